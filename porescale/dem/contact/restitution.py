"""Restitution of a damped contact: the same for the linear law and that of Hertz with its own damping.

Both obey p dp/dy + 2 h w p + w^2 y = 0 between speed p and a measure y of the overlap (the overlap itself, or its power
5/4), and is released at the same point of it.  So restitution depends on the damping ratio h alone, not on the speed.
Sources: release at zero force, Schwager & Poeschel 2007, Granular Matter 9, 465; Hertz, Antypov & Elliott 2011, EPL 94,
50004.
"""

import math

from porescale.common.core.ranges import Range, require_in_range
from porescale.common.core.roots import brent


def contact_phase(h: float, release: str) -> float:
    """Duration of a linear contact times w0, at damping ratio ``h``; Schwager & Poeschel 2007 for release "force"."""
    if release == "overlap":
        return math.pi / math.sqrt(1.0 - h * h) if h < 1.0 else math.inf
    if abs(h - 1.0) < 1e-8:
        return 2.0  # both branches below tend to 2, 2 + 2(1-h)/3, and cancel to 0/0 at h = 1
    if h < 1.0:
        s = math.sqrt((1.0 - h) * (1.0 + h))
        return math.atan2(2.0 * h * s, 2.0 * h * h - 1.0) / s
    s = math.sqrt((h - 1.0) * (h + 1.0))
    return 2.0 * math.log(h + s) / s  # (h+s)/(h-s) = (h+s)^2


def restitution_of(h: float, release: str) -> float:
    """Parting speed over approach speed at damping ratio ``h``: exp(-h phase) for both rules."""
    return math.exp(-h * contact_phase(h, release)) if h > 0.0 else 1.0


def ratio_from_restitution(restitution: float, release: str) -> float:
    """Damping ratio that gives ``restitution``.

    Raises InputError unless 0 < restitution <= 1 (release "overlap" also allows 0: critical damping).
    """
    allowed = Range(ge=0, le=1) if release == "overlap" else Range(gt=0, le=1)
    require_in_range("contact", {"restitution": restitution}, {"restitution": allowed})
    if restitution == 1.0:
        return 0.0
    if restitution == 0.0:
        return 1.0
    wanted = -math.log(restitution)
    if release == "overlap":
        return wanted / math.hypot(math.pi, wanted)
    # h phase(h) grows from 0 like pi h and for large h like 2 ln 2h: e = 1/(4 h^2) brackets the root.
    highest = 1.0 + math.exp(0.5 * wanted)

    def excess(h: float) -> float:
        """What the phase of ``h`` is above that wanted; 0 at the root."""
        return h * contact_phase(h, release) - wanted

    return brent(excess, 0.0, highest, xtol=1e-15, rtol=1e-14)

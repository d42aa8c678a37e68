"""Linear springs and dashpots with a Coulomb limit.

Normal:      F = k_n d + c_n d',  d overlap (m), d' closing speed (m/s), F > 0 pushes apart.
Tangential:  f = -(k_t s + c_t v_t),  s the spring (m), one scalar per contact, v_t the slip speed (m/s).

Two rules for the end of a contact, which differ in restitution:
  release "force"   : F = max(0, ...), never pulls; the contact ends when the force vanishes;
  release "overlap" : F as it is while d > 0, may attract; the contact ends when the overlap vanishes.

Friction, limit L = mu max(0, F).  The spring is a Coulomb element of its own: first it moves with the slip,
s <- s + v_t dt, and is cut back to |k_t s| <= L, which is the reset on sliding; only then the dashpot is
added, and the sum is cut to |f| <= L again.  So the dashpot decides with the spring whether the contact
slides, but never enters the stored spring.  Each cut only dissipates: a spring lengthens by no more than
the slip that did work on it. (Resetting the spring to the limit with the dashpot in the check, as is
common, stores energy nobody supplied.)

Sources: Cundall & Strack 1979; release at zero force: Schwager & Poeschel 2007, Granular Matter 9, 465.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from porescale.ground.check import Fault, InputError
from porescale.ground.jit import inline

KN, CN, KT, CT, MU, RULE, YIELD = range(7)
"""Columns of a law's row, as kernels read it; YIELD is 1/k_t, which spares a division per contact (0 for
k_t = 0).
"""
COLUMNS = 7
RELEASES = ("force", "overlap")
RELEASE_FORCE, RELEASE_OVERLAP = 0.0, 1.0


@inline
def normal_force(overlap, closing, p):
    """Repulsion (N/m) at ``overlap`` (m) > 0 and ``closing`` speed (m/s) of the law row p (7,); see
    module.
    """
    force = p[KN] * overlap + p[CN] * closing
    if p[RULE] == RELEASE_FORCE:
        force = max(force, 0.0)
    return force


@inline
def tangential_force(spring, slip, limit, dt, p):
    """Friction and the new spring: (force N/m along t on body i, spring m).

    spring (m) before the step, slip speed v_t (m/s), limit mu F (N/m) >= 0, dt (s), p (7,) law row.
    """
    reach = limit * p[YIELD]
    spring = min(max(spring + slip * dt, -reach), reach)
    force = p[KT] * spring + p[CT] * slip
    force = min(max(force, -limit), limit)
    return -force, spring


@inline
def contact_force(overlap, closing, slip, spring, dt, p):
    """One contact: (normal N/m, tangential N/m, spring m).  The same function for pairs, walls and plates.

    overlap (m) > 0, closing and slip speed (m/s), spring (m), dt (s), p (7,) law row.
    """
    normal = normal_force(overlap, closing, p)
    limit = p[MU] * max(normal, 0.0)
    tangential, spring = tangential_force(spring, slip, limit, dt, p)
    return normal, tangential, spring


@dataclass(frozen=True)
class Linear:
    """Linear law per metre of depth.

    stiffness k_n : N/m per metre, > 0;   damping c_n : N s/m per metre, >= 0;
    tangential_stiffness k_t, tangential_damping c_t : likewise, >= 0;   friction mu : -, >= 0;
    release : "force" (never pulls) or "overlap" (may attract), see module.
    """

    name = "linear"
    stiffness: float
    damping: float = 0.0
    tangential_stiffness: float = 0.0
    tangential_damping: float = 0.0
    friction: float = 0.0
    release: str = "force"

    def __post_init__(self) -> None:
        faults = []
        if not (self.stiffness > 0.0 and math.isfinite(self.stiffness)):
            faults.append(Fault("contact.stiffness", self.stiffness, unit="N/m", allowed="> 0"))
        for key, unit in (
            ("damping", "N s/m"),
            ("tangential_stiffness", "N/m"),
            ("tangential_damping", "N s/m"),
            ("friction", ""),
        ):
            value = getattr(self, key)
            if not (value >= 0.0 and math.isfinite(value)):
                faults.append(Fault(f"contact.{key}", value, unit=unit, allowed=">= 0"))
        if self.release not in RELEASES:
            faults.append(Fault("contact.release", self.release, allowed=" or ".join(RELEASES)))
        if faults:
            raise InputError(faults)

    @classmethod
    def from_restitution(
        cls,
        restitution: float,
        mass: float,
        stiffness: float,
        tangential_stiffness: float = 0.0,
        tangential_damping: float = 0.0,
        friction: float = 0.0,
        release: str = "force",
    ) -> Linear:
        """The law whose normal coefficient of restitution is ``restitution`` at effective ``mass``
        (kg/m).
        """
        damping = damping_from_restitution(restitution, mass, stiffness, release)
        return cls(stiffness, damping, tangential_stiffness, tangential_damping, friction, release)

    def with_friction(self, friction: float) -> Linear:
        """The same law with another friction coefficient."""
        return replace(self, friction=friction)

    def row(self) -> NDArray[np.float64]:
        """The law as kernels read it, (7,) float64, see the columns above."""
        return np.array(
            [
                self.stiffness,
                self.damping,
                self.tangential_stiffness,
                self.tangential_damping,
                self.friction,
                float(RELEASES.index(self.release)),
                1.0 / self.tangential_stiffness if self.tangential_stiffness > 0.0 else 0.0,
            ]
        )

    def frequency(self, mass: float) -> float:
        """Undamped angular frequency w0 = sqrt(k/m), rad/s, at effective ``mass`` (kg/m)."""
        return math.sqrt(self.stiffness / mass)

    def damping_ratio(self, mass: float) -> float:
        """h = c / (2 sqrt(k m)) at effective ``mass`` (kg/m)."""
        return self.damping / (2.0 * math.sqrt(self.stiffness * mass))

    def contact_time(self, mass: float) -> float:
        """Seconds from touch until the contact ends; infinite for release "overlap" at h >= 1.

        mass : effective, m1 m2/(m1 + m2), or m against a wall, kg/m.
        """
        return contact_phase(self.damping_ratio(mass), self.release) / self.frequency(mass)

    def restitution(self, mass: float) -> float:
        """Parting speed over approach speed at effective ``mass`` (kg/m): exp(-h w0 T) for both rules."""
        h = self.damping_ratio(mass)
        return math.exp(-h * contact_phase(h, self.release)) if h > 0.0 else 1.0

    def critical_step(self, mass: float) -> float:
        """Stability limit (s) of leap-frog with lagged damping for one pair: 2 (sqrt(1+h^2) - h)/w0."""
        h = self.damping_ratio(mass)
        return 2.0 * (math.hypot(1.0, h) - h) / self.frequency(mass)


def contact_phase(h: float, release: str) -> float:
    """Duration of a contact times w0, at damping ratio ``h``; Schwager & Poeschel 2007 for release
    "force".
    """
    if release == "overlap":
        return math.pi / math.sqrt(1.0 - h * h) if h < 1.0 else math.inf
    if abs(h - 1.0) < 1e-8:
        return 2.0  # both branches below tend to 2, 2 + 2(1-h)/3, and cancel to 0/0 at h = 1
    if h < 1.0:
        s = math.sqrt((1.0 - h) * (1.0 + h))
        return math.atan2(2.0 * h * s, 2.0 * h * h - 1.0) / s
    s = math.sqrt((h - 1.0) * (h + 1.0))
    return 2.0 * math.log(h + s) / s  # (h+s)/(h-s) = (h+s)^2


def damping_from_restitution(restitution: float, mass: float, stiffness: float, release: str) -> float:
    """Damping c (N s/m) that gives ``restitution`` at effective ``mass`` (kg/m) and ``stiffness`` (N/m).

    Raises InputError unless 0 < restitution <= 1 (release "overlap" also allows 0: critical damping).
    """
    allowed = "0 <= e <= 1" if release == "overlap" else "0 < e <= 1"
    if not (0.0 <= restitution <= 1.0) or (restitution == 0.0 and release == "force"):
        raise InputError(Fault("contact.restitution", restitution, allowed=allowed))
    if restitution == 1.0:
        return 0.0
    scale = 2.0 * math.sqrt(stiffness * mass)
    if restitution == 0.0:
        return scale
    wanted = -math.log(restitution)
    if release == "overlap":
        return scale * wanted / math.hypot(math.pi, wanted)
    # h phase(h) grows from 0 like pi h and for large h like 2 ln 2h: e = 1/(4 h^2) brackets the root.
    highest = 1.0 + math.exp(0.5 * wanted)

    def excess(h: float) -> float:
        return h * contact_phase(h, release) - wanted

    return scale * float(brentq(excess, 0.0, highest, xtol=1e-15, rtol=1e-14))

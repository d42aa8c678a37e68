"""Stable contact step: of discs in any packing, and of clumps, as the mass of a disc with the same limit."""

import math
from collections.abc import Sequence

import numpy as np

from porescale.common.core.ranges import Range, require_in_range
from porescale.common.core.types import Floats
from porescale.dem.bodies.clumps import Clumps, fastest
from porescale.dem.contact.law import ContactLaw
from porescale.dem.discs import Discs

NEIGHBOURS = 6
"""Most discs that touch a disc and are no smaller than it: the kissing number of the plane."""
SAFETY = 0.8
"""Share of a limit at which steps are chosen."""
HALVINGS = 60
"""Steps to a fixed point each of which halves the logarithm of the distance, at least."""


def lightest(clumps: Clumps, discs: Discs, laws: Sequence[ContactLaw]) -> float:
    """Mass (kg/m) that the smallest disc would have if its packing limit (packing_limit) were that of the
    fastest clump under all of ``laws``; infinite where all clumps are with a prescribed velocity.

    Contacts of clumps count as stiff as those of the largest member, and as damped as those of the heaviest clump.
    """
    found, size, largest = [], float(discs.radius.min()), float(clumps.radius.max())
    for law in laws:
        for kind, own in enumerate(law.stiffest(float(clumps.mass.max()), largest)):
            if max(own) > 0.0:
                most = fastest(clumps, discs.radius, *own, NEIGHBOURS, law.rolling_friction)
                mass = float(discs.mass.min())
                if most == 0.0:  # all are with a prescribed velocity
                    continue
                for _ in range(HALVINGS):  # dashpots of Hertz go with the root of the mass that is looked for
                    mass = packing_factor(*law.stiffest(mass, size)[kind]) / most
                found.append(mass)
    return min(found, default=math.inf)


def packing_factor(normal: float, tangential: float, rolling: float = 0.0) -> float:
    """Largest eigenvalue bound, N/m: m w^2 of the stiffest motion in any packing of discs of mass >= m.

    Energy of a contact: k_n/2 (n.(u_i - u_j))^2 + k_t/2 (t.(u_i - u_j) + r_i q_i + r_j q_j)^2.  From
    (a - b)^2 <= 2 a^2 + 2 b^2 it is at most the sum over both ends of k_n (n.u)^2 + k_t (t.u + r q)^2, so
    w^2 is at most the largest eigenvalue of a single disc on contacts twice as stiff, held still at their
    other ends.  The smallest disc is the stiffest; it touches at most 6, and six contacts 60 degrees apart
    give
        translation: 2 * 3 (k_n + k_t)/m,      rotation: 2 * 6 k_t r^2/I = 24 k_t/m.
    Table 1 of Saito et al. (k_t = k_n/4): 7.5 k_n/m, dt = 2.2e-5 s; the infinite triangular lattice itself
    reaches 6.5 k_n/m, 2.3e-5 s (a zone-boundary wave), where one pair alone allows 4.2e-5 s.
    Rolling springs, k_r/2 R^2 (q_i - q_j)^2 with R <= r, add 24 k_r/m to rotation in the same way.
    """
    return max(NEIGHBOURS * (normal + tangential), 4.0 * NEIGHBOURS * (tangential + rolling))


def crowded(radius: Floats, safety: float = SAFETY) -> Floats:
    """How much heavier (n,) than one mass for all discs of ``radius`` (n,) m must be for the step of that mass.

    Of the smallest, pi/arcsin(r0/(r + r0)) fit round a disc, where the step counts on NEIGHBOURS; ``safety`` leaves
    room for 1/safety² times as many.  Not needed of discs of one density, whose mass grows with their area.
    """
    smallest = radius.min()
    made: Floats = np.maximum(1.0, safety**2 / NEIGHBOURS * np.pi / np.arcsin(smallest / (radius + smallest)))
    return made


def packing_limit(law: ContactLaw, mass: float, radius: float | None = None) -> float:
    """Stability limit (s) in any packing whose lightest disc has ``mass`` (kg/m), damping lagged half a
    step.  The law of Hertz also needs its ``radius`` (m), and takes the stiffness at its ``deepest`` overlap.

    A mode z = -1 needs dt^2 K + 2 dt C = 4 M; with bounds K/M = a, C/M = b: dt = 2 / (b/2 + sqrt(b^2/4 +
    a)), which is 2 (sqrt(1 + h^2) - h)/w for one pair.
    """
    if radius is None and law.needs_radius:
        raise ValueError(f"the stable step of the law {law.name!r} depends on the radius")
    a, b = (packing_factor(*part) / mass for part in law.stiffest(mass, radius or 0.0))
    return 2.0 / (0.5 * b + math.sqrt(0.25 * b * b + a))


def stable_step(
    laws: ContactLaw | Sequence[ContactLaw],
    mass: float,
    radius: float | None = None,
    *,
    safety: float = SAFETY,
    steps_per_contact: float = 10.0,
) -> float:
    """A safe contact step (s) for discs whose lightest has ``mass`` (kg/m) and ``radius`` (m) under all of ``laws``.

    ``safety`` times the packing limit, and at least ``steps_per_contact`` steps in the shortest contact of
    two such discs (a free bounce errs by about a step in its duration; 0: stability alone decides).  Linear laws do
    without the radius; see packing_limit for that of Hertz.  Raises InputError unless safety > 0 and
    steps_per_contact >= 0.
    """
    given = {"safety": safety, "steps_per_contact": steps_per_contact}
    require_in_range("stable_step", given, {"safety": Range(gt=0), "steps_per_contact": Range(ge=0)})
    steps = []
    for law in laws if isinstance(laws, Sequence) else [laws]:
        steps.append(safety * packing_limit(law, mass, radius))
        if steps_per_contact > 0.0:
            steps.append(law.shortest_contact(0.5 * mass, 0.5 * (radius or 0.0)) / steps_per_contact)
    return min(steps)

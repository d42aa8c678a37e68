"""A contact as kernels see it: one body for every law, cut to what the law has when it is compiled.

Normal:      F = F_el(d) + g d',  d overlap (m), d' closing speed (m/s), F > 0 pushes apart; two rules for its end:
  release "force"   : F = max(0, ...), never pulls; the contact ends when the force vanishes;
  release "overlap" : F as it is while d > 0, may attract; the contact ends when the overlap vanishes.
Tangential:  f = -(k_t s + c_t v_t),  s the spring (m), one scalar per contact, v_t the slip speed (m/s), limit mu F.
Rolling:     M = -R (k_r u + c_r v_r),  v_r = R (w_i - w_j) rolling speed (m/s), u its spring (m), R the reduced radius
r_i r_j/(r_i + r_j) (r at a wall), limit |M| <= mu_r R F: equal and opposite on both bodies, so that angular momentum is
kept.  An elastic-plastic spring with a dashpot, "type C" of Ai et al.

Both springs are Coulomb elements of their own: first a spring moves with the slip, s <- s + v_t dt, and is cut back to
|k_t s| <= mu F, which is the reset on sliding; only then the dashpot is added, and the sum is cut to the limit again.
So the dashpot decides with the spring whether the contact slides, but never enters the stored spring.  Each cut only
dissipates: a spring lengthens by no more than the slip that did work on it.  (Resetting the spring to the limit with
the dashpot in the check, as is common, stores energy nobody supplied.)

A law goes into kernels as a flat NamedTuple: its class says which bodies are compiled (linear or Hertz, with rolling
resistance or without), the absence of ``material`` and ``book`` leaves out what serves several materials and the energy
book.

Sources: Cundall & Strack 1979, Geotechnique 29, 47; release at zero force: Schwager & Poeschel 2007, Granular Matter 9,
465; rolling: Iwashita & Oda 1998, J. Eng. Mech. 124, 285; Ai, Chen, Rotter & Ooi 2011, Powder Technology 206, 269;
rolling speed independent of the observer: Luding 2008, Granular Matter 10, 235.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import by_law, inline

Array = NDArray[np.float64]

KN, CN, KT, CT, MU, RULE, YIELD, KR, CR, MUR, RYIELD = range(11)
"""Columns of a law's row, as kernels read it.  YIELD is 1/k_t and RYIELD 1/k_r, which spare divisions (0 for none)."""
COLUMNS = 11
RELEASES = ("force", "overlap")
RELEASE_FORCE, RELEASE_OVERLAP = 0.0, 1.0

NORMAL_DASHPOT, TANGENTIAL_DASHPOT, FRICTION, ROLLING_DASHPOT, ROLLING_FRICTION = range(5)
SURFACES, EXTERNAL, HOLDERS, DRAG = range(5, 9)
BEFORE_X, BEFORE_Y, BEFORE_SPIN = range(9, 12)
"""Columns of the energy book: lost in dashpots and friction, work of moving surfaces, of external forces and of those
who hold discs, lost to the background drag (J/m); velocity and spin half a step before the last force (m/s, rad/s)."""
BOOK = 12


class LinearSliding(NamedTuple):
    """Linear law without rolling resistance.

    table (m, m, COLUMNS): rows by the materials of both discs;  material (n,) uint8, or None where there is one;
    mass (n,) kg/m of the discs;  book (n, BOOK): energy book, at the lower disc of a pair, or None.
    """

    table: Array
    material: NDArray[np.uint8] | None
    mass: Array
    book: Array | None


class LinearRolling(NamedTuple):
    """Linear law with rolling resistance; fields as in LinearSliding."""

    table: Array
    material: NDArray[np.uint8] | None
    mass: Array
    book: Array | None


class HertzSliding(NamedTuple):
    """Law of Hertz and Mindlin without rolling resistance; fields as in LinearSliding."""

    table: Array
    material: NDArray[np.uint8] | None
    mass: Array
    book: Array | None


class HertzRolling(NamedTuple):
    """Law of Hertz and Mindlin with rolling resistance; fields as in LinearSliding."""

    table: Array
    material: NDArray[np.uint8] | None
    mass: Array
    book: Array | None


class LinearSmooth(NamedTuple):
    """Linear law without friction; fields as in LinearSliding.  Springs are neither read nor written: they are zero
    and stay so, and nothing turns a disc.
    """

    table: Array
    material: NDArray[np.uint8] | None
    mass: Array
    book: Array | None


KernelLaw = LinearSliding | LinearRolling | HertzSliding | HertzRolling | LinearSmooth


def memory_of(law: KernelLaw) -> int:
    """Numbers that a contact under ``law`` carries from step to step: its springs."""
    return 2 if isinstance(law, LinearRolling | HertzRolling) else 1


@by_law
def stiffness(overlap, radius, mass, p, law):
    """(elastic force N/m, normal damping N s/m, scale, 1/scale, tangential and rolling damping N s/m).

    overlap (m) > 0;  radius (m) and mass (kg/m) reduced;  p (COLUMNS,) row.  Tangential and rolling stiffness are
    p[KT] and p[KR] times the scale.
    """


@by_law
def scale_at(overlap, radius, law):
    """What tangential and rolling stiffness are in proportion to, at ``overlap`` (m) >= 0, ``radius`` (m) reduced."""


@by_law
def kept(overlap, closing, dt, law):
    """Share of a spring that is left when the overlap (m) has come to what it is at ``closing`` (m/s) over ``dt``."""


@by_law
def stored_normal(overlap, radius, p, law):
    """Elastic energy (J/m) at ``overlap`` (m) > 0, reduced ``radius`` (m), row p (COLUMNS,)."""


@inline
def coulomb(spring, slip, limit, dt, stiff, soft, damping):
    """Spring, slider and dashpot: (force N/m against the slip, new spring m).

    spring (m) before the step, slip (m/s), limit (N/m) >= 0, dt (s), stiff (N/m), soft 1/stiff or 0, damping N s/m.
    """
    reach = limit * soft
    spring = min(max(spring + slip * dt, -reach), reach)
    force = stiff * spring + damping * slip
    force = min(max(force, -limit), limit)
    return -force, spring


@by_law
def sliding(spring, slip, limit, dt, stiff, soft, damping, law):
    """The tangential force (N/m) and its new spring (m): see ``coulomb``."""


@sliding.of(LinearSliding, LinearRolling, HertzSliding, HertzRolling)
def _sliding(spring, slip, limit, dt, stiff, soft, damping, law):
    """As far as friction goes."""
    return coulomb(spring, slip, limit, dt, stiff, soft, damping)


@sliding.of(LinearSmooth)
def _smooth(spring, slip, limit, dt, stiff, soft, damping, law):
    """None."""
    return 0.0, 0.0


@by_law
def push(normal, tangential, nx, ny, law):
    """Components (N/m) of the force on a body that presses with ``normal`` along (nx, ny): see ``contact``."""


@push.of(LinearSliding, LinearRolling, HertzSliding, HertzRolling)
def _push(normal, tangential, nx, ny, law):
    """Both parts."""
    return -normal * nx - tangential * ny, -normal * ny + tangential * nx


@push.of(LinearSmooth)
def _push_smooth(normal, tangential, nx, ny, law):
    """The normal one alone."""
    return -normal * nx, -normal * ny


@by_law
def rolling(roll, turning, limit, scale, softness, damping, dt, p, law):
    """Rolling resistance over the reduced radius and its new spring: (N/m, m).

    roll (m), turning R (w_i - w_j) (m/s), limit F (N/m) >= 0, scale, softness 1/scale, damping (N s/m), dt (s), p row.
    """


@rolling.of(LinearSliding, HertzSliding, LinearSmooth)
def _no_rolling(roll, turning, limit, scale, softness, damping, dt, p, law):
    """Discs roll freely."""
    return 0.0, 0.0


@rolling.of(LinearRolling, HertzRolling)
def _rolling(roll, turning, limit, scale, softness, damping, dt, p, law):
    """Spring, slider and dashpot against rolling."""
    return coulomb(roll, turning, p[MUR] * limit, dt, p[KR] * scale, p[RYIELD] * softness, damping)


@by_law
def moments(tangential, resisting, arm_i, arm_j, radius, law):
    """Torques on both bodies, N m/m: tangential force (N/m) at lever arms (m), rolling resistance at the radius (m)."""


@moments.of(LinearSliding, HertzSliding)
def _moments_sliding(tangential, resisting, arm_i, arm_j, radius, law):
    """Those of the tangential force."""
    return tangential * arm_i, tangential * arm_j


@moments.of(LinearRolling, HertzRolling)
def _moments_rolling(tangential, resisting, arm_i, arm_j, radius, law):
    """Equal and opposite ones of rolling besides."""
    return tangential * arm_i + resisting * radius, tangential * arm_j - resisting * radius


@moments.of(LinearSmooth)
def _no_moments(tangential, resisting, arm_i, arm_j, radius, law):
    """None: adding -0.0 changes no bit, so no torque is read or written for it."""
    return -0.0, -0.0


@by_law
def recall(memory, k, law):
    """(spring, rolling spring), m, of contact k of ``memory`` (m, 1 or 2)."""


@recall.of(LinearSliding, HertzSliding)
def _recall_sliding(memory, k, law):
    """One spring a contact."""
    return memory[k, 0], 0.0


@recall.of(LinearSmooth)
def _recall_nothing(memory, k, law):
    """Springs at rest."""
    return 0.0, 0.0


@recall.of(LinearRolling, HertzRolling)
def _recall_rolling(memory, k, law):
    """Two springs a contact."""
    return memory[k, 0], memory[k, 1]


@by_law
def remember(memory, k, spring, roll, law):
    """Overwrite both springs (m) of contact k of ``memory`` (m, 1 or 2)."""


@remember.of(LinearSliding, HertzSliding)
def _remember_sliding(memory, k, spring, roll, law):
    """One spring a contact."""
    memory[k, 0] = spring


@remember.of(LinearSmooth)
def _remember_nothing(memory, k, spring, roll, law):
    """They are."""


@remember.of(LinearRolling, HertzRolling)
def _remember_rolling(memory, k, spring, roll, law):
    """Two springs a contact."""
    memory[k, 0] = spring
    memory[k, 1] = roll


@inline
def holds(memory, k, law):
    """Whether contact k of ``memory`` (m, 1 or 2) has a spring that is not at rest."""
    spring, roll = recall(memory, k, law)
    return spring != 0.0 or roll != 0.0


@inline
def booked(book):
    """Whether there is an energy book."""
    return book is not None


@inline
def material_of(material, i):
    """Material of disc i; 0 where there is one."""
    if material is None:
        return 0
    return material[i]


@inline
def contact(overlap, closing, slip, turning, spring, roll, radius, mass, dt, p, law):
    """One contact: (normal, tangential, rolling N/m, springs m).  The same function for pairs and surfaces.

    overlap (m) > 0;  closing, slip and rolling speed (m/s);  springs (m);  radius (m) and mass (kg/m) reduced;  dt (s);
    p (COLUMNS,) row.
    """
    elastic, damping, scale, softness, rubbing, turning_damping = stiffness(overlap, radius, mass, p, law)
    normal = elastic + damping * closing
    if p[RULE] == RELEASE_FORCE:
        normal = max(normal, 0.0)
    limit = max(normal, 0.0)
    left = kept(overlap, closing, dt, law)
    tangential, spring = sliding(
        left * spring, slip, p[MU] * limit, dt, p[KT] * scale, p[YIELD] * softness, rubbing, law
    )
    resisting, roll = rolling(left * roll, turning, limit, scale, softness, turning_damping, dt, p, law)
    return normal, tangential, resisting, spring, roll


@inline
def element_losses(before, after, force, slip, old_stiff, stiff, dt):
    """(lost in the dashpot, lost in the slider), J/m, of one Coulomb element over the step that led here.

    before, after: spring (m);  force (N/m) on the body;  slip (m/s);  stiffness (N/m) before and after.  The spring's
    force at both ends of the step does work on the slip between them, trapezoidal, as leap-frog does; what the spring
    has not kept went into the slider.
    """
    held, holds = old_stiff * before, stiff * after
    worked = 0.5 * (held + holds) * slip * dt
    return (-force - holds) * slip * dt, worked - 0.5 * (holds * after - held * before)


@inline
def note_contact(
    i, overlap, closing, slip, turning, before, roll_before, normal, tangential, resisting, spring, roll, radius, mass,
    dt, p, book, law,
):  # fmt: skip
    """Enter into ``book`` (n, BOOK), row i, what one contact lost in the step; nothing where it is None.

    Arguments and results of ``contact``, with the springs before.
    """
    if book is None:
        return
    elastic, _, scale, _, _, _ = stiffness(overlap, radius, mass, p, law)
    old = scale_at(max(overlap - closing * dt, 0.0), radius, law)
    book[i, NORMAL_DASHPOT] += (normal - elastic) * closing * dt
    dashpot, slider = element_losses(before, spring, tangential, slip, p[KT] * old, p[KT] * scale, dt)
    book[i, TANGENTIAL_DASHPOT] += dashpot
    book[i, FRICTION] += slider
    dashpot, slider = element_losses(roll_before, roll, resisting, turning, p[KR] * old, p[KR] * scale, dt)
    book[i, ROLLING_DASHPOT] += dashpot
    book[i, ROLLING_FRICTION] += slider


@inline
def note_parting(i, overlap, closing, slip, turning, before, roll_before, radius, dt, p, book, law):
    """Enter into ``book`` (n, BOOK), row i, what springs lost that let go within the step; nothing where it is None.

    overlap (m) < 0;  the other arguments as in ``contact``, springs before.  The force of a step ago does half a step's
    work more, and what the springs held is gone.
    """
    if book is None:
        return
    old = scale_at(max(overlap - closing * dt, 0.0), radius, law)
    book[i, FRICTION] += element_losses(before, 0.0, 0.0, slip, p[KT] * old, 0.0, dt)[1]
    book[i, ROLLING_FRICTION] += element_losses(roll_before, 0.0, 0.0, turning, p[KR] * old, 0.0, dt)[1]


@inline
def note_work(book, i, column, power, dt):
    """Add ``power`` (W/m) over ``dt`` (s) to a column of ``book`` (n, BOOK), row i; nothing where it is None."""
    if book is None:
        return
    book[i, column] += power * dt


@inline
def stored(overlap, spring, roll, radius, p, law):
    """Elastic energy of one contact, J/m: (normal, tangential, rolling); arguments as in ``contact``."""
    scale = scale_at(overlap, radius, law)
    return (
        stored_normal(overlap, radius, p, law),
        0.5 * p[KT] * scale * spring * spring,
        0.5 * p[KR] * scale * roll * roll,
    )

"""A contact as kernels take it: springs, dashpots and sliders round the elastic force of a law.

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
the dashpot in the check, as is common, stores energy that no work supplied.)

A law goes into kernels as a flat NamedTuple, its class chosen by the law's file: that says which of the four formulas
below (``stiffness`` to ``stored_normal``) are compiled.  The absence of ``friction`` or ``rolling`` leaves their part
out, that of ``material`` and ``budget`` of the discs what serves several materials and the energy budget.

Sources: Cundall & Strack 1979, Geotechnique 29, 47; release at zero force: Schwager & Poeschel 2007, Granular Matter 9,
465; rolling: Iwashita & Oda 1998, J. Eng. Mech. 124, 285; Ai, Chen, Rotter & Ooi 2011, Powder Technology 206, 269;
rolling speed independent of the observer: Luding 2008, Granular Matter 10, 235.
"""

from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple, Protocol

from porescale.common.compiled.jit import inline, law_function
from porescale.common.core.types import Floats

KN, CN, KT, CT, MU, RULE, COMPLIANCE_T, KR, CR, MUR, COMPLIANCE_R = range(11)
"""Columns of a law's row, as kernels read it.  The compliances are 1/k_t and 1/k_r, which spare divisions (0 for none).
"""
COLUMNS = 11
"""Columns that every law has; a user's own law has one more for each of its keys, see own.py."""
RELEASES = ("force", "overlap")
RELEASE_FORCE, RELEASE_OVERLAP = 0.0, 1.0


class KernelLaw(NamedTuple):
    """A law as kernels take it; the file of a law derives a class of its own, for its formulas.

    table (m, m, COLUMNS): rows by the materials of both discs;  friction: None leaves it out, springs are then neither
    read nor written: they are zero and stay so, and nothing turns a disc;  rolling: None where there is no resistance.
    """

    table: Floats
    friction: float | None
    rolling: float | None


class Springs(NamedTuple):
    """Normal, tangential and rolling stiffness (N/m) and dashpots (N s/m) per metre of depth, as the stable step takes
    them of a law; the last of each is 0 without rolling resistance."""

    stiffness: tuple[float, float, float]
    damping: tuple[float, float, float]


class ContactLaw(Protocol):
    """What a law of contacts provides.  A law is one file of this folder: parameters, formulas, source, consequences.

    The file has a frozen dataclass with these members, ``LAW = TheClass`` for the register (choose.py), a class derived
    from KernelLaw, and bodies for it of the four formulas: ``@stiffness.of(TheKernel)`` and so on.
    """

    name: ClassVar[str]
    """Name of the law in scenes, [contact] law."""
    order: ClassVar[int]
    """Position of the law in lists of all contact laws."""
    purpose: ClassVar[str]
    """What the law is good for, one line."""
    kernel: ClassVar[type[KernelLaw]]
    """Class of the law as kernels take it."""
    keys: ClassVar[tuple[str, ...]]
    """Keys of [contact] that belong to this law, restitution, friction and rolling_friction not counted."""
    required: ClassVar[tuple[str, str]]
    """The key that must be given, and its unit."""
    damping_keys: ClassVar[tuple[str, ...]]
    """Keys of [contact] that give the damping; exactly one of them is given."""
    of_materials: ClassVar[tuple[str, ...]]
    """Keys that follow from two materials, and are not given for a pair."""
    needs_radius: ClassVar[bool]
    """Whether points, corners without thickness, have no contact."""
    compresses: ClassVar[bool]
    """Whether packings are compressed, and rock is bonded, under this law: it has one stiffness."""

    def __hash__(self) -> int:
        """Laws are values: equal ones have the same hash."""

    @property
    def friction(self) -> float:
        """Coulomb friction coefficient of the contact, -."""

    @property
    def rolling_friction(self) -> float:
        """Coefficient of rolling friction."""

    @property
    def release(self) -> str:
        """Rule for the end of a contact: one of RELEASES."""

    @property
    def rolls(self) -> bool:
        """Whether there is rolling resistance."""

    @classmethod
    def from_numbers(cls, numbers: Mapping[str, float], release: str, mass: float, deepest: float) -> "ContactLaw":
        """The law of the keys of [contact];  mass (kg/m): of two grains each, whose restitution is given;  deepest:
        overlap over radius that the stable step allows for."""

    def with_numbers(self, numbers: Mapping[str, float], mass: float) -> "ContactLaw":
        """This law with other numbers, by the keys of [contact];  mass (kg/m): effective, of the restitution."""

    def with_friction(self, friction: float) -> "ContactLaw":
        """This law with another friction coefficient."""

    def mixed(self, other: Any) -> "ContactLaw":
        """Between unlike materials, each of which has its law with itself; see materials.py for the rule."""

    def row(self) -> Floats:
        """The law as kernels read it, (COLUMNS,) float64."""

    def stiffest(self, mass: float, radius: float) -> Springs:
        """Springs that bound it for the stable step, for a disc of ``mass`` (kg/m) and ``radius`` (m)."""

    def shortest_contact(self, mass: float, radius: float) -> float:
        """Seconds that the shortest contact lasts, at effective ``mass`` (kg/m) and reduced ``radius`` (m)."""

    def restitution(self, mass: float, radius: float = 0.0) -> float:
        """Parting speed over approach speed at effective ``mass`` (kg/m) and reduced ``radius`` (m), at 1 cm/s where
        the speed counts."""

    def ratio_of_damping(self, mass: float, radius: float = 0.0) -> float:
        """Normal damping ratio at effective ``mass`` (kg/m) and reduced ``radius`` (m)."""

    def contact_report(self, mass: float, radius: float) -> tuple[float, str]:
        """Seconds that a contact lasts at effective ``mass`` (kg/m) and reduced ``radius`` (m), and a remark on it."""

    def impact(self, mass: float, radius: float, speed: float) -> tuple[float, float]:
        """Deepest overlap (m) of an undamped impact at ``speed`` (m/s), effective ``mass`` (kg/m), reduced ``radius``
        (m); and the power of the stiffness over overlap: what of it makes the overlap half as deep."""

    @staticmethod
    def friction_problem(numbers: Mapping[str, float]) -> tuple[str, str, str] | None:
        """What is wrong with the keys of friction and rolling: (key, problem, repair); None where nothing is."""


class Relative(NamedTuple):
    """Relative motion at a contact: overlap m;  closing, slip and rolling speed m/s;  reduced radius m."""

    overlap: float
    closing: float
    slip: float
    rolling: float
    radius: float


class Response(NamedTuple):
    """What a contact answers: normal (> 0 pushes apart), tangential and rolling force N/m, both new springs m."""

    normal: float
    tangential: float
    rolling: float
    spring: float
    roll: float


def springs_of(law: KernelLaw) -> int:
    """Numbers that a contact under ``law`` carries from step to step: its springs."""
    return 1 if law.rolling is None else 2


@law_function
def stiffness(overlap, radius, mass, p, law):
    """(elastic force N/m, normal damping N s/m, scale, 1/scale, tangential and rolling damping N s/m).

    overlap (m) > 0;  radius (m) and mass (kg/m) reduced;  p (COLUMNS,) row.  Tangential and rolling stiffness are
    p[KT] and p[KR] times the scale.  Bodies: in the file of each law.
    """


@law_function
def stiffness_scale(overlap, radius, law):
    """What tangential and rolling stiffness are in proportion to, at ``overlap`` (m) >= 0, ``radius`` (m) reduced."""


@law_function
def history_scaling(overlap, closing, dt, law):
    """Share of a spring that is left when the overlap (m) has come to what it is at ``closing`` (m/s) over ``dt``."""


@law_function
def stored_normal(overlap, radius, p, law):
    """Elastic energy (J/m) at ``overlap`` (m) > 0, reduced ``radius`` (m), row p (COLUMNS,)."""


@law_function
def normal_force(elastic, damping, seen, mass, p, law):
    """Normal force (N/m), > 0 pushes apart, before the rule for the end of a contact.

    elastic (N/m), damping (N s/m): of ``stiffness``;  seen: Relative motion;  mass (kg/m) reduced;  p (COLUMNS,) row.
    A law has a body of its own where the two do not add up.
    """


@normal_force.of(KernelLaw)
def _spring_and_dashpot(elastic, damping, seen, mass, p, law):
    """Spring and dashpot side by side."""
    return elastic + damping * seen.closing


@law_function
def row_numbers(p, law):
    """A row as numbers, which a loop over pairs reads once; a law with more columns has a body of its own."""


@row_numbers.of(KernelLaw)
def _row_numbers(p, law):
    """The columns that all laws have."""
    return p[KN], p[CN], p[KT], p[CT], p[MU], p[RULE], p[COMPLIANCE_T], p[KR], p[CR], p[MUR], p[COMPLIANCE_R]


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


@inline
def element_if(present, spring, slip, limit, dt, stiff, soft, damping):
    """As ``coulomb``; (0, 0) where ``present`` is None, which leaves the element out when compiled."""
    if present is None:
        return 0.0, 0.0
    return coulomb(spring, slip, limit, dt, stiff, soft, damping)


@inline
def components_if(friction, normal, tangential, nx, ny):
    """As force_components, without the tangential part where ``friction`` is None."""
    if friction is None:
        return -normal * nx, -normal * ny
    return -normal * nx - tangential * ny, -normal * ny + tangential * nx


@inline
def force_components(found, nx, ny, law):
    """Components (N/m) of the force on a body, from the Response of the contact along the unit vector (nx, ny)."""
    return components_if(law.friction, found.normal, found.tangential, nx, ny)


@inline
def moments_if(friction, rolling, tangential, resisting, arm_i, arm_j, radius):
    """As ``moments``; adding -0.0 changes no bit, so without friction no torque is read or written for it."""
    if friction is None:
        return -0.0, -0.0
    if rolling is None:
        return tangential * arm_i, tangential * arm_j
    return tangential * arm_i + resisting * radius, tangential * arm_j - resisting * radius


@inline
def moments(found, arm_i, arm_j, radius, law):
    """Torques on both bodies, N m/m: tangential force at lever arms (m), rolling resistance at the reduced radius (m),
    equal and opposite.
    """
    return moments_if(law.friction, law.rolling, found.tangential, found.rolling, arm_i, arm_j, radius)


@inline
def load_if(friction, rolling, history, k):
    """(spring, rolling spring) of contact k, m; 0 for those that ``friction`` and ``rolling`` leave out."""
    if friction is None:
        return 0.0, 0.0
    if rolling is None:
        return history[k, 0], 0.0
    return history[k, 0], history[k, 1]


@inline
def load_history(history, k, law):
    """(spring, rolling spring), m, of contact k of ``history`` (m, 1 or 2); 0 for those that the law has not."""
    return load_if(law.friction, law.rolling, history, k)


@inline
def store_if(friction, rolling, history, k, spring, roll):
    """Overwrite row k of ``history`` with the springs (m) that ``friction`` and ``rolling`` do not leave out."""
    if friction is not None:
        history[k, 0] = spring
        if rolling is not None:
            history[k, 1] = roll


@inline
def store_history(history, k, spring, roll, law):
    """Overwrite the springs (m) of contact k of ``history`` (m, 1 or 2) that the law has."""
    store_if(law.friction, law.rolling, history, k, spring, roll)


@inline
def has_history(history, k, law):
    """Whether contact k of ``history`` (m, 1 or 2) has a spring that is not at rest."""
    spring, roll = load_history(history, k, law)
    return spring != 0.0 or roll != 0.0


@inline
def material_of(material, i):
    """Material of disc i; 0 where there is one."""
    if material is None:
        return 0
    return material[i]


@inline
def contact(seen, spring, roll, mass, dt, p, law):
    """One contact, for pairs and surfaces alike: the Response to the Relative motion ``seen``.

    spring, roll (m): before the step;  mass (kg/m) reduced;  dt (s);  p (COLUMNS,) row.
    """
    elastic, damping, scale, softness, rubbing, turning_damping = stiffness(seen.overlap, seen.radius, mass, p, law)
    normal = normal_force(elastic, damping, seen, mass, p, law)
    if p[RULE] == RELEASE_FORCE:
        normal = max(normal, 0.0)
    limit = max(normal, 0.0)
    left = history_scaling(seen.overlap, seen.closing, dt, law)
    tangential, spring = element_if(
        law.friction, left * spring, seen.slip, p[MU] * limit, dt, p[KT] * scale, p[COMPLIANCE_T] * softness, rubbing
    )
    resisting, roll = element_if(
        law.rolling, left * roll, seen.rolling, p[MUR] * limit, dt, p[KR] * scale, p[COMPLIANCE_R] * softness,
        turning_damping,
    )  # fmt: skip
    return Response(normal, tangential, resisting, spring, roll)


@inline
def stored(overlap, spring, roll, radius, p, law):
    """Elastic energy of one contact, J/m: (normal, tangential, rolling) at ``overlap`` (m) with these springs (m),
    reduced ``radius`` (m), row p (COLUMNS,)."""
    scale = stiffness_scale(overlap, radius, law)
    return (
        stored_normal(overlap, radius, p, law),
        0.5 * p[KT] * scale * spring * spring,
        0.5 * p[KR] * scale * roll * roll,
    )

"""Law of Hertz and Mindlin for discs: that of spheres of the discs' radii, one sphere to a metre of depth.

Normal:      F = K d^(3/2) + a d^(1/4) d',  K = 4/3 E sqrt(R),  a = 2 h sqrt(5/4 K m) = h sqrt(5 K m);
Tangential:  k_t = 8 G sqrt(R d),  c_t = 2 sqrt(5/6) h_t sqrt(m k_t);   rolling likewise, k_r in proportion to k_t.
R and m are the reduced radius and mass of the contact (r and m at a wall), E and G the moduli of the contact:
    1/E = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2,    1/G = (2 - nu_1)/G_1 + (2 - nu_2)/G_2.
(Two-dimensional codes, PFC2D among them, take the spheres' law, since a line contact of cylinders has no force law of
the overlap alone.)

With damping in proportion to d^(1/4) the restitution does not depend on the speed: with y = d^(5/4) speed and overlap
obey the linear oscillator p dp/dy + 2 h w p + w^2 y = 0, w = sqrt(4K/5m), and the force vanishes where its does.  So h
is its damping ratio and restitution.py holds for both rules of release.

The tangential spring s (m) is kept with k_t of the overlap: on unloading s stays, and the force falls with k_t; on
loading the force stays and s shrinks, since new area of contact comes in unstressed.  Otherwise a loop of loading and
unloading would give energy (Thornton, Cummins & Cleary 2011, Powder Technology 210, 189).

Sources: Mindlin & Deresiewicz 1953, J. Appl. Mech. 20, 327; Tsuji, Tanaka & Ishida 1992, Powder Technology 71, 239;
Antypov & Elliott 2011, EPL 94, 50004.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range, require_in_range
from porescale.dem.contact.law import (
    CN,
    CR,
    CT,
    KN,
    KR,
    KT,
    RELEASES,
    KernelLaw,
    Springs,
    history_scaling,
    stiffness,
    stiffness_scale,
    stored_normal,
)
from porescale.dem.contact.linear import series
from porescale.dem.contact.restitution import contact_phase, ratio_from_restitution, restitution_of

RENAMED = {"rolling_stiffness_ratio": "rolling_stiffness"}
"""Keys of [contact] that are called otherwise here."""
TANGENT = 2.0 * math.sqrt(5.0 / 6.0)
"""Damping over sqrt(m dF/dd) and ratio h: of a d^(1/4) = TANGENT h sqrt(m 3/2 K sqrt(d))."""


RANGES = {
    "modulus": Range("Pa", gt=0), "shear_modulus": Range("Pa", ge=0), "damping_ratio": Range(ge=0),
    "tangential_damping_ratio": Range(ge=0), "friction": Range(ge=0), "rolling_friction": Range(ge=0),
    "rolling_stiffness": Range(ge=0), "rolling_damping_ratio": Range(ge=0), "deepest": Range(gt=0),
}  # fmt: skip


class HertzKernel(KernelLaw):
    """The law of Hertz and Mindlin as kernels take it."""


@stiffness.of(HertzKernel)
def _stiffness(overlap, radius, mass, p, law):
    """Tangents that grow with the square root of the overlap."""
    scale = np.sqrt(radius * overlap)
    root = np.sqrt(mass * scale)
    # K d^(3/2) = 4/3 E sqrt(R d) d; the columns of damping hold what sqrt(m sqrt(R d)) multiplies.
    return p[KN] * scale * overlap, p[CN] * root, scale, 1.0 / scale, p[CT] * root, p[CR] * root


@stiffness_scale.of(HertzKernel)
def _stiffness_scale(overlap, radius, law):
    """Factor on the stiffness: radius of the contact area, m."""
    return np.sqrt(radius * overlap)


@history_scaling.of(HertzKernel)
def _history_scaling(overlap, closing, dt, law):
    """Springs shrink as the contact grows, so that their force stays; while it is unloaded they keep their length."""
    before = max(overlap - closing * dt, 0.0)
    return np.sqrt(min(before / overlap, 1.0))


@stored_normal.of(HertzKernel)
def _stored_normal(overlap, radius, p, law):
    """Integral of K d^(3/2) over the overlap."""
    return 0.4 * p[KN] * np.sqrt(radius * overlap) * overlap * overlap


@dataclass(frozen=True)
class Hertz:
    """Law of Hertz and Mindlin between like discs; see module for the formulas and ``of`` for elastic constants.

    modulus E, shear_modulus G : of the contact, Pa (of spheres to a metre of depth), > 0 and >= 0;
    damping_ratio h, tangential_damping_ratio h_t : -, >= 0;  friction mu : -, >= 0;  release : as in law.py;
    rolling_friction mu_r, rolling_stiffness over tangential stiffness, rolling_damping_ratio : -, >= 0;
    deepest : overlap over radius that the stable step allows for, > 0: stiffness grows with its root.
    """

    name: ClassVar = "hertz"
    order: ClassVar = 1
    purpose: ClassVar = "of Hertz and Mindlin, for spheres of the discs' radii, one a metre"
    kernel: ClassVar[type[KernelLaw]] = HertzKernel
    keys: ClassVar[tuple[str, ...]] = (
        "young", "poisson", "damping_ratio", "tangential_damping_ratio", "rolling_stiffness_ratio",
        "rolling_damping_ratio",
    )  # fmt: skip
    required: ClassVar = ("young", "Pa")
    damping_keys: ClassVar[tuple[str, ...]] = ("damping_ratio", "restitution")
    of_materials: ClassVar[tuple[str, ...]] = ("young", "poisson")
    needs_radius: ClassVar = True
    compresses: ClassVar = False

    modulus: float
    shear_modulus: float = 0.0
    damping_ratio: float = 0.0
    tangential_damping_ratio: float = 0.0
    friction: float = 0.0
    release: str = "force"
    rolling_friction: float = 0.0
    rolling_stiffness: float = 1.0
    rolling_damping_ratio: float = 0.0
    deepest: float = 0.02

    def __post_init__(self) -> None:
        require_in_range("contact", vars(self), RANGES, {"release": RELEASES})

    @classmethod
    def of(
        cls,
        young: float,
        poisson: float,
        restitution: float = 1.0,
        friction: float = 0.0,
        release: str = "force",
        rolling_friction: float = 0.0,
    ) -> "Hertz":
        """Discs of Young's modulus ``young`` (Pa) and Poisson's ratio, dashpots all at the ratio of ``restitution``.

        Raises InputError unless young > 0 and -1 < poisson <= 0.5.
        """
        given = {"young": young, "poisson": poisson}
        require_in_range("contact", given, {"young": Range("Pa", gt=0), "poisson": Range(gt=-1, le=0.5)})
        ratio = ratio_from_restitution(restitution, release)
        return cls(
            young / (2.0 * (1.0 - poisson**2)), young / (4.0 * (1.0 + poisson) * (2.0 - poisson)), ratio, ratio,
            friction, release, rolling_friction, rolling_damping_ratio=ratio,
        )  # fmt: skip

    @classmethod
    def from_numbers(cls, numbers: Mapping[str, float], release: str, mass: float, deepest: float) -> "Hertz":
        """The law of the keys of [contact]; its restitution is the same at any ``mass``."""
        get = numbers.get
        plain = cls.of(
            numbers["young"], numbers["poisson"], 1.0, get("friction", 0.0), release, get("rolling_friction", 0.0)
        )
        ratio = get("damping_ratio")
        if ratio is None:
            ratio = ratio_from_restitution(numbers["restitution"], release)
        return replace(
            plain, damping_ratio=ratio, tangential_damping_ratio=get("tangential_damping_ratio", ratio),
            rolling_stiffness=get("rolling_stiffness_ratio", 1.0),
            rolling_damping_ratio=get("rolling_damping_ratio", ratio), deepest=deepest,
        )  # fmt: skip

    def with_numbers(self, numbers: Mapping[str, float], mass: float) -> "Hertz":
        """This law with other numbers, by the keys of [contact]; its restitution is the same at any ``mass``."""
        given = {RENAMED.get(key, key): value for key, value in numbers.items() if key != "restitution"}
        restitution = numbers.get("restitution")
        if restitution is not None:
            given["damping_ratio"] = ratio_from_restitution(restitution, self.release)
        return replace(self, **given)  # type: ignore[arg-type]

    @staticmethod
    def friction_problem(numbers: Mapping[str, float]) -> tuple[str, str, str] | None:
        """Stiffnesses and dampings that are not given have values of their own: nothing can be missing."""
        return None

    @property
    def rolls(self) -> bool:
        """Whether there is rolling resistance."""
        return self.rolling_friction > 0.0

    def with_friction(self, friction: float) -> "Hertz":
        """This law with another friction coefficient."""
        return replace(self, friction=friction)

    def row(self) -> NDArray[np.float64]:
        """The law as kernels read it, (COLUMNS,) float64; see law.py and _stiffness."""
        normal, shear = 4.0 / 3.0 * self.modulus, 8.0 * self.shear_modulus
        turning = self.rolling_stiffness * shear
        return np.array([
            normal, TANGENT * self.damping_ratio * math.sqrt(1.5 * normal),
            shear, TANGENT * self.tangential_damping_ratio * math.sqrt(shear),
            self.friction, float(RELEASES.index(self.release)), 1.0 / shear if shear > 0.0 else 0.0,
            turning, TANGENT * self.rolling_damping_ratio * math.sqrt(turning), self.rolling_friction,
            1.0 / turning if turning > 0.0 else 0.0,
        ])  # fmt: skip

    def mixed(self, other: Any) -> "Hertz":
        """Between unlike materials, each of which has its law with itself; see materials.py for the rule."""
        if not isinstance(other, Hertz) or other.release != self.release:
            raise InputError(Fault("contact.law", f"{self} and {other}", "differ in kind or release"))

        def mean(key: str) -> float:
            """Mean of a number of both laws."""
            return float(0.5 * (getattr(self, key) + getattr(other, key)))

        return Hertz(
            series(self.modulus, other.modulus), series(self.shear_modulus, other.shear_modulus),
            mean("damping_ratio"), mean("tangential_damping_ratio"),
            min(self.friction, other.friction), self.release,
            min(self.rolling_friction, other.rolling_friction), mean("rolling_stiffness"),
            mean("rolling_damping_ratio"), max(self.deepest, other.deepest),
        )  # fmt: skip

    def constant(self, radius: float) -> float:
        """K = 4/3 E sqrt(R), N/m^(3/2) per metre, at the reduced ``radius`` (m)."""
        return 4.0 / 3.0 * self.modulus * math.sqrt(radius)

    def restitution(self, mass: float = 1.0, radius: float = 0.0) -> float:
        """Parting speed over approach speed, at any speed, radius and ``mass`` (kg/m)."""
        return restitution_of(self.damping_ratio, self.release)

    def overlap_at(self, mass: float, radius: float, speed: float) -> float:
        """Deepest overlap (m) of an undamped impact at ``speed`` (m/s); reduced ``mass`` (kg/m), ``radius`` (m)."""
        return float((1.25 * mass * speed**2 / self.constant(radius)) ** 0.4)

    def contact_time(self, mass: float, radius: float, speed: float) -> float:
        """Seconds from touch until the contact ends; arguments as in overlap_at.  Infinite where it never ends.

        On the path of the oscillator y(q), dt = dd/p = 4/5 y^(-1/5) dq; with q = T z^(5/4) near the touch, and likewise
        where y vanishes again, the integrand has no singularity.  Undamped: 2.943 times deepest overlap over speed.
        """
        h, end = self.damping_ratio, contact_phase(self.damping_ratio, self.release)
        if not math.isfinite(end):
            return math.inf
        w = math.sqrt(0.8 * self.constant(radius) / mass)

        def measure(q: float) -> float:
            """y w/speed on the path at phase q."""
            root = complex(1.0 - h * h) ** 0.5
            if abs(root) < 1e-6:
                return q * math.exp(-h * q)
            return math.exp(-h * q) * float((np.sin(root * q) / root).real)

        half = 0.5 * end

        def rising(z: float) -> float:
            """Integrand from touch to midway, in z = (2 q/end)^(4/5), in which it has no singularity."""
            return float(measure(half * z**1.25) ** -0.2 * half * z**0.25)

        def falling(z: float) -> float:
            """The same from the end back to midway."""
            return float(measure(end - half * z**1.25) ** -0.2 * half * z**0.25)

        from scipy.integrate import quad  # takes longer to import than a scene to be judged

        total = quad(rising, 0.0, 1.0)[0] + quad(falling, 0.0, 1.0)[0]
        return float(total * (speed / w) ** -0.2 / w)

    def ratio_of_damping(self, mass: float, radius: float = 0.0) -> float:
        """The damping ratio, which is the same at any ``mass``."""
        return self.damping_ratio

    def contact_report(self, mass: float, radius: float) -> tuple[float, str]:
        """Seconds that a contact lasts at a speed of 1 cm/s, and that it lasts longer at a lower one."""
        return self.contact_time(mass, radius, 0.01), "at 1 cm/s; longer when slower"

    def impact(self, mass: float, radius: float, speed: float) -> tuple[float, float]:
        """See overlap_at; it goes with the modulus to the power of 2/5."""
        return self.overlap_at(mass, radius, speed), 2.5

    def stiffest(self, mass: float, radius: float) -> Springs:
        """The springs of its tangents at the overlap ``deepest`` times ``radius`` (m), for the stable step.

        mass (kg/m) and radius are those of the smallest disc: its contacts are at most as stiff as with a wall, R = r,
        and damped as with one.
        """
        row, scale = self.row(), radius * math.sqrt(self.deepest)
        root = math.sqrt(mass * scale)
        return Springs(
            (1.5 * row[KN] * scale, row[KT] * scale, row[KR] * scale * self.rolls),
            (row[CN] * root, row[CT] * root, row[CR] * root * self.rolls),
        )

    def shortest_contact(self, mass: float, radius: float) -> float:
        """Seconds an impact lasts that reaches ``deepest`` of ``radius`` (m) at a wall; ``mass`` reduced, kg/m."""
        speed = math.sqrt(self.constant(radius) * (self.deepest * radius) ** 2.5 / (1.25 * mass))
        return self.contact_time(mass, radius, speed)


LAW = Hertz

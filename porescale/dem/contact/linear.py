"""Linear springs and dashpots with a Coulomb limit, and rolling resistance if wanted.

F = k_n d + c_n d';  tangential and rolling spring of constant stiffness; the rest is the same for all laws: law.py.

Sources: Cundall & Strack 1979; release at zero force: Schwager & Poeschel 2007, Granular Matter 9, 465.
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
    RELEASES,
    KernelLaw,
    Springs,
    history_scaling,
    stiffness,
    stiffness_scale,
    stored_normal,
)
from porescale.dem.contact.restitution import contact_phase, ratio_from_restitution, restitution_of

RANGES = {
    "stiffness": Range("N/m", gt=0), "damping": Range("N s/m", ge=0), "tangential_stiffness": Range("N/m", ge=0),
    "tangential_damping": Range("N s/m", ge=0), "friction": Range(ge=0), "rolling_friction": Range(ge=0),
    "rolling_stiffness": Range("N/m", ge=0), "rolling_damping": Range("N s/m", ge=0),
}  # fmt: skip


class LinearKernel(KernelLaw):
    """The linear law as kernels take it."""


@stiffness.of(LinearKernel)
def _stiffness(overlap, radius, mass, p, law):
    """Elastic force k_n d; stiffnesses and dampings are the same at every overlap."""
    return p[KN] * overlap, p[CN], 1.0, 1.0, p[CT], p[CR]


@stiffness_scale.of(LinearKernel)
def _stiffness_scale(overlap, radius, law):
    """Factor on the stiffness: 1 at every overlap."""
    return 1.0


@history_scaling.of(LinearKernel)
def _history_scaling(overlap, closing, dt, law):
    """Factor on the springs as the overlap changes: 1, they keep their length."""
    return 1.0


@stored_normal.of(LinearKernel)
def _stored_normal(overlap, radius, p, law):
    """Half the stiffness times the overlap squared."""
    return 0.5 * p[KN] * overlap * overlap


@dataclass(frozen=True)
class Linear:
    """Linear law per metre of depth.

    stiffness k_n : N/m per metre, > 0;   damping c_n : N s/m per metre, >= 0;
    tangential_stiffness k_t, tangential_damping c_t : likewise, >= 0;   friction mu : -, >= 0;
    release : "force" (never pulls) or "overlap" (may attract), see law.py;
    rolling_friction mu_r : -, >= 0, torque over reduced radius and normal force; with rolling_stiffness k_r (N/m per
    metre) and rolling_damping c_r (N s/m per metre) on the rolling path.
    """

    name: ClassVar = "linear"
    order: ClassVar = 0
    purpose: ClassVar = "springs and dashpots"
    kernel: ClassVar[type[KernelLaw]] = LinearKernel
    keys: ClassVar[tuple[str, ...]] = (
        "stiffness", "damping", "tangential_stiffness", "tangential_damping", "rolling_stiffness", "rolling_damping",
    )  # fmt: skip
    required: ClassVar = ("stiffness", "N/m")
    damping_keys: ClassVar[tuple[str, ...]] = ("damping", "restitution")
    of_materials: ClassVar[tuple[str, ...]] = ()
    needs_radius: ClassVar = False
    compresses: ClassVar = True

    stiffness: float
    damping: float = 0.0
    tangential_stiffness: float = 0.0
    tangential_damping: float = 0.0
    friction: float = 0.0
    release: str = "force"
    rolling_friction: float = 0.0
    rolling_stiffness: float = 0.0
    rolling_damping: float = 0.0

    def __post_init__(self) -> None:
        require_in_range("contact", vars(self), RANGES, {"release": RELEASES})

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
    ) -> "Linear":
        """The law whose normal coefficient of restitution is ``restitution`` at effective ``mass``
        (kg/m).  Raises InputError as damping_from_restitution does.
        """
        damping = damping_from_restitution(restitution, mass, stiffness, release)
        return cls(stiffness, damping, tangential_stiffness, tangential_damping, friction, release)

    @classmethod
    def from_numbers(cls, numbers: Mapping[str, float], release: str, mass: float, deepest: float) -> "Linear":
        """The law of the keys of [contact]; ``deepest`` is not needed: stiffness is the same at every overlap."""
        get, k = numbers.get, numbers["stiffness"]
        damping = get("damping")
        if damping is None:
            damping = damping_from_restitution(numbers["restitution"], mass / 2, k, release)
        return cls(
            k, damping, get("tangential_stiffness", 0.0), get("tangential_damping", 0.0), get("friction", 0.0),
            release, get("rolling_friction", 0.0), get("rolling_stiffness", 0.0), get("rolling_damping", 0.0),
        )  # fmt: skip

    def with_numbers(self, numbers: Mapping[str, float], mass: float) -> "Linear":
        """This law with other numbers, by the keys of [contact];  mass (kg/m): effective, of the restitution."""
        given = {key: value for key, value in numbers.items() if key != "restitution"}
        restitution = numbers.get("restitution")
        if restitution is not None:
            stiffness = given.get("stiffness", self.stiffness)
            given["damping"] = damping_from_restitution(restitution, mass, stiffness, self.release)
        return replace(self, **given)  # type: ignore[arg-type]

    @staticmethod
    def friction_problem(numbers: Mapping[str, float]) -> tuple[str, str, str] | None:
        """Friction bounds a tangential spring or dashpot, and has no effect without; rolling resistance needs a spring
        or a dashpot, and friction."""
        slides = numbers.get("tangential_stiffness", 0.0) + numbers.get("tangential_damping", 0.0) > 0.0
        if not slides and numbers.get("friction", 0.0) > 0.0:
            problem = "is needed where there is friction"
            return "tangential_stiffness", problem, "give it, half of the normal one say, or leave friction out"
        resists = numbers.get("rolling_stiffness", 0.0) + numbers.get("rolling_damping", 0.0) > 0.0
        if resists == (numbers.get("rolling_friction", 0.0) > 0.0):
            return None
        one, other = ("rolling_stiffness", "rolling_friction")[:: -1 if resists else 1]
        problem = f"is needed where there is {other}" if not resists else "is needed for rolling resistance"
        return one, problem, f"give both, or leave {other} out"

    @property
    def rolls(self) -> bool:
        """Whether there is rolling resistance."""
        return self.rolling_friction > 0.0

    def with_friction(self, friction: float) -> "Linear":
        """This law with another friction coefficient."""
        return replace(self, friction=friction)

    def with_rolling(self, friction: float, stiffness: float) -> "Linear":
        """This law with another rolling friction and stiffness (N/m), damped as its normal spring is."""
        damping = self.damping * math.sqrt(stiffness / self.stiffness)
        return replace(self, rolling_friction=friction, rolling_stiffness=stiffness, rolling_damping=damping)

    def row(self) -> NDArray[np.float64]:
        """The law as kernels read it, (COLUMNS,) float64, see law.py."""
        return np.array([
            self.stiffness, self.damping, self.tangential_stiffness, self.tangential_damping,
            self.friction, float(RELEASES.index(self.release)),
            1.0 / self.tangential_stiffness if self.tangential_stiffness > 0.0 else 0.0,
            self.rolling_stiffness, self.rolling_damping, self.rolling_friction,
            1.0 / self.rolling_stiffness if self.rolling_stiffness > 0.0 else 0.0,
        ])  # fmt: skip

    def mixed(self, other: Any) -> "Linear":
        """Between unlike materials, each of which has its law with itself; see materials.py for the rule."""
        if not isinstance(other, Linear) or other.release != self.release:
            raise InputError(Fault("contact.law", f"{self} and {other}", "differ in kind or release"))

        def dashpot(stiff: str, damping: str, between: float) -> float:
            """A dashpot with the mean damping ratio of both, on a spring of stiffness ``between``."""
            ends = [(getattr(law, stiff), getattr(law, damping)) for law in (self, other)]
            if all(k > 0.0 for k, _ in ends):
                return float(0.5 * sum(c / math.sqrt(k) for k, c in ends) * math.sqrt(between))
            return float(0.5 * sum(c for _, c in ends))

        normal = series(self.stiffness, other.stiffness)
        tangential = series(self.tangential_stiffness, other.tangential_stiffness)
        turning = series(self.rolling_stiffness, other.rolling_stiffness)
        return Linear(
            normal, dashpot("stiffness", "damping", normal),
            tangential, dashpot("tangential_stiffness", "tangential_damping", tangential),
            min(self.friction, other.friction), self.release,
            min(self.rolling_friction, other.rolling_friction),
            turning, dashpot("rolling_stiffness", "rolling_damping", turning),
        )  # fmt: skip

    def stiffest(self, mass: float, radius: float) -> Springs:
        """Its springs, which are the same at every overlap."""
        return Springs(
            (self.stiffness, self.tangential_stiffness, self.rolling_stiffness * self.rolls),
            (self.damping, self.tangential_damping, self.rolling_damping * self.rolls),
        )

    def shortest_contact(self, mass: float, radius: float) -> float:
        """Seconds that the shortest contact lasts, at effective ``mass`` (kg/m): they all last as long."""
        return self.contact_time(mass)

    def frequency(self, mass: float) -> float:
        """Undamped angular frequency w0 = sqrt(k/m), rad/s, at effective ``mass`` (kg/m)."""
        return math.sqrt(self.stiffness / mass)

    def damping_ratio(self, mass: float) -> float:
        """h = c / (2 sqrt(k m)) at effective ``mass`` (kg/m)."""
        return self.damping / (2.0 * math.sqrt(self.stiffness * mass))

    def ratio_of_damping(self, mass: float, radius: float = 0.0) -> float:
        """The damping ratio at effective ``mass`` (kg/m)."""
        return self.damping_ratio(mass)

    def contact_report(self, mass: float, radius: float) -> tuple[float, str]:
        """Seconds that a contact lasts: the same at every speed and ``radius``."""
        return self.contact_time(mass), ""

    def impact(self, mass: float, radius: float, speed: float) -> tuple[float, float]:
        """Overlap v sqrt(m/k) of an undamped impact, which goes with the root of the stiffness."""
        return speed * math.sqrt(mass / self.stiffness), 2.0

    def contact_time(self, mass: float) -> float:
        """Seconds from touch until the contact ends; infinite for release "overlap" at h >= 1.

        mass : effective, m1 m2/(m1 + m2), or m against a wall, kg/m.
        """
        return contact_phase(self.damping_ratio(mass), self.release) / self.frequency(mass)

    def restitution(self, mass: float, radius: float = 0.0) -> float:
        """Parting speed over approach speed at effective ``mass`` (kg/m): exp(-h w0 T) for both rules."""
        return restitution_of(self.damping_ratio(mass), self.release)

    def critical_step(self, mass: float) -> float:
        """Stability limit (s) of leap-frog with lagged damping for one pair: 2 (sqrt(1+h^2) - h)/w0."""
        h = self.damping_ratio(mass)
        return 2.0 * (math.hypot(1.0, h) - h) / self.frequency(mass)


def series(one: float, other: float) -> float:
    """Two springs, each a contact of like materials, as the one between unlike: 2 k1 k2/(k1 + k2), 0 if one is 0."""
    return 2.0 * one * other / (one + other) if one > 0.0 and other > 0.0 else 0.0


def damping_from_restitution(restitution: float, mass: float, stiffness: float, release: str) -> float:
    """Damping c (N s/m) that gives ``restitution`` at effective ``mass`` (kg/m) and ``stiffness`` (N/m).

    Raises InputError unless 0 < restitution <= 1 (release "overlap" also allows 0: critical damping), and unless mass
    and stiffness are positive.
    """
    given = {"mass": mass, "stiffness": stiffness}
    require_in_range("contact", given, {"mass": Range("kg/m", gt=0), "stiffness": RANGES["stiffness"]})
    return 2.0 * math.sqrt(stiffness * mass) * ratio_from_restitution(restitution, release)


LAW = Linear

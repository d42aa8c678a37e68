"""Linear springs and dashpots with a Coulomb limit, and rolling resistance if wanted.

F = k_n d + c_n d';  tangential and rolling spring of constant stiffness; the rest is the same for all laws: law.py.

Sources: Cundall & Strack 1979; release at zero force: Schwager & Poeschel 2007, Granular Matter 9, 465.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.dem.contact.law import (
    CN,
    CR,
    CT,
    KN,
    RELEASES,
    LinearRolling,
    LinearSliding,
    LinearSmooth,
    kept,
    scale_at,
    stiffness,
    stored_normal,
)
from porescale.dem.contact.restitution import contact_phase, ratio_from_restitution, refuse, restitution_of


@stiffness.of(LinearSliding, LinearRolling, LinearSmooth)
def _stiffness(overlap, radius, mass, p, law):
    """The same at every overlap."""
    return p[KN] * overlap, p[CN], 1.0, 1.0, p[CT], p[CR]


@scale_at.of(LinearSliding, LinearRolling, LinearSmooth)
def _scale_at(overlap, radius, law):
    """Constant."""
    return 1.0


@kept.of(LinearSliding, LinearRolling, LinearSmooth)
def _kept(overlap, closing, dt, law):
    """All of it."""
    return 1.0


@stored_normal.of(LinearSliding, LinearRolling, LinearSmooth)
def _stored_normal(overlap, radius, p, law):
    """Half k d²."""
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

    name = "linear"
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
        refuse(
            {
                "stiffness": (self.stiffness, "N/m", True),
                "damping": (self.damping, "N s/m", False),
                "tangential_stiffness": (self.tangential_stiffness, "N/m", False),
                "tangential_damping": (self.tangential_damping, "N s/m", False),
                "friction": (self.friction, "", False),
                "rolling_friction": (self.rolling_friction, "", False),
                "rolling_stiffness": (self.rolling_stiffness, "N/m", False),
                "rolling_damping": (self.rolling_damping, "N s/m", False),
            },
            self.release,
        )

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

    @property
    def rolls(self) -> bool:
        """Whether there is rolling resistance."""
        return self.rolling_friction > 0.0

    def kind(self, rolls: bool) -> type[LinearSliding | LinearRolling]:
        """The class under which kernels take it, with rolling resistance or without."""
        return LinearRolling if rolls else LinearSliding

    def with_friction(self, friction: float) -> Linear:
        """The same law with another friction coefficient."""
        return replace(self, friction=friction)

    def row(self) -> NDArray[np.float64]:
        """The law as kernels read it, (COLUMNS,) float64, see law.py."""
        return np.array(
            [
                self.stiffness,
                self.damping,
                self.tangential_stiffness,
                self.tangential_damping,
                self.friction,
                float(RELEASES.index(self.release)),
                1.0 / self.tangential_stiffness if self.tangential_stiffness > 0.0 else 0.0,
                self.rolling_stiffness,
                self.rolling_damping,
                self.rolling_friction,
                1.0 / self.rolling_stiffness if self.rolling_stiffness > 0.0 else 0.0,
            ]
        )

    def mixed(self, other: Linear) -> Linear:
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

    def stiffest(self, mass: float, radius: float) -> Linear:
        """The linear law that bounds it for the stable step: itself."""
        return self

    def shortest_contact(self, mass: float, radius: float) -> float:
        """Seconds that the shortest contact lasts, at effective ``mass`` (kg/m): they all last as long."""
        return self.contact_time(mass)

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

    Raises InputError unless 0 < restitution <= 1 (release "overlap" also allows 0: critical damping).
    """
    return 2.0 * math.sqrt(stiffness * mass) * ratio_from_restitution(restitution, release)

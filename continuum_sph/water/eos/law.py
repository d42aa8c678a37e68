"""The contract of an equation of state: what a file of this folder has to hold."""

from typing import Any, ClassVar, NamedTuple, Protocol, Self

from porescale.common.compiled.jit import law_function
from porescale.common.core.types import Floats


class Given(NamedTuple):
    """The properties of a fluid that a scene gives.

    density : ρ0, kg/m³, under the pressure of the air;  sound_speed : c0, m/s, None where it is not given;
    pressure : p0 of the air, Pa;  exponent : γ, None where it is not given;  stiffness : B of the water about it, Pa.
    """

    density: float
    sound_speed: float | None
    pressure: float
    exponent: float | None
    stiffness: float


class StateLaw(Protocol):
    """An equation of state with its parameters; SI, pressures above that of the air.

    gas : whether it is one: it fills what room it has, is not shifted, and may be the air of pores.
    """

    gas: ClassVar[bool]

    @classmethod
    def of(cls, given: Given) -> Self:
        """The equation of state with the properties that a scene gives."""

    @property
    def density(self) -> float:
        """ρ0, kg/m³, at the pressure of the air."""

    @property
    def sound_speed(self) -> float:
        """Speed of sound c0 at the density ρ0, m/s."""

    @property
    def least_density(self) -> float:
        """kg/m³, below which no particle of it comes."""

    @property
    def numbers(self) -> Any:
        """A flat NamedTuple of a type of its own that begins with density, sound_speed and least_density; kernels take
        it, and `pressure_of` has a body for it."""

    def pressure(self, density: Floats) -> Floats:
        """Pressure (Pa) at a density (kg/m³)."""

    def density_at(self, pressure: Floats) -> Floats:
        """Density (kg/m³) at a pressure (Pa)."""

    def sound_speed_at(self, density: Floats) -> Floats:
        """Speed of sound (m/s) at a density (kg/m³), which may lie beside all that it can have."""

    def energy(self, density: Floats) -> Floats:
        """Work of compression per mass from ρ0 on, ∫ p/ρ² dρ, J/kg."""


@law_function
def pressure_of(ratio, law):
    """Pressure (Pa) and (c/c0)² at ``ratio`` ρ/ρ0, in kernels.

    law : the `numbers` of a law, by whose type the body is chosen.
    """

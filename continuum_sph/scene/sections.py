"""The sections of a continuum scene.  SI numbers or texts with units; an absent section builds nothing."""

from __future__ import annotations

from typing import Literal

import pydantic

from porescale.ground.check import Fault
from porescale.ground.constants import GRAVITY
from porescale.workbench.sections import Refused, Section, quantity

CALM_MACH = 10.0  # sound speed over the speed of free fall from the highest water: Mach number 0.1 (spec §1.7)


class Tank(Section):
    """A rectangular tank, lower left inner corner at the origin.

    "slip" walls carry pressure only, "stick" walls hold the water as well.
    """

    width: float = quantity("m", gt=0, help="inner width of the tank")
    height: float = quantity("m", gt=0, help="inner height of the tank")
    walls: Literal["slip", "stick"] = "slip"
    lid: bool = pydantic.Field(True, description="close the tank, so that no splash is lost")


class Column(Section):
    """A rectangle of water at the start."""

    left: float = quantity("m", 0.0, ge=0, help="left edge of the water")
    bottom: float = quantity("m", 0.0, ge=0, help="lower edge of the water")
    width: float = quantity("m", gt=0, help="width of the water")
    height: float = quantity("m", gt=0, help="height of the water")


class Water(Section):
    """A weakly compressible liquid.

    pressure : at the start, "hydrostatic", that of a column whose right face is free ("released"), or "none"
    (density ρ0 everywhere, as in the paper);  push : "face" gives the particles of the right face √(2g(H-y)) to
    the right, as in figs 6 and 7 of the paper.
    """

    density: float = quantity("kg/m^3", 1000.0, gt=0, help="density under the pressure of the air")
    viscosity: float = quantity("Pa s", 1.002e-3, ge=0, help="viscosity")
    sound_speed: float | None = quantity("m/s", None, gt=0, help="speed of sound, at least 10 sqrt(2 g H)")
    exponent: float = quantity("", 7.0, ge=1.5, help="exponent of the equation of state")
    pressure: Literal["hydrostatic", "released", "none"] = "hydrostatic"
    push: Literal["none", "face"] = "none"
    column: tuple[Column, ...] = pydantic.Field(min_length=1, description="rectangles of water")


class Numerics(Section):
    """Particles and what corrects them.  The paper: kernel cubic, smoothing_ratio 1, no density diffusion, xsph.

    xsph moves particles with the smoothed velocity but continuity with their own: volume is lost where they differ.
    """

    spacing: float = quantity("m", gt=0, help="spacing of the particles at the start")
    kernel: Literal["wendland", "cubic"] = "wendland"
    smoothing_ratio: float = quantity("", 1.3, ge=1, le=3, help="smoothing length over spacing")
    artificial_viscosity: float = quantity("", 0.05, ge=0, help="alpha of eq. 36")
    artificial_viscosity_2: float = quantity("", 0.0, ge=0, help="beta of eq. 36")
    softening: float = quantity("", 0.1, gt=0, help="epsilon of eq. 36")
    density_diffusion: float = quantity("", 0.1, ge=0, le=0.2, help="delta of the density diffusion")
    xsph: float = quantity("", 0.0, ge=0, le=1, help="epsilon of eq. 53")
    tension: Literal["cut", "kept"] = "kept"
    courant: float = quantity("", 0.25, gt=0, le=0.5, help="share of the acoustic step of eq. 49")
    skin: float = quantity("", 0.25, gt=0, le=2, help="skin of the pair list over smoothing length")


class Time(Section):
    """How long a run lasts."""

    end: float = quantity("s", gt=0, help="physical time to simulate")


class Output(Section):
    """What is recorded when; recording never changes the physics."""

    snapshot_interval: float = quantity("s", gt=0, help="time between snapshots (frames of the film)")
    series_interval: float = quantity("s", gt=0, help="time between rows of series.csv")
    checkpoint_seconds: float = quantity("s", 30.0, gt=0, help="wall-clock time between checkpoints")


class Scene(Section):
    """A tank and its water."""

    title: str = ""
    gravity: float = quantity("m/s^2", GRAVITY, ge=0, help="acceleration of free fall, downwards")
    tank: Tank
    water: Water
    numerics: Numerics
    time: Time
    output: Output

    @property
    def head(self) -> float:
        """Height of the highest water above the floor, m."""
        return max(column.bottom + column.height for column in self.water.column)

    @property
    def fall_speed(self) -> float:
        """Speed of free fall from there, m/s."""
        return float((2.0 * self.gravity * self.head) ** 0.5)

    @property
    def sound_speed(self) -> float:
        """c0, m/s: as given, or ten times the fall speed."""
        given = self.water.sound_speed
        return given if given is not None else CALM_MACH * self.fall_speed

    @pydantic.model_validator(mode="after")
    def _fits(self) -> Scene:
        tank, spacing = self.tank, self.numerics.spacing
        faults = []
        for index, column in enumerate(self.water.column):
            key = f"water.column[{index}]"
            slack = 1e-9 * tank.width
            if column.left + column.width > tank.width + slack:
                faults.append(
                    Fault(f"{key}.width", column.width, "reaches beyond the tank", "m",
                          f"<= {tank.width - column.left:g}")
                )  # fmt: skip
            if column.bottom + column.height > tank.height + slack:
                faults.append(
                    Fault(f"{key}.height", column.height, "reaches beyond the tank", "m",
                          f"<= {tank.height - column.bottom:g}")
                )  # fmt: skip
            if min(column.width, column.height) < 4.0 * spacing:
                finest = min(column.width, column.height) / 4.0
                faults.append(
                    Fault("numerics.spacing", spacing, f"leaves {key} fewer than 4 particles across", "m",
                          f"<= {finest:g}")
                )  # fmt: skip
        first = self.water.column[0]
        if self.water.pressure == "released" and (len(self.water.column) > 1 or first.left > 0 or first.bottom > 0):
            faults.append(
                Fault("water.pressure", "released", "is known for one column in the left corner only",
                      repair='use "hydrostatic", or one column with left = bottom = 0')
            )  # fmt: skip
        if self.gravity == 0.0 and self.water.sound_speed is None:
            faults.append(Fault("water.sound_speed", None, "is needed when there is no gravity to take it from"))
        if faults:
            raise Refused(*faults)
        return self

"""What is measured, as sections: probes, lines, flux sections, loads on chosen bodies, permeability of a bed."""

from __future__ import annotations

from typing import Any, Literal

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Refused, Section, quantity

PLACE: Any = {"ge": -1e3, "le": 1e3}
LENGTH: Any = {"ge": 1e-9, "le": 1e3}
FieldName = Literal["vorticity", "stream_function"]


class Probe(Section):
    """A point where pressure and velocity are recorded over time: probes.csv."""

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    x: float = quantity("m", **PLACE, help="place")
    y: float = quantity("m", **PLACE, help="place")


class Segment(Section):
    """A straight section between two points."""

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    start: tuple[float, float] = quantity("m", **PLACE, help="first point")
    end: tuple[float, float] = quantity("m", **PLACE, help="last point")

    @pydantic.model_validator(mode="after")
    def _has_length(self) -> Segment:
        if self.start == self.end:
            raise Refused(Fault("end", None, "is the same as start", "m", repair="move one of them"))
        return self


class Line(Segment):
    """A straight line along which velocity and pressure are recorded at every snapshot: lines.csv."""

    points: int = pydantic.Field(101, ge=2, le=100_000, description="points along the line, both ends included")


class Flux(Segment):
    """A straight section through which the volume flux is recorded over time: flux.csv.

    Positive from left to right for one who looks from ``start`` to ``end``: upwards means to the right.
    """


class Loads(Section):
    """Chosen bodies whose force and torque from the fluid are recorded over time: loads.csv.

    With a speed U and a length L also the coefficients 2 F/(rho U² L): drag along ``direction``, lift to its left.
    """

    discs: tuple[int, ...] = pydantic.Field((), description="numbers of [[disc]] entries, from 0")
    grains: tuple[int, ...] = pydantic.Field((), description="numbers of grains, from 0: the packing's come first")
    rectangles: tuple[int, ...] = pydantic.Field((), description="numbers of [[rectangle]] entries, from 0")
    speed: float | None = quantity("m/s", None, ge=1e-12, le=1e4, help="reference speed of the coefficients")
    length: float | None = quantity("m", None, **LENGTH, help="reference length of the coefficients")
    direction: tuple[float, float] = quantity("", (1.0, 0.0), ge=-1, le=1, help="direction of drag")

    @pydantic.model_validator(mode="after")
    def _complete(self) -> Loads:
        faults = []
        if not self.discs and not self.grains and not self.rectangles:
            faults.append(Fault("discs, grains, rectangles", None, "name no body", repair="write discs = [0], say"))
        if (self.speed is None) != (self.length is None):
            faults.append(Fault("speed, length", None, "coefficients need both", repair="give both, or leave both out"))
        if self.direction == (0.0, 0.0):
            faults.append(Fault("direction", None, "has no length", repair="write [1, 0]"))
        if faults:
            raise Refused(*faults)
        return self


class Window(Section):
    """A part of the bed."""

    left: float = quantity("m", **PLACE, help="left edge")
    bottom: float = quantity("m", **PLACE, help="lower edge")
    width: float = quantity("m", **LENGTH, help="width")
    height: float = quantity("m", **LENGTH, help="height")


class Permeability(Section):
    """The permeability of the bed as it stands in the first and the last snapshot: permeability.csv.

    The grains in the window are held, a body force drives fluid through them, slowly enough for Stokes flow; operators
    and relaxation time are the run's, so that it is what this bed lets through in this run.
    """

    window: Window | None = None
    direction: Literal["x", "y"] = pydantic.Field("y", description="direction of the flow")
    spacing: float | None = quantity(
        "m", None, **LENGTH, help="lattice spacing of the measurement (default: the run's)"
    )


class Homogenise(Section):
    """How `porescale homogenise` asks the scene's packing what soil it makes; runs of the scene do without it.

    pressure : left out, that of the packing, else what the weight of half its height makes.
    """

    pressure: float | None = quantity("Pa", None, gt=0, le=1e12, help="mean stress at which the soil is measured")
    grains: int = pydantic.Field(800, ge=100, le=100_000, description="grains in a specimen")
    packings: int = pydantic.Field(6, ge=2, le=1000, description="specimens, from the packing's seed on")
    strain: float = quantity("", 0.24, ge=0.03, le=1, help="logarithmic axial strain of a test")
    inertial_number: float = quantity("", 1e-3, ge=1e-6, le=1e-2, help="rate of a test, quasi-static to 1e-3")
    cells: int = pydantic.Field(12, ge=4, le=100, description="cells per hydraulic diameter of the flow")

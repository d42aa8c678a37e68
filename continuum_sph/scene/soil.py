"""The section of the soil."""

import math
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import pydantic
from numpy.typing import NDArray

from continuum_sph.scene.material_file import CONDUCTING, Origin
from continuum_sph.scene.rate import RateSection
from continuum_sph.scene.side_walls import SideWallsSection
from continuum_sph.scene.softening import SofteningSection
from continuum_sph.scene.suction import SuctionSection
from continuum_sph.scene.water import stacked_top
from porescale.common.core.errors import Fault
from porescale.common.core.types import Floats
from porescale.common.schema.names import name_faults
from porescale.common.schema.sections import Section, quantity

ON_A_SIDE = 1e-9
"""Distance to a side, over the largest coordinate of an outline, within which a point is on it: a slope of 1 : 1 runs
through centres of the lattice, where round-off would decide, and left and right sides would differ."""


class Outline(Section):
    """A closed polygon: corners (x, y), m, in order."""

    outline: Annotated[tuple[tuple[float, float], ...], pydantic.Field(min_length=3)] = quantity(
        "m", ge=0, le=1e5, help="corners (x, y) of the outline"
    )

    def top(self, x: Floats) -> Floats:
        """Height (m) of its highest point above each ``x`` (n,) m; below all numbers where there is none."""
        return self.reach(x)[1]

    def reach(self, x: Floats) -> tuple[Floats, Floats]:
        """Heights (m) of its lowest and highest point over each ``x`` (n,) m; inf and -inf where there is none."""
        lowest, highest = np.full(x.shape, np.inf), np.full(x.shape, -np.inf)
        for (ax, ay), (bx, by) in zip(self.outline, (*self.outline[1:], self.outline[0]), strict=True):
            left, right = min(ax, bx), max(ax, bx)
            over = (x >= left) & (x <= right)
            along = 0.0 if ax == bx else (x - ax) * ((by - ay) / (bx - ax))
            low, high = (min(ay, by), max(ay, by)) if ax == bx else (ay + along, ay + along)
            lowest = np.where(over, np.minimum(lowest, low), lowest)
            highest = np.where(over, np.maximum(highest, high), highest)
        return lowest, highest

    def crosses(self) -> bool:
        """Whether two sides of the outline cross each other; sides that only touch do not."""
        corners = np.array(self.outline)
        sides = list(zip(corners, np.roll(corners, -1, axis=0), strict=True))

        def turn(a: Floats, b: Floats, c: Floats) -> float:
            """Twice the area of the triangle, above zero where it turns left."""
            return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))

        return any(
            turn(a, b, c) * turn(a, b, d) < 0.0 and turn(c, d, a) * turn(c, d, b) < 0.0
            for k, (a, b) in enumerate(sides)
            for c, d in sides[:k]
        )

    def spike(self) -> tuple[float, float] | None:
        """The first corner (x, y), m, at which the outline goes back along the line that it came; None if none."""
        corners = np.array(self.outline)
        out, back = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
        turned = np.abs(out[:, 0] * back[:, 1] - out[:, 1] * back[:, 0])
        flat = turned <= ON_A_SIDE * np.hypot(*out.T) * np.hypot(*back.T)
        tips = np.flatnonzero(flat & ((out * back).sum(axis=1) < 0.0))
        return self.outline[tips[0]] if tips.size else None

    def holds(self, points: Floats) -> NDArray[np.bool_]:
        """Which of ``points`` (n, 2) m lie inside (an odd number of sides to their right), or on a side."""
        x, y = points[:, 0], points[:, 1]
        inside, on = np.zeros(len(points), np.bool_), np.zeros(len(points), np.bool_)
        near = ON_A_SIDE * np.abs(self.outline).max()
        for (ax, ay), (bx, by) in zip(self.outline, (*self.outline[1:], self.outline[0]), strict=True):
            if ay != by:
                inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) * ((bx - ax) / (by - ay)))
            dx, dy = bx - ax, by - ay
            way = ((x - ax) * dx + (y - ay) * dy) / (max(dx * dx + dy * dy, near * near) or 1.0)
            along = np.clip(way, 0.0, 1.0)
            on |= np.hypot(x - ax - along * dx, y - ay - along * dy) < near
        return inside | on


class Body(Outline):
    """A piece of ground, with a permeability of its own or that of the soil."""

    permeability: float | None = quantity("m/s", None, ge=1e-12, le=10, help="k of this piece of ground alone")


class Watch(Outline):
    """A part of the ground whose mean displacement is recorded: what lies within its outline at the start."""

    name: str = pydantic.Field("", description="name in the columns (default: its number)")


class SoilNumerics(Section):
    """Numerics that damp the noise of soil particles and keep them evenly spaced; see `continuum_sph.soil.momentum`.

    Maeda & Sakai 2004: gradient "plain", damping_of "approach" with 0.001, neither diffusion nor parting.
    parting : with 0 soil does not swell where its particles crowd, either.
    damping, damping_viscosity, stress_diffusion : left out, they follow from gravity and the ground's height and
    stiffness, see `continuum_sph.soil.steadying`; "approach" and "bounded" have 0.2.
    damping_of : "bounded", for slides that begin slowly, and full ground: where soil yields, zig-zags are damped by 4 %
    of the shear stress at most, stress diffuses there alone, and pores swell as stress takes it to.  Columns run far.
    """

    gradient: Literal["corrected", "plain"] = pydantic.Field(
        default="corrected", description="gradients of the velocity"
    )
    damping: float | None = quantity("", None, ge=0, le=4, help="alpha of the damping")
    damping_of: Literal["zig-zags", "approach", "bounded"] = pydantic.Field(
        default="zig-zags", description="what the damping acts on"
    )
    damping_viscosity: float | None = quantity("m^2/s", None, ge=0, le=1e6, help="alpha c h, in place of damping")
    stress_diffusion: float | None = quantity(
        "", None, ge=0, le=1000, help="diffusion of stress and volume per shear strain"
    )
    restless_diffusion: float = quantity("", 0.0, ge=0, le=1, help="diffusion by sound, too: soil creeps")
    parting: float = quantity("", 4.0, ge=0, le=20, help="rate at which particles too near part, per shear strain")
    repulsion: float = quantity(
        "", 10.0, ge=0, le=100, help="repulsion that keeps soil that bears tension from clumping"
    )
    settle: float = quantity("s", 0.0, ge=0, le=1e6, help="time at the start while motion is braked")


class SoilSection(Section):
    """Soil: hypo-elastic, E = stiffness (p/reference)^exponent, with Mohr-Coulomb strength in plane strain.

    A key material names a file of `porescale homogenise`, see material_file.py, whose numbers hold where the scene has
    none of its own;  strength : which of its angles;  origin : where they come from, for the card of a run.

    friction_angle : φ; tan φ = 0.5 of Maeda & Sakai 2004 is sin φ = 0.5, 30 degrees;  modulus : "printed" is their
    eq. 43, of plane stress;  stress : at the start, "geostatic" below its surface with K0 = rest (left out: as it would
    settle), "none", or "unconsolidated": none, and the water of its full pores bears its weight;  exponent : from
    stress "none" diffusion of stress, which levels it as the weight comes on, would make soil stiffer before it is
    strained: a column of 12, 24 and 48 rows with m = 0.5 settled 25, 15 and 9 % too little.  So there, unless
    numerics.stress_diffusion is given, it begins when numerics.settle ends: 2.8 and 1.7 % (12 and 24 rows, settled in
    0.6 s; 12 % of 12 rows where settle ends half-way);  permeability : the hydraulic conductivity k of full pores,
    under 9.81 m/s² whatever the scene's gravity is, but with ``suction`` under that of the scene;  permeability_law :
    how k follows the porosity;
    hydraulic_share : see `continuum_sph.seepage.resistance`;  floor, sides : of the tank, "hold" the
    soil or let it "slip".
    """

    files: ClassVar[tuple[str, ...]] = ("material",)

    strength: Literal["critical", "peak"] = pydantic.Field(
        default="critical", description="which angles of the material file hold"
    )
    origin: Origin | None = None
    density: float = quantity("kg/m^3", 1590.0, ge=1, le=1e5, help="mass of grains per whole volume: 1 - n of theirs")
    porosity: float = quantity("", 0.4, ge=0, le=0.99, help="porosity at the start")
    stiffness: float = quantity("Pa", 2e6, ge=1, le=1e12, help="Young's modulus at the reference stress")
    reference: float = quantity("Pa", 1e5, ge=1e-3, le=1e12, help="mean stress at which stiffness is given")
    exponent: float = quantity(
        "", 0.0, ge=0, le=1,
        help='exponent m of stiffness over mean stress; from stress "none" give numerics.settle, too',
    )  # fmt: skip
    least: float = quantity("Pa", 100.0, ge=1e-6, le=1e12, help="mean stress below which soil gets no softer")
    poisson: float = quantity("", 0.3, ge=0, le=0.49, help="Poisson's ratio")
    modulus: Literal["plane strain", "printed"] = pydantic.Field(
        default="plane strain", description="law of elasticity: of plane strain, or as printed"
    )
    friction_angle: float = quantity("rad", "30 degree", ge=0, le=1.4, help="angle of friction")
    dilatancy_angle: float = quantity("rad", 0.0, ge=0, le=1.4, help="angle of dilatancy")
    cohesion: float = quantity("Pa", 0.0, ge=0, le=1e9, help="cohesion")
    tension: float = quantity("Pa", 0.0, ge=0, le=1e9, help="largest tension")
    elastic: bool = pydantic.Field(False, description="never yields")
    permeability: float = quantity(
        "m/s", 1e-3, ge=1e-12, le=10,
        help="k of full pores under 9.81 m/s2, at the porosity of the start; with soil.suction under gravity",
    )  # fmt: skip
    permeability_law: Literal["constant", "kozeny-carman"] = pydantic.Field(
        default="constant", description="how permeability follows the porosity"
    )
    hydraulic_share: float = quantity(
        "", 1.0, ge=0.01, le=1, help='share of their volume that grains take up in the flow, of "kozeny-carman"'
    )
    saturated: bool = pydantic.Field(False, description="pores are full at the start, up to the surface of the ground")
    water_table: float | None = quantity("m", None, ge=0, le=1e5, help="height up to which pores are full at the start")
    held: bool = pydantic.Field(False, description="does not move, whatever acts on it: only its water does")
    stress: Literal["geostatic", "none", "unconsolidated"] = pydantic.Field(
        default="geostatic", description="stress at the start"
    )
    rest: float | None = quantity("", None, ge=0, le=5, help="K0 at the start")
    floor: Literal["hold", "slip"] = pydantic.Field(default="hold", description="whether the floor holds the soil")
    sides: Literal["hold", "slip"] = pydantic.Field(default="slip", description="whether the sides hold the soil")
    body: tuple[Body, ...] = pydantic.Field(min_length=1, description="pieces of ground")
    watch: tuple[Watch, ...] = pydantic.Field(default=(), description="parts of it whose displacement is recorded")
    suction: SuctionSection | None = None
    rate: RateSection | None = None
    softening: SofteningSection | None = None
    side_walls: SideWallsSection | None = None
    numerics: SoilNumerics = SoilNumerics()

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        about = "file of porescale homogenise, whose numbers hold where the scene has none of its own"
        material = {"type": "string", "description": about}
        return {**schema, "properties": {**schema["properties"], "material": material}}

    def surface_over(self, points: Floats, slack: float) -> Floats:
        """Height (m) of the surface of the ground that stands over each of ``points`` (n, 2) m without a gap wider than
        ``slack`` (m), (n,); that of the point where there is none."""
        return stacked_top(points[:, 1], [body.reach(points[:, 0]) for body in self.body], slack)

    def permeability_at(self, points: Floats) -> Floats:
        """k (n,) m/s of the ground at ``points`` (n, 2) m: of the last body that holds a point and has its own."""
        k = np.full(len(points), self.permeability)
        for body in self.body:
            if body.permeability is not None:
                k[body.holds(points)] = body.permeability
        return k

    @property
    def loads_from_none(self) -> bool:
        """Whether its weight comes on a soil without stress, whose stiffness grows with it: there stress diffuses once
        it has settled, unless the scene has a diffusion of its own."""
        return self.stress == "none" and self.exponent > 0.0 and self.numerics.stress_diffusion is None

    @property
    def permeabilities(self) -> tuple[float, float]:
        """The least and the largest k of the bodies, m/s."""
        found = [self.permeability if it.permeability is None else it.permeability for it in self.body]
        return min(found), max(found)

    @property
    def height(self) -> float:
        """Height of the highest soil above the floor, m."""
        return max(y for body in self.body for _, y in body.outline)

    def faults(self, width: float, height: float, slack: float) -> list[Fault]:
        """What is wrong with the ground in a tank of ``width`` by ``height``, m."""
        found = []
        outlines: list[tuple[str, tuple[Outline, ...]]] = [("body", self.body), ("watch", self.watch)]
        for key, body in ((f"soil.{kind}[{k}].outline", it) for kind, of in outlines for k, it in enumerate(of)):
            if tip := body.spike():
                problem = "is the tip of a spike: the outline goes out and back along one line"
                found.append(Fault(key, tip, problem, "m", repair="take this corner out"))
            elif body.crosses():
                problem = "crosses itself"
                found.append(Fault(key, None, problem, repair="give the corners in their order around the body"))
            for x, y in body.outline:
                if not (-slack <= x <= width + slack and -slack <= y <= height + slack):
                    found.append(Fault(key, (x, y), "lies outside of the tank", "m"))
        found += name_faults("soil.watch", self.watch, "part")
        if self.stress == "unconsolidated" and (not self.saturated or self.held):
            repair = 'give soil.saturated = true and soil.held = false, or stress "geostatic"'
            found.append(Fault("soil.stress", self.stress, "is of ground with full pores that may move", repair=repair))
        if self.rest is not None and self.stress != "geostatic":
            problem, repair = f'is of stress "geostatic", not "{self.stress}"', "take out one of them"
            found.append(Fault("soil.rest", self.rest, problem, repair=repair))
        if self.hydraulic_share != 1.0 and self.permeability_law != CONDUCTING:
            repair = f'give soil.permeability_law = "{CONDUCTING}"'
            problem = "is of a law that the scene does not have"
            found.append(Fault("soil.hydraulic_share", self.hydraulic_share, problem, repair=repair))
        for part in (self.rate, self.softening, self.side_walls):
            found += part.faults(self) if part else []
        if self.dilatancy_angle > self.friction_angle:
            found.append(
                Fault("soil.dilatancy_angle", self.dilatancy_angle, "makes soil that gives energy as it shears",
                      "rad", f"<= {self.friction_angle:g}")
            )  # fmt: skip
        if self.tension > 0.0 and self.friction_angle > 0.0:
            most = self.cohesion / math.tan(self.friction_angle)
            if self.tension > most:
                found.append(Fault("soil.tension", self.tension, "exceeds c cot φ", "Pa", f"<= {most:g}"))
        return found

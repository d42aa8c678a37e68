"""The scene of a continuum: all its sections.  SI numbers or texts with units; an absent section builds nothing."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
import pydantic
from numpy.typing import NDArray

from continuum_sph.scene.air import AirSection
from continuum_sph.scene.bounds import MOST, WEAKEST, WHOLE, spacings
from continuum_sph.scene.face import FaceSection, face_faults
from continuum_sph.scene.inclusion import InclusionSection
from continuum_sph.scene.instruments import LevelSection, ProbeSection
from continuum_sph.scene.look import look_faults
from continuum_sph.scene.material_file import with_material
from continuum_sph.scene.numerics import NumericsSection
from continuum_sph.scene.output import OutputSection, TimeSection
from continuum_sph.scene.pile import SheetPileSection
from continuum_sph.scene.reservoir import ReservoirSection, reservoir_faults
from continuum_sph.scene.soil import SoilSection
from continuum_sph.scene.tank import TankSection
from continuum_sph.scene.water import WaterSection
from porescale.common.core.constants import GRAVITY
from porescale.common.core.dividing import dividing
from porescale.common.core.errors import Fault
from porescale.common.core.types import Floats
from porescale.common.schema.look import LookSection
from porescale.common.schema.names import name_faults, names_of
from porescale.common.schema.scene import SceneBase
from porescale.common.schema.sections import Refused, quantity

CALM_MACH = 10.0
"""Sound speed over the speed of free fall from the highest water: Mach number 0.1, so that density changes by 1 %."""


class Scene(SceneBase):
    """A tank with water, soil, or both."""

    elsewhere: ClassVar[Mapping[str, str]] = {"domain": "porescale"}

    title: str = pydantic.Field("", description="title, of pictures and reports")
    gravity: float = quantity("m/s^2", GRAVITY, ge=0, le=1e6, help="acceleration of free fall (downwards)")
    tank: TankSection
    water: WaterSection = WaterSection()
    soil: SoilSection | None = None
    air: AirSection | None = None
    inclusion: InclusionSection | None = None
    pile: SheetPileSection | None = None
    reservoir: tuple[ReservoirSection, ...] = ()
    face: tuple[FaceSection, ...] = ()
    probe: tuple[ProbeSection, ...] = ()
    level: tuple[LevelSection, ...] = ()
    numerics: NumericsSection
    time: TimeSection
    output: OutputSection
    look: LookSection | None = None

    @pydantic.model_validator(mode="before")
    @classmethod
    def _measured(cls, table: Any, info: pydantic.ValidationInfo) -> Any:
        return with_material(table, (info.context or {}).get("folder"))

    @property
    def highest(self) -> float:
        """Height of the highest water in the open above the floor, m."""
        tops = [column.bottom + column.height for column in self.water.column]
        return max([*tops, *(it.highest for it in self.reservoir)], default=0.0)

    @property
    def head(self) -> float:
        """Highest head above the floor, m: of water in the open and of faces; without them of that in pores."""
        return max([self.highest, *(it.highest for it in self.face)]) or self.pores_full_to

    @property
    def pores_full_to(self) -> float:
        """Height above the floor up to which pores of soil are full at the start, m; 0 where they are dry."""
        if self.soil is None or self.soil.suction is not None:
            return 0.0
        if self.soil.water_table is not None:
            return min(self.soil.water_table, self.soil.height)
        return self.soil.height if self.soil.saturated else 0.0

    @property
    def has_water(self) -> bool:
        """Whether there is water, now or later."""
        return bool(self.water.column or self.reservoir or self.face or self.pores_full_to > 0.0)

    @property
    def fall_speed(self) -> float:
        """Speed of free fall from there, m/s."""
        return float((2.0 * self.gravity * self.head) ** 0.5)

    @property
    def dry(self) -> bool:
        """Whether there is soil and no water, now or later."""
        return self.soil is not None and not self.has_water

    @property
    def inner(self) -> tuple[float, float]:
        """Inner width and height of the tank, m, in whole spacings, from which those given may differ by round-off."""
        spacing = self.numerics.spacing
        return spacings(self.tank.width, spacing) * spacing, spacings(self.tank.height, spacing) * spacing

    def open_at(self, points: Floats) -> NDArray[np.bool_]:
        """At which of ``points`` (n, 2) m, none of them to the left of the tank, neither water nor ground nor a side of
        the tank is."""
        taken = points[:, 0] > self.inner[0]
        for column in self.water.column:
            low, high = column.reach(points[:, 0])
            taken |= (low < points[:, 1]) & (points[:, 1] < high)
        for body in self.soil.body if self.soil is not None else ():
            taken |= body.holds(points)
        return ~taken

    def meeting_strips(self) -> list[str]:
        """Warnings of reservoirs that meet with other levels and no pile between them."""
        spacing = self.numerics.spacing
        at = self.pile.column(spacing) if self.pile is not None else None
        return [
            f"strips of reservoirs meet at {other.left:g} m with other levels: the higher feeds the lower as long as "
            "the run lasts; part them, or make them one"
            for one, other in pairwise(sorted(self.reservoir, key=lambda it: it.left))
            if other.left - one.right < 0.5 * spacing and one.table != other.table
            and not (at is not None and one.left < at < other.right)
        ]  # fmt: skip

    @pydantic.model_validator(mode="after")
    def _tension(self) -> "Scene":
        """Says what water does under negative pressure where that is left out.

        Beside ground they are cut, since thin water would cling to it; in the open, and beside air, kept, since without
        them water that splashes loses volume.
        """
        if self.numerics.tension is None:
            wet = self.soil is not None and self.has_water and self.air is None
            chosen = self.numerics.model_copy(update={"tension": "cut" if wet else "kept"})
            object.__setattr__(self, "numerics", chosen)
        return self

    @pydantic.model_validator(mode="after")
    def _fits(self) -> "Scene":
        tank, spacing = self.tank, self.numerics.spacing
        faults = self._unresolved()
        if self.soil is not None:
            faults += self.soil.faults(tank.width, tank.height, WHOLE * spacing)
            faults += self.soil.suction.faults(self) if self.soil.suction else []
        elif not self.water.column and not self.reservoir:  # which is refused below
            faults.append(Fault("water.column", None, "is missing", repair="give at least one rectangle of water"))
        uneven = {"tank.width", "tank.height"} & {it.key for it in faults}  # said already
        inner = (tank.width, tank.height) if uneven else self.inner
        faults += reservoir_faults(self.reservoir, self.soil, inner, spacing)
        if self.soil is not None:
            faults += self._wet_soil(self.soil)
        faults += face_faults(self.face, self.soil, tank.lid, inner, spacing)
        if self.face and self.gravity == 0.0:
            faults.append(Fault("face", "given", "has a head, which needs gravity", repair="raise gravity"))
        if self.pile is not None:
            faults += self.pile.faults(*inner, spacing)
            if self.soil is None:
                faults.append(Fault("pile", "given", "needs soil beside it", repair="add [soil]"))
        if not self.has_water and (self.soil is None or self.soil.suction is None):  # which refuses them itself
            of_water = (
                ("output.energy", True, self.output.energy),
                ("probe", "given", self.probe),
                ("level", "given", self.level),
            )
            problem, repair = "is of water, of which there is none", "leave it out"
            faults += [Fault(key, value, problem, repair=repair) for key, value, asked in of_water if asked]
        if self.reservoir and self.soil is None:
            faults.append(Fault("reservoir", "given", "needs soil beside it", repair="add [soil]"))
        if self.air is not None and (self.soil is None or not self.has_water):
            faults.append(Fault("air", "given", "needs soil and water", repair="add [soil] and [[water.column]]"))
        if self.air is not None and self.soil is not None and self.soil.saturated:
            faults.append(Fault("air", "given", "has no room in full pores", repair="take out soil.saturated"))
        if self.air is not None and self.water.viscosity == 0.0:  # drag on air is that on water, times μ_a/μ_w
            problem = "leaves the drag on air without a measure: air passes soil as much easier as it is less viscous"
            faults.append(Fault("water.viscosity", 0.0, problem, "Pa s", "> 0"))
        refused = self.soil is not None and self.soil.suction is not None  # as a whole, by suction
        for index, column in enumerate(() if refused else self.water.column):
            key = f"water.column[{index}]"
            slack = WHOLE * spacing
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
            if min(column.width, column.height) < (4.0 - WHOLE) * spacing:
                finest = min(column.width, column.height) / 4.0
                faults.append(
                    Fault("numerics.spacing", spacing, f"leaves {key} fewer than 4 particles across", "m",
                          f"<= {finest:g}")
                )  # fmt: skip
        faults += self._overlapping() + self._unseen() + look_faults(self)
        faults += self._released() + self._pushed()
        faults += self._misplaced()
        if 0.0 < self.gravity < WEAKEST:
            faults.append(Fault("gravity", self.gravity, "is too weak to move water", "m/s^2", f"0 or >= {WEAKEST:g}"))
        if self.gravity == 0.0 and self.has_water and self.water.sound_speed is None:
            faults.append(Fault("water.sound_speed", None, "is needed when there is no gravity to take it from"))
        if faults:
            raise Refused(*faults)
        return self

    def _overlapping(self) -> list[Fault]:
        """Columns of water that share room: every place would be filled twice."""
        found, least = [], 0.5 * self.numerics.spacing
        for k, one in enumerate(self.water.column):
            for j, other in enumerate(self.water.column[:k]):
                wide = min(one.left + one.width, other.left + other.width) - max(one.left, other.left)
                high = min(one.bottom + one.height, other.bottom + other.height) - max(one.bottom, other.bottom)
                if wide > least and high > least:
                    problem = f"overlaps water.column[{j}] by {wide:g} x {high:g} m"
                    found.append(Fault(f"water.column[{k}]", None, problem, repair="move or narrow one of them"))
        return found

    def _released(self) -> list[Fault]:
        """A column let go whose pressure is not known: not in the left corner, or beside ground or under a lid, which
        do not let it go."""
        columns, spacing = self.water.column, self.numerics.spacing
        if self.water.pressure != "released" or not columns:
            return []
        if not (len(columns) == 1 and columns[0].left == columns[0].bottom == 0.0):
            return [Fault("water.pressure", "released", "is known for one column in the left corner only",
                          repair='use "hydrostatic", or one column with left = bottom = 0')]  # fmt: skip
        width, height, (inner, top) = columns[0].width, columns[0].height, self.inner
        beside = ""
        if self.soil is not None:
            ends = (min(width + spacing, inner), min(height + spacing, top))
            sides = [(np.arange(spacings(end, spacing)) + 0.5) * spacing for end in ends]
            about = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
            beside = "beside ground" if any(body.holds(about).any() for body in self.soil.body) else ""
        under = self.inclusion is None and self.tank.lid and height > top - 0.5 * spacing
        if under and width < inner - 0.5 * spacing:  # as wide as the tank it is at rest
            beside = beside or "under a lid"
        if beside:
            return [Fault("water.pressure", "released", f"is not known {beside}, of which the column is not free",
                          repair='use "hydrostatic"')]  # fmt: skip
        return []

    def _pushed(self) -> list[Fault]:
        """A right face that is to start with a speed, where no column has a right face in the open."""
        columns, spacing = self.water.column, self.numerics.spacing
        if self.water.push == "none" or (self.soil is None and not columns):  # the latter is refused itself
            return []
        for it in columns:
            y = it.bottom + (np.arange(spacings(it.height, spacing)) + 0.5) * spacing
            if self.open_at(np.column_stack((np.full(len(y), it.left + it.width + 0.5 * spacing), y))).any():
                return []
        problem = "needs a right face of water in the open, and none has no side, ground or water before it"
        return [Fault("water.push", self.water.push, problem, repair="take it out")]

    def _unseen(self) -> list[Fault]:
        """Probes and levels that lie outside of the tank, or whose names make no columns."""
        found = name_faults("probe", self.probe, "probe") + name_faults("level", self.level, "level")
        found += self._shared_columns()
        width, height = self.tank.width, self.tank.height
        for k, it in enumerate(self.probe):
            if it.x > width or it.y > height:
                found.append(Fault(f"probe[{k}]", (it.x, it.y), "lies outside of the tank", "m"))
            else:
                found += it.unfilled(f"probe[{k}]", (width, height), self.numerics.spacing)
        for k, level in enumerate(self.level):
            if level.x > width:
                found.append(Fault(f"level[{k}].x", level.x, "lies outside of the tank", "m", f"<= {width:g}"))
        return found

    def _shared_columns(self) -> list[Fault]:
        """Probes and levels one of whose columns another has, too: one of both would be lost."""
        probes = list(zip(names_of(self.probe, "probe"), self.probe, strict=True))
        levels = names_of(self.level, "level") if self.soil is not None else []
        means = {f"{name} mean" for name, it in probes if it.width is not None}
        depths = {f"{name} open depth" for name in levels}
        shared = [("probe", k, name) for k, (name, it) in enumerate(probes) if it.width is None and name in means]
        shared += [("level", k, name) for k, name in enumerate(levels) if name in depths]
        problem = "makes a column that another one has"
        return [Fault(f"{key}[{k}].name", name, problem, repair="rename it") for key, k, name in shared]

    def _wet_soil(self, soil: SoilSection) -> list[Fault]:
        """Keys of the soil that need water, or exclude each other."""
        faults = []
        if soil.held and self.dry and soil.suction is None:
            faults.append(Fault("soil.held", True, "is of soil with water, of which there is none",
                                repair="add [[water.column]], [[reservoir]] or [[face]]"))  # fmt: skip
        for key, there, unit in (("held", soil.held, ""), ("water_table", soil.water_table, "m")):
            if soil.suction is not None and there is not None and there is not False:
                faults.append(Fault(f"soil.{key}", there, "cannot be with soil.suction", unit,
                                    repair="take out one of them"))  # fmt: skip
        if self.face and soil.suction is not None:
            faults.append(Fault("face", "given", "cannot be with soil.suction", repair="take out one of them"))
        for key, there in (("soil.saturated", soil.saturated), ("air", self.air is not None)):
            if there and soil.water_table is not None:
                faults.append(Fault("soil.water_table", soil.water_table, f"cannot be with {key}", "m",
                                    repair="take out one of them"))  # fmt: skip
        if soil.water_table is not None and soil.water_table > (1.0 + WHOLE) * self.tank.height:
            faults.append(Fault("soil.water_table", soil.water_table, "lies over the tank", "m",
                                f"<= {self.tank.height:g}"))  # fmt: skip
        lowest = min(it[1] for body in soil.body for it in body.outline) + 0.5 * self.numerics.spacing
        if soil.water_table is not None and soil.water_table < lowest * (1.0 - WHOLE):
            faults.append(Fault("soil.water_table", soil.water_table, "lies under all particles of the soil", "m",
                                f">= {lowest:g}", "raise it, or leave it out where pores are empty"))  # fmt: skip
        if soil.held and soil.watch:
            faults.append(Fault("soil.watch", "given", "has no displacement in soil that is held",
                                repair="take out soil.watch or soil.held"))  # fmt: skip
        return faults

    def _misplaced(self) -> list[Fault]:
        """Discs of the second fluid not within water or not resolved, and choices that have no room for one."""
        if self.inclusion is None:
            return []
        faults = []
        for index, disc in enumerate(self.inclusion.disc):
            key, r = f"inclusion.disc[{index}]", disc.radius
            inner = r - WHOLE * self.numerics.spacing  # a disc may touch the edges, to round-off
            held = any(
                c.left <= disc.x - inner and disc.x + inner <= c.left + c.width
                and c.bottom <= disc.y - inner and disc.y + inner <= c.bottom + c.height
                for c in self.water.column
            )  # fmt: skip
            if not held:
                faults.append(Fault(key, (disc.x, disc.y), "does not lie within a column of water", "m"))
            if r < (1.0 - WHOLE) * 3.0 * self.numerics.spacing:
                faults.append(
                    Fault("numerics.spacing", self.numerics.spacing, f"leaves {key} fewer than 6 particles across", "m",
                          f"<= {r / 3.0:g}")
                )  # fmt: skip
        faults += self.inclusion.overlaps(WHOLE * self.numerics.spacing)
        if self.tank.wall_particles == "images":
            faults.append(Fault("tank.wall_particles", "images", "have the pressure of one fluid only",
                                repair='use "pressure" with an inclusion'))  # fmt: skip
        return faults

    def _unresolved(self) -> list[Fault]:
        """Lengths of tank and water that are not whole spacings, and a spacing that makes too many particles."""
        spacing, tank, faults = self.numerics.spacing, self.tank, []
        count = tank.width * tank.height / spacing**2
        if count > MOST:
            finest = (tank.width * tank.height / MOST) ** 0.5
            faults.append(
                Fault(
                    "numerics.spacing",
                    spacing,
                    f"makes room for {count:.2g} particles in the tank",
                    "m",
                    f">= {finest:.3g}",
                )
            )
        lengths = {"tank.width": tank.width, "tank.height": tank.height}
        for index, column in enumerate(self.water.column):
            lengths |= {
                f"water.column[{index}].{it}": getattr(column, it) for it in ("left", "bottom", "width", "height")
            }
        lengths = {key: it for key, it in lengths.items() if it > 0.0}
        shares = {key: it / spacing for key, it in lengths.items()}
        uneven = [key for key, it in shares.items() if abs(it - spacings(lengths[key], spacing)) > WHOLE * max(1.0, it)]
        better = dividing(list(lengths.values()), spacing, WHOLE) if uneven else None
        for key in uneven:
            whole = spacings(lengths[key], spacing)
            another = f", or with a spacing of {better:.9g} m all lengths" if better else ""
            problem = f"is {shares[key]:.6g} spacings of {spacing:.6g} m, not whole ones"
            repair = f"{whole * spacing:.9g} m would be{another}"
            faults.append(Fault(key, lengths[key], problem, "m", repair=repair))
        return faults

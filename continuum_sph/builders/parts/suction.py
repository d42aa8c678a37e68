"""Soil with suction: particles that carry their water, and what is recorded of it."""

from typing import Any

import numpy as np

from continuum_sph.builders.assembly import Assembly
from continuum_sph.builders.parts.material import material_of
from continuum_sph.builders.parts.soil import SoilPart, porous_section, soil_flow, soil_law, soil_section
from continuum_sph.builders.parts.stiffness import largest_modulus, sound_speed
from continuum_sph.builders.sanity import Now, Range, require_finite, require_within
from continuum_sph.scene.sections import Scene
from continuum_sph.scene.suction import SuctionSection
from continuum_sph.seepage.overlap import Overlap
from continuum_sph.seepage.resistance import Resistance
from continuum_sph.soil import Material, SoilFlow
from continuum_sph.soil.stress import XX, XY, YY, ZZ
from continuum_sph.unsaturated import Level, MoistSoil, Moisture, Outside, VanGenuchten
from continuum_sph.unsaturated.pore_stress import borne
from continuum_sph.unsaturated.richards import (
    CONTENT,
    EFFECTIVE,
    FROM_WATER,
    PRESSURE,
    TO_AIR,
    properties_of,
    unity,
)
from continuum_sph.unsaturated.step import SHARE
from continuum_sph.water.no_step import LEAST
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors import square_lattice
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.part import Part
from porescale.common.schema.names import names_of

REPAIR = "raise soil.stiffness or soil.numerics.damping, or lower numerics.courant"
GAP = 1.5
"""Spacings between two particles of a column that do not stand on each other."""
FULLEST = 1.5
"""Filling of pores beyond which the water would be compressed by a half."""


def suction_section(scene: Scene) -> SuctionSection:
    """The suction of a scene that has some."""
    section = soil_section(scene).suction
    assert section is not None
    return section


def retention_of(scene: Scene) -> VanGenuchten:
    """The retention of a scene's soil."""
    section, water = suction_section(scene), scene.water
    return VanGenuchten(
        section.alpha, section.n, section.residual, water.density * scene.gravity,
        water.density * sound_speed(scene) ** 2,
    )  # fmt: skip


def initial_pressure(scene: Scene, y: Floats) -> Floats:
    """Pressure (Pa) in pores at heights ``y`` (n,) m at the start."""
    section, law = suction_section(scene), retention_of(scene)
    if section.water_table is not None:
        found: Floats = law.weight * (section.water_table - y)
        return found
    assert section.saturation is not None
    part = (section.saturation - section.residual) / (1.0 - section.residual)
    return np.full(len(y), -law.weight * float(law.suction(part)))


def require_filled(scene: Scene, y: Floats) -> None:
    """Refuse suction at the start that leaves pores at heights ``y`` (n,) m less than no water: beyond the dry end of
    the retention curve a filling falls with the stiffness of the water, and without an end."""
    section, law = suction_section(scene), retention_of(scene)
    if float(law.filling(initial_pressure(scene, y)).min()) >= 0.0:
        return
    key, problem, repair = "soil.suction", "leaves pores less than no water", "raise it or water.sound_speed"
    if section.water_table is not None:
        numbers = law.numbers
        deepest = numbers.dry_pressure - numbers.stiffness * numbers.dry  # at which a filling is 0
        least = float(y.max()) + deepest / law.weight
        raise InputError(Fault(f"{key}.water_table", section.water_table, problem, "m", f">= {least:.4g}", repair))
    raise InputError(Fault(f"{key}.saturation", section.saturation, problem, repair=repair))


def longest_step(scene: Scene) -> float:
    """Longest step (s) for sound in the soil of a scene that cannot drain, of grains and the residual water.

    InputError for water so stiff that it is less than `LEAST` of the soil's own, with which a run is unstable.
    """
    section, law, ground, modulus = porous_section(scene), retention_of(scene), soil_law(scene), largest_modulus(scene)
    porosity, density = section.porosity, scene.water.density
    whole, way = section.density + law.residual * porosity * density, SHARE * ground.smoothing.length
    step, least = way / ((modulus + law.stiffness / porosity) / whole) ** 0.5, LEAST * ground.step_at_rest
    if step < least:
        fastest = (max(0.0, (way / least) ** 2 * whole - modulus) * porosity / density) ** 0.5
        problem = f"makes steps of {step:.2g} s, less than {LEAST:g} of those of the soil"
        raise InputError(Fault("water.sound_speed", sound_speed(scene), problem, "m/s", f"<= {fastest:.4g}",
                               "lower it, or leave it out"))  # fmt: skip
    return float(step)


def outside_of(scene: Scene, ground: SoilFlow) -> Outside:
    """All places of the tank, and the levels of its reservoirs."""
    spacing, (width, height), h = scene.numerics.spacing, scene.inner, ground.law.smoothing.length
    places = square_lattice((0.0, 0.0), (width, height), spacing)
    columns = round(width / spacing)
    levels = []
    for name, it in zip(names_of(scene.reservoir, "reservoir"), scene.reservoir, strict=True):
        times, heights = (np.array(column, np.float64) for column in zip(*it.table, strict=True))
        levels.append(Level(name, it.left, it.right, it.bottom, times, heights))
    margin = 4.0 * h
    box = (-margin, -margin), (width + margin, height + margin)
    overlap = Overlap(len(places), ground.soil.soil, h, scene.numerics.skin * h, *box)
    return Outside(places, len(places) // columns, columns, spacing, overlap, levels)


def rest(scene: Scene, both: MoistSoil, material: Material) -> None:
    """Effective stress of soil at rest under its weight, its water's, and open water: what stands over a particle
    without a gap, less π, σ_xx = K0 σ_yy."""
    section, soil, n = soil_section(scene), both.ground.soil, both.ground.soil.soil
    if section.stress == "none":
        return
    spacing, gravity, law = scene.numerics.spacing, scene.gravity, both.water.retention
    x, weight = soil.x[:n], gravity * (soil.mass[:n] + both.water.content[:, CONTENT]) / spacing
    state = both.water.state
    pore = np.array([borne(p, s) for p, s in zip(state[:, PRESSURE], state[:, EFFECTIVE], strict=True)])
    upright = np.zeros(n)
    for column in np.unique(np.floor(x[:, 0] / spacing)):
        rows = np.flatnonzero(np.floor(x[:, 0] / spacing) == column)
        rows = rows[np.argsort(-x[rows, 1])]
        near, ceiling = np.abs(both.outside.x[:, 0] - x[rows[0], 0]) < 0.5 * spacing, np.inf
        for piece in np.split(rows, np.flatnonzero(np.diff(x[rows, 1]) < -GAP * spacing) + 1):
            over = near & (both.outside.x[:, 1] > x[piece[0], 1]) & (both.outside.x[:, 1] < ceiling)
            head = float(both.outside.places[over, 2].max(initial=0.0))
            top = max(0.0, law.weight * (head - x[piece[0], 1] - 0.5 * spacing))
            upright[piece] = top + np.cumsum(weight[piece]) - 0.5 * weight[piece] - pore[piece]
            ceiling = x[piece[-1], 1]
    upright = np.maximum(upright, 0.0)
    k0 = material.rest if section.rest is None else section.rest
    soil.stress[:n, XX], soil.stress[:n, YY], soil.stress[:n, XY] = k0 * upright, upright, 0.0
    soil.stress[:n, ZZ] = material.poisson * (1.0 + k0) * upright


def moist_soil(scene: Scene) -> MoistSoil:
    """Soil and its water, ready for the first step."""
    section, suction, ground = porous_section(scene), suction_section(scene), soil_flow(scene)
    law, spacing, soil = retention_of(scene), scene.numerics.spacing, ground.soil
    smoothing = ground.law.smoothing
    c = unity(smoothing.kind, smoothing.length / spacing)
    properties = properties_of(scene.water.density, scene.gravity, law, spacing, c, suction.connectivity)
    x, area = soil.x[: soil.soil], np.full(soil.soil, spacing * spacing)
    resistance = Resistance(section.porosity, section.permeability_law, share=section.hydraulic_share)
    water = Moisture(
        law, properties, (1.0 - section.porosity) * area, section.permeability_at(x), section.porosity,
        resistance if resistance.number else None,
    )  # fmt: skip
    water.place(x, area)
    longest_step(scene)
    require_filled(scene, x[:, 1])
    water.fill(initial_pressure(scene, x[:, 1]))
    both = MoistSoil(ground, water, outside_of(scene, ground), largest_modulus(scene))
    both.look(0.0)
    rest(scene, both, material_of(section))
    both.start()
    return both


class MoisturePart(Part):
    """The water in the pores of soil with suction."""

    key = "moisture"

    def __init__(self, flow: MoistSoil) -> None:
        self.flow = flow

    def saturation(self) -> Floats:
        """S of each particle of soil, (soil,)."""
        water = self.flow.water
        found: Floats = water.retention.residual + (1.0 - water.retention.residual) * water.state[:, EFFECTIVE]
        return found

    def check(self) -> None:
        """Raise Unstable where there is no water, or more than pores can hold."""
        water, soil = self.flow.water, self.flow.ground.soil
        now = Now(self.flow.step, self.flow.time, REPAIR)
        require_finite({"water": ("kg/m", water.content), "pore pressure": ("Pa", water.state[:, PRESSURE])}, now,
                       "soil particle")  # fmt: skip
        filling = water.content[:, CONTENT] / (water.properties.density * (self.flow.volume - water.grains))
        require_within(filling, Range("filling of pores", "", 0.0, FULLEST), np.arange(soil.soil), soil.x, now)

    def row(self) -> dict[str, float]:
        """Columns of the water in pores, and the levels outside.

        water in pores (kg/m) : mass per metre of depth
        water from reservoirs (kg/m) : what has come in since the start
        water seeped out (kg/m) : what has left into the air since the start
        mean saturation () : by volume of the soil
        least saturation () : of any particle
        largest suction (Pa) : of any particle
        largest pore pressure (Pa) : of any particle, above the room's
        stages of flow () : stages of the flow's own steps, since the start
        NAME level (m) : height of the water outside
        """
        flow, state = self.flow, self.flow.water.state
        saturation, volume = self.saturation(), flow.volume
        totals = flow.water.content.sum(axis=0)
        return {
            "water in pores (kg/m)": float(totals[CONTENT]),
            "water from reservoirs (kg/m)": float(totals[FROM_WATER]),
            "water seeped out (kg/m)": float(totals[TO_AIR]),
            "mean saturation ()": float((saturation * volume).sum() / volume.sum()),
            "least saturation ()": float(saturation.min()),
            "largest suction (Pa)": float(max(0.0, -state[:, PRESSURE].min())),
            "largest pore pressure (Pa)": float(max(0.0, state[:, PRESSURE].max())),
            "stages of flow ()": float(flow.stages),
            **{f"{it.name} level (m)": it.at(flow.time) for it in flow.outside.levels},
        }

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return self.flow.state()

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from a state; the soil's part, which comes after, has been restored."""
        self.flow.restore(state)


class MoistSoilPart(SoilPart):
    """Soil whose particles show saturation, suction and pressure of their water."""

    def __init__(self, scene: Scene, flow: MoistSoil, water: MoisturePart) -> None:
        super().__init__(scene, flow.ground)
        self.water = water

    def masses(self) -> Floats:
        """Masses of the soil with the water that it carries, which move as one, (n,) kg/m; a copy."""
        found: Floats = super().masses() + self.water.flow.water.content[:, CONTENT]
        return found

    def cloud(self) -> Cloud:
        """The soil with what its pores hold."""
        found, pressure = super().cloud(), self.water.flow.water.state[:, PRESSURE]
        found.data["saturation"] = self.water.saturation()
        found.data["suction"] = np.maximum(0.0, -pressure)
        found.data["pore_pressure"] = pressure.copy()
        found.units |= {"suction": "Pa", "pore_pressure": "Pa"}
        return found

    def show(self, snapshot: Snapshot) -> None:
        """Add the soil to the snapshot."""
        snapshot.clouds["particles"] = snapshot.clouds["soil"] = self.cloud()


def assemble(scene: Scene) -> Assembly:
    """Soil with suction, and its parts."""
    both = moist_soil(scene)
    water = MoisturePart(both)
    soil = MoistSoilPart(scene, both, water)
    return Assembly(both, [water, soil], soil, REPAIR)

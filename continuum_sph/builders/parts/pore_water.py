"""Soil and the water in its pores: both layers of particles, ready to move together."""

from dataclasses import replace

import numpy as np

from continuum_sph.builders.parts.air import AIR, air_fluid, air_pores, dry_pores, specific_weights, with_air
from continuum_sph.builders.parts.faces import enclosing, pressure_face
from continuum_sph.builders.parts.held_soil import held_ground
from continuum_sph.builders.parts.reservoirs import halves, reservoir, spare
from continuum_sph.builders.parts.sheet_pile import ground_at, sheet_pile
from continuum_sph.builders.parts.soil import porous_section, soil_flow, soil_section
from continuum_sph.builders.parts.stiffness import largest_modulus
from continuum_sph.builders.parts.water import wall_layers, water_law, water_particles, water_state
from continuum_sph.scene.bounds import WHOLE
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage import PoreFlow, Resistance, Seepage, Supply, skeleton_of
from continuum_sph.seepage.overlap import Overlap
from continuum_sph.seepage.reservoir import BERTH, berths
from continuum_sph.seepage.sheet_pile import CutPairList
from continuum_sph.seepage.skeleton import Frame, Skeleton
from continuum_sph.soil import SoilFlow
from continuum_sph.water.density import LINEAR
from continuum_sph.water.parameters import Law
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.state import Layer
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList
from porescale.common.schema.names import names_of

REACH = 1.05
"""Least smoothing length over the distance of water's particles in pores that they enter, to reach the next row: with
0.87 a dam that gets wet lets through 3.5 % too little (`rectangular_dam`), with 1.25 the foot of a front is blunt
(`dry_levee`)."""


def gets_wet(scene: Scene, soil: Floats) -> bool:
    """Whether pores of ``soil`` (s, 2) m start without water and without air, so that water enters them as it comes."""
    return not scene.air and len(pore_water(scene, soil)[0]) < len(dry_pores(scene.water.column, soil))


def pore_law(scene: Scene, soil: Floats) -> Law:
    """Parameters of the water in a scene with ``soil`` (s, 2) m.

    Where it enters pores its particles part to 1/√n of their distance: where pores start empty, so that all that is in
    them has done so, smoothing lengths are at least REACH of that.

    Among grains gradients are corrected, as those of the soil are: total stress is in balance where pressure and
    effective stress cancel, and would not by 1.3 % of both.  Density diffusion takes departures from linear fields only
    there: any other lets water through that the soil keeps back; it is as much less as pores are smaller than the
    whole.  In the open both are those of water alone (`seepage.mixture.open_gradients`).
    """
    law = water_law(scene)
    strength = 0.5 * law.diffusion * soil_section(scene).porosity
    law = replace(law, corrected=True, noise=LINEAR, diffusion=strength)
    if gets_wet(scene, soil):
        least = REACH * law.spacing / soil_section(scene).porosity ** 0.5
        law = replace(law, smoothing=replace(law.smoothing, length=max(least, law.smoothing.length)))
    return with_air(law, air_fluid(scene.air)) if scene.air else law


def wet_height(scene: Scene, x: Floats) -> Floats:
    """Height of water at the start above each of ``x`` (n, 2) m, that within soil included, (n,) m."""
    found = np.zeros(len(x))
    for column in scene.water.column:
        over = (x[:, 0] > column.left) & (x[:, 0] < column.left + column.width)
        top = column.bottom + column.height
        found = np.where(over & (x[:, 1] < top), found + (top - np.maximum(x[:, 1], column.bottom)), found)
    return found


def wet_top(scene: Scene, x: Floats) -> Floats | None:
    """Height (m) up to which pores over or under ``x`` (n, 2) m are full at the start, (n,); None without a table."""
    section = soil_section(scene)
    if not section.saturated and section.water_table is None:
        return None
    top = section.surface_over(x, 0.5 * scene.numerics.spacing)
    return top if section.water_table is None else np.minimum(top, section.water_table)


def buoyancy(scene: Scene, x: Floats) -> Floats:
    """What water takes off the upright stress (n,) Pa of soil at ``x`` (n, 2) m that is at rest: (1 - n) ρ g of the
    ground above that is wet."""
    section = soil_section(scene)
    top = section.surface_over(x, 0.5 * scene.numerics.spacing)
    above = np.column_stack((x[:, 0], np.minimum(top, scene.inner[1])))
    wet = wet_height(scene, x) - wet_height(scene, above)
    table = wet_top(scene, x)
    grains = wet if table is None else table - x[:, 1]  # of the soil above a particle, what is wet
    if section.water_table is not None:
        grains = np.maximum(wet, grains)
    lost: Floats = (1.0 - section.porosity) * scene.water.density * scene.gravity * np.maximum(grains, 0.0)
    return lost


def submerge(scene: Scene, ground: SoilFlow) -> None:
    """Take the buoyancy of the grains off the stress of soil that is at rest under its dry weight."""
    soil, n = ground.soil, ground.soil.soil
    upright, lost = soil.stress[:n, 1], buoyancy(scene, soil.x[:n])
    share = np.divide(lost, upright, out=np.ones(n), where=lost < upright)
    soil.stress[:n] *= (1.0 - share)[:, None]


def leave_to_water(scene: Scene, ground: SoilFlow, x: Floats, v: Floats, rho: Floats) -> Floats:
    """Densities (n,) of water at ``x`` (n, 2) m, with ``rho`` (n,) at rest, when it bears the weight of the soil.

    Overwrites the velocities of the soil and of the water in it, ``v`` (n, 2) m/s: they pass each other upright at
    Darcy's velocity, q = k γ'/(ρ g) with the g of k, and together displace nothing: n v_w + (1 - n) v_s = 0.  From rest
    the momentum that this has would ring in both as sound, by k c/(g H) of the weight.
    """
    section, state = soil_section(scene), water_state(scene)
    n = section.porosity
    depth = section.surface_over(x, 0.5 * scene.numerics.spacing) - x[:, 1]
    inside = np.any([body.holds(x) for body in section.body], axis=0)
    borne = section.density * scene.gravity * depth - buoyancy(scene, x)
    gradient, soil = section.density / scene.water.density - (1.0 - n), slice(ground.soil.soil)
    k, k_soil = section.permeability_at(x[inside]), section.permeability_at(ground.soil.x[soil])
    v[inside, 1] = k * gradient * (scene.gravity / GRAVITY) * (1.0 - n) / n
    ground.soil.v[soil, 1] = -(k_soil * gradient * (scene.gravity / GRAVITY))
    found: Floats = state.density_at(state.pressure(rho) + np.where(inside, np.maximum(borne, 0.0), 0.0))
    return found


def pore_water(scene: Scene, soil: Floats) -> tuple[Floats, Floats]:
    """Places (k, 2) m of the water in pores of ``soil`` (s, 2) m that no column of water holds and that are full at the
    start, and their depths (k,) m under the surface of the ground or the water table, or of the water that stands on
    it."""
    pores = dry_pores(scene.water.column, soil)
    top = wet_top(scene, pores)
    if top is None:
        return np.zeros((0, 2)), np.zeros(0)
    if soil_section(scene).water_table is not None:
        under = pores[:, 1] < top
        pores, top = pores[under], top[under]
    return pores, scene.water.surface_over(pores, top, 0.5 * scene.numerics.spacing) - pores[:, 1]


def head_on_lid(scene: Scene, count: int) -> float:
    """Head (m) over the lid under which water that fills the tank rests: the lowest of its faces at the start.

    0 where there is no face or water has a surface: where it has fewer particles, ``count``, than fit under a lid.
    Water that starts without that head is pressed together by p/ρc² before it flows, and rows beside the faces with it:
    flow under a gradient of 0.5 over 24 cm, 5 m deep, sound at 50 m/s, was 9 % low after 0.1 s, 27 % after 0.8 s.
    """
    if not scene.face or not fills(scene, count):
        return 0.0
    return max(0.0, min(it.table[0][1] for it in scene.face) - scene.inner[1])


def fills(scene: Scene, count: int) -> bool:
    """Whether so many particles of water, ``count``, fill the tank up to its lid."""
    rows, columns = (round(length / scene.numerics.spacing) for length in scene.inner)
    return scene.tank.lid and count >= rows * columns


def stays_full(scene: Scene, count: int) -> bool:
    """Whether so many particles of water, ``count``, fill the tank and no head of its faces ever lies below the lid."""
    lowest = min((head for it in scene.face for _, head in it.table), default=0.0)
    return fills(scene, count) and lowest >= scene.inner[1] * (1.0 - WHOLE)


def saturate(scene: Scene, soil: Floats, x: Floats, v: Floats, rho: Floats) -> tuple[Floats, Floats, Floats]:
    """Places, velocities (n, 2) and densities (n,) of water with that in pores of ``soil`` (s, 2) m that have none and
    lie under the surface of the ground or the water table: at rest, as are columns that end below full pores; with
    ``water.pressure = "none"`` all water starts without pressure, that in pores, too."""
    pores, depth = pore_water(scene, soil)
    lid = head_on_lid(scene, len(x) + len(pores))
    more = water_state(scene).settled_density(depth + lid, scene.gravity)
    if scene.water.pressure == "none":
        more = np.full(len(pores), scene.water.density)
    table = wet_top(scene, x)
    if (table is not None or lid > 0.0) and scene.water.pressure == "hydrostatic":
        inside = np.any([body.holds(x) for body in soil_section(scene).body], axis=0)
        start = x[:, 1] if table is None else np.where(inside & (table > x[:, 1]), table, x[:, 1])
        slack = 0.5 * scene.numerics.spacing
        over = scene.water.surface_over(x, start, slack) + lid
        alone = scene.water.surface_over(x, x[:, 1], slack)
        rho = np.where(over > alone, water_state(scene).settled_density(over - x[:, 1], scene.gravity), rho)
    return np.concatenate((x, pores)), np.concatenate((v, np.zeros_like(pores))), np.concatenate((rho, more))


def water_counts(scene: Scene, soil: Floats) -> tuple[int, int]:
    """Particles of water in the tank at the start, those in pores of ``soil`` (s, 2) m included, and particles that
    wait for reservoirs to let them in, or to be halves of others."""
    x = np.concatenate((water_particles(scene, pore_law(scene, soil))[0], pore_water(scene, soil)[0]))
    if scene.pile:
        x = x[~sheet_pile(scene.pile, scene.numerics.spacing).holds(x)]
    return len(x), spare(scene, x) + halves(scene, len(soil), porous_section(scene).porosity)


def ground_of(scene: Scene, *, hasty: bool = False) -> tuple[SoilFlow | Frame, Skeleton]:
    """The soil of a scene, moving or held, and what its water needs of it;  hasty : as of `soil.placed`."""
    section = soil_section(scene)
    if section.held:
        frame = held_ground(scene)
        return frame, frame.skeleton
    ground = soil_flow(scene, hasty=hasty)
    submerge(scene, ground)
    return ground, skeleton_of(
        ground, section.density / (1.0 - section.porosity), section.permeability_at(ground.soil.x[: ground.soil.soil])
    )


def seepage_flow(scene: Scene, *, hasty: bool = False) -> Seepage:
    """Soil and water of a scene, ready for their first step;  hasty : kernels of the water run first, those of the soil
    (`soil.placed`) then."""
    section, spacing = porous_section(scene), scene.numerics.spacing
    ground, skeleton = ground_of(scene, hasty=hasty)
    law = pore_law(scene, skeleton.x)
    x, v, rho = saturate(scene, skeleton.x, *water_particles(scene, law))
    full = stays_full(scene, len(x))
    if section.stress == "unconsolidated" and isinstance(ground, SoilFlow):
        rho = leave_to_water(scene, ground, x, v, rho)
    pile = sheet_pile(scene.pile, spacing) if scene.pile else None
    if pile:
        skeleton.foot = pile.foot(ground_at(section, pile.x))
        x, v, rho = (values[~pile.holds(x)] for values in (x, v, rho))
    layers, (width, height), area = wall_layers(law, spacing), scene.inner, spacing * spacing
    margin, skin = layers * spacing, scene.numerics.skin * law.smoothing.length
    wet = len(x)
    if scene.air:
        pores = air_pores(scene, skeleton.x)
        x, v = np.concatenate((x, pores)), np.concatenate((v, np.zeros_like(pores)))
        rho = np.concatenate((rho, np.full(len(pores), scene.air.density)))
    present, top = len(x), height + margin
    spared = spare(scene, x[:wet])
    waiting = spared + halves(scene, skeleton.count, section.porosity)
    berth = berths(present + waiting, width, top, BERTH * law.smoothing.support)
    if waiting:
        x, v = np.concatenate((x, berth[present:])), np.concatenate((v, np.zeros((waiting, 2))))
        rho = np.concatenate((rho, np.full(waiting, law.state.density)))
        top = float(berth[-1, 1]) + BERTH * law.smoothing.support
    walls, side = tank_walls(width, height, spacing, layers, lid=scene.tank.lid), np.zeros(0, np.int64)
    if pile:
        piled, _, side = pile.particles(layers, height)
        walls = np.concatenate((walls[~pile.holds(walls)], piled))
    mass = np.concatenate((rho * area, np.full(len(walls), law.state.density * area)))
    mass[present : len(x)] = 0.0
    layer = Layer(len(x), np.concatenate((x, walls)), np.concatenate((v, np.zeros_like(walls))), mass, rho)
    layer.material[wet:present] = AIR if scene.air else 0
    if scene.output.energy:
        layer.keep_budget()
    box = (-margin, -margin), (width + margin, top)
    overlap = Overlap(len(x), skeleton.count, law.smoothing.length, skin, *box)
    pairs = PairList(layer.count, skin, *box, full=True)
    if pile:
        pairs, overlap.pairs = CutPairList(pairs, pile, len(x), side, layer.v), CutPairList(overlap.pairs, pile)
    flow = PoreFlow(
        layer, law, pairs, skeleton=skeleton, overlap=overlap,
        resistance=Resistance(section.porosity, section.permeability_law, share=section.hydraulic_share),
    )  # fmt: skip
    size, weight = (width, height), scene.water.density * scene.gravity
    of_tank = np.arange(len(x), layer.count - len(side))
    flow.faces += [pressure_face(it, layer.x, of_tank, size, weight) for it in scene.face]
    flow.enclosing = enclosing(scene.face, layer.x, of_tank, size, full=full)
    if scene.air:
        flow.specific_weight = specific_weights(layer.material[: len(x)], law, flow.resistance.gravity)
    flow.lower[:] = 0.0
    flow.upper[:] = width, height if scene.tank.lid and not waiting else np.inf
    whole = section.porosity * scene.water.density + section.density if not section.held else np.inf
    both = Seepage(flow, ground, largest_modulus(scene), whole)
    both.start()
    layer.mass[:present] = (flow.porosity * rho * area)[:present]
    if waiting:
        stiff = law.state.density * law.state.sound_speed**2
        names = names_of(scene.reservoir, "reservoir")
        kept = [reservoir(it, name, width) for name, it in zip(names, scene.reservoir, strict=True)]
        both.supply = Supply(layer, kept, berth, spacing, law.state.density, stiff, scene.gravity, spared)
        both.supply.keep(0.0)
    both.start()
    return both

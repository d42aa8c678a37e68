"""From a scene's ground to particles, law and pair list."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from continuum_sph.scene.sections import Scene
from continuum_sph.scene.soil_sections import Ground
from continuum_sph.seepage.sheet_pile import PartedList, Pile
from continuum_sph.soil import Material, Soil, SoilFlow, SoilLaw
from continuum_sph.soil.walls import HOLDING, SLIPPING
from continuum_sph.water.image_walls import facing
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import Smoothing
from porescale.common.core.constants import GRAVITY
from porescale.common.neighbors import PairList, square_lattice

Floats = NDArray[np.float64]
NO_PILE = np.zeros((0, 2)), np.zeros((0, 4)), np.zeros(0, np.int64)


def geostatic(depth: Floats, material: Material, gravity: float = GRAVITY, rest: float | None = None) -> Floats:
    """Stress (n, 4) Pa at a ``depth`` (n,) m below level ground, σ_xx = K0 σ_yy."""
    weight = material.density * gravity * np.maximum(depth, 0.0)
    k0 = material.rest if rest is None else rest
    across = material.poisson * (1.0 + k0) * weight
    return np.column_stack((k0 * weight, weight, np.zeros_like(weight), across))


def placed(
    x: Floats,
    stress: Floats,
    tank: tuple[float, float],
    law: SoilLaw,
    *,
    floor: str = "hold",
    sides: str = "slip",
    skin: float,
    pile: Pile | None = None,
) -> SoilFlow:
    """Soil at ``x`` (n, 2) m with ``stress`` (n, 4) Pa in a tank (width, height), m, lower left corner at the origin.

    floor, sides : "hold" the soil or let it "slip", sides "none": endless soil, periodic across;  skin : of the pair
    list, over the smoothing length;  pile : in the soil of a closed tank.
    """
    (width, height), spacing, material = tank, law.spacing, law.materials[0]
    layers = math.ceil(law.smoothing.support / spacing - 0.5 - 1e-9)
    closed = sides != "none"
    tank_sides = tank_walls(width, height, spacing, layers, sides=closed)
    piled, behind, side = pile.particles(layers, height) if pile else NO_PILE
    walls = np.concatenate((tank_sides, piled))
    n, count = len(x), len(x) + len(walls)
    number = np.zeros(count, np.int64)
    beside = (walls[:, 0] < 0.0) | (walls[:, 0] > width)
    below = walls[:, 1] < 0.0
    # In a corner both walls reverse what they meet, which is what a wall that holds does.
    slips = {"hold": HOLDING, "slip": SLIPPING}
    kinds = np.where(beside, slips.get(sides, HOLDING), slips[floor])
    number[n:] = np.where(beside & below, HOLDING, kinds)
    if pile:
        number[count - len(piled) :] = HOLDING if pile.rough else SLIPPING
    soil = Soil(
        n,
        np.concatenate((x, walls)),
        np.zeros((count, 2)),
        np.full(count, material.density * spacing**2),
        np.full(n, material.density),
        np.concatenate((stress, np.zeros((len(walls), 4)))),
        number,
    )
    margin = layers * spacing
    lower, upper = (0.0, 0.0) if closed else (-math.inf, 0.0), (width, math.inf) if closed else (math.inf, math.inf)
    soil.facing[n:] = np.concatenate((facing(tank_sides, lower, upper), behind))
    box = ((-margin, -margin), (width + margin, height + margin)) if closed else ((0.0, -margin), (width, height))
    pairs = PairList(count, skin * law.smoothing.length, *box, (not closed, False), full=True)
    if pile:
        pairs = PartedList(pairs, pile, n, side, soil.v)
    flow = SoilFlow(soil, law, pairs)
    flow.lower[:], flow.upper[:] = lower, upper
    flow.start()
    return flow


def ground_of(scene: Scene) -> Ground:
    """The soil of a scene that has some."""
    assert scene.soil is not None
    return scene.soil


def damping_of(scene: Scene) -> float:
    """α of the damping: as given, or what makes α c h the given viscosity, c sound in a column at E0."""
    ground, numerics = ground_of(scene), scene.numerics
    if ground.numerics.damping_viscosity is None:
        return ground.numerics.damping
    sound = math.sqrt(ground.material.column_modulus / ground.density)
    return ground.numerics.damping_viscosity / (sound * numerics.smoothing_ratio * numerics.spacing)


def soil_law(scene: Scene) -> SoilLaw:
    """What the soil of a scene obeys."""
    ground, numerics = ground_of(scene), scene.numerics
    choice, material = ground.numerics, ground.material
    # What stops the slowest swing of a column of this height, period 4 H/c, within one of its periods.
    softest = material.column_modulus * material.stiffness_at(material.least) / material.stiffness
    slowest = 0.5 * math.pi * math.sqrt(softest / material.density) / ground.height
    return SoilLaw(
        Smoothing(numerics.kernel, numerics.smoothing_ratio * numerics.spacing),
        numerics.spacing,
        (material,),
        (0.0, -scene.gravity),
        damping=damping_of(scene),
        printed_damping=choice.damping_of == "approach",
        corrected=choice.gradient == "corrected",
        diffusion=choice.stress_diffusion,
        restless=choice.restless_diffusion,
        apart=choice.parting,
        repulsion=choice.repulsion,
        drag=slowest,
        settle=choice.settle,
        courant=numerics.courant,
    )


def soil_particles(scene: Scene) -> tuple[Floats, Floats]:
    """Positions (n, 2) m and stresses (n, 4) Pa of a scene's soil at the start."""
    ground, (width, height) = ground_of(scene), scene.inner
    lattice = square_lattice((0.0, 0.0), (width, height), scene.numerics.spacing)
    inside = np.zeros(len(lattice), np.bool_)
    top = np.full(len(lattice), -np.inf)
    for body in ground.body:
        inside |= body.holds(lattice)
        top = np.maximum(top, body.top(lattice[:, 0]))
    if scene.pile:
        inside &= ~scene.pile.wall(scene.numerics.spacing).holds(lattice)
    x = lattice[inside]
    if ground.stress == "none":
        return x, np.zeros((len(x), 4))
    return x, geostatic(top[inside] - x[:, 1], ground.material, scene.gravity, ground.rest)


def soil_flow(scene: Scene) -> SoilFlow:
    """The soil of a scene, ready for its first step."""
    ground, numerics = ground_of(scene), scene.numerics
    x, stress = soil_particles(scene)
    law, pile = soil_law(scene), scene.pile.wall(numerics.spacing) if scene.pile else None
    return placed(x, stress, scene.inner, law, floor=ground.floor, sides=ground.sides, skin=numerics.skin, pile=pile)

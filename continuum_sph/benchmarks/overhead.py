"""Kinds of continuum scenes for `study parts`: a column of water on its way down, and what each choice adds to it; soil
of the same size, water in it, and air in the lower half of its pores."""

from collections.abc import Callable
from typing import Any

from continuum_sph.benchmarks.minimal_sph import PlainColumn
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.tanks import level_ground, tank_scene
from porescale.common.evidence.overhead import SMALLEST, BuiltScene, SceneKind, SceneKinds

SPACING = 1.0 / 32.0  # m: 2048 particles of water
WARM = 200
"""Steps before timing: water in motion."""
Table = dict[str, Any]

COLUMN: Table = {"width": 1.0, "height": 2.0}
PLAIN, SMOOTHED = "water only", "water with XSPH"
SOIL, SOAKED = "soil", "soil and water"


def scene(numerics: Table | None = None, tank: Table | None = None, **more: Any) -> Scene:
    """A column in a closed tank."""
    given: Table = {"tank": {"width": 4.0, "height": 3.0} | (tank or {}), "water": {"column": [COLUMN]}}
    return tank_scene(4.0, 3.0, SPACING, numerics=numerics, **given | more)


def parts_of(it: Scene) -> list[str]:
    """What the scene builds beyond particles, walls and their list."""
    numerics = it.numerics
    chosen = {
        "water": bool(it.water.column), "second fluid": it.inclusion is not None,
        "surface tension": it.inclusion is not None and it.inclusion.surface_tension > 0.0,
        "corrected gradients": numerics.gradient == "corrected", "shifting": numerics.shifting > 0.0,
        "energy book": it.output.energy, "XSPH": numerics.xsph > 0.0, "walls that hold": it.tank.walls != "slip",
        "walls of images": it.tank.wall_particles == "images", "soil": it.soil is not None,
        "air": it.air is not None, "faces": bool(it.face), "sheet pile": it.pile is not None,
        "held": it.soil is not None and it.soil.held, "suction": it.soil is not None and it.soil.suction is not None,
        "rate": it.soil is not None and it.soil.rate is not None,
        "softening": it.soil is not None and it.soil.softening is not None,
        "side walls": it.soil is not None and it.soil.side_walls is not None,
    }  # fmt: skip
    return [name for name, there in chosen.items() if there]


def started(it: Scene) -> Simulation:
    """The simulation of a scene, on its way."""
    made = Simulation(it)
    made.advance(WARM)
    return made


def added(name: str, because: str = "", **more: Any) -> SceneKind:
    """A scene with something more, beside water alone."""

    def make() -> BuiltScene:
        """The scene with the addition and water alone, both after their warm-up steps."""
        it = scene(**more)
        own, other = started(it), started(scene())
        return BuiltScene(own, parts_of(it), own.flow.layer.fluid, own.advance, other.advance)

    return SceneKind(name, "particle", PLAIN, make, because=because)


def alone(**more: Any) -> BuiltScene:
    """Water alone, with ``more`` in its scene, beside the smallest kernels for it."""
    it = scene(**more)
    made = started(it)
    return BuiltScene(made, parts_of(it), made.flow.layer.fluid, made.advance, PlainColumn(made.flow).advance)


def ground(soil: Table | None = None, **more: Any) -> Scene:
    """Soil at rest in a tank, of the size of the column of water."""
    own = {"density": 1590.0, "porosity": 0.4, "stiffness": 2e6, "permeability": 0.01, "stress": "geostatic",
           "sides": "slip", "body": [level_ground(1.0, 2.0)]} | (soil or {})  # fmt: skip
    return tank_scene(1.0, 2.5, SPACING, lid=False, **{"soil": own} | more)


def settled(it: Scene) -> tuple[Simulation, int]:
    """The simulation of a scene with soil, on its way, and how many particles it has."""
    made = Simulation(it)
    made.advance(SETTLING)
    if it.soil is not None and it.soil.suction is not None:
        return made, made.flow.ground.soil.soil
    if it.dry:
        return made, made.flow.soil.soil
    return made, made.flow.water.layer.fluid + made.flow.water.skeleton.count


def soil_beside_water() -> BuiltScene:
    """The scene of soil alone beside that of water alone, with equal numbers of particles."""
    it = ground()
    made, count = settled(it)
    return BuiltScene(made, parts_of(it), count, made.advance, started(scene()).advance)


def in_soil(other: Table, **more: Any) -> Callable[[], BuiltScene]:
    """Soil with more in its pores, beside soil with an ``other``."""

    def make() -> BuiltScene:
        """The scene with ``more`` and that with ``other``, both after their warm-up steps."""
        it = ground(**more)
        made, count = settled(it)
        return BuiltScene(made, parts_of(it), count, made.advance, settled(ground(**other))[0].advance)

    return make


SETTLING, FEWER = 40, 10
"""Steps before timing, and at a time: those of soil take ten times those of water."""
WET: Table = {"water": {"pressure": "hydrostatic", "column": [COLUMN]}}
ABOVE: Table = {"pressure": "hydrostatic", "column": [{"bottom": 1.0, "width": 1.0, "height": 1.0}]}
FULL: Table = {"soil": {"saturated": True}, "tank": {"width": 1.0, "height": 2.0}}
HEAD: Table = {"name": "lid", "side": "lid", "head": 2.5}
MOIST: Table = {"alpha": 5.0, "n": 3.0, "water_table": 1.0}
SAND: Table = {"friction_angle": "20 degree", "shear_strain": 0.1, "band_width": 4.0 * SPACING}
BEADS: Table = {"friction_angle": "33 degree", "inertial_number": 0.3, "grain_diameter": "1 mm"}
PLATES: Table = {"distance": "0.2 m", "friction_angle": "12 degree"}
UNSATURATED: Table = {"water": ABOVE, "air": {"density": 20.0, "pressure": 5e4}}
DISC: Table = {"density": 500.0, "law": "liquid", "disc": [{"x": 0.5, "y": 1.0, "radius": 0.2}]}
ENERGY_BUDGET: Table = {"snapshot_interval": 1.0, "series_interval": 1.0, "energy": True}
SHIFTED: Table = {"gradient": "corrected", "shifting": 2.0}

KINDS = SceneKinds([
    SceneKind(PLAIN, "particle", SMALLEST, alone,
         because="13 to 20 % from process to process on this machine, 1 to 5 % on that of 2026-11-22: stops at walls "
                 "are counted, densities and pressures kept for others, and Python stands between kernels, some 4 % "
                 "then; where the rest goes was not looked into"),
    SceneKind(SMOOTHED, "particle", SMALLEST, lambda: alone(numerics={"xsph": 0.5}),
         because="4 to 9 % from process to process: as of water only"),
    added("water only, twice", "a run beside its like: what the method of measuring makes of nothing"),
    added("energy book", "sums of pressure apart from the rest 8 %, the book's own lines 5 %, taken up 3 %",
          output=ENERGY_BUDGET),
    added("walls that hold", tank={"walls": "stick"}),
    added("walls of images", "walls have densities of their own, by a sum of their own",
          tank={"wall_particles": "images"}),
    added("XSPH", "a kernel's value, a division and two sums a pair: its smallest kernel has them too",
          numerics={"xsph": 0.5}),
    added("corrected gradients", "a pass over pairs before the one that reads what it finds",
          numerics={"gradient": "corrected"}),
    added("corrected gradients and shifting", "three passes: moments, with two sums of their own; rates; the surface",
          numerics=SHIFTED),
    added("second fluid", "number and viscosity of the partner, a comparison, a division a pair", inclusion=DISC),
    added("second fluid with surface tension", "five passes over what is near the interface",
          inclusion=DISC | {"surface_tension": 1.0}),
    SceneKind(SOIL, "particle", PLAIN, soil_beside_water, FEWER,
         "two passes over pairs, gradients of velocity and divergence of stress, and stresses of walls"),
    SceneKind(SOAKED, "particle", SOIL, in_soil({}, **WET), FEWER, "twice the particles, in three kinds of pairs"),
    SceneKind("air in soil", "particle", SOAKED, in_soil(WET, **UNSATURATED), FEWER,
         "a second fluid, and powers of its density"),
    SceneKind("soil and water, held", "particle", SOAKED, in_soil(WET, **WET, soil={"held": True}), FEWER,
         "no stress of soil"),
    SceneKind("face", "particle", SOAKED, in_soil(FULL, **FULL, face=[HEAD]), FEWER,
         "soil and water of a closed tank beside it"),
    SceneKind("sheet pile", "particle", SOAKED, in_soil(WET, **WET, pile={"x": 0.5, "tip": 1.0}), FEWER,
         "pairs across it are left out as lists are made"),
    SceneKind("suction", "particle", SOIL, in_soil({}, soil={"suction": MOIST}, water={"sound_speed": 40.0}),
         FEWER,
         "stages of the flow of water between steps of the soil"),
    SceneKind("friction that grows with the rate", "particle", SOIL, in_soil({}, soil={"rate": BEADS}), FEWER,
         "a root where soil yields"),
    SceneKind("strength that softens", "particle", SOIL, in_soil({}, soil={"softening": SAND}), FEWER,
         "a pass over pairs for each average, here one"),
    SceneKind("side walls", "particle", SOIL, in_soil({}, soil={"side_walls": PLATES}), FEWER,
         "a root and a stress for each particle"),
])  # fmt: skip
"""What `continuum-sph study parts` measures."""

"""Kinds of continuum scenes for `study parts`: a column of water on its way down, and what each choice adds to it."""

from __future__ import annotations

from typing import Any

from continuum_sph.bench_plain import PlainColumn
from continuum_sph.scene.model import Simulation
from continuum_sph.scene.sections import Scene
from porescale.workbench.parts import SMALLEST, Built, Kind, Kinds
from porescale.workbench.sections import validate

SPACING = 1.0 / 32.0  # m: 2048 particles of water
WARM = 200
"""Steps before timing: water in motion."""
Table = dict[str, Any]

NUMERICS: Table = {"spacing": SPACING}
COLUMN: Table = {"width": 1.0, "height": 2.0}
PLAIN = "water only"


def scene(numerics: Table | None = None, tank: Table | None = None, **more: Any) -> Scene:
    """A column in a closed tank."""
    table: Table = {
        "tank": {"width": 4.0, "height": 3.0} | (tank or {}), "water": {"column": [COLUMN]},
        "numerics": NUMERICS | (numerics or {}), "time": {"end": 1.0},
        "output": {"snapshot_interval": 1.0, "series_interval": 1.0},
    }  # fmt: skip
    return validate(Scene, table | more)


def parts_of(it: Scene) -> list[str]:
    """What the scene builds beyond particles, walls and their list."""
    numerics = it.numerics
    chosen = {
        "water": bool(it.water.column), "second fluid": it.inclusion is not None,
        "surface tension": it.inclusion is not None and it.inclusion.surface_tension > 0.0,
        "corrected gradients": numerics.gradient == "corrected", "shifting": numerics.shifting > 0.0,
        "energy book": it.output.energy, "XSPH": numerics.xsph > 0.0, "walls that hold": it.tank.walls != "slip",
        "walls of images": it.tank.wall_particles == "images", "soil": it.soil is not None,
    }  # fmt: skip
    return [name for name, there in chosen.items() if there]


def started(it: Scene) -> Simulation:
    """The simulation of a scene, on its way."""
    made = Simulation(it)
    made.advance(WARM)
    return made


def added(name: str, because: str = "", **more: Any) -> Kind:
    """A scene with something more, beside water alone."""

    def make() -> Built:
        """Both scenes, started."""
        it = scene(**more)
        own, other = started(it), started(scene())
        return Built(own, parts_of(it), own.flow.layer.fluid, own.advance, other.advance)

    return Kind(name, "particle", PLAIN, make, because=because)


def alone() -> Built:
    """Water alone, beside the smallest kernels for it."""
    it = scene()
    made = started(it)
    return Built(made, parts_of(it), made.flow.layer.fluid, made.advance, PlainColumn(made.flow).advance)


DISC: Table = {"density": 500.0, "law": "liquid", "disc": [{"x": 0.5, "y": 1.0, "radius": 0.2}]}
BOOK: Table = {"snapshot_interval": 1.0, "series_interval": 1.0, "energy": True}
SHIFTED: Table = {"gradient": "corrected", "shifting": 2.0}

KINDS = Kinds([
    Kind(PLAIN, "particle", SMALLEST, alone,
         because="kernel by kernel: pressure and friction of a pair summed apart 5 %; what calls hand over 3 %; fluids "
                 "looked up in a table, density and pressure in a kernel of their own 5 %; walls that might move 1 %; "
                 "what Python does between kernels 3 %"),
    added("water only, twice", "a run beside its like: what the method of measuring makes of nothing"),
    added("energy book", output=BOOK),
    added("walls that hold", tank={"walls": "stick"}),
    added("walls of images", "all choices are made in one pass over pairs, the plain one is a kernel of its own",
          tank={"wall_particles": "images"}),
    added("XSPH", numerics={"xsph": 0.5}),
    added("corrected gradients", numerics={"gradient": "corrected"}),
    added("corrected gradients and shifting", numerics=SHIFTED),
    added("second fluid", inclusion=DISC),
    added("second fluid with surface tension", inclusion=DISC | {"surface_tension": 1.0}),
])  # fmt: skip
"""What `continuum-sph study parts` measures."""

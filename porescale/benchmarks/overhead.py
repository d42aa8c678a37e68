"""Kinds of scenes of fluid and grains for `study parts`: each built from a scene, as a user's scene is."""

from collections.abc import Callable
from copy import deepcopy
from typing import Any

import numpy as np

from porescale.benchmarks.minimal_dem import PlainDiscs
from porescale.benchmarks.minimal_lbm import PlainWater
from porescale.builders.build import build
from porescale.builders.kinds import SECTIONS
from porescale.builders.scene import Scene
from porescale.builders.simulation import Simulation
from porescale.common.evidence.overhead import SMALLEST, BuiltScene, SceneKind, SceneKinds
from porescale.common.schema.sections import validate

CELLS = 256
GRAINS = (0.09, 0.045)
"""Width and height of the pile, m: some 1500 grains."""
DIAMETER = 1.5e-3
WARM = 2000
"""Steps before timing, an even number: kernels are compiled, and grains that may sleep sleep."""
Table = dict[str, Any]

FLUID: Table = {"viscosity": 1e-4, "spacing": 1e-3, "relaxation_time": 0.8}
CONTACT: Table = {"stiffness": 5e5, "tangential_stiffness": 1.25e5, "restitution": 0.97, "friction": 0.5}


def scene(width: float, height: float, **sections: Any) -> Scene:
    """A closed box with these sections."""
    table: Table = {
        "domain": {"width": width, "height": height}, "time": {"end": 1.0},
        "output": {"snapshot_interval": 1.0, "series_interval": 1.0},
    }  # fmt: skip
    return validate(Scene, table | sections)


def water(**more: Any) -> Scene:
    """A scene of water alone, at rest, with ``more`` sections."""
    return scene(CELLS * 1e-3, CELLS * 1e-3, fluid=FLUID | {"velocity": (0.0, 0.0)}, **more)


def dry(contact: Table = CONTACT, **more: Any) -> Scene:
    """A settled pile from wall to wall."""
    packing = {"left": 0.0, "width": GRAINS[0], "height": GRAINS[1], "diameter": DIAMETER}
    grains = {"density": 2500.0, "packing": packing}
    return scene(GRAINS[0], 3.0 * GRAINS[1], **({"grains": grains, "contact": contact} | more))


def fixed(**more: Any) -> Scene:
    """Discs that stand in water that is driven through them."""
    pitch = 16e-3
    discs = [
        {"x": (i + 0.5) * pitch, "y": (k + 0.5) * pitch, "diameter": 0.6 * pitch}
        for i in range(CELLS // 16) for k in range(CELLS // 16)
    ]  # fmt: skip
    return scene(1.0, 1.0, domain=OPEN, fluid=FLUID | {"body_force": (1e-3, 0.0)}, disc=discs, **more)


def parts_of(it: Scene) -> list[str]:
    """Sections that the scene has, in the order of the report."""
    return [name for name in SECTIONS if getattr(it, name)]


def built(it: Scene, item: str, other: Callable[[Simulation], Callable[[int], object]]) -> BuiltScene:
    """The simulation of a scene, one step done, beside what ``other`` makes of it."""
    made = build(it)
    made.advance(WARM)
    fluid, grains = made.fluid, made.grains
    count = fluid.nx * fluid.ny if item == "cell" and fluid else grains.discs.count if grains else 0
    return BuiltScene(made, parts_of(it), count, made.advance, other(made))


def lattice(made: Simulation) -> Callable[[int], object]:
    """The smallest lattice with the same water."""
    assert made.fluid
    assert made.fluid.step % 2 == 0
    return PlainWater(made.fluid.populations, made.fluid.relaxation_time).advance


def discs(made: Simulation) -> Callable[[int], object]:
    """The smallest kernel with the same discs."""
    assert made.grains
    assert made.weight is not None
    return PlainDiscs(made.grains, np.asarray(made.weight, float), made.step_seconds).advance


def without(it: Scene) -> Callable[[Simulation], Callable[[int], object]]:
    """A scene that lacks a part."""

    def other(made: Simulation) -> Callable[[int], object]:
        """The ``advance`` of the other scene, after its warm-up steps."""
        twin = build(it)
        twin.advance(WARM)
        return twin.advance

    return other


def nothing_moves(made: Simulation) -> Callable[[int], object]:
    """The same cells with the fluid step alone: no contacts, no motion of discs."""
    twin = deepcopy(made)
    assert twin.coupled
    assert twin.fluid
    fluid, wet, units = twin.fluid, twin.coupled.saturated, twin.coupled.scales
    held = twin.coupled.grains.discs
    motion = held.position / units.spacing, np.zeros_like(held.velocity), np.zeros_like(held.spin)

    def steps(count: int) -> None:
        """So many steps of the fluid and its solid cells."""
        for _ in range(count):
            wet.advance(fluid, *motion)

    return steps


ROLLING: Table = {"rolling_friction": 0.1, "rolling_stiffness": 1e5}
ENERGY_BUDGET: Table = {"snapshot_interval": 1.0, "series_interval": 1.0, "energy": True}
WIDER: Table = {"width": 1.5 * GRAINS[0], "height": 3.0 * GRAINS[1]}
LATER = 1e9  # s
STEEL: Table = {"name": "steel", "stiffness": 8e5}
OPEN: Table = {"width": CELLS * 1e-3, "height": CELLS * 1e-3, "left": "periodic", "right": "periodic",
               "bottom": "periodic", "top": "periodic"}  # fmt: skip
PENTAGON: Table = {"sides": 5, "diameter": 3e-3, "thickness": 1e-4, "density": 2500.0, "at": [(0.5 * GRAINS[0], 0.12)]}


def added(name: str, item: str, of: str, base: Callable[..., Scene], **more: Any) -> SceneKind:
    """A scene with something more than ``base`` has."""
    return SceneKind(name, item, of, lambda: built(base(**more), item, without(base())))


KINDS = SceneKinds([
    SceneKind("water only", "cell", SMALLEST, lambda: built(water(), "cell", lattice),
         because="0.88 to 0.96 from run to run"),
    SceneKind("dry grains", "grain", SMALLEST, lambda: built(dry(), "grain", discs)),
    SceneKind("dry grains without friction or rotation", "grain", SMALLEST,
         lambda: built(dry({"stiffness": 5e5, "restitution": 0.97, "friction": 0.0}), "grain", discs),
         because="0.94 to 1.02 from run to run; the smallest asks every grain at each step whether it touches a "
                 "wall, here those are asked that may before the pair list is due"),
    SceneKind("fixed grains in water", "cell", SMALLEST, lambda: built(fixed(), "cell", nothing_moves), steps=20,
         because="1.02 to 1.06 from run to run: contact steps of discs that nothing moves are left out"),
    added("rolling friction", "grain", "dry grains", dry, contact=CONTACT | ROLLING),
    added("energy book", "grain", "dry grains", dry, output=ENERGY_BUDGET),
    added("gate that stands", "grain", "dry grains", dry, domain=WIDER, gate={"x": GRAINS[0], "opens_at": LATER}),
    added("walls of a second material", "grain", "dry grains", dry, contact=CONTACT | {"wall_material": "steel"},
          material=[STEEL]),
    added("a polygon that falls", "grain", "dry grains", dry, polygon=[PENTAGON]),
    added("sleep", "grain", "dry grains", dry, sleep={"share": 0.05}),
    added("no walls", "cell", "water only", water, domain=OPEN),
    added("gate in water", "cell", "water only", water, gate={"x": 0.5e-3 * CELLS, "opens_at": LATER}),
])  # fmt: skip
"""What `porescale study parts` measures."""

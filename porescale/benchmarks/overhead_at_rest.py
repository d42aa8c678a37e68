"""Kinds of scenes for `study parts` in which little happens: a pile that sleeps under water, and water at rest.

Cells of water at rest are not left out.  At rest shifted populations are zero and a step leaves them so, but a moving
body sends sound through all the water within some hundred steps, and what it leaves fades with the viscosity of the
longest waves: in a collapse hardly a cell goes slower than 1e-6 cells a step from then on (tests/validation holds
it), though a look at all cells costs but a share of a step.
"""

from collections.abc import Callable

import numpy as np

from porescale.benchmarks.minimal_lbm import largest_of_rows
from porescale.benchmarks.minimal_psm import PlainWet
from porescale.benchmarks.overhead import Table, built, nothing_moves, parts_of, scene, water, without
from porescale.builders.build import build
from porescale.builders.scene import Scene
from porescale.builders.simulation import Simulation
from porescale.common.evidence.overhead import SMALLEST, BuiltScene, SceneKind, SceneKinds

PILE = (0.03, 0.02)
"""Width and height, m: some 300 grains, 10 cells each."""
DIAMETER = 1.5e-3
WARM = 3000
"""Steps before timing: grains that may sleep sleep."""
FLUID: Table = {"viscosity": 1e-4, "spacing": 1.5e-4, "relaxation_time": 0.8}
CONTACT: Table = {"stiffness": 5e5, "tangential_stiffness": 1.25e5, "restitution": 0.5, "friction": 0.5}


def wet(**more: object) -> Scene:
    """A settled pile from wall to wall of a tank of water."""
    packing = {"left": 0.0, "width": PILE[0], "height": PILE[1], "diameter": DIAMETER}
    grains = {"density": 2500.0, "packing": packing, "hydraulic_radius_ratio": 0.8}
    return scene(PILE[0], 1.5 * PILE[1], fluid=FLUID, grains=grains, contact=CONTACT, **more)


def sleeping() -> BuiltScene:
    """The pile whose grains sleep, beside that whose grains do not."""
    it = wet(sleep={"share": 0.05})
    made = build(it)
    made.advance(WARM)
    assert made.grains
    return BuiltScene(made, parts_of(it), made.grains.discs.count, made.advance, without(wet())(made))


def looking() -> BuiltScene:
    """A look at every cell of a tank, beside a step of it."""
    it = water()
    made = build(it)
    made.advance(2)
    assert made.fluid
    populations, row, largest = made.fluid.padded, np.zeros(made.fluid.nx), np.zeros(made.fluid.ny)

    def look(steps: int) -> None:
        """Search the largest population of every row ``steps`` times."""
        for _ in range(steps):
            largest_of_rows(populations, row, largest)

    return BuiltScene(made, parts_of(it), made.fluid.nx * made.fluid.ny, look, made.advance)


def smallest(made: Simulation) -> Callable[[int], object]:
    """The smallest kernels with the same discs in the same water."""
    assert made.coupled
    return PlainWet(made.coupled).advance


KINDS = SceneKinds([
    SceneKind("moving grains in water", "cell", SMALLEST, lambda: built(wet(), "cell", smallest), steps=10,
         because="1.13 to 1.18 from run to run: rows with grains are laid out and their loads taken, lists and sums "
                 "over rows, contact steps, Python"),
    SceneKind("grains that may move", "cell", "the same grains, held", lambda: built(wet(), "cell", nothing_moves),
         steps=10),
    SceneKind("sleep under water", "grain", "pile under water", sleeping, steps=10,
         because="all sleep: no contact steps, and cells stay covered as they were until a grain moves; 0.91 to 0.94 "
                 "from run to run"),
    SceneKind("a look for water at rest", "cell", "water only", looking,
         because="a look beside a step: cells at rest are not left out, as it costs more, and in a collapse there are "
                 "none once sound has crossed the tank"),
])  # fmt: skip
"""More of what `porescale study parts` measures."""

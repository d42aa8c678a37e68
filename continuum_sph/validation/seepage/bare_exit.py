"""Steady flow under a sheet pile out of ground on which no water stands.  SI."""

import functools

from continuum_sph.builders.parts.sheet_pile import NAME
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.seepage.sheet_pile import SheetPile
from continuum_sph.validation.tanks import level_ground, tank_scene
from porescale.common.evidence.convergence import Ladders
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS, LADDERS = Validations(), Ladders()

HEAD = 0.5  # m, of the water on the left over the ground, 1 m deep, on both sides of a sheet
PERMEABILITY = 1e-3  # m/s
SOUND = 250.0  # m/s
STEPS = 150
"""A row of T: 0.2 s at any spacing, 3.2 T²/D with D = k c²/(n g), in which pressures spread; exp(-3.2 π²/4) = 0.04 % of
the start is left."""
BETWEEN = 0.2  # spacings, by which heads of a free surface's rows differ from those of water at rest


def scene(share: float, rows: int) -> Scene:
    """Held ground 1 m deep, ``rows`` of particles, and 1 m to both sides of a sheet to the depth ``share`` m; water on
    its left alone."""
    spacing = 1.0 / rows
    width = (2 * rows + 1) * spacing
    ground = {"held": True, "saturated": True, "permeability": PERMEABILITY, "body": [level_ground(width, 1.0)]}
    return tank_scene(
        width, 1.0 + HEAD + 4.0 * spacing, spacing, lid=False, soil=ground,
        water={"sound_speed": SOUND, "column": [{"width": 1.0, "height": 1.0 + HEAD}]},
        pile={"x": 0.5 * width, "tip": 1.0 - share},
    )  # fmt: skip


@functools.cache
def exit_over_exact(rows: int, share: float = 0.5) -> float:
    """Exit gradient of series.csv over the exact one, when the flow is steady."""
    model, exact = Simulation(scene(share, rows)), SheetPile(share, rows)
    model.advance(STEPS * rows)
    return float(model.series()[NAME] / (exact.exit_gradient * HEAD))


@VALIDATIONS.row(
    "continuum.exit_through_bare_ground",
    source="exact: conformal mapping of ground that ends 1 T beside the sheet (the way of Harr 1962); s/T 0.5, 0.75",
    because="heads of both free surfaces are known to 0.2 spacings, of 10 that drive the flow; 2 % as of ground "
    "between faces",
    tolerance=2.0 * BETWEEN / (HEAD * 20) + 0.02,
    slow=True,
)
def bare_row() -> Measured:
    """Exit gradient over its exact value, water on one side of the pile alone; 20 particles over T."""
    return Measured.absolute([1.0, 1.0], [exit_over_exact(20), exit_over_exact(20, 0.75)])


@LADDERS.ladder(
    "seepage.exit_gradient_in_bare_ground",
    title="Relative error of the exit gradient through ground on which no water stands",
    along="particles over the depth",
    levels=(10, 20, 40),
    expected=1.0,
    because="free surfaces are known to a share of a spacing: first order",
)
def bare_ladder(rows: float) -> float:
    """|exit gradient over that of the conformal map, less 1|, of a sheet to half of the depth."""
    return abs(exit_over_exact(int(rows)) - 1.0)

"""Water over held ground: stirred, it comes to rest, keeps its volume and lies level; let go, it runs.  SI."""

import functools
import math
from typing import Any

import numpy as np

from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.tanks import level_ground, tank_scene
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.schema.sections import validate

VALIDATIONS = Validations()

WIDTH, BED, STANDS = 1.0, 0.2, 0.25  # m: of the tank; surface of the ground; depth of the water once it lies level
SECONDS = 10.0
PERIOD = 2.0 * WIDTH / math.sqrt(GRAVITY * STANDS)  # s, in which a long wave goes to and fro
HELD = {"stiffness": 2e6, "friction_angle": "30 degree", "held": True, "permeability": 1e-3}


def stirred(spacing: float, seconds: float = SECONDS) -> tuple[float, float]:
    """(by how much the water is too deep, twice its mean height over the ground less ``STANDS``, in spacings;
    difference of level between two quarters of the tank, mean of the last `PERIOD`, as it goes on to slosh, m).

    A column twice as deep as it will stand falls from the left half of the tank and sloshes for so many ``seconds``
    over ground that is held and full of water.
    """
    column = [
        {"width": WIDTH, "height": BED},
        {"width": 0.5 * WIDTH, "height": 2.0 * STANDS, "bottom": BED},
    ]
    scene = tank_scene(
        WIDTH, 1.4, spacing, seconds, lid=False, water={"column": column},
        soil=HELD | {"body": [level_ground(WIDTH, BED)]}, level=[{"x": 0.25 * WIDTH}, {"x": 0.75 * WIDTH}],
    )  # fmt: skip
    model, askew = Simulation(scene), []
    while model.time < seconds:
        model.advance(50)
        if model.time > seconds - PERIOD:
            row = next(row for row in model.tables().values() if "level 0 (m)" in row)
            askew.append(row["level 0 (m)"] - row["level 1 (m)"])
    layer = model.state()["water"]["flow"]["layer"]
    height = layer["x"][: len(layer["density"]), 1]
    depth = 2.0 * (float(height[height > BED].mean()) - BED)
    return (depth - STANDS) / spacing, float(np.mean(askew))


@VALIDATIONS.row(
    "continuum.stirred_water_over_ground",
    source="exact: water keeps its volume: a column 0.5 m deep over half of a tank lies 0.25 m deep",
    because="half a spacing, in spacings, at 5 and 10 rows of water: it covers the ground with whole particles, so its"
    " lower edge is known to half of one",
    tolerance=0.5,
    slow=True,
)
def stirred_water() -> Measured:
    """Depth of water over ground 10 s after it was let go, less that which it has, in spacings, 5 and 10 rows."""
    return Measured.absolute([0.0, 0.0], [stirred(spacing)[0] for spacing in (0.05, 0.025)])


SIDE, VISCOSITY = 0.4, 3.0  # m, of a square column of water; Pa s: 0.003 m²/s
GROUND_ROWS = 6  # under it, more than kernels reach
TIMES = (0.2, 0.8)  # s, between which the front is followed: by then it is four columns away
AHEAD = 0.9  # share of the water over the bed that its front has behind it
FRONT_ROWS = (12, 24, 48)


@functools.cache
def front_speed(rows: int, bed: str = "ground") -> float:
    """Speed (m/s) of the front of a viscous column of water, ``rows`` high, that is let go over a ``bed``: "ground"
    that is held and full of water, or a floor that it is to "stick" to or to "slip" on.

    ν = 0.003 m²/s: the layer that a bed holds is √(ν t) thick, 1.3 of 12 rows after the first 0.6 s.
    """
    spacing, width = SIDE / rows, 6.0 * SIDE
    floor = GROUND_ROWS * spacing if bed == "ground" else 0.0
    column = {"width": SIDE, "height": SIDE, "bottom": floor}
    table: dict[str, Any] = {
        "tank": {"width": width, "height": floor + 1.5 * SIDE, "lid": False},
        "numerics": {"spacing": spacing, "tension": "kept"},  # over either bed
        "time": {"end": TIMES[1]},
        "output": {"snapshot_interval": TIMES[1], "series_interval": TIMES[1]},
        "water": {"viscosity": VISCOSITY, "column": [column]},
    }
    if bed == "ground":
        table["soil"] = HELD | {"body": [level_ground(width, floor)]}
        table["water"]["column"] = [{"width": width, "height": floor}, column]
    else:
        table["tank"]["walls"] = "floor and lid stick" if bed == "stick" else "slip"
    model, places = Simulation(validate(Scene, table)), []
    for time in TIMES:
        while model.time < time:
            model.advance(5)
        state = model.state()
        layer = state["water"]["flow"]["layer"] if bed == "ground" else state["flow"]["layer"]
        x = layer["x"][: len(layer["density"])]
        places.append((model.time, float(np.quantile(x[x[:, 1] > floor, 0], AHEAD))))
    (begin, first), (end, last) = places
    return (last - first) / (end - begin)


@VALIDATIONS.row(
    "continuum.front_over_ground",
    source="the same flow over a floor that holds the water: no slip",
    because="a tenth was asked, from 12 to 48 rows; ground, whose grains are smeared over two spacings, holds water "
    "somewhere within half of one of its surface: that much of a layer of 1.3 to 5",
    tolerance=0.1,
    slow=True,
)
def front_row() -> Measured:
    """Speed of the front of a viscous column let go over held ground, over that on a floor, 12, 24, 48 rows."""
    found = [front_speed(rows) / front_speed(rows, "stick") for rows in FRONT_ROWS]
    return Measured.absolute([1.0] * len(found), found)

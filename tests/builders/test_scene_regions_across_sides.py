"""What is measured of bodies that have crossed a periodic side is that of where they are seen."""

from typing import Any

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.builders.parts.frame_measures import solid_in
from porescale.dem.measures.region import Region
from tests.reference.scenes import dry

WIDTH, HEIGHT, SIDE = 0.012, 0.008, 0.002
SQUARE: dict[str, Any] = {
    "corners": [[-0.001, -0.001], [0.001, -0.001], [0.001, 0.001], [-0.001, 0.001]], "thickness": 1e-4,
    "at": [[0.004, 0.004]], "velocity": [0.5, 0.0],
}  # fmt: skip
BOX: dict[str, Any] = {
    "domain__width": WIDTH, "domain__height": HEIGHT, "domain__left": "periodic", "domain__right": "periodic",
    "gravity": [0.0, 0.0],
}  # fmt: skip


@pytest.mark.parametrize("gone", [0.0, 0.008, 0.012, 0.0321])
def test_tiles_of_a_periodic_box_hold_all_of_a_polygon_wherever_it_has_gone(gone: float) -> None:
    simulation = build(dry(grains={"density": 2500}, polygon=[SQUARE], **BOX))
    grains = simulation.grains
    assert grains
    grains.discs.position[:, 0] += gone
    tiles = [Region((x, 0.0), (x + 0.5 * WIDTH, HEIGHT)) for x in (0.0, 0.5 * WIDTH)]
    left, right = (solid_in(grains, simulation.frames, it) for it in tiles)
    assert left + right == pytest.approx(SIDE**2, rel=1e-9)  # places are good to 1e-16 of a period or so
    # Its left edge is at 3 mm plus what it has gone, less whole periods; half a box is 6 mm.
    edge = (0.003 + gone) % WIDTH
    within = np.clip(min(edge + SIDE, 0.006) - edge, 0.0, SIDE) + max(edge + SIDE - WIDTH, 0.0)
    assert left == pytest.approx(SIDE * within, abs=1e-9 * SIDE**2)
    assert solid_in(grains, simulation.frames, Region((0.0, 0.0), (WIDTH, 0.004))) == pytest.approx(SIDE**2 / 2)

"""What is measured of bodies that have crossed a periodic side is that of where they are seen."""

from typing import Any

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.builders.parts.frame_measures import solid_in
from porescale.dem.measures.region import Region
from tests.reference.scenes import dry, grain

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


def test_a_grain_that_has_gone_round_a_periodic_box_presses_on_its_floor_where_it_is_seen() -> None:
    scene = {"grains": {"density": 2500, "grain": [grain(0.004, 0.0004999)]}, "output__forces": True}
    simulation = build(dry(**{**BOX, **scene, "gravity": [0.0, -9.81]}))
    simulation.advance(1)
    grains = simulation.grains
    assert grains

    def moment() -> float:
        """Of the grain on the floor, about the middle of it."""
        return simulation.tables()["forces"]["bottom wall moment (N m/m)"]

    force, first = simulation.tables()["forces"]["bottom wall force y (N/m)"], moment()
    assert first == pytest.approx((0.004 - 0.5 * WIDTH) * force, rel=1e-9) != 0.0
    grains.discs.position[0, 0] += 3.0 * WIDTH
    assert moment() == pytest.approx(first, rel=1e-9)  # its place is good to eps times three periods
    grains.discs.position[0, 0] += 1e-5
    assert moment() != pytest.approx(first, rel=1e-3)  # the check that must fail: a hundredth of a diameter is seen


@pytest.mark.filterwarnings("ignore:.*makes no bond")  # as the last is to
@pytest.mark.parametrize(("gone", "bonds"), [(0.0, 1.0), (-WIDTH, 1.0), (2.0 * WIDTH, 1.0), (0.5 * WIDTH, 0.0)])
def test_bodies_that_have_gone_round_a_periodic_box_are_bonded_where_they_are_seen(gone: float, bonds: float) -> None:
    pair = [grain(0.004, 0.004), grain(0.004999, 0.004)]
    scene: dict[str, Any] = {**BOX, "grains": {"density": 2500, "overlap": 0.01, "grain": pair}, "time__end": 1.0}
    seconds = build(dry(**scene)).step_seconds
    simulation = build(dry(**scene, bonds=[{"at": seconds, "within": [0.003, 0.0, 0.006, HEIGHT]}]))
    assert simulation.grains
    simulation.grains.discs.position[:, 0] += gone
    simulation.grains.refresh(anew=True)
    simulation.advance(2)
    assert simulation.series()["bonds ()"] == bonds

"""A periodic cell that is strained: what a scene says of it holds, is in series.csv and snapshots, or is refused."""

import math
import time
from typing import Any

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.output.grain_pictures import branches
from tests.reference.scenes import grain
from tests.reference.scenes_of_grains import assert_same_bits, lines, loose, resumed

SIDES = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")
SIX = 0.006
GRID = [grain(0.0005 + 0.001 * i, 0.0005 + 0.001 * j) for i in range(6) for j in range(6)]
"""A square lattice of grains that just touch, in a square cell."""


def square(cell: dict[str, Any] | None, **changes: Any) -> Scene:
    """The lattice in its cell, without gravity and friction."""
    return loose(*GRID, **{"domain": {"width": SIX, "height": SIX, **SIDES}, "gravity": [0.0, 0.0], "cell": cell,
                           "contact__friction": 0.0, **changes})  # fmt: skip


def test_a_cell_that_stands_leaves_the_grains_without_steering():
    simulation = build(square(None))
    assert not simulation.grains.steered
    assert "strain xx ()" not in simulation.series()


def test_the_stress_of_a_squeezed_lattice_is_that_of_its_springs():
    simulation = build(square({"rate_yy": -0.1}))
    simulation.advance(round(0.02 / simulation.step_seconds))
    row = simulation.series()
    # Each step multiplies by 1 + g dt: its logarithm is off by g dt/2 = 1e-6 of itself.
    assert row["strain yy ()"] == pytest.approx(-0.1 * simulation.time, rel=1e-5)
    assert row["cell height (m)"] == pytest.approx(SIX * math.exp(-0.1 * simulation.time), rel=1e-7)
    assert row["cell width (m)"] == SIX
    # Affine by symmetry: every upright contact is h = d (1 - H/H0) deep, and its force, k h and the dashpot's c v, is
    # spread over one diameter.  The stress is that of the step before the last, one of 930 in which it grew: 1.1e-3.
    overlap = 0.001 * (1 - row["cell height (m)"] / SIX)
    damping = simulation.grains.laws[0].damping * 0.1 * 0.001
    assert row["stress yy (Pa)"] == pytest.approx((2e5 * overlap + damping) / 0.001, rel=2e-3)
    assert row["stress xx (Pa)"] == pytest.approx(0.0, abs=1e-3 * row["stress yy (Pa)"])
    assert row["solid fraction ()"] == pytest.approx(math.pi / 4 * SIX / row["cell height (m)"], rel=1e-12)


@pytest.mark.slow
def test_an_energy_budget_costs_pairs_that_do_not_touch_in_a_cell_no_more_than_it_does_elsewhere():
    pitch, side = 0.00102, 30  # all neighbours are listed, and none touches
    loose_grid = [grain(pitch * (i + 0.5), pitch * (j + 0.5)) for i in range(side) for j in range(side)]
    width = pitch * side

    def seconds(energy: bool) -> float:
        """Of the processor, for 100 steps, the least of eight times."""
        simulation = build(loose(*loose_grid, domain={"width": width, "height": width, **SIDES}, gravity=[0.0, 0.0],
                                 cell={"rate_yy": -1e-6}, contact__friction=0.5, output__energy=energy))  # fmt: skip
        took = []
        for _ in range(9):  # the first compiles
            began = time.process_time()
            simulation.advance(100)
            took.append(time.process_time() - began)
        return min(took[1:])

    # 1.1 times as much; 7 times where each such pair asked for its springs within the function that lets them go.
    assert seconds(True) < 3.0 * seconds(False)


def test_a_cell_goes_to_the_stress_that_it_is_given():
    simulation = build(square({"stress_xx": 500.0, "stress_yy": 1000.0, "fastest": 1.0}))
    simulation.advance(round(0.05 / simulation.step_seconds))
    row = simulation.series()
    # Steered to its stress within tens of steps; waves lose a tenth in half a millisecond: 0.9^100 = 3e-5.
    assert row["stress xx (Pa)"] == pytest.approx(500.0, rel=1e-4)
    assert row["stress yy (Pa)"] == pytest.approx(1000.0, rel=1e-4)
    assert row["strain yy ()"] < row["strain xx ()"] < 0


def test_snapshots_show_a_sheared_cell_as_it_is():
    simulation = build(square({"rate_xy": 5.0}))
    simulation.advance(round(0.02 / simulation.step_seconds))
    assert simulation.series()["strain xy ()"] == pytest.approx(5.0 * simulation.time, rel=1e-9)
    cloud = simulation.snapshot().clouds["grains"]
    x, y = cloud.position.T
    assert ((y >= 0) & (y < SIX) & (x >= 0) & (x < SIX)).all()
    # Every image of a disc is the same disc: its way to where the run has it is whole edges of the cell, to round-off.
    away = simulation.grains.discs.position - cloud.position
    up = away[:, 1] / SIX
    along = (away[:, 0] - np.rint(up) * simulation.series()["cell tilt (m)"]) / SIX
    np.testing.assert_allclose(np.column_stack((up, along)), np.rint(np.column_stack((up, along))), atol=1e-13)
    # All rows of a frictionless sheared lattice go with the shear: v_x = 5 y and little else while they hardly touch.
    np.testing.assert_allclose(cloud.data["velocity"][:, 0], 5.0 * y, atol=0.02 * 5.0 * SIX)


def test_a_strained_run_is_taken_up_again_to_the_bit():
    scene = square({"rate_xy": {"amplitude": 5.0, "frequency": 40}, "stress_yy": [[0, 0], [0.01, 500]], "fastest": 1.0})
    assert_same_bits(*resumed(scene, 300, 300))
    assert validate(Scene, scene_as_dict(scene)) == scene


REGIONS = [{"name": "all", "lower": [0, 0], "upper": [SIX, SIX]}, {"lower": [0.001, 0.0042], "upper": [0.004, 0.0072]}]
ASKED = {"region": REGIONS, "output__contacts": True,
         "coarse_graining": {"spacing": 0.0005, "width": 0.003,
                             "fields": ["solid_fraction", "velocity", "strain_rate", "stress"]}}  # fmt: skip


def test_regions_and_fields_of_a_sheared_cell_show_its_stress_and_strain():
    simulation = build(square({"rate_xy": 5.0, "rate_xx": -3.0, "rate_yy": -3.0}, **ASKED))
    simulation.advance(round(0.003 / simulation.step_seconds))
    row, whole = simulation.tables()["regions"], simulation.series()
    # A region as large as the cell was: the cell is smaller by 1 %, so it holds that much of some images twice, and
    # what is there may be pores or discs.  One three diameters wide has an edge of a tenth of a diameter's half share.
    assert row["all porosity ()"] == pytest.approx(1 - whole["solid fraction ()"], abs=0.01)
    for name, close in (("all", 0.03), ("region 1", 0.1)):
        assert row[f"{name} stress yy (Pa)"] == pytest.approx(whole["stress yy (Pa)"], rel=close)
        # Affine, so that the fit is exact: round-off alone.
        assert row[f"{name} strain rate xx (1/s)"] == pytest.approx(-3.0, rel=1e-6)
        assert row[f"{name} strain rate xy (1/s)"] == pytest.approx(2.5, rel=1e-6)
        assert row[f"{name} rotation (rad/s)"] == pytest.approx(-2.5, rel=1e-6)
    snapshot = simulation.snapshot()
    cells = snapshot.grids["grain_fields"].cells
    # Means over the box as it was: again a strip of 1 %, and kernels sampled twice a diameter.
    assert float(cells["stress_yy"].mean()) == pytest.approx(whole["stress yy (Pa)"], rel=0.05)
    assert float(cells["velocity"][..., 0].mean()) == pytest.approx(5.0 * SIX / 2 - 3.0 * SIX / 2, rel=0.05)
    np.testing.assert_allclose(cells["strain_rate_xy"], 2.5, rtol=1e-5)
    contacts, grains = snapshot.clouds["contacts"], snapshot.clouds["grains"]
    ends = branches(grains, contacts)
    width, height, tilt = simulation.grains.period
    for end, bodies in ((ends[:, 0], contacts.data["first"]), (ends[:, 1], contacts.data["second"])):
        away = end - grains.position[bodies]
        up = np.rint(away[:, 1] / height)
        along = (away[:, 0] - up * tilt) / width
        np.testing.assert_allclose(away[:, 1], up * height, atol=1e-9)
        np.testing.assert_allclose(along, np.rint(along), atol=1e-6)


def test_a_strained_scene_keeps_an_energy_book():
    simulation = build(square({"rate_xy": 5.0, "rate_yy": -3.0}, output__energy=True, contact__step=2e-6))
    simulation.advance(round(0.003 / simulation.step_seconds))
    row = simulation.series()
    # Dashpots take what is left of the work after springs; first order with a hundred steps in a contact of 0.2 ms.
    assert row["work of the cell (J/m)"] > 0.5 * row["turned over (J/m)"] > 0
    assert abs(row["residual (J/m)"]) < 1e-2 * row["turned over (J/m)"]


PERIODIC = {"domain": {"width": SIX, "height": SIX, **SIDES}}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"cell": {"rate_xx": 1.0}}, "cell: only a box that is periodic both ways can be strained"),
        ({**PERIODIC, "cell": {}}, "cell: strains nothing"),
        ({**PERIODIC, "cell": {"rate_xx": 1.0, "stress_xx": 1.0, "fastest": 1.0}}, "cell.stress_xx: and rate_xx"),
        ({**PERIODIC, "cell": {"stress_xx": 1.0}}, "cell.fastest: is missing"),
        ({**PERIODIC, "cell": {"rate_xx": 1.0, "fastest": 1.0}}, "cell.fastest = 1.0 1/s: belongs to a stress"),
        ({**PERIODIC, "cell": {"rate_xx": "1 Pa"}}, "cell.rate_xx = '1 Pa': 'Pa' does not measure"),
        ({**PERIODIC, "cell": {"rate_xx": 1.0}, "output__energy": True}, "gravity = '[0, -9.81]': in a strained"),
        ({**PERIODIC, "cell": {"rate_xx": 1.0}, "disc": [grain(0.004, 0.004)]}, "disc: does not go with a strained"),
    ],
)
def test_cells_that_make_no_sense_are_refused(changes, line):
    assert lines(**changes)[0].startswith(line), lines(**changes)

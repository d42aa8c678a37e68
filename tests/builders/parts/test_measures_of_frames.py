"""What regions and coarse-grained fields say of polygons of any thickness, and of walls of segments."""

import math
from typing import Any

import pytest

from porescale.builders.build import build
from tests.reference.scenes import dry, grain

SIDE, DENSITY = 0.002, 2500.0
DISC = math.pi * 0.0005**2
SQUARE: dict[str, Any] = {
    "corners": [[-0.001, -0.001], [0.001, -0.001], [0.001, 0.001], [-0.001, 0.001]], "at": [[0.004, 0.004]],
}  # fmt: skip
ASKED: dict[str, Any] = {
    "region": [{"name": "box", "lower": [0.0, 0.0], "upper": [0.012, 0.008]}], "gravity": [0.0, 0.0],
    "coarse_graining": {"spacing": 0.0005, "fields": ["density", "solid_fraction"]},
}  # fmt: skip
SINGLE = 1e-6
"""Fields are stored in single precision, and some hundred cells are added."""


def measured(**more: Any) -> tuple[dict[str, float], float, float]:
    """The row of a region, and mass (kg/m) and area (m²) of all that the fields show."""
    moving = {**grain(0.009, 0.004), "velocity": [0.1, 0.0]}
    system = build(dry(grains={"density": DENSITY, "grain": [moving]}, **ASKED, **more))
    row, fields = system.tables()["regions"], system.snapshot().grids["grain_fields"]
    cell = math.prod(fields.spacing)
    mass, area = (float(fields.cells[it].sum(dtype=float)) * cell for it in ("density", "solid_fraction"))
    return row, mass, area


@pytest.mark.parametrize("thickness", [0.0, 1e-4])
def test_a_polygon_counts_by_its_outline_whatever_its_thickness(thickness: float) -> None:
    row, mass, area = measured(polygon=[{**SQUARE, "thickness": thickness}])
    assert area == pytest.approx(DISC + SIDE**2, rel=SINGLE)
    assert mass == pytest.approx(DENSITY * (DISC + SIDE**2), rel=SINGLE)
    # Two masses part at 0.1 m/s: the reduced one times the square of it, over the area of the region.
    reduced = DENSITY * DISC * SIDE**2 / (DISC + SIDE**2)
    assert row["box kinetic stress xx (Pa)"] == pytest.approx(reduced * 0.01 / (0.012 * 0.008), rel=1e-12)


@pytest.mark.parametrize("thickness", [0.0, 1e-4])
@pytest.mark.parametrize("closed", [False, True])
def test_a_box_of_segments_round_the_grains_is_a_wall_and_none_of_them(thickness: float, closed: bool) -> None:
    chain = [[0.011, 0.001], [0.001, 0.001], [0.001, 0.007], [0.011, 0.007], [0.011, 0.001]]
    row, mass, area = measured(container=[{"chain": chain[: 5 if closed else 4], "thickness": thickness}])
    assert area == pytest.approx(DISC, rel=SINGLE)
    assert mass == pytest.approx(DENSITY * DISC, rel=SINGLE)
    assert row["box porosity ()"] == pytest.approx(1 - DISC / (0.012 * 0.008), rel=1e-12)


def test_a_polygon_that_stands_still_is_solid_and_has_no_mass() -> None:
    _, mass, area = measured(polygon=[{**SQUARE, "thickness": 1e-4, "held": True}])
    assert area == pytest.approx(DISC + SIDE**2, rel=SINGLE)
    assert mass == pytest.approx(DENSITY * DISC, rel=SINGLE)

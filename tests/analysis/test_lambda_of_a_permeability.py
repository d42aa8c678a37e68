"""Which lambda gives a bed of discs a wanted permeability, and that `check` says it."""

import math
from dataclasses import replace

import pytest

from porescale.analysis.permeability import Measured, bed_of_spheres, gebart, ratio_for
from porescale.analysis.soil_pores import STEP, exponent
from porescale.builders.report import report
from porescale.builders.scene import Scene
from porescale.common.schema.sections import load
from tests.reference.folders import CASES

MEASURED = {0.8: 6.90e-3, 0.9: 1.41e-3}
"""K/R² by lambda of a bed of solid fraction 0.836, 16 cells a diameter: table of docs/theory/hydraulic_radius.md."""


def rows(*settings: str) -> dict[str, object]:
    scene = load(CASES / "permeameter", Scene, overrides=list(settings))
    return {row.name: row.value for row in report(scene).groups["Grains"]}


@pytest.mark.parametrize("ratio", [0.3, 0.7, 0.8, 0.9, 0.99])
def test_a_lambda_comes_back_from_the_permeability_that_it_gives(ratio):
    relative = 0.25 * ratio**2 * gebart(0.83 * ratio**2, hexagonal=True)
    assert ratio_for(relative, 0.83) == pytest.approx(ratio, abs=2e-6)  # halved to 1e-6


@pytest.mark.parametrize("ratio", MEASURED)
def test_the_lambda_of_a_measured_bed_is_found(ratio):
    # K falls as the power -13 of lambda at 0.8 and -22 at 0.9: a tenth of K and, at 0.9, its third are 0.008 and 0.014.
    assert ratio_for(MEASURED[ratio] / 4, 0.836) == pytest.approx(ratio, abs=0.015)
    # The check that must fail: taken for that of another bed, a fifth looser.
    assert ratio_for(MEASURED[ratio] / 4, 0.836 / 1.2) != pytest.approx(ratio, abs=0.015)


def test_a_permeability_out_of_reach_has_no_lambda():
    assert ratio_for(1e-9, 0.81) is None  # less than touching discs leak by Gebart: 0.81 is not the densest
    assert ratio_for(1e3, 0.81) is None


def test_check_says_which_lambda_gives_what_is_wanted():
    plain = rows()
    assert "lambda for permeability.wanted" not in plain
    bed = load(CASES / "permeameter", Scene).grains.packing
    assert float(plain["lambda for spheres"]) == pytest.approx(
        ratio_for(bed_of_spheres(0.4), bed.packing_fraction), abs=5e-4
    )
    wanted = rows("permeability.wanted=0.002")
    assert float(wanted["lambda for permeability.wanted"]) == pytest.approx(
        ratio_for(0.002, bed.packing_fraction), abs=5e-4
    )
    assert rows("permeability.wanted=1e-12")["lambda for permeability.wanted"] == "none"
    # What it proposes has what is wanted.
    again = rows(f"grains.hydraulic_radius_ratio={wanted['lambda for permeability.wanted']}")
    assert again["K/d² by Gebart"] == pytest.approx(0.002, rel=13 * 5e-4 / 0.8)


def test_an_exponent_of_lambda_is_a_number_only_where_wider_discs_leave_pores_open():
    bed = Measured(1e-9, 1e-3, 0.5, 1e-3, 6.0, True, 1000)
    assert exponent(bed, replace(bed, permeability=1e-9 * (1.0 + STEP) ** -8)) == pytest.approx(-8.0, rel=1e-12)
    for sealed in (replace(bed, permeability=0.0), replace(bed, permeability=-1e-20), replace(bed, steady=False)):
        assert math.isnan(exponent(bed, sealed))

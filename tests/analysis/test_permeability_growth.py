"""How K follows the porosity that shearing leaves."""

import math

import numpy as np
import pytest

from continuum_sph.seepage import Resistance
from porescale.analysis.material import known, tables
from porescale.analysis.soil_pores import GROWTH, LOOSENED, SHEARED, known_growth

SLOPE = 6.5


def rows(noise: float, slope: float = SLOPE) -> list[dict[str, float]]:
    """Six packings that open by 0.02 to 0.03, ln K off by ``noise``."""
    rng = np.random.default_rng(1)
    made = []
    for opened in np.linspace(0.02, 0.03, 6).tolist():
        grown = slope * opened + noise * float(rng.normal())
        made.append({"porosity": 0.16, LOOSENED: 0.16 + opened, "permeability": 4e-9, SHEARED: 4e-9 * math.exp(grown)})
    return made


def test_the_slope_between_before_and_after_is_found():
    (exact,) = known_growth(rows(0.0)).values()
    assert exact.mean == pytest.approx(SLOPE, rel=1e-12)
    found = known_growth(rows(0.01))[GROWTH]
    assert abs(found.mean - SLOPE) < found.interval
    assert abs(known_growth(rows(0.01, 2.0 * SLOPE))[GROWTH].mean - SLOPE) > found.interval  # must differ
    assert known_growth([{"porosity": 0.2}] * 3) == {}  # no flow was asked for


def test_the_law_of_the_continuum_has_the_slope_of_discs_with_their_share_and_not_without():
    """K of six packings of discs with 0.8 of their radius, before and after they were sheared (docs/theory/seepage):
    6.6 ± 0.6 a unit of porosity."""
    first, last = 0.161, 0.187

    def slope(share: float) -> float:
        given = Resistance(first, "kozeny-carman", share=share)
        return math.log(given.permeability(1.0, last)) / (last - first)

    assert abs(slope(0.64) - 6.62) < 0.63
    assert abs(slope(1.0) - 6.62) > 10 * 0.63


def test_a_material_file_has_the_share_of_grains_in_the_flow():
    row = {
        "porosity": 0.2, "peak friction angle": 0.4, "peak dilatancy angle": 0.1, "critical friction angle": 0.3,
        "permeability": 3e-9, "hydraulic solid fraction": 0.512,
    }  # fmt: skip
    assert tables(known([row, row]), 2500.0, 300.0, {})["pores"]["hydraulic_share"] == pytest.approx(0.64)

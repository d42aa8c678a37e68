"""Soil whose strength falls as it shears: the law at one element, scenes with and without it."""

import math

import numpy as np
import pytest

from continuum_sph.builders.parts.material import material_of
from continuum_sph.builders.parts.soil import soil_law
from continuum_sph.builders.report import report
from continuum_sph.soil import Material, Rate, Softening
from continuum_sph.soil.material import RATE_STRENGTH, SOFTENED_STRAIN
from continuum_sph.soil.plasticity import new_stress, strength
from continuum_sph.soil.softening import band_width
from continuum_sph.validation.tanks import level_ground, tank_scene
from porescale.common.core.errors import InputError

FIRM = {"sin_friction": 0.5, "cohesion_intercept": 800.0, "sin_dilatancy": 0.2, "tension": 1000.0}
SOFT = Softening(0.3, 200.0, 0.05)
PLAIN, SOFTENS = Material(1e6, 1590.0, **FIRM), Material(1e6, 1590.0, **FIRM, softening=SOFT)
GIVEN = {"friction_angle": "18 degree", "shear_strain": 0.1, "band_width": "20 cm"}
EPS = float(np.finfo(np.float64).eps)


def test_strength_goes_from_that_at_first_to_that_of_large_strains():
    row = SOFTENS.row()
    assert strength(0.0, row) == pytest.approx((0.5, 800.0, 0.2, 1000.0), rel=4 * EPS)
    left = math.exp(-1.0)
    wanted = 0.3 + 0.2 * left, 200.0 + 600.0 * left, 0.2 * left, 1000.0 * (200.0 + 600.0 * left) / 800.0
    assert strength(0.05, row) == pytest.approx(wanted, rel=4 * EPS)
    # e^-40 of what is lost is left
    assert strength(2.0, row) == pytest.approx((0.3, 200.0, 0.0, 250.0), rel=4 * EPS, abs=0.2 * math.exp(-40.0))


def test_tension_stays_within_the_tip_of_the_cone():
    row = Material(1e6, 1590.0, sin_friction=0.5, cohesion_intercept=800.0, tension=1e9, softening=SOFT).row()
    for plastic in np.linspace(0.0, 0.5, 20).tolist():
        slope, cohesion, _, tension = strength(plastic, row)
        assert 0.0 < tension <= cohesion / slope * (1.0 + 4 * EPS)


def test_a_soil_without_a_softening_has_none_of_it():
    assert PLAIN.row()[SOFTENED_STRAIN] == 0.0
    same = Material(1e6, 1590.0, **FIRM, softening=Softening(0.5, 800.0, 1e300))
    for row in (PLAIN.row(), same.row()):
        found = new_stress((1e3, 1e3, 480.0, 6e2), 0.0, (0.0, 90.0, 0.0, -9.0), 1e-3, 0.0, 0.3, row)
        assert found == new_stress((1e3, 1e3, 480.0, 6e2), 0.0, (0.0, 90.0, 0.0, -9.0), 1e-3, 0.0, 0.0, PLAIN.row())


def test_soil_that_has_sheared_yields_sooner():
    """One step of simple shear from the strength that is left: r = p sin φ(γ) + c cos φ(γ), and dilatancy e^(-γ/γs)."""
    for plastic in (0.0, 0.02, 0.2):
        slope, cohesion, dilatancy, _ = strength(plastic, SOFTENS.row())
        trial = (5e3, 5e3, 3.0e3, 3e3), 0.0, (0.0, -90.0, 0.0, 0.0), 1e-4
        xx, yy, xy, *_, flow = new_stress(*trial, 0.0, plastic, SOFTENS.row())
        p, r = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
        assert flow > 0.0
        assert r == pytest.approx(p * slope + cohesion, rel=1e2 * EPS)
        assert p - 5e3 == pytest.approx(SOFTENS.area_modulus * SOFTENS.stiffness * dilatancy * flow, rel=1e-9, abs=1e-9)


def test_friction_of_the_fastest_flow_is_that_of_large_strains():
    fast = Rate(0.6, 0.3, 1e-3)
    both = Material(1e6, 1590.0, **FIRM, softening=SOFT, rate=fast).row()
    assert both[RATE_STRENGTH] == pytest.approx(0.6 - 0.3, rel=EPS)
    between = Rate(0.4, 0.3, 1e-3)  # less than before, more than after
    Material(1e6, 1590.0, **FIRM, softening=SOFT, rate=between)
    with pytest.raises(InputError, match="is less than at rest"):
        Material(1e6, 1590.0, **FIRM, rate=between)


def scene(softening, **soil):
    given = {
        "body": [level_ground(1.0, 0.5)],
        "friction_angle": "22 degree",
        "cohesion": 50.0,
        "softening": softening,
    } | soil
    return tank_scene(1.0, 1.0, 0.05, soil=given)


def test_a_scene_names_its_softening_and_particles_have_its_slip():
    given = scene(GIVEN)
    assert material_of(given.soil).softening == Softening(math.sin(math.radians(18.0)), 0.0, 0.1)
    for wide in (0.02, 0.2, 0.5):  # 0.4, 4, 10 spacings
        law = soil_law(scene(GIVEN | {"band_width": wide}))
        strain = law.materials[0].softening.shear_strain
        width = band_width(law.smoothing, given.numerics.spacing, law.averages)
        assert strain * width == pytest.approx(0.1 * wide, rel=4 * EPS)
        # of bands that particles resolve the strain itself, within what one more average would change
        wider = band_width(law.smoothing, given.numerics.spacing, law.averages + 1) / width
        assert wide < width or 1.0 <= strain / 0.1 < wider
    assert soil_law(scene(None)).materials[0].softening is None


def test_check_says_the_slip_and_warns_of_bands_that_are_wide_or_break_at_once():
    said = report(scene(GIVEN))
    names = {row.name: row.value for group in said.groups.values() for row in group}
    assert names["angle of friction after large strains"] == pytest.approx(18.0)
    assert names["slip of a shear band that leaves 1/e of the difference"] == pytest.approx(2e-2)
    assert not said.warnings
    narrow = report(scene(GIVEN | {"band_width": "9 cm"}))  # that of particles is 18 cm
    assert [line for line in narrow.warnings if "is 1.99 times as wide as soil.softening.band_width" in line]
    assert len(narrow.warnings) == 1
    wide = report(scene(GIVEN | {"band_width": "2 m"}))
    assert [line for line in wide.warnings if "0.78 m wide at most, 2.56 times less than" in line]
    assert len(wide.warnings) == 1
    brittle = report(scene(GIVEN | {"band_width": "10 um"}))
    assert [line for line in brittle.warnings if "it breaks at once; lower numerics.spacing" in line]


@pytest.mark.parametrize(
    ("softening", "soil", "line"),
    [
        ({}, {}, r"soil\.softening\.friction_angle"),
        ({k: v for k, v in GIVEN.items() if k != "band_width"}, {}, r"soil\.softening\.band_width"),
        (GIVEN | {"friction_angle": "30 degree"}, {}, r"soil\.softening\.friction_angle.*is more than before"),
        (GIVEN | {"cohesion": 60.0}, {}, r"soil\.softening\.cohesion.*is more than before"),
        (GIVEN | {"friction_angle": "22 degree", "cohesion": 50.0}, {}, r"nothing softens"),
        (GIVEN | {"shear_strain": 0.0}, {}, r"soil\.softening\.shear_strain"),
        (GIVEN, {"elastic": True}, r"soil\.elastic.*leaves nothing that soil\.softening"),
        (GIVEN, {"held": True}, r"soil\.held.*leaves nothing that soil\.softening"),
    ],
)
def test_a_softening_that_no_soil_has_is_refused(softening, soil, line):
    with pytest.raises(InputError, match=line):
        scene(softening, **soil)


def test_from_python_too():
    with pytest.raises(InputError, match="is more than before"):
        Material(1e6, 1590.0, sin_friction=0.5, softening=Softening(0.6, 0.0, 0.05))
    with pytest.raises(InputError, match="shear_strain"):
        Softening(0.3, 0.0, 0.0)

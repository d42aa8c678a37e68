"""Soil whose friction grows with the rate of shear: the law at one element, scenes with and without it."""

import math

import numpy as np
import pytest

import continuum_sph
from continuum_sph.builders.parts.material import material_of
from continuum_sph.builders.report import report
from continuum_sph.soil import Material, Rate
from continuum_sph.soil.material import RATE_PACE, RATE_STRENGTH
from continuum_sph.soil.plasticity import new_stress
from continuum_sph.validation.tanks import level_ground, tank_scene
from porescale.common.core.errors import InputError
from tests.reference.folders import CASES

FAST = Rate(sin_friction=0.8, inertial_number=0.3, grain_diameter=1e-3)
STILL = Material(1e6, 1590.0, sin_friction=0.5)
RUBS = Material(1e6, 1590.0, sin_friction=0.5, rate=FAST)
GIVEN = {"friction_angle": "40 degree", "inertial_number": 0.3, "grain_diameter": "1 mm"}


def sheared(material, pace, steps=4000, step=1e-5):
    """(mean stress Pa, share of it that the circle's radius is) of soil sheared at ``pace`` (1/s) under 1 kPa."""
    stress, opening, row = (1e3, 1e3, 0.0, 6e2), 0.0, material.row()
    for _ in range(steps):
        *after, opening, _flow = new_stress.py_func(stress, 0.0, (0.0, pace, 0.0, 0.0), step, opening, 0.0, row)
        stress = tuple(after)
    xx, yy, xy, _ = stress
    p = 0.5 * (xx + yy)
    return p, math.hypot(0.5 * (xx - yy), xy) / p


@pytest.mark.parametrize("pace", [1.0, 30.0, 300.0])
def test_soil_sheared_at_a_steady_pace_has_the_friction_of_its_inertial_number(pace):
    strain = max(1.0, pace * 0.04)  # ten times what it takes to yield, p sin φ/G = 1.3e-3, and more
    p, friction = sheared(RUBS, pace, step=strain / pace / 4000)
    inertial = pace * FAST.grain_diameter * math.sqrt(1590.0 / 0.6 / p)
    wanted = 0.5 + 0.3 * inertial / (0.3 + inertial)
    assert p == pytest.approx(1e3, rel=1e-12)
    # The circle lags behind the turning soil by the angle r/G, so all but half of its square of the pace is plastic.
    lag = friction * p / (RUBS.shear_modulus * RUBS.stiffness)
    assert friction == pytest.approx(wanted, rel=0.5 * lag**2)
    assert sheared(STILL, pace, step=strain / pace / 4000)[1] == pytest.approx(0.5, rel=1e-12)  # must differ


def test_the_way_back_is_exact_in_one_step_where_soil_dilates_too():
    """Residual of the law for one long step, with p of the trial in the rate at which half of the growth is there."""
    soil = Material(1e6, 1590.0, sin_friction=0.5, sin_dilatancy=0.2, rate=FAST)
    stress, step, row = (1e3, 1e3, 300.0, 6e2), 1e-4, soil.row()
    xx, yy, xy, *_, flow = new_stress(stress, 0.0, (0.0, 50.0, 0.0, 0.0), step, 0.0, 0.0, row)
    p, r = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
    half = 0.3 / 1e-3 / math.sqrt(1590.0 / 0.6) * math.sqrt(1e3)
    rate = flow / step
    assert flow > 0.0
    # The trial's radius, 300 Pa and G γ of the step, some 2 kPa, through a dozen operations
    trial = 300.0 + soil.shear_modulus * soil.stiffness * 50.0 * step
    assert abs(r - p * (0.5 + 0.3 * rate / (rate + half))) < 12 * np.finfo(float).eps * trial


@pytest.mark.parametrize("excess", [-5e3, 0.0, 5e3])
def test_growth_of_friction_never_lifts_a_stress_beyond_its_trial(excess):
    for pace in (1e-6, 1.0, 1e4):
        *_, still = new_stress((1e3, 1e3, 480.0, 6e2), excess, (0.0, pace, 0.0, 0.0), 1e-5, 0.0, 0.0, STILL.row())
        *_, flow = new_stress((1e3, 1e3, 480.0, 6e2), excess, (0.0, pace, 0.0, 0.0), 1e-5, 0.0, 0.0, RUBS.row())
        assert 0.0 <= flow <= still


def test_a_soil_without_a_rate_has_none_of_it():
    assert STILL.row()[RATE_STRENGTH] == 0.0 == STILL.row()[RATE_PACE]
    same = Material(1e6, 1590.0, sin_friction=0.5, rate=Rate(0.5, 0.3, 1e-3))
    assert sheared(same, 30.0) == sheared(STILL, 30.0)


def scene(rate, **soil):
    given = {"body": [level_ground(1.0, 0.5)], "friction_angle": "22 degree", "rate": rate} | soil
    return tank_scene(1.0, 1.0, 0.05, soil=given)


def test_a_scene_names_its_rate():
    rate = material_of(scene(GIVEN).soil).rate
    assert rate == Rate(math.sin(math.radians(40.0)), 0.3, 1e-3)
    assert material_of(scene(None).soil).rate is None


def test_check_says_what_the_rate_does_and_warns_in_water():
    dry = report(scene(GIVEN))
    names = {row.name: row.value for group in dry.groups.values() for row in group}
    assert names["angle beyond which it speeds up without end"] == pytest.approx(
        math.degrees(math.atan(math.sin(math.radians(40.0))))
    )
    # √(9.81/0.5) 1e-3 √(2/(9.81 0.5 0.6)): H 0.5 m, ρs/ρ 1/0.6
    fall = names["inertial number of its own fall"]
    assert fall == pytest.approx((9.80665 / 0.5) ** 0.5 * 1e-3 * (2.0 / (9.80665 * 0.5 * 0.6)) ** 0.5)
    assert not dry.warnings
    wet = report(scene(GIVEN, saturated=True))
    assert [line for line in wet.warnings if "is of dry grains" in line]
    assert "inertial number of its own fall" not in {r.name for g in report(scene(None)).groups.values() for r in g}


def test_check_takes_gravity_and_viscosity_of_the_scene():
    def stokes(**changes):
        """The Stokes number that is warned of, and the inertial number of the fall."""
        out = report(scene(GIVEN, saturated=True).with_(changes))
        line = next(line for line in out.warnings if "Stokes number" in line)
        fall = next(row.value for group in out.groups.values() for row in group if row.name.startswith("inertial"))
        return float(line.split()[-1].rstrip(")")), fall

    (usual, fall), (heavy, same) = stokes(), stokes(gravity=98.0665)
    viscous, _ = stokes(**{"water.viscosity": 0.1002})
    assert same == pytest.approx(fall, rel=1e-12)  # √g of the shear, and of the pressure
    assert viscous == pytest.approx(0.01 * usual, rel=0.05)  # two digits are said
    assert heavy == pytest.approx(10**0.5 * usual, rel=0.05)


def test_check_warns_of_wet_pores_too():
    given = 'soil.rate={friction_angle="40 degree", inertial_number=0.3, grain_diameter=0.001}'
    wet = report(continuum_sph.load(CASES / "levee_by_suction", settings=[given]))
    assert [line for line in wet.warnings if "is of dry grains" in line]


@pytest.mark.parametrize(
    ("rate", "soil", "line"),
    [
        ({}, {}, r"soil\.rate\.friction_angle"),
        (GIVEN | {"friction_angle": "20 degree"}, {}, r"soil\.rate\.friction_angle.*is less than that at rest"),
        (GIVEN | {"grain_diameter": 0.0}, {}, r"soil\.rate\.grain_diameter"),
        (GIVEN | {"inertial_number": -1.0}, {}, r"soil\.rate\.inertial_number"),
        (GIVEN, {"elastic": True}, r"soil\.elastic.*leaves nothing that soil\.rate could slow"),
    ],
)
def test_a_rate_that_no_grains_have_is_refused(rate, soil, line):
    with pytest.raises(InputError, match=line):
        scene(rate, **soil)


def test_from_python_too():
    with pytest.raises(InputError, match="is less than at rest"):
        Material(1e6, 1590.0, sin_friction=0.5, rate=Rate(0.4, 0.3, 1e-3))
    with pytest.raises(InputError, match="grain_diameter"):
        Rate(0.8, 0.3, 0.0)

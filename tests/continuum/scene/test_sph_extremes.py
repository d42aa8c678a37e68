"""What cannot go well is refused before it starts, or stopped with the particle and the reason."""

import numpy as np
import pytest

import continuum_sph
from continuum_sph.benchmarks.extremes import EXTREMES, WATER, bubble, collapse, spun
from continuum_sph.benchmarks.extremes_seepage import stirred
from continuum_sph.builders.parts import soil
from porescale.common.evidence.extremes import REFUSED, STOPPED, Verdict


def found(axis, value):
    return next(it for it in EXTREMES.chosen([axis]) if it.value == value).tried()


@pytest.mark.parametrize(
    ("axis", "value", "key"),
    [
        ("Mach number", "0.4", "water.sound_speed"),
        ("neighbours, wendland", "9", "numerics.smoothing_ratio"),
        ("neighbours, cubic", "9", "numerics.smoothing_ratio"),
    ],
)
def test_what_cannot_go_well_is_refused_by_its_key(axis, value, key):
    row = found(axis, value)
    assert row.end == REFUSED
    assert key in row.said


@pytest.mark.parametrize(("value", "named"), [("position lost", "7"), ("thrown down at 3 c0", "particle")])
def test_what_leaves_sense_is_stopped_and_named(value, named):
    row = found("leaving the domain", value)
    assert row.end == STOPPED
    assert named in row.said


@pytest.mark.parametrize(
    ("run", "said"),
    [
        (collapse(0.01, judged=False), "fastest"),
        (bubble(1.0, 0.01), "energy balance"),
        (stirred(1e-3, 0.002), "energy left"),
    ],
    ids=["collapse", "bubble", "stirred"],
)
def test_what_goes_well_says_how(run, said):
    assert said in run()


@pytest.mark.slow
def test_what_is_judged_is_right():
    """The front of a column let go is that of a twentieth of the Mach number, within half a spacing."""
    found = collapse(0.3)()
    assert isinstance(found, Verdict)
    assert found.right
    thick = collapse(0.3, viscosity=1e5 * WATER)()  # the check that must fail
    assert isinstance(thick, Verdict)
    assert not thick.right
    assert "least pressure" in spun("kept", 0.0)()


def test_a_tank_far_wider_than_its_ground_has_no_lattice_of_its_width(monkeypatch):
    scene, real, looked_at = continuum_sph.load("dry_slope"), soil.square_lattice, []

    def lattice(*words):
        found = real(*words)
        looked_at.append(len(found))
        return found

    monkeypatch.setattr(soil, "square_lattice", lattice)
    narrow, wide = (soil.soil_particles(it) for it in (scene, scene.with_({"tank.width": 9e4})))
    spacing = scene.numerics.spacing
    whole = scene.tank.width * scene.tank.height / spacing**2
    assert looked_at[0] <= whole  # cells of the tank as it is
    assert looked_at[1] <= 1.1 * whole  # and at most a row and a column beyond the ground, not 25 000 times as many
    assert all(a.tobytes() == b.tobytes() for a, b in zip(narrow, wide, strict=True))
    assert np.isfinite(narrow[1]).all()

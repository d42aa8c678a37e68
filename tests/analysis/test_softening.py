"""How strength falls from peak to critical state: found where it is known, absent where there is no peak."""

import math

import numpy as np
import pytest

from continuum_sph.scene.material_file import with_material
from porescale.analysis.biaxial import LATE
from porescale.analysis.material import Known, known, tables
from porescale.analysis.softening import HEIGHT, STRAIN, fall, handed_over, known_softening, softening_table
from porescale.demseg.convert import toml
from tests.scene.test_material_file import ROWS

PEAK, CRITICAL, LENGTH = 0.40, 0.26, 0.06


def series(noise: float, seed: int, height: float = PEAK - CRITICAL, length: float = LENGTH) -> dict[str, np.ndarray]:
    """Columns of a test at constant volume: sin φ rises within a strain of 2 % and falls by the law; ``noise`` of it,
    correlated over 0.5 % of strain as that of a few hundred discs is."""
    strain = np.linspace(0.0, 0.24, 3001)
    shear = 2.0 * strain
    sine = CRITICAL + height * np.exp(-np.maximum(shear - 0.04, 0.0) / length)
    sine *= np.minimum(1.0, shear / 0.04)
    swing = np.convolve(np.random.default_rng(seed).normal(0.0, 1.0, 3063), np.ones(63) / math.sqrt(63.0), "valid")
    sine = sine + noise * swing
    side = np.full(3001, 300.0)
    axial = side * (1.0 + sine) / (1.0 - sine)
    return {
        "strain xx ()": strain, "strain yy ()": -strain, "stress xx (Pa)": side, "stress yy (Pa)": axial,
        "solid fraction ()": np.full(3001, 0.8),
    }  # fmt: skip


def test_the_area_over_the_critical_state_is_the_strain_of_the_law():
    shear = np.linspace(0.0, 2.0, 20001)
    sine = CRITICAL + 0.1 * np.exp(-shear / LENGTH)
    late = shear > 1.5  # e^-25 is left
    height, length = fall(shear, sine, late)
    assert height == pytest.approx(0.1, rel=1e-9)
    # The trapezoidal rule errs by (h/γs)²/12 of an exponential
    assert length == pytest.approx(LENGTH, rel=(1e-4 / LENGTH) ** 2)
    assert all(math.isnan(it) for it in fall(shear, np.full_like(shear, 0.3), late))
    assert all(math.isnan(it) for it in fall(shear, shear, late))  # still rising


def seen(length: float) -> float:
    """γs of `series` without noise by quadrature: of the mean over 1 % of strain, cut off where the critical state
    begins, which is the mean beyond."""
    shear = np.linspace(0.0, 0.48, 48001)
    curve = (CRITICAL + 0.14 * np.exp(-np.maximum(shear - 0.04, 0.0) / length)) * np.minimum(1.0, shear / 0.04)
    whole = np.concatenate(([0.0], np.cumsum(0.5 * (curve[1:] + curve[:-1])) * 1e-5))
    mean, middle = (whole[2000:] - whole[:-2000]) / 0.02, shear[1000:-1000]
    late = middle > LATE * 0.48
    above = np.where(late, 0.0, mean - mean[late].mean())
    peak = int(mean.argmax())
    return float(above[peak:].sum() * 1e-5 / (mean[peak] - mean[late].mean()))


def test_tests_with_noise_have_it_within_their_interval():
    found = known_softening([series(0.01, seed) for seed in range(6)])
    assert abs(found[STRAIN].mean - seen(LENGTH)) < found[STRAIN].interval
    assert handed_over(found)
    slow = {"critical friction angle": Known((0.26,) * 3)}
    assert softening_table(slow | found)["shear_strain"] == found[STRAIN].mean
    # must differ: twice the strain lies outside of what is allowed for half of it
    twice = known_softening([series(0.01, seed, length=2.0 * LENGTH) for seed in range(6)])
    assert abs(twice[STRAIN].mean - seen(LENGTH)) > twice[STRAIN].interval
    # without noise: rows of 0.1 % of strain, 0.002 of shear, of which the end of the fall is known to one
    clean = known_softening([series(0.0, seed) for seed in range(2)])[STRAIN].mean
    assert clean == pytest.approx(seen(LENGTH), abs=0.002)


def test_a_peak_within_the_noise_is_not_handed_over():
    assert not handed_over(known_softening([series(0.01, seed, height=0.0) for seed in range(6)]))
    assert not handed_over({})
    assert not handed_over({HEIGHT: Known((0.1, 0.1, 0.1)), STRAIN: Known((0.3, -0.1, 0.05))})


def test_a_scene_of_the_continuum_takes_it_below_its_own_numbers(tmp_path):
    found = known_softening([series(0.0, seed) for seed in range(2)])
    law = softening_table(known(ROWS) | found)
    (tmp_path / "material.toml").write_text(
        toml(tables(known(ROWS) | found, 2500.0, 300.0, {}, {"softening": law})), encoding="utf-8"
    )
    soil = {"material": "material.toml", "strength": "peak", "softening": {"band_width": 0.015}}
    taken = with_material({"soil": soil}, tmp_path)["soil"]
    assert taken["softening"] == law | {"band_width": 0.015}
    assert taken["friction_angle"] == pytest.approx(0.42)
    assert law["friction_angle"] == pytest.approx(0.31)
    own = {"soil": soil | {"softening": {"shear_strain": 0.2}}}
    assert with_material(own, tmp_path)["soil"]["softening"]["shear_strain"] == 0.2
    assert "softening" not in with_material({"soil": {"material": "material.toml"}}, tmp_path)["soil"]

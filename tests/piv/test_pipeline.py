"""From a film to fields by Python: what the command does, without it."""

import cv2
import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.piv.estimate.measure import Settings
from porescale.piv.estimate.series import Shots
from porescale.piv.fields.field import read
from porescale.piv.images import flows
from porescale.piv.images.film import open_film
from porescale.piv.images.synth import Camera, pair
from porescale.piv.pipeline import Measurement, write_fields

SIZE, SHIFT = (96, 96), (2.4, -1.3)
SETTINGS = Settings(window=16, search=8)


@pytest.fixture
def film(tmp_path):
    """Two pictures of tracers that move by SHIFT."""
    made = pair(flows.uniform(*SHIFT), Camera(SIZE, noise=0.0, lost=0.0), 1)
    names = [str(tmp_path / name) for name in ("a.png", "b.png")]
    for name, image in zip(names, (made.first, made.second), strict=True):
        cv2.imwrite(name, image)
    return open_film(tuple(names))


def test_a_film_becomes_fields_in_pixels_or_metres(film):
    (pixels,) = Measurement(Shots(film), SETTINGS).fields()
    (metres,) = Measurement(Shots(film), SETTINGS, pixel=1e-4, interval=5e-3).fields()
    good = pixels.valid & ~pixels.replaced
    # The accuracy of clean pairs, `piv.clean`, three times over
    assert np.abs(pixels.u[good] - SHIFT[0]).max() < 0.03
    assert np.abs(pixels.v[good] - SHIFT[1]).max() < 0.03
    assert np.nanmax(np.abs(metres.u - pixels.u * 1e-4 / 5e-3)) < 1e-12
    assert np.nanmax(np.abs(metres.v + pixels.v * 1e-4 / 5e-3)) < 1e-12
    assert metres.upwards


def test_fields_are_written_with_their_times(film, tmp_path):
    measurement = Measurement(Shots(film), SETTINGS, pixel=1e-4, interval=5e-3, zero=2.0)
    assert measurement.time(0) == pytest.approx(2.0 + 2.5e-3, abs=1e-15)
    found = write_fields(measurement, measurement.fields(), tmp_path / "out", csv=tmp_path / "field.csv")
    assert found["pairs"] == 1
    assert found["valid"] > 0.9 * found["vectors"]
    assert np.nanmean(read(tmp_path / "field.csv").u) == pytest.approx(SHIFT[0] * 1e-4 / 5e-3, rel=0.02)
    assert all((tmp_path / "out" / name).exists() for name in ("piv.vtkhdf", "quiver.png", "vorticity.png"))


def test_what_a_longer_film_left_in_the_folder_goes(film, tmp_path):
    measurement = Measurement(Shots(film), SETTINGS)
    for name in ("vectors_0001.csv", "overlay.mp4", "review.html", "vectors.csv"):
        (tmp_path / name).write_text("of an earlier film")
    write_fields(measurement, measurement.fields(), tmp_path)
    assert [path.name for path in sorted(tmp_path.glob("vectors*"))] == ["vectors.csv", "vectors_0000.csv"]
    assert not (tmp_path / "overlay.mp4").exists()
    assert not (tmp_path / "review.html").exists()


def test_pictures_of_two_flows_are_no_field(film, tmp_path):  # the check that must fail
    other = pair(flows.uniform(*SHIFT), Camera(SIZE, noise=0.0, lost=0.0), 7)
    cv2.imwrite(str(tmp_path / "b.png"), other.second)
    measurement = Measurement(Shots(film), SETTINGS)
    with pytest.raises(InputError, match="same tracers"):
        write_fields(measurement, measurement.fields(), None)

"""Discs of a laboratory's picture are found, each once, to a fraction of a pixel, and become the grains of a scene."""

from typing import Any

import cv2
import numpy as np
import pytest
from scipy.spatial import cKDTree

from porescale import Scene
from porescale.analysis.detect_circles import _peaks, circles_in
from porescale.builders.build import build
from porescale.common.core.errors import InputError
from porescale.common.neighbors.placement import place
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.scene.circles import Circles
from tests.reference.pictures import photograph
from tests.reference.scenes import table

WIDE, HIGH = 420, 360


@pytest.fixture(scope="module")
def bed() -> tuple[np.ndarray, np.ndarray]:
    """Centres and radii, px, of rows of touching discs of two sizes, and of loose ones of all sizes above them."""
    at = [(20.0 + 36.0 * k, 330.3) for k in range(11)] + [(38.0 + 36.0 * k, 299.3) for k in range(10)]
    loose = place((6.0, 6.0), (WIDE - 6.0, 270.0), radii=np.linspace(8.0, 24.0, 60), seed=4)
    return np.concatenate((at, loose.position)), np.concatenate((np.full(21, 18.0), loose.radius))


def compared(bed, found):
    """(discs missed or found twice, rms of the distance, of the error of the radius, px)."""
    at, radius = found
    distance, nearest = cKDTree(at).query(bed[0])
    wrong = abs(len(at) - len(bed[0])) + len(bed[0]) - len(set(nearest.tolist()))
    return wrong, float(np.sqrt(np.mean(distance**2))), float(np.sqrt(np.mean((radius[nearest] - bed[1]) ** 2)))


@pytest.mark.parametrize(("noise", "blur", "light"), [(0.0, 0.8, True), (6.0, 0.8, False), (6.0, 1.2, True)])
def test_discs_are_found_within_a_fifth_of_a_pixel(bed, noise, blur, light):
    picture = photograph(*bed, (HIGH, WIDE), noise=noise, blur=blur, light=light)
    wrong, places, radii = compared(bed, circles_in(picture, 12.0, 60.0, light=light))
    assert wrong == 0
    assert places < 0.2  # the specification
    # Blur of b px, and 1 px of the finder's own, bend rims inwards by (b^2 + 1)/2r, 0.15 px at r = 8; where a neighbour
    # comes near, its light does the same.
    assert radii < 0.3


def test_a_picture_read_from_its_other_corner_is_off(bed):  # the twin that must fail
    found, radius = circles_in(photograph(*bed, (HIGH, WIDE)), 12.0, 60.0)
    assert compared(bed, (found - 0.5, radius))[1] > 0.5


def test_peaks_of_the_distance_alone_are_coarser(bed):  # the twin that must fail
    picture = photograph(*bed, (HIGH, WIDE)).astype(np.float32)
    _, peaks = _peaks(cv2.GaussianBlur(picture, (0, 0), 1.0), 6.0, 30.0)
    peaks = np.array(peaks)
    assert compared(bed, (peaks[:, :2] + 0.5, peaks[:, 2]))[1] > 0.3


def test_an_empty_picture_shows_no_disc():
    grey = np.random.default_rng(0).normal(100.0, 2.0, (80, 90)).astype(np.float32)
    with pytest.raises(InputError, match="shows no disc"):
        circles_in(cv2.GaussianBlur(grey, (0, 0), 2.0), 20.0, 40.0)


def given(**circles: Any) -> dict[str, Any]:
    """A dry scene whose grains are those of bed.png, 50 um a pixel."""
    section = {"file": "bed.png", "pixel": "50 um", "smallest": "0.6 mm", "largest": "3 mm", **circles}
    section = {key: value for key, value in section.items() if value is not None}
    return table(fluid=None, gate=None, domain={"width": 0.021, "height": 0.018},
                 grains={"density": 2500, "circles": section, "overlap": 0.05})  # fmt: skip


def test_a_scene_starts_from_a_picture(bed, tmp_path):
    cv2.imwrite(str(tmp_path / "bed.png"), photograph(*bed, (HIGH, WIDE)))
    scene: Any = validate(Scene, given(part=True), folder=tmp_path)
    placed = np.array([(it.x, it.y) for it in scene.grains.grain])
    wanted = np.column_stack((bed[0][:, 0], HIGH - bed[0][:, 1])) * 5e-5
    distance, _ = cKDTree(placed).query(wanted)
    # In the picture within 0.2 px, rms; ``part`` slides what overlaps by twice that.
    assert np.sqrt(np.mean(distance**2)) < 0.4 * 5e-5
    assert len(placed) == len(wanted)
    assert validate(Scene, scene_as_dict(scene)) == scene  # the card holds the grains, elsewhere without the picture
    discs = build(scene).grains.discs
    assert discs.count == len(wanted)
    assert float(discs.area.sum()) == pytest.approx(np.pi * np.sum((bed[1] * 5e-5) ** 2), rel=0.03)


@pytest.mark.parametrize(("keys", "said"), [
    ({"pixel": None}, r"circles.pixel.*is needed for a picture"),
    ({"y": "down"}, r"circles.y.*follows from the picture"),
    ({"smallest": "4 mm"}, r"circles.smallest.*must be below the largest"),
    ({"smallest": "0.3 mm"}, r"circles.smallest.*too few pixels"),
    ({"file": "bed.csv"}, r"circles.pixel.*is for pictures"),
    ({"file": "none.png"}, r"circles.file.*none.png.*cannot be read"),
])  # fmt: skip
def test_pictures_that_say_too_little_are_refused(keys, said, tmp_path):
    with pytest.raises(InputError, match=said):
        validate(Scene, given(**keys), folder=tmp_path)


def test_a_section_says_what_it_needs():
    assert Circles(file="bed.h5").pixel is None

"""The page of a measured pair shows what was measured; what is taken out on it is taken out by the next measure."""

from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
import pytest

from porescale.common.core.errors import InputError, PorescaleWarning
from porescale.common.page.scripts import joined
from porescale.piv import Field, measure
from porescale.piv.fields.field import in_metres, on_picture
from porescale.piv.images import flows
from porescale.piv.images.synth import Camera, pair
from porescale.piv.review import review

SIZE = (128, 160)
REGION = (16, 8, 144, 120)
SCALE = {"scale": 1e-4, "interval": 5e-3}


class Measured(NamedTuple):
    """Pictures, what they are measured with, the field, and its page."""

    files: list[Path]
    settings: dict
    field: Field
    page: Path


@pytest.fixture(scope="module")
def measured(tmp_path_factory) -> Measured:
    """A pair in a region of its pictures, in metres, with a corner that shows nothing alike."""
    folder = tmp_path_factory.mktemp("review")
    made = pair(flows.lamb_oseen(SIZE, 3.0, 30.0), Camera(SIZE), 1)
    second = made.second.copy()
    second[80:, 100:] = np.random.default_rng(0).integers(0, 60, second[80:, 100:].shape)
    files = [folder / "a.png", folder / "b.png"]
    for file, image in zip(files, (made.first, second), strict=True):
        cv2.imwrite(str(file), image)
    settings = {"region": REGION, **SCALE}
    return Measured(
        files, settings, measure(files, out=folder / "m", review=True, **settings), folder / "m" / review.NAME
    )


def place(page, field, k):
    """CSS pixels of a vector on the page, from its left upper corner."""
    j, i = divmod(k, field.u.shape[1])
    return page.evaluate(
        """([i, j]) => {
        const { vectors, ratio } = window.review;
        const [x, y] = window.review.device(vectors.x[i], vectors.y[j]);
        const box = document.getElementById("area").getBoundingClientRect();
        return [box.left + x / ratio, box.top + y / ratio];
    }""",
        [i, j],
    )


def test_a_vector_clicked_out_is_the_one_that_the_next_measure_leaves_out(page, heard, measured, tmp_path):
    page.goto(measured.page.as_uri())
    field = measured.field
    k = int(np.flatnonzero(field.valid.ravel())[len(field.x) + 3])
    page.mouse.click(*place(page, field, k))
    assert page.inner_text("#count") == "1 taken out"
    assert "taken out" in page.inner_text("#reading")
    with page.expect_download() as saved:
        page.click("#save")
    saved.value.save_as(tmp_path / "reject.png")
    mask = cv2.imread(str(tmp_path / "reject.png"), cv2.IMREAD_GRAYSCALE)
    assert mask.shape == SIZE  # of the whole picture, though a region of it was measured
    again = measure(measured.files, reject=tmp_path / "reject.png", **measured.settings)
    assert np.flatnonzero((again.valid != field.valid).ravel()).tolist() == [k]
    assert np.flatnonzero((again.replaced != field.replaced).ravel()).tolist() == [k]
    others = np.arange(field.u.size) != k
    for name in ("u", "v", "uncertainty", "correlation"):
        assert np.array_equal(getattr(again, name).ravel()[others], getattr(field, name).ravel()[others])
    page.mouse.click(*place(page, field, k))  # once more puts it back
    assert page.inner_text("#count") == "none taken out"
    assert page.is_disabled("#save")
    page.keyboard.press("u")
    assert page.inner_text("#count") == "1 taken out"
    assert heard.requests == [measured.page.as_uri()]


def test_what_is_out_already_is_shown_out(page, measured, tmp_path):
    mask = np.zeros(SIZE, np.uint8)
    mask[8:40, 16:56] = 255  # vectors at 8, 16 … of the region: three rows of four
    cv2.imwrite(str(tmp_path / "mask.png"), mask)
    measure(measured.files, out=tmp_path, review=True, reject=tmp_path / "mask.png", **measured.settings)
    page.goto((tmp_path / review.NAME).as_uri())
    assert page.inner_text("#count") == "12 taken out"


def test_a_vector_says_what_was_measured(page, measured):
    page.goto(measured.page.as_uri())
    field = measured.field
    k = int(np.flatnonzero(field.valid.ravel())[50])
    page.mouse.move(*place(page, field, k))
    said = page.inner_text("#reading")
    u, v, own = (getattr(field, name).ravel()[k] for name in ("u", "v", "uncertainty"))
    pixels = on_picture(field, SIZE[0], 1e-4, 5e-3)  # without the corner: in pixels of the whole picture
    x, y = pixels.x[k % len(field.x)], pixels.y[k // len(field.x)]
    assert said.startswith(f"x {x:g}, y {y:g} px: ")
    for number, digits in ((u, 4), (v, 4), (own, 2)):
        # Four and two digits are shown of values held in single precision.
        found = [float(it) for it in said.replace(",", " ").replace("(", " ").split() if it[0] in "-0123456789"]
        assert np.abs(np.array(found) / number - 1).min() < 0.51 * 10.0 ** (1 - digits)
    assert said.endswith("valid")


def test_pictures_are_shown_in_turn_by_keys(page, measured):
    page.emulate_media(reduced_motion="reduce")
    page.goto(measured.page.as_uri())
    from playwright.sync_api import expect

    flicker, which = page.locator("#flicker"), page.locator("#which")
    assert flicker.get_attribute("aria-pressed") == "false"  # as it was asked for
    grey = "[...document.getElementById('picture').getContext('2d').getImageData(300, 300, 40, 40).data].join()"
    first = page.evaluate(grey)
    page.keyboard.press("2")
    assert which.inner_text() == "2"
    assert page.evaluate(grey) != first
    page.keyboard.press("1")
    assert page.evaluate(grey) == first
    page.keyboard.press("Space")
    assert flicker.get_attribute("aria-pressed") == "true"
    expect(which).to_have_text("2")
    expect(which).to_have_text("1")
    page.keyboard.press(".")
    assert page.inner_text("#hertz") == "2.5 a second"
    page.keyboard.press("Space")
    assert flicker.get_attribute("aria-pressed") == "false"


def test_keys_go_from_vector_to_vector(page, measured):
    page.goto(measured.page.as_uri())
    page.focus("#area")
    page.keyboard.press("n")
    assert "invalid" in page.inner_text("#reading")
    first = page.inner_text("#reading")
    page.keyboard.press("ArrowLeft")
    assert page.inner_text("#reading") != first
    page.keyboard.press("Enter")
    assert page.inner_text("#count") == "1 taken out"
    before = page.evaluate("window.review.place.scale")
    page.keyboard.press("+")
    assert page.evaluate("window.review.place.scale") > before
    page.keyboard.press("0")
    assert page.evaluate("window.review.place.scale") == before


@pytest.mark.parametrize(
    "look", [{"color_scheme": "light"}, {"color_scheme": "dark"}, {"viewport": {"width": 390, "height": 844}}]
)
def test_everybody_can_use_it(open_page, axe, measured, look):
    page = open_page(**look)
    page.goto(measured.page.as_uri())
    page.select_option("#colour", "uncertainty")
    page.click("summary")
    assert axe(page) == []
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


@pytest.mark.parametrize(("window", "step"), [(16, 8), (16, 16), (32, 5), (8, 1)])
def test_a_rectangle_holds_the_pixel_of_its_own_vector(node, tmp_path, window, step):
    grid = 0.5 * window + step * np.arange(9.0)
    script = joined([(Path(review.__file__).parent / "vectors.js").read_text()])
    (tmp_path / "vectors.js").write_text(script)
    make = f"""Object.assign(Object.create(Vectors.prototype), {{x: {grid.tolist()}, y: {grid.tolist()}, nx: 9, ny: 9,
        step: {step}, corner: [3, 7], rejected: new Uint8Array(81).fill(1), solid: new Uint8Array(81)}})"""
    found = node(f"{make}.rectangles()", tmp_path / "vectors.js")
    pixels = grid.astype(int)
    for k, (left, top, width, height) in enumerate(found):
        inside = (
            [it for it in pixels + 3 if left <= it < left + width],
            [it for it in pixels + 7 if top <= it < top + height],
        )
        assert inside == ([pixels[k % 9] + 3], [pixels[k // 9] + 7])


def test_a_large_pair_loses_quality_before_the_page_grows(measured, monkeypatch, tmp_path):
    monkeypatch.setattr(review, "MEBIBYTES", 0.06)
    measure(measured.files, out=tmp_path, review=True, **measured.settings)
    text = (tmp_path / review.NAME).read_text()
    assert "data:image/jpeg" in text
    assert len(text) < 0.06 * 2**20 < measured.page.stat().st_size


def test_of_a_film_the_pair_with_the_fewest_valid_vectors_is_shown(page, tmp_path):
    one, other = (pair(flows.uniform(2.0, 1.0), Camera(SIZE), seed) for seed in (1, 2))
    with pytest.warns(PorescaleWarning, match=r"50 % of the vectors are valid \(0 % of pair 1\)"):
        measure([one.first, one.second, other.first], out=tmp_path, review=True)
    page.goto((tmp_path / review.NAME).as_uri())
    facts = page.inner_text("#facts")
    assert "frames 1 and 2" in facts
    assert "1 of 0 to 1, the one with the fewest valid vectors" in " ".join(facts.split())
    assert "not met where the displacement takes them" in page.inner_text("#doubts")


def test_a_field_comes_back_onto_its_pictures(measured):
    field = measured.field
    there = on_picture(field, SIZE[0], 1e-4, 5e-3, REGION[:2])
    back = in_metres(there, SIZE[0], 1e-4, 5e-3)
    np.testing.assert_allclose(there.x, 8 * np.arange(len(there.x)) + 8, rtol=0)
    np.testing.assert_allclose(back.x - field.x, -16e-4)
    np.testing.assert_allclose(back.y - field.y, 8e-4)
    for name in ("u", "v", "uncertainty"):
        np.testing.assert_allclose(getattr(back, name), getattr(field, name), rtol=1e-12)


def test_what_cannot_be_rejected_is_said(measured, tmp_path):
    cv2.imwrite(str(tmp_path / "small.png"), np.zeros((20, 20), np.uint8))
    (tmp_path / "text.png").write_text("none")
    files = measured.files
    for wrong, words in (
        ("none.png", "is no file"),
        ("small.png", "not of the pictures' size"),
        ("text.png", "no picture"),
    ):
        with pytest.raises(InputError, match=f"reject.*{words}"):
            measure(files, reject=tmp_path / wrong)
    with pytest.raises(InputError, match=r"reject.*is no bitmap"):
        measure(files, reject="bright")
    with pytest.raises(InputError, match=r"review.*give out"):
        measure(files, review=True)


def test_a_good_pair_is_not_doubted(measured, recwarn):
    measure(measured.files)
    assert [it for it in recwarn if issubclass(it.category, PorescaleWarning)] == []

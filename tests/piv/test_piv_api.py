"""Measuring pictures from Python: stacks in one TIFF file, arrays and files give the same vectors as the command."""

import tracemalloc
import warnings

import cv2
import numpy as np
import pytest
from PIL import Image

import porescale
from porescale import piv
from porescale.common.core.errors import InputError, PorescaleWarning
from porescale.piv.fields.field import read
from porescale.piv.images import flows
from porescale.piv.images.film import open_film
from porescale.piv.images.stacks import is_stack

SIZE = (64, 80)
FEW = piv.Camera(size=(64, 64), density=0.1, noise=0.0, lost=0.0)


def noise(depth: str, count: int = 5) -> list[np.ndarray]:
    random = np.random.default_rng(1)
    return [random.integers(0, np.iinfo(depth).max, SIZE).astype(depth) for _ in range(count)]


def write_stack(path, pictures, **how):
    first, *rest = [Image.fromarray(it) for it in pictures]
    first.save(path, save_all=True, append_images=rest, **how)
    return path


def write_files(folder, pictures):
    folder.mkdir()
    for k, it in enumerate(pictures):
        cv2.imwrite(str(folder / f"{k:03d}.png"), it)
    return folder


def pair(shift: float = 2.0):
    made = piv.pair(flows.by_name("uniform", (64, 64), shift, None), FEW, 3)
    return made.first, made.second


@pytest.mark.parametrize("depth", ["uint8", "uint16"])
@pytest.mark.parametrize("how", [{}, {"compression": "tiff_lzw"}, {"big_tiff": True}], ids=["plain", "lzw", "big"])
def test_a_stack_is_the_same_frames_as_files(tmp_path, depth, how):
    pictures = noise(depth)
    stack = open_film([write_stack(tmp_path / "film.tif", pictures, **how)], start=1, step=2, region=(8, 16, 72, 60))
    files = open_film([write_files(tmp_path / "files", pictures)], start=1, step=2, region=(8, 16, 72, 60))
    assert stack.count() == files.count() == 2
    found, expected = list(stack), list(files)
    assert all(one.dtype == depth and np.array_equal(one, other) for one, other in zip(found, expected, strict=True))
    assert not np.array_equal(found[0], expected[1])  # the check that must fail


def test_bytes_the_other_way_round_and_colours_are_read(tmp_path):
    pictures = noise("uint16", 3)
    content = write_stack(tmp_path / "one.tif", pictures)
    swapped = [Image.frombytes("I;16B", SIZE[::-1], it.astype(">u2").tobytes()) for it in pictures]
    swapped[0].save(tmp_path / "other.tif", save_all=True, append_images=swapped[1:])
    for one, other in zip(open_film([content]), open_film([tmp_path / "other.tif"]), strict=True):
        assert one.dtype.isnative
        assert other.dtype.isnative
        assert np.array_equal(one, other)
    colour = [np.stack([it >> 8] * 3, -1).astype(np.uint8) for it in pictures]
    grey = list(open_film([write_stack(tmp_path / "colour.tif", colour)]))
    assert np.array_equal(grey[2], colour[2][..., 0])


def test_a_stack_is_read_a_page_at_a_time(tmp_path):
    pictures = [np.full((300, 400), k, np.uint8) for k in range(60)]
    film = open_film([write_stack(tmp_path / "long.tif", pictures)])
    tracemalloc.start()
    assert [int(it[0, 0]) for it in film] == list(range(60))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.reset_peak()
    assert len(list(film)) == 60  # the check that must fail: all of them, kept
    whole = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # A page, its bytes and the copy that is given, besides 60 directories of a few kB.
    assert peak < 10 * 300 * 400
    assert whole > 60 * 300 * 400


def test_a_stack_among_pictures_and_what_is_no_stack_are_refused(tmp_path):
    stack = write_stack(tmp_path / "film.tif", noise("uint8"))
    with pytest.raises(InputError, match="is a stack of 5 pictures; give it alone, or single pictures"):
        open_film([stack, stack])
    single = write_stack(tmp_path / "single.tif", noise("uint8", 1))
    with pytest.raises(InputError, match="is a single picture"):
        open_film([single])
    preview = [noise("uint8", 1)[0], noise("uint8", 1)[0][::4, ::4]]
    assert not is_stack(write_stack(tmp_path / "preview.tif", preview))
    (tmp_path / "torn.tif").write_bytes(stack.read_bytes()[:3000])
    (tmp_path / "text.tif").write_text("no picture")
    wide = write_stack(tmp_path / "wide.tif", noise("uint16"))
    (tmp_path / "short.tif").write_bytes(wide.read_bytes()[: -2 * SIZE[0] * SIZE[1]])
    for name in ("torn.tif", "text.tif", "short.tif"):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with pytest.raises(InputError, match="cannot be read"):
                list(open_film([tmp_path / name]))


def test_arrays_files_and_a_stack_give_the_vectors_of_the_command(tmp_path, capsys):
    from porescale.cli.piv_measure import measure

    first, second = pair()
    field = piv.measure((first, second))
    assert np.array_equal(field.u, piv.measure(first, second, window=16).u)
    stack = write_stack(tmp_path / "pair.tif", [first, second])
    files = write_files(tmp_path / "files", [first, second])
    assert measure(str(stack), out=tmp_path / "out") == 0
    capsys.readouterr()
    said = read(tmp_path / "out" / "vectors_0000.csv")
    for other in (piv.measure(stack), piv.measure(sorted(files.iterdir())), piv.measure(files), piv.measure(
        str(files / "000.png"), files / "001.png")):  # fmt: skip
        assert np.array_equal(other.u, field.u)
        assert np.array_equal(other.uncertainty, field.uncertainty)
    assert said.u == pytest.approx(field.u, rel=1e-9)  # ten digits in the file
    # Tracers without noise: the method's errors are a few hundredths of a pixel.
    assert np.median(np.hypot(field.u, field.v)) == pytest.approx(2.0, abs=0.05)
    other = piv.measure(*pair(1.0))
    assert abs(np.median(np.hypot(other.u, other.v)) - 2.0) > 0.5  # the check that must fail


def test_a_film_gives_a_field_for_each_pair_in_metres_and_seconds(tmp_path):
    first, second = pair()
    fields = piv.measure([first, second, first], scale="0.1 mm", interval="5 ms", time=0.1, out=tmp_path / "out")
    assert [it.time for it in fields] == pytest.approx([0.1025, 0.1075])
    speed = 2 * 1e-4 / 5e-3
    assert [np.median(np.hypot(it.u, it.v)) / speed for it in fields] == pytest.approx([1, 1], abs=0.03)
    assert np.sign(fields[0].u).tolist() == np.sign(-fields[1].u).tolist()
    assert fields[0].upwards
    assert (tmp_path / "out" / "vectors_0001.csv").is_file()
    assert isinstance(piv.measure([first, second, first, second], average=True, step=2, end=3), piv.Field)
    solid = np.zeros((64, 64), bool)
    solid[:, :20] = True
    masked = piv.measure(first, second, mask=solid)
    assert masked.solid.any()
    assert not masked.solid.all()


def test_a_field_says_little_and_becomes_a_table_and_a_plot():
    field = piv.measure(*pair())
    lines = repr(field).splitlines()
    assert len(lines) == 3
    assert lines[0].startswith("Field of 7 x 7 vectors (rows x columns)")
    frame = field.to_pandas()
    assert list(frame) == ["x", "y", "u", "v", "valid", "replaced", "solid", "correlation", "uncertainty"]
    assert frame.u.to_numpy() == pytest.approx(field.u.ravel())
    assert frame.x[1] == field.x[1]
    axes = field.plot()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (px)", "y (px)")
    assert axes.get_ylim()[0] > axes.get_ylim()[1]  # down
    field.u[3, 3] += 9.0  # one of 49, which hardly sets the scale
    assert field.plot().get_title() == f"longest arrows {np.hypot(field.u, field.v).max():.3g} px a frame"
    assert field._repr_png_().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda a, b: piv.measure(a, b, window=13), "window = 13 px: is not a window of these pictures"),
        (lambda a, b: piv.measure(a, b, no_slip=True), "no_slip: there are no solids; give mask or polygon"),
        (lambda a, b: piv.measure(a, b, scale="2 s", interval=1.0), "scale = '2 s': "),
        (lambda a, b: piv.measure(a, b, scale=1e-4), "interval: is needed with scale"),
        (lambda a, b: piv.measure(a, b[:-1]), "pictures are not of one size"),
        (lambda a, b: piv.measure([a, "b.png"]), "is neither files nor arrays"),
        (lambda a, b: piv.measure([a]), "fewer than two frames"),
        (lambda a, b: piv.measure(a[..., None], b), "is no grey picture"),
        (lambda a, b: piv.measure(a, b, step=0), "step = 0: is out of range"),
        (lambda a, b: piv.measure("nowhere.tif"), "film = 'nowhere.tif': "),
        (lambda a, b: piv.measure(a, b, background="most"), "background = 'most': is unknown"),
        (lambda a, b: piv.measure(a, b, mask=np.ones((3, 3), bool)), "mask = '3x3 and 64x64': "),
        (lambda a, b: piv.measure(a, b, region=(0, 0, 99, 99)), "region = '0,0,99,99': leaves the picture"),
    ],
)
def test_wrong_arguments_are_named_as_in_python(wrong, said):
    with pytest.raises(InputError) as caught:
        wrong(*pair())
    assert said in str(caught.value)
    assert "--" not in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_a_pair_of_a_film_that_shows_nothing_is_a_warning_at_the_callers_line(tmp_path):
    first, second = pair()
    with pytest.warns(PorescaleWarning, match="frames 1 and 2: pictures: no tracers") as caught:
        fields = piv.measure([first, second, 0 * first])
    assert not fields[1].valid.any()
    assert fields[0].valid.all()
    assert caught[0].filename == __file__
    masks = write_files(tmp_path / "masks", [0 * first, 0 * first, 0 * first + 255])
    with pytest.warns(PorescaleWarning, match="frames 1 and 2: mask: covers the whole picture"):
        piv.measure([first, second, first], mask=masks)


def test_a_film_of_pictures_too_small_is_refused():
    with pytest.raises(InputError, match="pictures = '3 x 64': are too small"):
        piv.measure([it[:, :3] for it in (*pair(), *pair())])


def test_piv_is_a_module_of_the_package():
    assert porescale.piv.measure is piv.measure

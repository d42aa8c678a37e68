"""The commands of ``porescale piv``, from the command line to the files: what they write, say, and refuse.

Films: long ones in bounded memory, moving masks, blank and overexposed frames, averages.
"""

import csv
import json
import os
from pathlib import Path

import cv2
import numpy as np
import pytest

from porescale.cli import piv_measure
from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.compiled.jit import set_threads, threads
from porescale.common.pictures.film import write_film
from porescale.common.record import snapshots
from porescale.piv.images import flows
from porescale.piv.images.spots import add_spots, coverage
from porescale.piv.images.synth import Camera, expose, seeded

ROWS, COLUMNS = 96, 128
SPEED, DISC = 1.5, 0.2
"""px a frame: of the flow, and of the disc in it."""


@pytest.fixture
def piv(tmp_path, monkeypatch, capsys):
    """Runs `porescale piv …` in an empty folder on one thread; gives exit code, stdout, stderr lines."""
    before = threads()
    monkeypatch.chdir(tmp_path)

    def run(*tokens: str) -> tuple[int, str, list[str]]:
        code = main(commands(), ["piv", *map(str, tokens)])
        said = capsys.readouterr()
        return code, said.out, said.err.splitlines()

    yield run
    set_threads(before)


@pytest.fixture
def measure(piv):
    """Runs `porescale piv measure …`, as `piv`."""
    return lambda *tokens: piv("measure", *tokens, "--threads", "1")


def columns(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_two_tables_have_two_files(piv, tmp_path):
    code, _, said = piv("measure", "a.png", "b.png", "--csv", "m.csv", "--openpiv", "./m.csv")
    assert code == 2
    assert said == ["--openpiv = 'm.csv': is the file of --csv, too; give them two names"]


@pytest.mark.parametrize("option", ["--csv", "--openpiv"])
def test_a_table_that_is_a_folder_is_refused_before_pictures_are_read(piv, tmp_path, option):
    code, _, said = piv("measure", "a.png", "b.png", option, ".")
    assert code == 2
    assert said == [f"{option} = '.': is a folder; name a file"]


def test_a_pair_is_made_measured_and_compared(piv, tmp_path):
    code, _, _ = piv("synth", "discs", "--size", "256", "--peak", "3", "--out", "pair")
    assert code == 0
    files = ("pair/a.png", "pair/b.png", "--mask", "pair/mask.png")
    code, said, _ = piv("measure", *files, "--csv", "m.csv", "--out", "m", "--openpiv", "m.txt", "--threads", "1")
    assert code == 0
    assert "vectors in the fluid" in said
    table = columns("m.csv")
    assert list(table) == ["x", "y", "u", "v", "valid", "replaced", "solid", "correlation", "uncertainty"]
    assert len(table["x"]) == 31 * 31
    fluid = table["solid"] == 0
    assert np.isfinite(table["u"][fluid]).all()
    assert np.isfinite(table["v"][fluid]).all()
    assert set(table["valid"]) <= {0.0, 1.0}
    mask = cv2.imread("pair/mask.png", 0) > 0
    assert np.array_equal(table["solid"] > 0, mask[table["y"].astype(int), table["x"].astype(int)])
    assert np.array_equal(table["valid"] + table["replaced"] + table["solid"], np.ones(31 * 31))
    for name in ("piv.vtkhdf", "quiver.png", "vorticity.png", "vectors_0000.csv"):
        assert (tmp_path / "m" / name).exists()
    code, said, _ = piv("compare", "pair/exact.csv", "m.csv", "--out", "c", "--json")
    assert code == 0
    found = json.loads(said)
    # Discs of 13 to 25 px with layers of 10 to 20 px, seen through windows of 16 px: a tenth of the speed is asked for.
    assert found["rms"] < 0.1
    assert found["direction"] > 0.99
    code, said, _ = piv("compare", "m", "m.txt", "--json")
    assert json.loads(said)["rms"] < 1e-7  # nine digits in the text


def test_metres_have_y_up(piv):
    piv("synth", "uniform", "--size", "128", "--out", "pair", "--peak", "2")
    code, _, _ = piv(
        "measure", "pair/a.png", "pair/b.png", "--csv", "m.csv", "--scale", "0.1 mm", "--interval", "10 ms"
    )
    assert code == 0
    table = columns("m.csv")
    assert table["y"][0] == pytest.approx((127.5 - 8) * 1e-4)
    # 1.6 and 1.2 px down in 10 ms at 0.1 mm; a hundredth of a pixel is 1e-4 m/s.
    np.testing.assert_allclose(table["u"], 1.6e-2, atol=5e-4)
    np.testing.assert_allclose(table["v"], -1.2e-2, atol=5e-4)


def test_what_cannot_be_measured_is_said_in_a_line(piv):
    piv("synth", "uniform", "--size", "64", "--out", "a")
    piv("synth", "uniform", "--size", "96", "--out", "b", "--seed", "1")
    cv2.imwrite("white.png", np.full((64, 64), 255, np.uint8))
    one, other = ("a/a.png", "a/b.png"), ("b/a.png", "b/b.png")
    refused = [
        (("measure",), "films: none given"),
        (("measure", "none.png", "a/b.png"), "cannot be read"),
        (("measure", one[0], other[1]), "not of one size"),
        (("measure", *one, "--mask", "white.png"), "covers the whole picture"),
        (("measure", *one, "--mask", "b/mask.png"), "not of the pictures' size"),
        (("measure", "white.png", "white.png"), "no tracers"),
        (("measure", *one, "--window", "15"), "--window = 15"),
        (("measure", *one, "--overlap", "1"), "--overlap = 1"),
        (("measure", *one, "--scale", "1 mm"), "--interval: is needed"),
        (("measure", *one, "--region", "0,0,10"), "--region"),
        (("measure", *one, "--region", "0,0,65,10"), "leaves the picture"),
        (("measure", *one, "--region", "50,0,20,40"), "is empty (allowed: left below right, and top below bottom)"),
        (("measure", *one, "--time=-1"), "--time = '-1': is out of range (allowed: >= 0 s)"),
        (("measure", "a/a.png"), "single picture"),
        (("measure", *one, "--no-slip"), "--no-slip: there are no solids"),
        (("measure", "a/exact.csv"), "cannot be read"),
        (("synth", "spiral"), "no such flow"),
        (("synth", "uniform", "--seed=-1"), "seed = -1"),
        (("compare", "a/exact.csv", "white.png"), "field"),
        (("compare", "a/exact.csv", "a/exact.csv", "--factor", "1"), "--factor = 1.0: is out of range (allowed: > 1)"),
        (("compare", "a/exact.csv", "a/exact.csv", "--error", "0"), "--error = 0.0: is out of range (allowed: > 0)"),
    ]
    for tokens, words in refused:
        code, out, said = piv(*tokens)
        assert (code, out, len(said)) == (2, "", 1), tokens
        assert words in said[0]


def test_pictures_of_other_tracers_give_no_field(piv, tmp_path):
    piv("synth", "uniform", "--size", "256", "--out", "a")
    piv("synth", "uniform", "--size", "256", "--out", "b", "--seed", "1")
    code, _, said = piv("measure", "a/a.png", "b/b.png", "--csv", "m.csv")
    assert code == 2
    assert "same tracers" in said[0]
    assert not (tmp_path / "m.csv").exists()


def test_a_film_is_measured_frame_by_frame(piv, tmp_path):
    flow, camera, random = flows.uniform(1.5, 0.0), Camera((96, 128)), np.random.default_rng(0)
    x, y, light = seeded(flow, camera, random)
    for k in range(4):
        image = expose(*flow.carried(x, y, float(k)), light, flow.discs, camera, random)
        cv2.imwrite(f"img_{k}.png", image)
    tokens = ("--out", "m", "--scale", "1 mm", "--interval", "0.1 s", "--time", "2 s", "--overlay", "--json")
    code, said, _ = piv("measure", "img_*.png", *tokens)
    assert code == 0
    found = json.loads(said)
    assert found["pairs"] == 3
    assert any(name.split(".")[0].endswith("overlay") for name in found["files"])
    for k in range(3):
        # A tenth of a pixel of 1.5: 15 mm/s; pictures of 96 px hold 150 vectors, each of a score of tracers.
        np.testing.assert_allclose(np.median(columns(tmp_path / "m" / f"vectors_{k:04d}.csv")["u"]), 0.015, rtol=0.07)
    times = [next(iter(entry.values())).time for entry in snapshots.catalogue(tmp_path / "m").values()]
    assert times == pytest.approx([2.05, 2.15, 2.25])


def shots(count, rows=ROWS, columns=COLUMNS):
    """Frames of a uniform flow, tracers coming in on the left, past a disc that moves, and masks of it."""
    random = np.random.default_rng(0)
    number = round((columns + SPEED * count + 40) * rows / 20)
    x, y = random.uniform(-20 - SPEED * count, columns + 20, number), random.uniform(-5, rows + 5, number)
    light = 200 * np.exp(-(random.uniform(-1, 1, number) ** 2))
    for k in range(count):
        image, share = np.full((rows, columns), 16.0), np.zeros((rows, columns))
        near = np.abs(x + SPEED * k - columns / 2) < columns / 2 + 10
        add_spots(x[near] + SPEED * k, y[near], light[near], 0.7, image)
        coverage(flows.Discs(np.array([30 + DISC * k]), np.array([48.0]), np.array([12.0])), share)
        image = image * (1 - share) + 180 * share + random.normal(0, 3, image.shape)
        yield np.clip(image, 0, 255).astype(np.uint8), ((share > 0.5) * 255).astype(np.uint8)


def filmed(count, folder, spoiled=None, size=(ROWS, COLUMNS)):
    """Write film.mp4 and masks/ into a folder; ``spoiled`` : number of a frame -> grey level of all of it."""
    (folder / "masks").mkdir()

    def frames():
        for k, (image, mask) in enumerate(shots(count, *size)):
            cv2.imwrite(str(folder / "masks" / f"{k:04d}.png"), mask)
            shown = np.full_like(image, spoiled[k]) if spoiled and k in spoiled else image
            yield np.repeat(shown[..., None], 3, 2)

    write_film(folder / "film", frames(), 25)


def resident() -> int:
    """Bytes of this process in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.slow
def test_300_frames_take_no_more_memory_than_50_and_say_how_far_they_are(measure, tmp_path, monkeypatch):
    size = (256, 256)
    filmed(300, tmp_path, size=size)
    monkeypatch.setattr(piv_measure, "PATIENCE", 0.0)
    used, write = [], snapshots.write_part

    def counted(*those):
        used.append(resident())
        write(*those)

    monkeypatch.setattr(snapshots, "write_part", counted)
    code, said, lines = measure("film.mp4", "--mask", "masks", "--window", 32, "--out", "m", "--json")
    assert code == 0
    assert json.loads(said)["pairs"] == len(used) == 299
    assert "298 of 299 pairs" in lines[-1]
    # 249 frames of a byte a pixel are 16 MB; a quarter of that is left to names and numbers of snapshots.
    assert max(used) - used[50] < 0.25 * 249 * size[0] * size[1]
    first, last = (columns(tmp_path / "m" / f"vectors_{k:04d}.csv") for k in (0, 298))
    # The mask moves with the disc, as far as vectors a step of 16 px apart show it.
    at = [it["x"][it["solid"] > 0].mean() for it in (first, last)]
    assert at[1] - at[0] == pytest.approx(298 * DISC, abs=16)
    free = (last["solid"] == 0) & (np.hypot(last["x"] - 30 - DISC * 298, last["y"] - 48) > 40)
    # H.264 takes off some of the faint tracers: a tenth of a pixel.
    assert np.sqrt(np.mean((last["u"][free] - SPEED) ** 2)) < 0.1


def test_a_blank_frame_spoils_its_own_pairs_only(measure, tmp_path):
    filmed(5, tmp_path, {1: 255})
    code, said, lines = measure("film.mp4", "--mask", "masks", "--out", "m", "--json")
    assert code == 0
    assert json.loads(said)["pairs"] == 4
    assert len(lines) == 2
    assert all("overexposed" in line or "no tracers" in line for line in lines)
    for k, good in enumerate((False, False, True, True)):
        found = columns(tmp_path / "m" / f"vectors_{k:04d}.csv")
        assert np.isfinite(found["u"][found["solid"] == 0]).all()
        assert (found["valid"].mean() > 0.8) == good
        assert (found["valid"].sum() == 0) != good


def test_a_film_that_shows_nothing_is_refused(measure, tmp_path):
    filmed(4, tmp_path, dict.fromkeys(range(4), 90))
    code, out, lines = measure("film.mp4", "--out", "m")
    assert (code, out) == (2, "")
    assert "same tracers" in lines[-1]
    assert not (tmp_path / "m" / "piv.vtkhdf").exists()


def test_an_overexposed_half_is_flagged_and_the_whole_refused(measure, tmp_path):
    for k, (image, _) in enumerate(shots(2)):
        half = image.copy()
        half[:, : COLUMNS // 2 - 4] = 255
        cv2.imwrite(f"half_{k}.png", half)
        white = np.where(image < 30, 250, 255).astype(np.uint8)
        white[::7] = 255
        white[image < 14] = 254
        white[image >= 14] = 255
        cv2.imwrite(f"white_{k}.png", white)
    code, _, _ = measure("half_0.png", "half_1.png", "--csv", "m.csv")
    assert code == 0
    found = columns(tmp_path / "m.csv")
    assert found["valid"][found["x"] < COLUMNS // 2 - 24].max() == 0
    assert found["valid"][found["x"] > COLUMNS // 2 + 16].mean() > 0.9
    code, out, lines = measure("white_0.png", "white_1.png", "--csv", "w.csv")
    assert (code, out) == (2, "")
    assert "overexposed" in lines[0]


def test_pairs_of_a_film_are_averaged_over_steps_and_regions(measure, tmp_path, monkeypatch):
    filmed(9, tmp_path)
    monkeypatch.setattr(piv_measure, "PATIENCE", 0.0)
    chosen = ("--start", 1, "--end", 8, "--step", 2, "--region", "8,0,128,96", "--average", "--csv", "m.csv")
    code, _, lines = measure("film.mp4", "--mask", "masks", *chosen)
    assert code == 0
    assert "pass 1: 1 of 3 pairs" in lines[0]
    found = columns(tmp_path / "m.csv")
    assert found["x"].min() == 16.0
    far = (found["solid"] == 0) & (np.hypot(found["x"] - 31, found["y"] - 48) > 28)
    # Two frames apart: twice the speed; three pairs of a film, a tenth of a pixel.
    assert np.sqrt(np.mean((found["u"][far] - 2 * SPEED) ** 2)) < 0.1


def test_a_mask_that_is_not_there_is_named_with_its_option(measure, tmp_path):
    for name in ("a.png", "b.png"):
        cv2.imwrite(str(tmp_path / name), np.zeros((64, 64), np.uint8))
    (tmp_path / "no.png").write_text("no picture")
    for name, words in (("missing.png", "is no file; name a bitmap"), ("no.png", "is no picture")):
        code, out, said = measure("a.png", "b.png", "--mask", name)
        assert (code, out, len(said)) == (2, "", 1)
        assert said[0].startswith(f"--mask = '{name}': {words}")
        assert not (tmp_path / "runs").exists() or not any((tmp_path / "runs").rglob("*.csv"))

"""The commands of ``porescale piv``, from the command line to the files: what they write, say, and refuse."""

import csv
import json

import cv2
import numpy as np
import pytest

from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.compiled.jit import set_threads, threads


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


def columns(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


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
        (("measure", "a/a.png"), "single picture"),
        (("measure", *one, "--no-slip"), "--no-slip: there are no solids"),
        (("measure", "a/exact.csv"), "cannot be read"),
        (("synth", "spiral"), "no such flow"),
        (("compare", "a/exact.csv", "white.png"), "field"),
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
    from porescale.piv.images import flows
    from porescale.piv.images.synth import Camera, expose, seeded

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
    from porescale.common.record import snapshots

    times = [next(iter(entry.values())).time for entry in snapshots.catalogue(tmp_path / "m").values()]
    assert times == pytest.approx([2.05, 2.15, 2.25])

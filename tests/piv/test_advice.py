"""Where few vectors are valid, what is said of the pictures is what is wrong with them, and what is advised helps."""

import json
import warnings

import cv2
import numpy as np
import pytest

from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.core.errors import InputError, PorescaleWarning
from porescale.piv import measure
from porescale.piv.images import flows
from porescale.piv.images.synth import Camera, pair

SIZE = (192, 192)


def pictures(flow=None, **camera):
    made = pair(flow or flows.uniform(3.0, 2.0), Camera(SIZE, **camera), 1)
    return made.first, made.second


def doubts(images, **settings):
    """What is said of a pair, as warnings or an error, and the share of valid vectors."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        try:
            field = measure(*images, **settings)
        except InputError as error:
            return str(error), 0.0
    said = [str(it.message) for it in found if issubclass(it.category, PorescaleWarning)]
    return "; ".join(said), float(field.valid.sum() / (~field.solid).sum())


def test_displacements_out_of_reach_are_measured_and_the_search_advised_finds_them():
    images = pictures(flows.uniform(24.0, 4.0))
    said, share = doubts(images)
    assert share == 0.0
    assert "displacements reach 24 px, and search 16 looks no further: give search 32, or pictures 1.5 times" in said
    assert doubts(images, search=32) == ("", pytest.approx(1.0, abs=0.05))  # what came from outside is lost


def test_too_few_tracers_are_counted_and_the_window_advised_holds_enough():
    images = pictures(density=0.0025, lost=0.4)
    said, share = doubts(images)
    assert share < 0.7
    assert f"only {100 * share:.0f} % of the vectors are valid, fewer than 70 %" in said
    # 0.0025 a pixel in 256: 0.64, of which 0.4 are in one picture only, and some too faint to be seen.
    found = float(said.split(" tracers in a window of 16 px")[0].split()[-1])
    assert 0.4 < found < 1.0
    window = int(said.split("give window ")[1].split(",")[0])
    assert window**2 * found / 256 >= 7
    # Wider windows are right where narrow ones hold no tracer; a vector is valid by how alike the pictures are there.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PorescaleWarning)
        fields = [measure(*images, window=side) for side in (16, window)]
    near = [float(np.mean(np.hypot(it.u - 3.0, it.v - 2.0) < 0.5)) for it in fields]
    assert near[1] > 0.95 > 0.8 > near[0]


def test_lost_pairs_are_counted():
    said, share = doubts(pictures(lost=0.7))
    assert share < 0.7
    lost = int(said.split(" % of the tracers are not met")[0].split()[-1])
    assert abs(lost - 70) < 10
    assert "tracers in a window" not in said
    assert "give mask" not in said


def test_where_there_are_no_tracers_a_mask_is_advised_and_helps():
    dark = np.random.default_rng(0)
    images = [it.copy() for it in pictures()]
    for it in images:
        it[:, 96:] = np.clip(dark.normal(20, 3, it[:, 96:].shape), 0, 255)
    said, share = doubts(images)
    assert share < 0.7
    assert "of the invalid vectors lie where there are hardly any tracers" in said
    assert "give mask" in said
    solid = np.zeros(SIZE, bool)
    solid[:, 96:] = True
    assert doubts(images, mask=solid) == ("", pytest.approx(1.0, abs=0.02))


def test_a_good_pair_is_not_doubted():  # the check that must fail, were everything doubted
    assert doubts(pictures(lost=0.3, noise=5.0)) == ("", pytest.approx(1.0, abs=0.05))


def test_the_command_warns_on_stderr_and_in_json(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for name, images in (("lost", pictures(lost=0.7)), ("far", pictures(flows.uniform(24.0, 4.0)))):
        for letter, image in zip("ab", images, strict=True):
            cv2.imwrite(f"{name}_{letter}.png", image)
    assert main(commands(), ["piv", "measure", "lost_a.png", "lost_b.png", "--csv", "m.csv", "--json"]) == 0
    said = capsys.readouterr()
    found = json.loads(said.out)["doubts"]
    assert said.err.splitlines() == [f"warning: {it}" for it in found]
    assert "closer in time" in found[1]
    assert main(commands(), ["piv", "measure", "far_a.png", "far_b.png", "--csv", "m.csv"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "do not show the same tracers, or not where they are looked for" in line
    assert "give --search 32" in line

"""Cases that film a run and measure the film do what their expected.toml says, and would say so if they did not."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from porescale import Scene, open_run
from porescale.common.schema.sections import load
from porescale.output.case import expected, missed
from porescale.piv.fields.field import Field
from porescale.piv.images.synth import Camera
from tests.reference.folders import CASES, script


@pytest.fixture(scope="module")
def cavity(tmp_path_factory):
    """The script and a run on 64² cells: what the measurement misses of a field does not depend on the field's own."""
    module = script("piv_cavity")
    return module, module.cavity(tmp_path_factory.mktemp("cavity") / "run", "draft")


@pytest.mark.slow
def test_the_measured_cavity_is_that_of_the_lattice(cavity):
    module, run = cavity
    numbers, _, _ = module.judged(run, pairs=3)
    assert set(numbers) == {row["name"] for row in expected(CASES / "piv_cavity")}
    assert missed(CASES / "piv_cavity", numbers) == []


@pytest.mark.slow
def test_wide_windows_miss_the_corners_and_noisy_pictures_the_rest(cavity):  # the twins that must fail
    module, run = cavity
    wide, _, _ = module.judged(run, pairs=1, window=64)
    corners = {row["name"] for row in expected(CASES / "piv_cavity") if row["name"].startswith("lower")}
    assert set(missed(CASES / "piv_cavity", wide)) >= corners
    noisy, _, _ = module.judged(run, pairs=1, camera=Camera(noise=60.0))
    assert {"all", "inside", "inside, px"} <= set(missed(CASES / "piv_cavity", noisy))


@pytest.fixture(scope="module")
def collapse():
    """The script of the films, of what it measures on them, and of the sweep."""
    folder = str(CASES / "column_collapse_piv")
    sys.path.insert(0, folder)
    try:
        yield (
            script("column_collapse_piv"),
            script("column_collapse_piv", "filmed"),
            script("column_collapse_piv", "sweep"),
        )
    finally:
        sys.path.remove(folder)


def turning(centre, sign, size=(0.2, 0.15), step=2e-3):
    """A field with a vortex of 100 cm²/s and a core of 1 cm, against the clock or with it, in a box of ``size``, m."""
    x = np.arange(step / 2, size[0], step)
    y = np.arange(step / 2, size[1], step)[::-1]
    dx, dy = np.meshgrid(x - centre[0], y - centre[1])
    turn = sign * 0.01 / (2 * np.pi) / (dx**2 + dy**2 + 0.01**2)
    none = np.zeros_like(dx)
    return Field(x, y, -turn * dy, turn * dx, none == 0, none > 0, none > 0, none, none, upwards=True)


def test_vortices_are_told_by_sign_and_region(collapse):
    _, filmed, _ = collapse
    size = (0.2, 0.15)
    for sign in (1, -1):
        low, high = (filmed.named(turning(at, sign), size) for at in ((0.05, 0.04), (0.11, 0.12)))
        assert low["upper middle"] is None
        assert high["lower left"] is None
        for found, place in ((low["lower left"], (0.05, 0.04)), (high["upper middle"], (0.11, 0.12))):
            assert found.circulation * sign > 0
            assert abs(found.x - place[0]) < 1e-3  # half a vector's distance
            assert abs(found.y - place[1]) < 1e-3
    assert filmed.named(turning((0.19, 0.12), 1), size) == {"lower left": None, "upper middle": None}


def test_water_sets_in_where_its_speed_passes_the_bound_after_the_gate_opens(collapse):
    _, filmed, _ = collapse
    place = filmed.Place((0.0, 1.0), 1.0, opens=0.1)
    assert filmed.reaches(0.05, [0.05, 0.2, 0.3], [9.0, 0.02, 0.08], place) == pytest.approx(0.15)
    assert filmed.reaches(0.01, [0.2], [0.02], place) == pytest.approx(0.05)  # from rest as the gate opens
    assert np.isnan(filmed.reaches(0.1, [0.2, 0.3], [0.02, 0.08], place))


def test_every_row_of_the_films_is_a_number_that_they_give(collapse):
    films, filmed, _ = collapse
    field = turning((0.05, 0.04), -1)
    numbers = {}
    for name, (_, _, _, moments) in films.FILMS.items():
        fields = {(moment, rate): (field, field) for moment in moments for rate in (filmed.RATE, films.FASTER)}
        numbers |= films.numbers_of(name, films.Seen({0.01: (0.1, 0.1), 0.05: (0.2, 0.2)}, fields), (0.2, 0.15))
    rows = expected(CASES / "column_collapse_piv")
    assert {row["name"] for row in rows} <= set(numbers)
    # The twin that must fail: a film that shows what the lattice has, and one vortex, is not what all of them show.
    assert {it.rpartition(": ")[2] for it in missed(CASES / "column_collapse_piv", numbers)} >= {"upper middle vortex"}


def test_every_variant_is_a_scene_of_its_own(collapse):
    _, _, sweep = collapse
    scenes = [load(CASES / it.case, Scene, overrides=it.settings).model_dump_json() for it in sweep.VARIANTS.values()]
    assert len(set(scenes)) == len(scenes)
    assert len({sweep.folder_of(it, Path()) for it in sweep.VARIANTS.values()}) == len(scenes)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "turn"), [("viscosity 1e-4", 1), ("viscosity 1e-4, gate vanishes", 0)])
def test_a_gate_that_is_lifted_leaves_a_vortex_in_the_upper_middle(collapse, tmp_path, name, turn):
    # Thicker than water, so that one film of 60 frames a second sees it; the second row is the twin without a gate.
    films, filmed, sweep = collapse
    variant = sweep.VARIANTS[f"{name}, seed 1, 6 cells"]
    short = replace(variant, settings=(*variant.settings, "time.end=0.62"))
    sweep.run(short, tmp_path)
    folder = sweep.folder_of(short, tmp_path)
    _, field = next(filmed.film(open_run(folder), 0.6 - 0.5 / 60, 0.6 + 0.51 / 60))
    for seen in (field, filmed.lattice(folder, 0.6)):
        assert films.turn(filmed.named(seen, (0.2, 0.15))["upper middle"]) == turn

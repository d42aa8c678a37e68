"""Fields compared: vortices by place, sign and circulation, surfaces of piles, a run against a film of it."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.core.errors import PorescaleWarning
from porescale.common.record import snapshots
from porescale.common.record.model import Cloud, Grid, Snapshot
from porescale.common.record.open_run import Run
from porescale.piv.estimate.measure import measure
from porescale.piv.estimate.series import as_grid
from porescale.piv.fields import pictures, surface
from porescale.piv.fields.compare import compare
from porescale.piv.fields.field import Field, in_metres, in_pixels
from porescale.piv.fields.of_run import field_of_run, surface_of_run
from porescale.piv.fields.vortices import Vortex, matched
from porescale.piv.images import flows
from porescale.piv.images.camera import Shooting, frames, shooting
from porescale.piv.images.flows import Discs
from porescale.piv.images.synth import Camera, exact, pair
from porescale.validation.piv import surfaces as lab
from porescale.validation.piv.surfaces import VALIDATIONS

SIDE, CELLS, TURN = 0.032, 64, 2.0


def test_a_vortex_twice_as_strong_is_another_one():
    one = Vortex(10.0, 10.0, 5.0, 4.0, 0.9)
    assert len(matched([one], [replace(one, x=13.0, circulation=9.0)])) == 1
    assert matched([one], [replace(one, circulation=11.0)]) == []
    assert len(matched([one], [replace(one, circulation=11.0)], factor=3.0)) == 1
    assert matched([one], [replace(one, circulation=-5.0)]) == []
    assert matched([one], [replace(one, x=15.0)]) == []
    near, alike = replace(one, x=10.5, circulation=9.5), replace(one, x=11.0, circulation=5.2)
    assert matched([one], [near, alike]) == [(one, alike)]  # nearly as near, and far more alike


def test_noise_of_a_measured_field_is_no_vortex_to_compare():
    made = pair(flows.uniform(2.0, 1.0), Camera((256, 256)), 0)
    measured = in_pixels(measure(made.first, made.second))
    found = compare(exact(made, 16, 8), measured)
    assert (found.reference_vortices, found.other_vortices) == ([], [])
    sure = replace(measured, uncertainty=0 * measured.uncertainty)  # the check that must fail: noise taken for motion
    assert compare(exact(made, 16, 8), sure).other_vortices != []


def test_fields_that_share_little_are_said_to():
    whole = exact(pair(flows.uniform(2.0, 1.0), Camera((256, 256)), 0), 16, 8)
    assert compare(whole, whole).shared == 1.0
    twice = replace(whole, x=2 * whole.x, y=2 * whole.y)  # as with a scale that is twice too large
    for one, other in ((whole, twice), (twice, whole)):
        with pytest.warns(PorescaleWarning, match="% of a field is compared"):
            found = compare(one, other)
        assert 0.2 < found.shared < 0.3  # a quarter, but for whole points


def test_a_grain_that_flies_would_spoil_the_surface(monkeypatch):  # the twin of the row that must fail
    monkeypatch.setattr(surface, "_resting", lambda grains, floor: np.ones(len(grains.x), bool))
    found, exact = lab.pile(1.0)
    assert abs(found[0] / exact[0] - 1) > VALIDATIONS["piv.surface_of_a_pile"].tolerance


def test_surfaces_differ_by_what_is_added():
    x = np.linspace(0.0, 1.0, 101)
    one = surface.of_grains(Discs(np.array([0.3, 0.5]), np.array([0.1, 0.1]), np.array([0.1, 0.1])), x)
    other = one._replace(height=one.height + 0.02)
    found = surface.difference(one, other)
    assert found.rms == pytest.approx(0.02)
    assert found.mean == pytest.approx(0.02)
    assert found.highest == pytest.approx(0.2)
    assert surface.difference(one, one._replace(x=x + 5)) is None


def test_walls_are_no_pile_and_what_flies_is_none_either():
    solid = np.zeros((10, 8), bool)
    solid[:, 0] = solid[-3:, 3:6] = solid[2, 7] = True
    for y, floor in ((np.arange(10.0), 9.5), (np.arange(10.0)[::-1], -0.5)):  # pixels, y down; metres, y up
        found = surface.of_solids(np.arange(8.0), y, solid)
        np.testing.assert_array_equal(found.height, [np.nan, 0, 0, 3, 3, 3, 0, 0])
        assert found.floor == pytest.approx(floor)


def turning(time: float, step: int) -> Snapshot:
    """Solid rotation, and three grains in a row on the floor."""
    at = (np.arange(CELLS) + 0.5) * SIDE / CELLS - SIDE / 2
    x, y = np.meshgrid(at, at)
    centres = np.array([[0.008, 0.003], [0.014, 0.003], [0.011, 0.0082]])
    solid = np.zeros_like(x)
    for a, b in centres:
        solid[np.hypot(x + SIDE / 2 - a, y + SIDE / 2 - b) < 0.003] = 1
    velocity = np.stack([-TURN * y, TURN * x, np.zeros_like(x)], -1)
    cells = {"velocity": velocity, "solid_fraction": solid}
    grid = Grid((0.0, 0.0), (SIDE / CELLS,) * 2, cells, {"velocity": "m/s"})
    return Snapshot(time, step, {"fields": grid}, {"grains": Cloud(centres, {"radius": np.full(3, 0.003)})})


def test_a_run_is_compared_with_the_film_of_it(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "run"
    for k in range(2):
        snapshots.write_part(folder, turning(0.1 * k, k))
    run = Run(folder, {"name": "turning"}, snapshots.catalogue(folder))
    monkeypatch.setattr("porescale.piv.fields.of_run.open_run", lambda folder: run)
    scale, pause = SIDE / 256, 0.02
    shot = shooting(run, Shooting(Camera(noise=1.0), scale, pause, 0.0, pause))
    first, second = list(frames(run, shot))
    field = in_metres(in_pixels(measure(first.picture, second.picture, first.solid)), 256, scale, pause)
    snapshots.write_part(tmp_path / "film", Snapshot(0.0, 0, grids={"piv": as_grid(field)}))
    snapshots.assemble(tmp_path / "film")
    assert surface_of_run(tmp_path / "film", field.x) is None  # it has no grains, only solids
    reference, other = field_of_run(folder), field_of_run(tmp_path / "film")
    found = compare(reference, other, surfaces=(surface_of_run(folder, reference.x), None))
    # 0.05 px beside grains of 24 px in a flow of up to 7 px: 2 % of the rms speed, 3.3 px; twice that is allowed.
    assert found.rms < 0.04
    assert found.direction > 0.999
    assert found.aligned > 0.999
    # A picture's solids are known to a grid step of 8 px, up or down: 1 mm.
    assert found.surface.largest < 0.003  # beside a rim that stands upright a column is in or out: a radius
    assert abs(found.surface.mean) < 8 * scale
    assert found.surface.highest == pytest.approx(0.0112, abs=1e-4)
    assert main(commands(), ["piv", "compare", str(folder), str(tmp_path / "film"), "--out", str(tmp_path / "c")]) == 0
    said = capsys.readouterr().out
    assert "surface of the pile" in said
    assert "within 30 degrees" in said
    assert (tmp_path / "c" / "compare.png").exists()
    for tokens in (["film.mp4", str(folder)], [str(folder), str(folder), "--factor", "0.5"]):
        assert main(commands(), ["piv", "compare", *tokens]) == 2
        assert len(capsys.readouterr().err.splitlines()) == 1


def test_it_is_said_which_moments_are_compared_and_none_beyond_the_run_is(tmp_path, monkeypatch, capsys):
    def told(*words):
        """Exit code, standard output and error of a comparison of two runs, of 0 to 0.1 s and of 0 to 0.2 s."""
        code = main(commands(), ["piv", "compare", str(tmp_path / "a"), str(tmp_path / "b"), *words])
        return code, *capsys.readouterr()

    for name, count in (("a", 2), ("b", 3)):
        for k in range(count):
            snapshots.write_part(tmp_path / name, turning(0.1 * k, k))
    opened = "porescale.piv.fields.of_run.open_run"
    monkeypatch.setattr(opened, lambda folder: Run(folder, {"name": "turning"}, snapshots.catalogue(folder)))
    code, out, err = told()
    assert (code, out.splitlines()[0]) == (0, f"{tmp_path / 'a'} at 0.1 s, {tmp_path / 'b'} at 0.2 s")
    assert err == "warning: the last fields are of 0.1 and 0.2 s; --time picks one moment of both\n"
    code, out, err = told("--time", "0.09")
    assert (code, err) == (0, "")
    assert out.startswith(f"{tmp_path / 'a'} at 0.1 s, {tmp_path / 'b'} at 0.1 s\n")
    code, out, err = told("--time", "0.5")
    assert (code, out) == (2, "")
    assert err == f"time = 0.5 s: is beyond what {tmp_path / 'a'} has (allowed: 0 to 0.1 s)\n"


def test_a_comparison_has_few_numbers_along_its_axes_and_a_unit_at_its_colours(tmp_path, monkeypatch):
    kept, saved = [], pictures._saved
    monkeypatch.setattr(pictures, "_saved", lambda figure, path: kept.append(figure) or saved(figure, path))
    x, y = (np.arange(160) + 0.5) * 2.5e-4, (np.arange(96)[::-1] + 0.5) * 2.5e-4
    flow, solid = np.sin(200 * x)[None, :] * np.ones((96, 1)), np.zeros((96, 160), bool)
    field = Field(x, y, flow, flow, ~solid, solid, solid, flow, 1e-3 + 0 * flow, upwards=True)
    pictures.comparison(field, field, compare(field, field), tmp_path / "c.png", ("one", "other"))
    assert {it.get_ylabel() for it in kept[0].axes} >= {"vorticity, 1/s"}
    axes = Figure(
        figsize=(16, 9)
    ).add_subplot()  # how many do not depend on the room that a panel has before it shrinks
    pictures._dressed(axes, field)
    low, high = axes.get_xlim()
    assert 2 < sum(low <= it <= high for it in axes.get_xticks()) < 6  # nine ran into each other

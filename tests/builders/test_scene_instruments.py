"""Probes, lines, flux sections, load cells, permeability: what they read where it is known; none makes nothing."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from porescale.analysis.bed_permeability import write_permeability
from porescale.analysis.permeability import gebart, kozeny_carman, measure
from porescale.builders.build import build
from porescale.builders.parts.flow_fields import vorticity
from porescale.common.core.errors import InputError, PorescaleWarning
from porescale.common.record.drive import drive
from porescale.common.record.open_run import open_run
from porescale.common.schema.sections import scene_as_dict
from porescale.output.lines import write_lines
from porescale.output.rectangle_mean import RectangleMean
from porescale.output.sample import Sampler, along, midpoints
from porescale.scene.measures.line import Flux, Line
from tests.reference.scenes import dry, water

DISC = {"x": 0.004, "y": 0.004, "diameter": 0.002}
MEASURED: dict[str, Any] = {
    "probe": [{"name": "tap", "x": 0.001, "y": 0.002}],
    "flux": [{"start": [0.006, 0.0], "end": [0.006, 0.008]}, {"start": [0.006, 0.008], "end": [0.006, 0.0]}],
    "line": [{"start": [0.006, 0.0], "end": [0.006, 0.008], "points": 5}],
    "loads": {"discs": [0], "speed": 0.01, "length": 0.002}, "disc": [DISC], "gravity": [0.0, 0.0],
}  # fmt: skip


def plane(x: Any, y: Any) -> Any:
    return 2.0 + 3.0 * x - 5.0 * y


def test_bilinear_interpolation_is_exact_for_a_plane():
    y, x = (np.mgrid[:7, :9] + 0.5) * 0.5
    points = [(0.25, 0.25), (1.1, 2.3), (4.25, 3.25), (3.99, 0.31)]
    read = Sampler(points, (9, 7), 0.5)
    # Four products of numbers of order ten: a few units in the last place.
    assert read.of(plane(x, y)) == pytest.approx([plane(*it) for it in points], rel=1e-14)
    # The twin that must fail: the nearest centre is half a cell off.
    assert abs(plane(x, y)[4, 2] - plane(1.1, 2.3)) > 0.1


def test_a_point_beyond_the_outermost_centres_reads_the_wall_cell_or_the_other_side():
    values = np.arange(12.0).reshape(3, 4)
    assert Sampler([(0.0, 0.0), (4.0, 3.0)], (4, 3), 1.0).of(values).tolist() == [0.0, 11.0]
    assert Sampler([(0.0, 0.5), (4.0, 0.5)], (4, 3), 1.0, (True, False)).of(values).tolist() == [1.5, 1.5]


def test_velocity_goes_on_to_that_of_a_wall_half_a_cell_outside_the_first_centres():
    y, x = np.mgrid[:5, :6] + 0.5
    points = [(0.0, 2.2), (0.2, 2.2), (6.0, 2.5), (3.1, 0.0), (3.1, 0.4), (0.1, 0.2), (3.1, 4.9), (2.7, 2.2)]
    read, open_water = Sampler(points, (6, 5), 1.0), np.zeros((5, 6))
    walls = [plane(0.0, 2.2), None, 7.0, None]
    found = read.to_sides(plane(x, y), walls, open_water)
    # At the wall what the wall has, linear up to the first centre; beside it, and at a side that has none, as before.
    beside = plane(3.1, 0.5)
    expected = [plane(*points[0]), plane(*points[1]), plane(5.5, 2.5), 7.0, 7.0 + 0.8 * (beside - 7.0)]
    corner = plane(0.0, 2.2) + 0.2 * (plane(0.5, 0.5) - plane(0.0, 2.2))
    expected += [7.0 + 0.4 * (corner - 7.0), plane(3.1, 4.5), plane(2.7, 2.2)]
    assert found == pytest.approx(expected, rel=1e-14)  # a few products and sums of numbers of order ten
    joined = Sampler(points, (6, 5), 1.0, (True, True))  # sides that are none
    assert joined.to_sides(plane(x, y), walls, open_water).tolist() == joined.of(plane(x, y)).tolist()
    # In what is solid at a wall it is the solid's, in half of it half way.
    solid = np.zeros((5, 6))
    solid[:, 0] = 1.0
    assert read.to_sides(plane(x, y), walls, solid)[0] == read.of(plane(x, y))[0]
    assert read.to_sides(plane(x, y), walls, 0.5 * solid)[0] == pytest.approx(plane(0.25, 2.2), rel=1e-14)


def test_pressure_goes_on_to_a_side_with_its_slope():
    y, x = np.mgrid[:5, :6] + 0.5
    points = [(0.0, 2.2), (6.0, 2.5), (3.1, 0.1), (6.0, 5.0), (2.7, 2.2)]
    read, solid = Sampler(points, (6, 5), 1.0), np.zeros((5, 6))
    # A dozen products and sums of numbers of order ten.
    assert read.in_fluid(plane(x, y), solid) == pytest.approx([plane(*it) for it in points], rel=1e-14)
    assert abs(plane(0.5, 2.2) - plane(0.0, 2.2)) > 1.0  # the check that must fail: the centre's
    # Where solid stands a cell away there is no slope to be had; the other axis keeps its own.
    solid[:, 1], solid[3, :] = 1.0, 1.0
    assert read.in_fluid(np.where(solid > 0, -1000.0, plane(x, y)), solid)[0] == pytest.approx(
        plane(0.5, 2.2), abs=1e-7
    )


def test_pressure_is_that_of_the_fluid_share_and_none_inside_solid():
    solid, values = np.zeros((3, 4)), np.full((3, 4), 7.0)
    solid[:, 2:] = 1.0
    values[:, 2:] = -1000.0
    read = Sampler([(2.0, 1.5), (3.0, 1.5)], (4, 3), 1.0)
    outside, inside = read.in_fluid(values, solid)
    assert outside == pytest.approx(7.0, rel=1e-14)  # a dozen products and sums of numbers of order ten
    assert math.isnan(inside)
    assert read.of(values)[0] == pytest.approx((7 - 1000) / 2)  # the twin: plain interpolation takes the solid's


def half_plane(rows, columns, wall):
    """Fractions of what lies right of x = ``wall``, and a plane's values in cells that are fluid, far off elsewhere."""
    y, x = np.mgrid[:rows, :columns] + 0.5
    solid = np.clip(x + 0.5 - wall, 0, 1)
    return solid, np.where(solid < 0.5, plane(x, y), -1000.0)


@pytest.mark.parametrize("wall", [4.0, 4.3])
def test_pressure_at_a_surface_is_that_of_the_plane_through_the_fluid_beside_it(wall):
    solid, values = half_plane(6, 8, wall)
    points = [(wall, 2.0), (wall, 3.4), (wall - 0.2, 2.9), (4.0, 0.5)]
    found = Sampler(points, (8, 6), 1.0).in_fluid(values, solid)
    # Slopes are pulled to zero by 1e-9 of them, over some two cells; round-off of values of 30 is a million times less.
    assert found == pytest.approx([plane(*it) for it in points], abs=1e-7)
    # The twin that must fail: the mean of the fluid of the four cells is that of half a cell off.
    assert abs(plane(3.5, 2.0) - found[0]) > 1.0
    # A plane along the wall alone can be seen where the fluid is a cell wide.
    solid[:, :3] = 1.0
    assert Sampler([(wall, 2.0)], (8, 6), 1.0).in_fluid(values, solid)[0] == pytest.approx(plane(3.5, 2.0), abs=1e-6)


@pytest.mark.parametrize(("y", "off"), [(2.0, 0.45), (2.5, 1 / 3)])
def test_a_bend_along_a_surface_puts_its_pressure_off_by_less_than_half_a_cell_s(y, off):
    solid, values = half_plane(6, 8, 4.0)
    values = np.where(solid < 0.5, (np.mgrid[:6, :8][0] + 0.5 - y) ** 2, -1000.0)
    # Rows at ±1/2 and ±3/2 count 9 and 1, at 0 and ±1 they count 4 and 1: means of squares of 9/20 and 1/3.
    found = Sampler([(4.0, y)], (8, 6), 1.0).in_fluid(values, solid)[0]
    assert found == pytest.approx(off, abs=1e-8)
    # The twin that must fail: bilinear weights, 3 and 1 or 2 and 1.
    assert found < 0.7 * {2.0: 0.75, 2.5: 0.5}[y]


def test_pressure_at_a_surface_is_not_that_behind_a_plate():
    # A plate two cells thick: behind it the pressure is another.
    solid, values = np.zeros((6, 8)), np.ones((6, 8))
    solid[:, 3:5], values[:, 5:], values[:, 3:5] = 1.0, 9.0, -1000.0
    left, right = Sampler([(3.0, 3.0), (5.0, 3.0)], (8, 6), 1.0).in_fluid(values, solid)
    assert (left, right) == pytest.approx((1.0, 9.0), rel=1e-7)
    # The twin: with a hole of one cell beside it the sides are joined, and the plane goes through both.
    solid[2, 3:5], values[2, 3:5] = 0.0, 5.0
    assert Sampler([(3.4, 2.5)], (8, 6), 1.0).in_fluid(values, solid)[0] > 1.5


def test_points_of_lines_and_sections():
    assert along((0, 0), (2, 4), 3).tolist() == [[0, 0], [1, 2], [2, 4]]
    assert midpoints((0, 0), (0, 4), 2).tolist() == [[0, 1], [0, 3]]


def test_vorticity_of_a_solid_rotation_is_twice_its_rate():
    y, x = (np.mgrid[:6, :8] + 0.5) * 0.1
    # Differences of a linear field are exact but for round-off of 1e-16 over a spacing of 0.1.
    assert vorticity(-3.0 * y, 3.0 * x, 0.1) == pytest.approx(6.0, abs=1e-13)
    # A box one cell wide, as a channel without anything that differs along it.
    assert vorticity(-3.0 * y[:, :1], 0 * y[:, :1], 0.1) == pytest.approx(3.0, abs=1e-13)
    assert vorticity(0 * x[:1], 3.0 * x[:1], 0.1) == pytest.approx(3.0, abs=1e-13)


def test_a_section_over_whole_cells_counts_what_flows_through_them():
    simulation = build(water(**MEASURED))
    simulation.advance(200)
    _, ux, _, _ = simulation.fields()
    row = simulation.tables()["flux"]
    spacing = 0.0002
    # x = 6 mm is the face between columns 29 and 30: the mean of the two, summed over 40 cells, to round-off.
    expected = 0.5 * (ux[:, 29] + ux[:, 30]).sum() * spacing
    assert row["section 0 volume flux (m²/s)"] == pytest.approx(expected, rel=1e-13)
    assert row["section 1 volume flux (m²/s)"] == -row["section 0 volume flux (m²/s)"]
    assert expected > 0
    assert row["section 0 flux of solid (m²/s)"] == 0.0


def test_in_steady_flow_the_load_of_a_disc_and_walls_balance_the_body_force():
    simulation = build(water(**{**MEASURED, "domain__top": "periodic", "domain__bottom": "periodic",
                                "fluid__viscosity": 1e-4}))  # fmt: skip
    # The flow's memory is area/(nu F/(mu U)), F/(mu U) about 13 at a solid fraction of 0.03: 0.074 s.  After 16000
    # steps of 4e-5 s 2e-4 of it is left.
    simulation.advance(16000)
    row = simulation.tables()["loads"]
    # Nothing else holds the fluid.  The force acts on (1 - B) of every cell, B between 0 and the solid fraction: on an
    # area between that of the box and that less the disc's, 1.7 % to either side of the middle.
    area, disc = 0.012 * 0.008, math.pi * 0.001**2
    assert row["disc 0 force x (N/m)"] == pytest.approx(10 * (area - disc / 2), rel=0.018)
    assert abs(row["disc 0 force y (N/m)"]) < 1e-9 * row["disc 0 force x (N/m)"]
    unit = 0.5 * 1000 * 0.01**2 * 0.002
    assert row["disc 0 drag coefficient ()"] == pytest.approx(row["disc 0 force x (N/m)"] / unit, rel=1e-14)


@pytest.mark.parametrize(("left_out", "tables"), [("probe", {"flux", "loads"}), ("flux", {"probes", "loads"}),
                                                  ("loads", {"probes", "flux"})])  # fmt: skip
def test_an_absent_instrument_writes_no_table(left_out, tables):
    assert build(water(**MEASURED)).tables().keys() == {"probes", "flux", "loads"}
    assert build(water(**{**MEASURED, left_out: None})).tables().keys() == tables


def test_without_instruments_nothing_is_measured(monkeypatch):
    from porescale.builders.parts import flow_fields, flow_instruments

    def refuse(*args: Any, **options: Any) -> None:
        raise AssertionError("measured")

    monkeypatch.setattr(flow_instruments.FlowInstruments, "tables", refuse)
    monkeypatch.setattr(flow_fields, "stream_function", refuse)
    monkeypatch.setattr(flow_fields, "vorticity", refuse)
    plain = build(water())
    plain.advance(2)
    assert plain.tables() == {}
    assert plain.snapshot().grids["fields"].cells.keys() == {"velocity", "pressure"}
    assert build(dry()).tables() == {}
    with pytest.raises(AssertionError, match="measured"):  # the twin: with one, it is
        build(water(**MEASURED)).tables()


def test_tables_and_lines_of_a_run_are_files(tmp_path):
    scene = water(**MEASURED, output__fields=["vorticity", "stream_function"], time__end=0.008)
    drive(build(scene), tmp_path, 0.008, snapshot_interval=0.004, series_interval=0.001,
          card={"scene": scene_as_dict(scene)}, quiet=True)  # fmt: skip
    run = open_run(tmp_path)
    assert len(run.table("probes")["tap pressure (Pa)"]) == len(run.series["time (s)"]) == 9
    assert run.table("loads")["time (s)"].tolist() == run.series["time (s)"].tolist()
    assert run.table("nothing") == {}
    assert {"vorticity", "stream_function"} <= run.snapshot(-1).grids["fields"].cells.keys()
    assert write_lines(run, tmp_path) == [tmp_path / "lines.csv"]
    lines = run.table("lines")
    assert len(lines["time (s)"]) == 3 * 5
    last = lines["velocity x (m/s)"][-5:]
    assert last[2] == pytest.approx(run.snapshot(-1).grids["fields"].cells["velocity"][19:21, 29:31, 0].mean())


def test_permeability_of_a_square_array_is_what_its_drag_says():
    # Stokes drag F/(mu U) = 51.53 at c = 0.2, so K = L²/51.53: within 2 % at ten cells anywhere in a cell.
    size = 20.0
    radius = size * math.sqrt(0.2 / math.pi)
    place = np.array([[10.3, 10.1]])
    box = {"periodic": (True, True), "direction": "x"}
    found = measure(place, np.array([radius]), (0.0, 0.0), (size, size), 1.0, **box)
    exact = size**2 / 51.53
    assert found.steady
    assert found.permeability == pytest.approx(exact, rel=0.02)
    assert found.solid_fraction == pytest.approx(0.2, rel=1e-12)
    assert found.cells == 2 * radius
    upward = measure(
        place[:, ::-1], np.array([radius]), (0.0, 0.0), (size, size), 1.0, direction="y", periodic=(True, True)
    )
    assert upward.permeability == pytest.approx(found.permeability, rel=1e-12)  # the same cells, transposed
    smaller = measure(place, np.array([0.9 * radius]), (0.0, 0.0), (size, size), 1.0, **box)
    assert smaller.permeability > 1.2 * found.permeability  # the twin that must fail


def test_held_discs_alone_have_a_permeability(tmp_path, monkeypatch):
    # The array above, four times, of discs that a scene holds, 5 cells across.
    size, c = 0.002, 0.2
    diameter = 2.0 * size * math.sqrt(c / math.pi)
    held = [{"x": (i + 0.51) * size, "y": (j + 0.5) * size, "diameter": diameter} for i in (0, 1) for j in (0, 1)]
    box = {"domain__width": 2 * size, "domain__height": 2 * size, "domain__top": "periodic"}
    window = {"left": 0.0, "bottom": 0.0, "width": 2 * size, "height": 2 * size}
    scene = water(disc=held, **box, domain__bottom="periodic", permeability={"window": window, "direction": "x"},
                  time__end=0.004)  # fmt: skip
    drive(build(scene), tmp_path, 0.004, snapshot_interval=0.004, series_interval=0.004,
          card={"scene": scene_as_dict(scene)}, quiet=True)  # fmt: skip
    run = open_run(tmp_path)
    assert write_permeability(run, tmp_path) == [tmp_path / "permeability.csv"]
    found = run.table("permeability")
    # 2 % at ten cells, at first order 4 % at five.
    assert found["permeability (m²)"] == pytest.approx([size**2 / 51.53] * 2, rel=0.05)
    assert found["hydraulic solid fraction ()"] == pytest.approx([c] * 2, rel=1e-6)

    # The bed may leave its window in a run: its end is said, and the run is not lost.
    full = run.snapshot(0).clouds["grains"]
    empty = replace(full, position=full.position[:0], data={key: value[:0] for key, value in full.data.items()})
    clouds = [full, empty]
    monkeypatch.setattr(run, "snapshot", lambda k, **_: SimpleNamespace(time=0.004 * k, clouds={"grains": clouds[k]}))
    with pytest.warns(PorescaleWarning, match=r"no permeability at t = 0.004 s: permeability.window: holds no grain"):
        assert write_permeability(run, tmp_path) == [tmp_path / "permeability.csv"]
    assert open_run(tmp_path).table("permeability")["time (s)"].tolist() == [0.0]
    clouds[0] = empty
    with pytest.warns(PorescaleWarning, match="no permeability at t = 0"):
        assert write_permeability(run, tmp_path) == []


def test_a_window_of_an_array_has_the_permeability_of_the_array():
    # The window's faces cut discs wherever they fall; what is left of them is a diameter away from where the gradient
    # is taken, and a position within the cells, for which single ones differ by up to 3 %.  Flanks leave no sliver of a
    # disc here: one that is a cell deep, at 3, lets 10 % more through.
    size, n = 14.0, 10
    radius = size * math.sqrt(0.4 / math.pi)
    grid = np.array([[(i + 0.5) * size, (j + 0.5) * size] for i in range(-1, n) for j in range(-1, n)])
    whole = measure(grid[:1] + size, np.array([radius]), (0.0, 0.0), (size, size), 1.0, periodic=(True, True))
    part = measure(grid, np.full(len(grid), radius), (4.5, 4.0), (4.5 + 3 * size, 4.0 + 8 * size), 1.0)
    assert part.permeability == pytest.approx(whole.permeability, rel=0.05)
    with pytest.raises(InputError, match="diameters long"):
        measure(grid, np.full(len(grid), radius), (3.0, 4.0), (3.0 + 3 * size, 4.0 + 2 * size), 1.0)
    with pytest.raises(InputError, match="holds no grain"):
        measure(grid + 1e4, np.full(len(grid), radius), (0.0, 0.0), (50.0, 80.0), 1.0)


def test_the_bed_beside_a_window_is_its_mirror_image_or_a_wall():
    # Slip flanks are mirrors: the same cells as a period that holds the mirror image, up to where each run is called
    # steady, 2e-5 of the flux a block.  Walls hold back what flows along them.
    size, radius = 16.0, 5.0
    disc = np.array([[8.2, 7.1]])
    image = np.array([[8.2, -7.1]])
    beside = measure(disc, np.array([radius]), (0.0, 0.0), (size, size), 1.0, direction="x", periodic=(True, False))
    both = np.concatenate([disc, image]) + np.array([0.0, size])
    whole = measure(both, np.full(2, radius), (0.0, 0.0), (size, 2 * size), 1.0, direction="x", periodic=(True, True))
    assert beside.permeability == pytest.approx(whole.permeability, rel=1e-4)
    walled, one = (
        measure(disc, np.array([radius]), (0.0, 0.0), (size, size), 1.0, direction="x", periodic=(True, False), walls=w)
        for w in ((True, True), (True, False))
    )
    assert walled.permeability < one.permeability < 0.9 * beside.permeability


def test_formulas_of_beds():
    # Gebart 1992: 16/(9 pi sqrt 2) (sqrt(pi/(4 c)) - 1)^2.5 at c = 0.5: 0.40 * 0.2533^2.5; closed where discs touch.
    assert gebart(0.5) == pytest.approx(0.40013 * (math.sqrt(math.pi / 2) - 1) ** 2.5, rel=1e-4)
    assert gebart(math.pi / 4) == 0.0
    assert gebart(0.8) == 0.0
    assert gebart(0.8, hexagonal=True) > 0
    assert kozeny_carman(0.5) == pytest.approx(0.125 / 5, rel=1e-15)


def slow_mean(values: Any, solid: Any, corners: Any, spacing: float, parts: int = 40) -> tuple[float, float]:
    """Share of fluid and mean by ``parts`` x ``parts`` points in each cell, for corners on their grid."""
    (x0, y0), (x1, y1) = corners
    fine = np.kron(values, np.ones((parts, parts))), np.kron(1 - solid, np.ones((parts, parts)))
    y, x = ((np.indices(fine[0].shape) + 0.5) * spacing / parts).reshape(2, *fine[0].shape)
    inside = (x > x0) & (x < x1) & (y > y0) & (y < y1)
    free = fine[1][inside]
    return float(free.mean()), float((free * fine[0][inside]).sum() / free.sum())


@pytest.mark.parametrize("corners", [((1.0, 1.0), (3.0, 2.0)), ((0.55, 0.2), (3.375, 2.85)), ((2.1, 1.2), (2.4, 1.3))])
def test_a_mean_over_a_rectangle_weighs_the_fluid_in_it(corners):
    random = np.random.default_rng(1)
    values, solid = random.normal(size=(3, 4)), random.uniform(size=(3, 4)).round(1)
    share, mean = RectangleMean(*corners, (4, 3), 1.0).of(solid, values)
    exact = slow_mean(values, solid, corners, 1.0)
    # Corners lie on the fine grid: sums of a few thousand numbers of order one.
    assert (share, mean) == pytest.approx(exact, rel=1e-12)
    plain = slow_mean(values, 0 * solid, corners, 1.0)[1]
    assert abs(plain - mean) > 1e-3 or (np.ptp(corners, axis=0) < 1).all()  # the twin: the solid is not left out


def test_a_mean_where_all_is_solid_is_no_number():
    share, mean = RectangleMean((0.5, 0.5), (2.5, 1.5), (4, 3), 1.0).of(np.ones((3, 4)), np.ones((3, 4)))
    assert share == 0.0
    assert math.isnan(mean)


def test_the_mean_pore_pressure_of_water_at_rest_is_that_of_the_rectangle_s_centre():
    still = {"domain__left": "wall", "domain__right": "wall", "fluid__body_force": None, "gravity": [3.0, -9.81]}
    x, y, width, height = 0.00371, 0.00333, 0.00417, 0.00259  # cuts cells on all sides
    probe = {"name": "pore", "x": x, "y": y, "width": width, "height": height}
    model = build(water(**still, probe=[probe, {"x": x, "y": y}]))
    row = model.tables()["probes"]
    assert list(row) == [
        "time (s)", "probe 1 pressure (Pa)", "probe 1 velocity x (m/s)", "probe 1 velocity y (m/s)",
        "pore mean pressure (Pa)", "pore mean velocity x (m/s)", "pore mean velocity y (m/s)", "pore fluid share ()",
    ]  # fmt: skip
    exact = 1000 * (9.81 * (0.008 - y) + 3.0 * x)
    # The lattice is at rest to a rounding of its density: 1e-15 of rho c_s² = 8.3e3 Pa a cell.
    assert row["pore mean pressure (Pa)"] == pytest.approx(exact, abs=1e-10 * 8.3e3)
    assert row["pore fluid share ()"] == 1.0
    assert row["probe 1 pressure (Pa)"] == pytest.approx(exact, abs=1e-10 * 8.3e3)
    # The twin: a tenth of a cell further up is seen.
    assert abs(row["pore mean pressure (Pa)"] - exact - 9.81e3 * 2e-5) > 0.1


def test_the_fluid_share_leaves_a_disc_out_exactly():
    probe = {"x": 0.004, "y": 0.004, "width": 0.0032, "height": 0.0028}
    row = build(water(disc=[DISC], gravity=[0.0, 0.0], probe=[probe])).tables()["probes"]
    # Areas of cells are exact to 16 roundings of the radius squared, 25 cells; a hundred cells are summed.
    assert row["probe 0 fluid share ()"] == pytest.approx(1 - math.pi * 0.001**2 / (0.0032 * 0.0028), abs=1e-11)
    assert row["probe 0 mean pressure (Pa)"] == pytest.approx(0.0, abs=1e-9)


def test_a_rectangle_needs_both_sides_and_lies_in_the_box():
    def said(**probe: Any) -> list[str]:
        with pytest.raises(InputError) as caught:
            water(probe=[{"x": 0.004, "y": 0.004, **probe}])
        return [it.line() for it in caught.value.faults]

    assert said(width=0.001)[0].startswith("probe[0].height: a rectangle needs both")
    assert said(width=0.001, height=0.01)[0].startswith("probe[0] = '(0.0035, -0.001)': is outside the box")
    water(probe=[{"x": 0.004, "y": 0.004, "width": 0.001, "height": 0.008}])  # the twin


def test_a_line_is_in_its_table_by_its_number_and_its_name_is_said_to_be_a_note():
    said = {it: it.model_fields["name"].description or "" for it in (Line, Flux)}
    assert "number of a line" in said[Line]
    assert "name in the columns" in said[Flux]  # the twin

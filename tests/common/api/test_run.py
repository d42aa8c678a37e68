"""A run in Python: its snapshots, tables and arrays are those of the files, read when they are used and no sooner."""

import subprocess
import sys
import tracemalloc

import numpy as np
import pytest

import porescale
from porescale.common.core.errors import InputError
from porescale.common.record import card as cards
from porescale.common.record import series, snapshots, vtkhdf
from porescale.common.record.model import Cloud, Grid, Snapshot

NY, NX, DX = 6, 8, 1e-3
SCENE = {"domain": {"width": 0.01, "height": 0.013}, "output": {}, "title": "Numbers"}
COUNTS = (3, 3, 5, 4)
"""Tracers of each snapshot."""


def snapshot(k: int, ny: int = NY, nx: int = NX) -> Snapshot:
    """Numbers that name their snapshot, row, column and component."""
    rows, columns = np.mgrid[:ny, :nx].astype(np.float32)
    velocity = np.stack([k + 0.1 * rows, columns, 0 * rows], -1).astype(np.float32)
    cells = {"velocity": velocity, "pressure": 1000.0 * k + rows}
    grid = Grid((0.002, 0.001), (DX, 2 * DX), cells, {"velocity": "m/s", "pressure": "Pa"})
    at = np.arange(6.0).reshape(3, 2) * DX + k
    motion = np.column_stack([np.full((3, 2), float(k)), np.zeros(3)])
    grains = Cloud(at, {"radius": np.full(3, DX), "velocity": motion}, {"radius": "m", "velocity": "m/s"})
    n = COUNTS[k % len(COUNTS)]
    bubbles = Cloud(np.full((n, 2), float(k)), {"number": np.arange(n, dtype=np.int32) + 10 * k})
    return Snapshot(0.5 * k, 100 * k, {"fields": grid}, {"bubbles": bubbles, "grains": grains})


@pytest.fixture
def folder(tmp_path):
    """A finished run of four snapshots, with a series and a table, joined but for the last snapshot."""
    card = cards.new_card({"package": "porescale", "name": "numbers", "scene": SCENE, "tables": ["loads"]})
    cards.write_card(tmp_path, card | {"outcome": "finished", "time": 1.5})
    for name, column in (("series", "front (m)"), ("loads", "disc 0 force x (N/m)")):
        table = series.Series(tmp_path / f"{name}.csv")
        for k in range(11):
            table.append({"time (s)": 0.15 * k, column: 0.1 * k**2, "Mach number ()": 0.01 * k})
        table.close()
    for k in range(4):
        snapshots.write_part(tmp_path, snapshot(k))
        if k == 2:
            snapshots.assemble(tmp_path)
    return tmp_path


@pytest.fixture
def run(folder):
    return porescale.open_run(folder)


def test_grids_and_clouds_say_their_arrays():
    shown = snapshot(0)
    assert set(shown["grains"]) == {"position", "radius", "velocity"}
    assert list(shown["fields"]) == ["velocity", "pressure"]
    assert all(len(shown["grains"][name]) == 3 for name in shown["grains"])


def test_snapshots_by_number_slice_and_in_turn(run):
    assert len(run) == 4
    assert run[-1].step == run[3].step == 300
    assert [it.time for it in run] == run.times.tolist() == [0.0, 0.5, 1.0, 1.5]
    assert [it.step for it in run[1:3]] == [100, 200]
    assert [it.step for it in run[::-2]] == [300, 100]
    assert np.array_equal(run[2]["velocity"], snapshot(2).grids["fields"].cells["velocity"])
    assert np.array_equal(run[2]["grains"]["velocity"], snapshot(2).clouds["grains"].data["velocity"])
    with pytest.raises(IndexError, match=r"snapshot 4 is not in this run: it has 4 \(0 to 3\)"):
        run[4]
    with pytest.raises(KeyError, match=r"array = 'velociti': is not in this snapshot; did you mean 'velocity'\?"):
        run[0]["velociti"]


def test_one_snapshot_reads_no_other(run, monkeypatch):
    read = []
    whole = vtkhdf.Reader.frame
    monkeypatch.setattr(
        vtkhdf.Reader, "frame", lambda self, index, *rest: read.append(index) or whole(self, index, *rest)
    )
    run[1]
    assert set(read) == {1}
    list(run)  # the check that must fail: this reads the others
    assert set(read) > {1}


def test_what_is_said_of_a_run_is_short(run):
    last = run[-1]
    for it in (run, last, last["fields"], last["grains"], run.series, run.table("loads"), run.picture()):
        assert len(repr(it).splitlines()) <= 3
        assert max(map(len, repr(it).splitlines())) <= 200
    assert "finished at t = 1.5 s" in repr(run)
    assert "4 snapshots, t = 0 to 1.5 s" in repr(run)
    assert "tables: series, loads" in repr(run)
    assert "fields 6 x 8 (" in repr(last)
    assert "pressure (Pa)" in repr(last["fields"])
    # The check that must fail: a dataclass says all that it holds.
    assert len(repr(vars(last["fields"])).splitlines()) > 3


def test_tables_are_mappings_that_name_the_nearest_column(run):
    assert run.tables == ["series", "loads"]
    assert list(run.series) == run.series._ipython_key_completions_() == ["time (s)", "front (m)", "Mach number ()"]
    assert run.series["front (m)"][-1] == 10.0
    assert dict(run.series).keys() == run.series.keys()
    assert "frnt (m)" not in run.series
    assert run.series.get("frnt (m)") is None
    with pytest.raises(InputError, match=r"^column = 'frnt \(m\)': is not in series; did you mean 'front \(m\)'\?$"):
        run.series["frnt (m)"]
    with pytest.raises(InputError, match=r"table = 'load': is not in the run folder; did you mean 'loads'\?"):
        run.table("load")
    for row in ("0.1,grain 3\n", ""):  # not numbers, also where nothing broke
        (run.folder / "breaks.csv").write_text(f"time (s),body ()\n{row}")
        assert run.tables == ["series", "loads"]
    with pytest.raises(InputError, match=r"table = 'break': is not in the run folder; did you mean 'breaks'\?"):
        run.table("break")


def test_a_table_with_names_of_bodies_is_read(run):
    (run.folder / "breaks.csv").write_text("time (s),strength (N/m),body ()\n0.1,2.5,grain 3\n0.2,2.5,polygon 11\n")
    breaks = run.table("breaks")
    assert breaks["body ()"].tolist() == ["grain 3", "polygon 11"]
    assert breaks["time (s)"].tolist() == [0.1, 0.2]
    assert "polygon 11" in breaks._repr_html_()
    (run.folder / "breaks.csv").write_text("time (s),strength (N/m),body ()\n0.1,grain 3,grain 3\n")
    with pytest.raises(InputError, match=r"line 2: is damaged"):  # a word among numbers is still refused
        run.table("breaks")


def test_tables_become_data_frames(run):
    frame = run.table("loads").to_pandas()
    assert frame.index.name == "time (s)"
    assert frame.index.tolist() == run.table("loads")["time (s)"].tolist()
    assert frame["disc 0 force x (N/m)"].tolist() == run.table("loads")["disc 0 force x (N/m)"].tolist()


def test_arrays_of_all_snapshots_have_places_and_units(run):
    data = run.xarray(["velocity"])
    assert data.velocity.dims == ("time", "y", "x", "component")
    assert list(data) == ["velocity"]
    assert data.velocity.attrs == {"units": "m/s"}
    assert data.time.attrs == data.step.attrs | {"units": "s"}
    assert data.x.values[[0, -1]] == pytest.approx([0.0025, 0.0095])
    assert data.y.values[[0, -1]] == pytest.approx([0.002, 0.012])
    whole = np.stack([it["velocity"][..., :2] for it in run])
    assert np.array_equal(data.velocity.values, whole)
    assert not np.array_equal(data.velocity.values, whole[::-1])  # the check that must fail
    part = data.velocity.isel(time=[3, 1], y=slice(None, None, -2), x=[5, 2], component=0)
    assert np.array_equal(part.values, whole[[3, 1]][:, ::-2][:, :, [5, 2], 0])
    assert float(data.velocity.sel(time=1.0, component="y").sel(x=0.0095, y=0.002, method="nearest")) == 7.0
    assert run.xarray().sizes == {"time": 4, "y": NY, "x": NX, "component": 2}
    assert run.xarray("pressure").pressure.dims == ("time", "y", "x")


def test_arrays_of_clouds_are_filled_up_where_points_come_and_go(run):
    grains = run.xarray(["velocity"], of="grains")
    assert grains.velocity.dims == ("time", "point", "component")
    assert np.array_equal(grains.x.values, np.stack([it["grains"].position[:, 0] for it in run]))
    assert run.xarray(["radius"]).radius.dtype == np.float64
    numbers = run.xarray(["number"]).number
    assert numbers.shape == (4, 5)
    assert np.isnan(numbers.values).sum(axis=1).tolist() == [2, 2, 0, 1]
    assert numbers.values[3, :4].tolist() == [30, 31, 32, 33]
    with pytest.raises(InputError, match="arrays = 'velocity, number': are not of one grid or cloud"):
        run.xarray(["velocity", "number"])
    with pytest.raises(InputError, match=r"array = 'velocit': is not in the snapshots; did you mean 'velocity'\?"):
        run.xarray(["velocit"])
    with pytest.raises(InputError, match=r"did you mean 'grains'\?"):
        run.xarray(["velocity"], of="grain")


def test_a_selection_reads_its_snapshots_alone_and_keeps_one_in_memory(tmp_path):
    ny, nx, count = 200, 300, 20
    cards.write_card(tmp_path, cards.new_card({"package": "porescale", "name": "long", "scene": SCENE}))
    for k in range(count):
        snapshots.write_part(tmp_path, snapshot(k, ny, nx))
    snapshots.assemble(tmp_path)
    run = porescale.open_run(tmp_path)
    data = run.xarray(["velocity"])
    data.velocity.isel(time=0).load()  # what is imported once
    one = ny * nx * 3 * 4  # bytes of the array of a snapshot

    def peak(work) -> int:
        tracemalloc.start()
        work()
        found = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return found

    def means() -> None:
        for k in range(count):
            float(data.velocity.isel(time=k, component=0).mean())

    # The array read, its component, and what a mean in double precision needs: five times one snapshot at most.
    assert peak(means) < 5 * one
    assert peak(data.velocity.load) > 10 * one  # the check that must fail: all of them, kept


def test_blocks_for_vtk_hold_arrays_and_units(run):
    blocks = run.vtk(3)
    assert blocks.keys() == ["fields", "grains", "bubbles"]
    fields, grains = blocks["fields"], blocks["grains"]
    assert fields.bounds[:4] == pytest.approx((0.002, 0.010, 0.001, 0.013))
    cell = fields.find_containing_cell((0.0095, 0.0021, 0.0))
    assert fields.cell_data["velocity"][cell].tolist() == [3.0, 7.0, 0.0]
    assert grains.n_cells == grains.n_points == 3
    assert np.array_equal(grains.points[:, :2], run[3]["grains"].position)
    assert grains.user_dict["units"] == {"radius": "m", "velocity": "m/s"}
    array = fields.GetCellData().GetAbstractArray("velocity")
    assert array.GetInformation().Get(array.UNITS_LABEL()) == "m/s"
    assert fields.field_data["TimeValue"] == [1.5]
    assert run.vtk(0)["fields"].cell_data["velocity"][cell].tolist() != [3.0, 7.0, 0.0]  # the check that must fail


def test_a_plot_has_labels_with_units(run):
    axes = run.plot("front (m)")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time (s)", "front (m)")
    assert np.array_equal(axes.lines[0].get_xydata()[:, 1], run.series["front (m)"])
    both = run.plot("front (m)", "Mach number ()")
    assert [it.get_ylabel() for it in both] == ["front (m)", "Mach number"]
    again = run.plot("disc 0 force x (N/m)", ax=axes, table="loads")
    assert again is axes
    assert len(axes.lines) == 2
    with pytest.raises(InputError, match=r"did you mean 'front \(m\)'\?"):
        run.plot("frnt (m)")
    with pytest.raises(InputError, match="have different units: m and none"):
        run.plot("front (m)", "Mach number ()", ax=axes)
    with pytest.raises(InputError, match="none named"):
        run.plot()


def test_notebooks_show_pictures_tables_and_films(run, tmp_path):
    from porescale.common.pictures.picture import png

    picture = run.picture(1)
    assert picture._repr_png_() == png(picture.pixels) == run[1]._repr_png_()
    assert run._repr_png_() == run[-1]._repr_png_() != picture._repr_png_()
    assert picture.save(tmp_path / "one.png").read_bytes() == picture._repr_png_()
    assert run._repr_html_().count("data:image/png;base64,") == 1
    assert "front (m)" in run.series._repr_html_()
    assert run.series._repr_html_().count("<tr>") == 1 + 4 + 1 + 4
    assert "<td>Pa</td>" in run[0]._repr_html_()
    film = run.film()
    assert film.path.parent == run.folder
    assert film.path.read_bytes()
    assert film._repr_html_().startswith("<video")
    assert run.film(tmp_path / "other" / "name.mp4").path.stem == "name"
    assert run.folder / "final.png" in run.show()


@pytest.mark.parametrize(
    ("use", "said"),
    [
        (lambda run: run.picture(size="85 mm"), "size = '85 mm': is no number of pixels"),
        (lambda run: run.picture(size=300.5), "size = 300.5: is out of range .allowed: whole, 200 to 8000"),
        (lambda run: run.picture(arrows="5"), "arrows = '5': is out of range .allowed: whole, 0 to 500"),
        (lambda run: run.picture(times=[0.0]), "argument = 'times': is not in those of pictures"),
        (lambda run: run.film(fps=10), "argument = 'fps': .*known arguments: .*rate"),
        (lambda run: run.figure(against="runs/other"), "against = 'runs/other': is no run"),
        (lambda run: run.picture().save("picture.jpg"), "path = 'picture.jpg': is not that of a PNG file"),
        (lambda run: run.plot(["front (m)"]), "is no name but list"),
    ],
)
def test_words_that_a_picture_cannot_follow_are_refused(run, use, said):
    with pytest.raises(InputError, match=said):
        use(run)


def test_sizes_of_numpy_are_sizes(run):
    assert run.picture(size=np.int64(300)).pixels.shape == run.picture(size=300).pixels.shape
    assert run.picture(size=300).pixels.shape != run.picture().pixels.shape  # the check that must fail


def test_what_a_missing_library_says(run, monkeypatch):
    for library, use in (("pandas", run.series.to_pandas), ("xarray", run.xarray), ("pyvista", run.vtk)):
        use()
        with monkeypatch.context() as patch:
            patch.setitem(sys.modules, library, None)
            with pytest.raises(
                InputError, match=rf"^{library}: is not installed; pip install 'porescale\[notebook\]'$"
            ):
                use()


def test_opening_a_run_imports_no_extra(folder):
    told = (
        f"import sys, porescale; run = porescale.open_run({str(folder)!r}); repr(run), repr(run[-1]), repr(run.series);"
        "print(*{'pandas', 'xarray', 'pyvista', 'vtk', 'matplotlib', 'numba'} & set(sys.modules))"
    )
    found = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True, timeout=100)
    assert found.stdout.split() == []
    told += "; run.series.to_pandas(); print('pandas' in sys.modules)"  # the check that must fail
    found = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True, timeout=100)
    assert found.stdout.split() == ["True"]


def test_a_run_without_snapshots_says_so(tmp_path):
    cards.write_card(tmp_path, cards.new_card({"package": "porescale", "name": "none", "scene": SCENE}))
    run = porescale.open_run(tmp_path)
    assert "no snapshots" in repr(run)
    assert run._repr_png_() is None
    assert "no snapshots" in run._repr_html_()
    for use in (run.xarray, run.film):
        with pytest.raises(InputError, match="no snapshots"):
            use()
    with pytest.raises(IndexError, match="it has 0"):
        run[-1]

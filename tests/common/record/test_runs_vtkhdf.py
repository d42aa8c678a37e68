"""Snapshots on disk: VTK reads what was written, bit by bit, at every time step."""

import shutil

import h5py
import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

from porescale.common.record import snapshots, vtkhdf
from porescale.common.record.model import Cloud, Grid, Snapshot
from porescale.common.record.open_run import Run

COUNTS = [3, 0, 0, 7, 7]


def snapshot(k: int) -> Snapshot:
    """Random bits, other ones for every k; the number of points changes and may be nought."""
    random, n = np.random.default_rng(k), COUNTS[k % 5]
    cells = {
        "velocity": random.normal(size=(4, 6, 3)).astype(np.float32),
        "pressure": random.normal(size=(4, 6)),
        "grain": random.integers(-3, 9, (4, 6)),
    }
    grid = Grid((0.1, -0.2), (1e-3, 2e-3), cells, {"velocity": "m/s", "pressure": "Pa"})
    data = {"radius": random.random(n), "velocity": random.random((n, 3)), "name": np.arange(n, dtype=np.int32)}
    cloud = Cloud(random.random((n, 2)), data, {"radius": "m", "velocity": "m/s"})
    return Snapshot(0.1 * k + 0.03, 10 * k, {"fields": grid}, {"grains": cloud})


@pytest.fixture
def folder(tmp_path):
    for k in range(5):
        snapshots.write_part(tmp_path, snapshot(k))
        if k == 2:
            snapshots.assemble(tmp_path)
    snapshots.assemble(tmp_path)
    return tmp_path


def test_snapshots_one_after_the_other_are_those_by_themselves(folder):
    run = Run(folder, {}, snapshots.catalogue(folder))
    for k, found in zip((4, 1, 3), run.snapshots(numbers=(4, 1, 3)), strict=True):
        alone = run.snapshot(k)
        assert (found.time, found.step) == (alone.time, alone.step) == (snapshot(k).time, snapshot(k).step)
        for (_, _, one), (_, _, other) in zip(found.blocks(), alone.blocks(), strict=True):
            assert list(one) == list(other)
            assert one.units == other.units
            assert all(np.array_equal(one[name], other[name]) for name in one)


def test_a_file_is_open_no_longer_than_its_snapshots_are_read(folder):
    some = Run(folder, {}, snapshots.catalogue(folder)).snapshots()
    next(some)
    with pytest.raises(OSError, match="open"):  # the twin: it is open here
        h5py.File(folder / "fields.vtkhdf", "r+")
    some.close()
    h5py.File(folder / "fields.vtkhdf", "r+").close()


def at_each_step(path):
    """What VTK makes of a file, one output per time step."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 5
    for k in range(5):
        reader.SetStep(k)
        reader.Update()
        assert reader.GetTimeValue() == snapshot(k).time
        yield k, reader.GetOutputDataObject(0)


def same(vtk_array, array):
    return vtk_to_numpy(vtk_array).tobytes() == np.ascontiguousarray(array).tobytes()


def test_vtk_reads_the_grids_bit_by_bit(folder):
    for k, image in at_each_step(folder / "fields.vtkhdf"):
        grid = snapshot(k).grids["fields"]
        assert image.GetDimensions() == (7, 5, 1)
        assert image.GetOrigin() == (0.1, -0.2, 0.0)
        assert image.GetSpacing() == (1e-3, 2e-3, 1.0)
        assert image.GetCellData().GetNumberOfArrays() == 3
        for name, array in grid.cells.items():
            assert same(image.GetCellData().GetArray(name), array)
            assert not same(image.GetCellData().GetArray(name), snapshot(k + 1).grids["fields"].cells[name])


def test_vtk_reads_the_clouds_bit_by_bit(folder):
    for k, points in at_each_step(folder / "grains.vtkhdf"):
        cloud, n = snapshot(k).clouds["grains"], COUNTS[k]
        assert points.GetNumberOfPoints() == points.GetNumberOfVerts() == points.GetNumberOfCells() == n
        if n:
            assert same(points.GetPoints().GetData(), np.pad(cloud.position, ((0, 0), (0, 1))))
            assert [points.GetCell(i).GetPointId(0) for i in range(n)] == list(range(n))
            for name, array in cloud.data.items():
                assert same(points.GetPointData().GetArray(name), array)


def test_every_dataset_has_a_unit_and_frames_are_protected(folder):
    def look(name, item):
        if isinstance(item, h5py.Dataset):
            assert item.attrs["units"]
            assert item.fletcher32 or item.size == 0

    for name in ("fields", "grains"):
        with h5py.File(folder / f"{name}.vtkhdf", "r") as file:
            file.visititems(look)
    with h5py.File(folder / "fields.vtkhdf", "r") as file:
        velocity = file["VTKHDF/CellData/velocity"]
        assert velocity.attrs["units"] == "m/s"
        assert velocity.chunks == (1, 4, 6, 3)


def assert_is(loaded, expected):
    assert (loaded.step, loaded.time) == (expected.step, expected.time)
    for name, grid in expected.grids.items():
        assert loaded.grids[name].extent == grid.extent
        for key, array in grid.cells.items():
            assert loaded.grids[name].cells[key].tobytes() == array.tobytes()
    for name, cloud in expected.clouds.items():
        assert loaded.clouds[name].position.tobytes() == cloud.position.tobytes()
        assert all(loaded.clouds[name].data[key].tobytes() == array.tobytes() for key, array in cloud.data.items())


def assert_holds(folder, steps):
    found = snapshots.catalogue(folder)
    assert list(found) == steps
    for step, entry in found.items():
        assert_is(snapshots.load(entry, step), snapshot(step // 10))


def test_parts_and_joined_files_hold_the_same(tmp_path):
    for k in range(4):
        snapshots.write_part(tmp_path, snapshot(k))
    assert_holds(tmp_path, [0, 10, 20, 30])
    snapshots.assemble(tmp_path)
    assert not (tmp_path / "parts").exists()
    assert_holds(tmp_path, [0, 10, 20, 30])


def test_a_kill_while_joining_loses_and_doubles_nothing(tmp_path):
    for k in range(3):
        snapshots.write_part(tmp_path, snapshot(k))
    shutil.copytree(tmp_path / "parts", tmp_path / "kept")
    snapshots.assemble(tmp_path)
    # Killed after the first file was in place: the parts are still there, one joined file is missing.
    (tmp_path / "kept").rename(tmp_path / "parts")
    (tmp_path / "grains.vtkhdf").unlink()
    assert_holds(tmp_path, [0, 10, 20])
    snapshots.assemble(tmp_path)
    assert_holds(tmp_path, [0, 10, 20])


@pytest.mark.parametrize("joined", [0, 2, 4])
def test_snapshots_after_the_checkpoint_are_forgotten(tmp_path, joined):
    for k in range(4):
        snapshots.write_part(tmp_path, snapshot(k))
        if k + 1 == joined:
            snapshots.assemble(tmp_path)
    snapshots.trim(tmp_path, 15)
    assert_holds(tmp_path, [0, 10])
    snapshots.write_part(tmp_path, snapshot(2))
    snapshots.assemble(tmp_path)
    assert_holds(tmp_path, [0, 10, 20])
    snapshots.trim(tmp_path, -1)
    assert snapshots.catalogue(tmp_path) == {}


def test_a_folder_in_place_of_a_file_is_said_with_its_name(tmp_path):
    (tmp_path / "fields.vtkhdf").mkdir()
    with pytest.raises(IsADirectoryError) as caught:
        snapshots.trim(tmp_path, 15)
    assert str(caught.value.filename) == str(tmp_path / "fields.vtkhdf")


def test_only_the_arrays_asked_for_are_read(folder):
    entry = snapshots.catalogue(folder)[20]
    assert list(snapshots.load(entry, 20, ("pressure",)).grids["fields"].cells) == ["pressure"]


@pytest.mark.parametrize(
    ("block", "problem"),
    [
        (Grid((0, 0), (1, 1), {"a.b": np.zeros((2, 2))}), "neither"),
        (Grid((0, 0), (1, 1), {"a/b": np.zeros((2, 2))}), "neither"),
        (Grid((0, 0), (1, 1), {"a": np.zeros((2, 2)), "b": np.zeros((2, 3))}), "shape"),
        (Grid((0, 0), (1, 1), {"a": np.zeros((2, 2), complex)}), "complex"),
        (Cloud(np.zeros((4, 2)), {"a": np.zeros(3)}), "shape"),
        (Cloud(np.zeros((4, 2)), {"a": np.zeros((4, 2))}), "shape"),
    ],
)
def test_what_a_file_cannot_hold_is_refused_and_nothing_written(tmp_path, block, problem):
    with pytest.raises(ValueError, match=problem):
        vtkhdf.write_frame(tmp_path / "x.vtkhdf", "x", block, 0, 0.0)
    assert list(tmp_path.iterdir()) == []


def test_flags_and_half_floats_become_types_that_vtk_knows(tmp_path):
    cells = {"on": np.eye(2, dtype=bool), "half": np.eye(2, dtype=np.float16)}
    vtkhdf.write_frame(tmp_path / "x.vtkhdf", "x", Grid((0, 0), (1, 1), cells), 0, 0.0)
    with vtkhdf.Readers() as readers:
        read = readers.of("x", tmp_path / "x.vtkhdf").frame(0)
    assert isinstance(read, Grid)
    assert read.cells["on"].dtype == np.uint8
    assert read.cells["half"].dtype == np.float32
    np.testing.assert_array_equal(read.cells["on"], np.eye(2))

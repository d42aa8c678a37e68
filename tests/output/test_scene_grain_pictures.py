"""Pictures of a pile's inside: a line a contact, as wide as its force, where its discs are; files for each."""

from typing import Any

import numpy as np
import pytest
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from porescale.builders.build import build
from porescale.common.pictures.look import Look
from porescale.common.record.model import Cloud, Snapshot
from porescale.output.grain_pictures import branches, chains, numbers, rose_of, write_chains, write_grain_pictures
from tests.reference.scenes import dry, grain

LOOK = Look(title="three", view=(0.0, 0.012, 0.0, 0.008))
ROW = [grain(0.001, 0.004), grain(0.0019996, 0.004), grain(0.0029988, 0.004), grain(0.006, 0.006)]
"""Three in a row with overlaps of 0.4 and 0.8 um, and one alone."""


def snapshot(**more: Any) -> Snapshot:
    return build(dry(grains={"density": 2500, "grain": ROW}, gravity=[0.0, 0.0], output__contacts=True,
                     **more)).snapshot()  # fmt: skip


def test_a_line_a_contact_as_wide_as_its_force():
    figure: Any = chains(snapshot(), LOOK)
    discs, lines = figure.axes[0].collections
    assert len(discs.get_offsets()) == 4
    weak, strong = lines.get_linewidths()
    assert strong / weak == pytest.approx(2.0, rel=1e-9)
    ends = np.array(lines.get_segments()) / 1e3  # axes in mm
    np.testing.assert_allclose(ends[:, :, 0], [[0.001, 0.0019996], [0.0019996, 0.0029988]], atol=1e-9)


def test_branches_cross_a_periodic_side_beside_their_point():
    sides = {"domain__left": "periodic", "domain__right": "periodic"}
    shown = build(dry(grains={"density": 2500, "grain": [grain(0.0119, 0.004), grain(0.0008995, 0.004)]},
                      gravity=[0.0, 0.0], output__contacts=True, **sides)).snapshot()  # fmt: skip
    (ends,) = branches(shown.clouds["grains"], shown.clouds["contacts"])
    assert abs(ends[1, 0] - ends[0, 0]) == pytest.approx(0.0009995, rel=1e-9)  # not the width of the box


def test_chains_open_in_vtk_as_lines_with_their_forces(tmp_path):
    shown = snapshot()
    for path, seen in ((tmp_path / "chains.vtp", shown), (tmp_path / "none.vtp", Snapshot(0.0, 0))):
        if seen is not shown:
            contacts = shown.clouds["contacts"]
            none = Cloud(contacts.position[:0], {key: values[:0] for key, values in contacts.data.items()})
            seen.clouds.update(grains=shown.clouds["grains"], contacts=none)
        write_chains(path, seen)
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(path))
        reader.Update()
        lines = reader.GetOutput()
        assert lines.GetNumberOfLines() == (2 if seen is shown else 0)
        if seen is shown:
            force = lines.GetCellData().GetArray("normal_force")
            assert force.GetValue(1) == pytest.approx(2.0 * force.GetValue(0), rel=1e-9)
            assert lines.GetPoint(0)[:2] == pytest.approx((0.001, 0.004), abs=1e-9)
            assert lines.GetPoint(3)[:2] == pytest.approx((0.0029988, 0.004), abs=1e-9)
            assert lines.GetCellData().GetArray("sliding").GetValue(0) == 0


def test_colours_say_how_many_contacts():
    figure: Any = numbers(snapshot(), LOOK)
    (discs,) = figure.axes[0].collections
    shown = discs.get_facecolors()
    assert (shown[0] == shown[2]).all()
    assert not (shown[0] == shown[1]).all()
    rims = discs.get_edgecolors()
    assert (rims[3] == rims[0]).all()  # with one contact, or none, they rattle


def test_a_rose_of_nothing_and_of_a_row():
    assert len(rose_of(snapshot(), LOOK).axes[0].patches) == 36
    empty = snapshot()
    contacts = empty.clouds["contacts"]
    empty.clouds["contacts"] = Cloud(contacts.position[:0], {k: v[:0] for k, v in contacts.data.items()})
    assert len(rose_of(empty, LOOK).axes[0].patches) == 0
    assert len(chains(empty, LOOK).axes[0].collections) == 1


def test_files_of_what_was_asked_for(tmp_path, monkeypatch):
    class Seen:
        def __init__(self, shown: Snapshot) -> None:
            self.shown = shown

        def snapshot(self, k: int) -> Snapshot:
            return self.shown

    asked: Any = Seen(snapshot())
    names = {path.name for path in write_grain_pictures(asked, tmp_path, LOOK)}
    assert names == {"packing.csv", "chains.png", "chains.vtp", "coordination.png", "rose.png"}
    assert all((tmp_path / name).stat().st_size > 100 for name in names)
    plain: Any = Seen(build(dry(grains={"density": 2500, "grain": ROW})).snapshot())
    assert [path.name for path in write_grain_pictures(plain, tmp_path, LOOK)] == ["packing.csv"]

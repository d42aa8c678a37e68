"""A deck of discs and clumps as a scene says the same in SI; what scenes do not know is refused."""

from __future__ import annotations

import numpy as np
import pytest

from porescale.app import demseg
from porescale.app.main import commands
from porescale.decks.build import Options
from porescale.decks.run import read
from porescale.ground.check import InputError
from porescale.scene.build import build
from porescale.scene.sections import Scene
from porescale.workbench.application import main
from porescale.workbench.sections import load
from tests.reference import decks

pytestmark = pytest.mark.usefixtures("one_thread")


def converted(tmp_path, gm, bc="", units="plain"):
    """The deck's grains and the scene's."""
    folder = decks.write(tmp_path / "deck", gm, bc)
    file = tmp_path / "scene.toml"
    assert demseg.convert(folder, out=file, units=units) == 0
    return read(folder, Options()), build(load(file, Scene))


def test_a_clump_of_a_deck_is_that_of_its_scene(tmp_path):
    deck, scene = converted(tmp_path, decks.CLUMP)
    own, other = deck.grains.steering.clumps, scene.grains.steering.clumps
    # The scene's domain begins at the origin, 10 to the right: places round by a few eps of 10.
    assert other.mass == pytest.approx(own.mass, rel=1e-14)
    assert other.inertia == pytest.approx(own.inertia, rel=1e-13)
    assert other.position - [10.0, 0.0] == pytest.approx(own.position, abs=1e-14 * 10)
    assert scene.step_seconds == deck.step_seconds
    assert scene.grains.contact.table == pytest.approx(deck.grains.contact.table, rel=1e-15)


def test_cgs_becomes_si(tmp_path):
    gm = decks.DISC.replace("0.0d0 0.0d0 0.0d0\n-10", "1.0d2 0.5d2 27.0d0\n-10")
    bc = decks.boundary("0 0 400 100 10", "1", "1", "1", "1 1 3.0d0 0 1.0d4 0 0")
    deck, scene = converted(tmp_path, gm, bc, "cgs")
    # Per centimetre of depth and per metre: 2.5 g/cm^3 pi 4 cm^2 = 31.4 g/cm = 3.14 kg/m; 1e8 g/s^2/cm = 1e7 kg/s^2/m.
    assert scene.grains.discs.mass[0] == pytest.approx(0.1 * deck.grains.discs.mass[0], rel=1e-14)
    assert scene.grains.law.stiffness == pytest.approx(1e7, rel=1e-14)
    assert scene.grains.law.damping == pytest.approx(10.0, rel=1e-14)
    assert scene.grains.law.friction == pytest.approx(np.tan(np.radians(27.0)), rel=1e-14)
    assert scene.scene.gravity == pytest.approx((0.0, -9.8))
    control = scene.scene.control[0]
    assert control.record
    assert control.x.displacement.values == pytest.approx((0.0, 0.03))
    assert control.y.force.mean == pytest.approx(10.0)  # 1e4 dyn/cm


MIXED = decks.grains("2 0 0", "1 1 1", "0 0 0", "1 1.0d0", "-5 5 0", "2 2 2", "1 0 2", "1 1.0d0", "5 5 0", "2 0.5d0",
                     "6 5 0").replace("\n1\n", "\n2\n5.0 2.0d8 0.5d8 1 1 20\n", 1)  # fmt: skip


def test_materials_stay_with_their_bodies(tmp_path):
    deck, scene = converted(tmp_path, MIXED)
    for model in (deck, scene):
        table = model.grains.contact.table
        # Springs in series, 2 k1 k2/(k1 + k2), and the smaller friction: the second material has none.
        assert table[:, :, 0].tolist() == [[2e8, pytest.approx(4e8 / 3, rel=1e-15)], [table[1, 0, 0], 1e8]]
        assert table[0, 1, 4] == 0.0 < table[0, 0, 4]
        assert model.grains.material.tolist() == [0, 1, 1]
        assert model.grains.discs.mass[0] == pytest.approx(5.0 * np.pi, rel=1e-15)
    assert scene.grains.steering.clumps.mass == pytest.approx(deck.grains.steering.clumps.mass, rel=1e-13)


def test_random_discs_become_a_scene(tmp_path):
    gm = "0 0 0\n5d-5 0 -980\n1\n2.5 1d8 .25d8 1d2 .5d2 27\n0 30 0 30 0\n1 2\n1\n0.5\n"
    deck, scene = converted(tmp_path, gm)
    assert scene.grains.discs.count == deck.grains.discs.count == 82
    assert (scene.grains.discs.position == deck.grains.discs.position).all()  # text keeps the bits


def test_segments_and_continuations_are_refused_by_name(tmp_path):
    folder = decks.write(tmp_path / "deck", decks.PUSHED, decks.boundary("1 0 20 10 10", *decks.PUSH))
    with pytest.raises(InputError) as caught:
        demseg.convert(folder, out=tmp_path / "a.toml")
    assert [fault.key for fault in caught.value.faults] == ["body 2", "jclid"]
    assert not (tmp_path / "a.toml").exists()


def test_a_malformed_deck_is_one_line_and_exit_code_2(tmp_path, capsys):
    folder = decks.write(tmp_path / "deck", decks.DISC.replace("5.0d-5", "5.0x-5"))
    for name in ("run", "convert"):
        assert main(commands(), ["demseg", name, str(folder), "--out", str(tmp_path / "out")]) == 2
        said = capsys.readouterr().err
        assert said.count("\n") == 1
        assert "in_gm.dat: line 2, dt = '5.0x-5': is no number, expected a number such as 5.0d-5" in said
    assert not (tmp_path / "out").exists()


def test_the_command_leaves_the_decks_files_beside_the_run_folders(tmp_path, capsys):
    folder = decks.write(tmp_path / "deck", bc=decks.boundary("0 0 40 20 10"))
    out = tmp_path / "out"
    assert main(commands(), ["demseg", "run", str(folder), "--out", str(out), "--threads", "1"]) == 0
    assert "finished" in capsys.readouterr().out
    names = {path.name for path in out.iterdir()}
    assert names >= {"energy.dat", "new_in_gm.dat", "new_in_bc.dat", "new_in_cf.dat", "new_in_cf0.dat", "card.json",
                     "checkpoint.h5", "grains.vtkhdf", "final.png", "film.mp4"}  # fmt: skip
    rows = np.loadtxt(out / "energy.dat")
    assert rows[:, 0].tolist() == [0, 10, 20, 30, 40]
    assert rows.shape[1] == 9
    assert main(commands(), ["demseg", "run", str(folder), "--out", str(out)]) == 2  # a run is not lost by accident

"""A deck as a scene says the same in SI, and runs alike; what scenes do not know is refused."""

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.cli import demseg
from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.core.errors import InputError, PorescaleWarning
from porescale.common.schema.sections import load
from porescale.demseg.build import Options
from porescale.demseg.run import read
from tests.reference import decks


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


def continued(tmp_path, material):
    """A deck that goes on 1700 steps after the start, in a contact with the floor, and the scene made of it."""
    gm = decks.DISC.replace("0.0d0 0.0d0 0.0d0\n1 2", "60 0 0\n1 2").replace("-10.0d0 10.0d0 0", "-20 20 0")
    gm = gm.replace("0.0d0 0.0d0 0.0d0\n-20", f"{material}\n-20")
    before = read(decks.write(tmp_path / "a", gm), Options())
    before.advance(1580)
    assert before.series()["enka"] > 0.0
    folder = tmp_path / "b"
    folder.mkdir()
    before.write_next(folder)
    for file in folder.iterdir():
        file.rename(folder / file.name.removeprefix("new_"))
    assert demseg.convert(folder, out=tmp_path / "a.toml") == 0
    return before, build(load(tmp_path / "a.toml", Scene))


@pytest.mark.parametrize(("material", "alike"), [("0 0 0", True), ("0 0 27", False)])
def test_a_continuation_becomes_a_scene_with_tangential_springs_at_rest(tmp_path, capsys, material, alike):
    deck, scene = continued(tmp_path, material)
    said = "leaves out the tangential springs of 1 contact: "
    assert (said in capsys.readouterr().out) != alike
    for model in (deck, scene):
        model.advance(100)
    # Without friction there are no such springs: the same to round-off, multiplied by a contact (see below).
    assert (apart(deck, scene) < 1e-12) == alike


def test_a_continuation_without_its_state_is_refused_by_name(tmp_path):
    folder = decks.write(tmp_path / "deck", decks.PUSHED, decks.boundary("1 0 20 10 10", *decks.PUSH))
    with pytest.raises(InputError, match=r"in_cf\.dat: cannot be read .*jclid 1 needs it"):
        demseg.convert(folder, out=tmp_path / "a.toml")
    assert not (tmp_path / "a.toml").exists()


def test_a_rule_that_scenes_do_not_have_is_refused_where_it_would_matter(tmp_path):
    folder = decks.write(tmp_path / "deck", decks.TRIANGLE)
    with pytest.raises(InputError, match="--rule = 'each': scenes count corners of segments once"):
        demseg.convert(folder, out=tmp_path / "a.toml", rule="each")
    discs = decks.write(tmp_path / "discs")
    assert demseg.convert(discs, out=tmp_path / "b.toml", rule="each") == 0


def test_discs_of_mode_0_are_controlled_and_recorded(tmp_path):
    gm = "0 0 0\n5d-5 0 -980\n1\n2.5 1d8 .25d8 1d2 .5d2 27\n0 30 0 30 0\n1 2\n1\n0.5\n"
    bc = decks.boundary("0 0 100 10 10", "1", "82", "1", "3 1 1.0 1 0 1 0")
    deck, scene = converted(tmp_path, gm, bc)
    assert scene.scene.control[0].record == (scene.scene.control[0].grain == 81)
    start = deck.grains.discs.position[2].copy()
    deck.advance(100)
    # The way in steps of 0.01: 100 roundings of eps 30.
    assert deck.grains.discs.position[2] - start == pytest.approx([1.0, 0.0], abs=100 * 30 * 2.3e-16)
    far = decks.write(tmp_path / "far", gm, decks.boundary("0 0 100 10 10", "1", "83", "0"))
    with pytest.raises(InputError, match=r"in_bc\.dat: line 3, recorded body 1 = 83: makes no sense, expected 1 to 82"):
        read(far, Options())


def apart(deck, scene, rows=slice(None)):
    """Largest distance of the scene's points from the deck's, whose domain begins elsewhere."""
    left, _, low, _ = deck.deck.domain
    return float(np.abs(scene.grains.discs.position[rows] + [left, low] - deck.grains.discs.position).max())


FALLEN = {
    "segment": decks.SEGMENT.replace("-2.0d0 2.0d0", "-2.0d0 0.1d0"),
    "polygon": decks.TRIANGLE.replace("-2 2", "-2 .1"),
}
"""Bodies that soon meet the floor."""
CONTAINER = decks.grains(
    "1 0 1", "1 1 1", "0 0 0", "1 1.0d0", "0 2.11 0", "2 1 2", "0 0 0", "1 -4 1", "4 1", "2 4 1", "4 3", dt="1.0d-5"
).replace("10.0d0 0.0d0\n1 0 1", "10.0d0 0.1\n1 0 1")  # fmt: skip
"""A disc falls onto a corner of thick segments, which are kept out of the cells and moved by 0.1 to the left."""


@pytest.mark.parametrize(
    ("gm", "bc", "sections"),
    [
        (CONTAINER, decks.boundary("0 0 1500 100 10", "0", "1", "2 1 -0.1 1 0 1 0"), ["segment", "control"]),
        (FALLEN["segment"], "", ["segment"]),
        (FALLEN["polygon"], "", ["polygon"]),
        (decks.PUSHED, decks.boundary("0 0 900 100 10", *decks.PUSH), ["segment", "control"]),
    ],
)  # fmt: skip
def test_a_scene_of_segments_runs_as_its_deck_to_round_off(tmp_path, gm, bc, sections):
    deck, scene = converted(tmp_path, gm, bc)
    assert [name for name in ("segment", "polygon", "control") if getattr(scene.scene, name)] == sections
    own, other = deck.grains.steering.clumps, scene.grains.steering.clumps
    assert other.mass == pytest.approx(own.mass, rel=1e-13)
    assert other.inertia == pytest.approx(own.inertia, rel=1e-12)
    deck.advance(900)
    scene.advance(900)
    assert deck.grains.budget is not None
    assert np.abs(deck.grains.steering.clumps.spin).max() > 0.1 or "control" in sections  # it has met something
    # Places are off by eps of 10 from the start; a bounce multiplies that by how far a body comes over how deep it
    # goes, some 1e2: 10 eps 1e2 = 2e-13 a bounce, of which there are a few.
    assert apart(deck, scene) < 1e-12


@pytest.mark.parametrize("low", ["-.05", "-.3"])
def test_a_body_that_is_pressed_into_a_side_is_so_in_its_scene(tmp_path, low):
    deck, scene = converted(tmp_path, decks.TRIANGLE.replace("-2 2", f"-2 {low}"))
    assert scene.grains.discs.position[:, 1].min() == pytest.approx(float(low), abs=1e-14)  # eps of 7, about its centre
    for model in (deck, scene):
        model.advance(200)
    assert np.abs(deck.grains.steering.clumps.velocity).max() > 1.0  # the side presses it back
    assert apart(deck, scene) < 1e-12  # as above


def test_what_a_scene_refuses_and_a_deck_does_not_is_said(tmp_path, capsys):
    # A corner 0.9 below the floor, more than 0.1 of the body's 7.9; middles of its sides are inside.
    folder = decks.write(tmp_path / "deck", decks.TRIANGLE.replace("-2 2", "-2 -.9"))
    read(folder, Options())
    file = tmp_path / "a.toml"
    assert main(commands(), ["demseg", "convert", str(folder), "--out", str(file)]) == 0
    said = capsys.readouterr()
    line = "polygon[0] = '(8, -0.9)': reaches out of the box; move it inside"
    refused = "porescale check refuses it, though demseg run takes the deck"
    assert said.err == f"warning: {file}: {refused}: {line}\n"
    assert main(commands(), ["check", str(file)]) == 2
    assert line in capsys.readouterr().err
    with pytest.warns(PorescaleWarning, match="reaches out"):
        demseg.convert(folder, out=file, overwrite=True)


def test_a_bonded_chain_becomes_a_scene_with_its_bonds(tmp_path):
    bonds = "1 1\n2 -2.0d7\n2 2\n1 -2.0d7\n3 -2.0d7\n3 1\n2 -2.0d7\n"
    told = ("1", "3", "2", "1 1 0 1 0 1 0", "3 1 1.0 1 0 1 0")
    folder = decks.write(tmp_path / "deck", decks.chain(3), decks.boundary("3 1 200 20 10", *told), in_cf0=bonds)
    assert demseg.convert(folder, out=tmp_path / "a.toml") == 0
    deck, scene = read(folder, Options()), build(load(tmp_path / "a.toml", Scene))
    assert scene.grains.bonds.ends.tolist() == deck.grains.bonds.ends.tolist()
    for model in (deck, scene):
        model.advance(200)
    # The same order of bodies, the domain begins at the origin: the same bits.
    assert (scene.grains.discs.position == deck.grains.discs.position).all()
    assert (scene.grains.bonds.whole == deck.grains.bonds.whole).all()
    assert scene.series()["broken bonds ()"] == 2 - deck.grains.bonds.count > 0


def test_bonds_of_bodies_in_another_order_are_between_the_same(tmp_path):
    # A clump before a disc in the deck, after it in the scene; a segment above both.
    gm = decks.grains(
        "2 1 0",
        "1 1 2",
        "0 0 0",
        "1 1.0d0",
        "-1 5 0",
        "2 1.0d0",
        "-2 5 0",
        "2 1 1",
        "0 0 0",
        "1 1.0d0",
        "0.9 5 0",
        "3 1 1",
        "0 0 0",
        "1 0 6.05",
        "2 6.05",
    ).replace("10.0d0 0.0d0\n2 1", "10.0d0 0.1\n2 1")
    gm = gm.replace("5.0d-5", "1.0d-5")
    first = decks.write(tmp_path / "first", gm, decks.boundary("0 0 1 1 1"))
    model = read(first, Options())
    model.write_next(first)
    cf0 = (first / "new_in_cf0.dat").read_text(encoding="utf-8")
    assert len(cf0.splitlines()) == 7  # disc with clump, disc with segment, both ways
    folder = decks.write(tmp_path / "deck", gm, decks.boundary("3 0 50 10 10"), in_cf0=cf0)
    assert demseg.convert(folder, out=tmp_path / "a.toml") == 0
    deck, scene = read(folder, Options()), build(load(tmp_path / "a.toml", Scene))
    assert scene.grains.bonds.back.tolist() == deck.grains.bonds.back.tolist()
    for model in (deck, scene):
        model.advance(50)
    assert apart(deck, scene, [1, 2, 0, 3, 4]) < 1e-12  # sums in another order, as above


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
    assert main(commands(), ["show", str(out)]) == 0
    assert str(out / "film.mp4") in capsys.readouterr().out
    rows = np.loadtxt(out / "energy.dat")
    assert rows[:, 0].tolist() == [0, 10, 20, 30, 40]
    assert rows.shape[1] == 9
    assert main(commands(), ["demseg", "run", str(folder), "--out", str(out)]) == 2  # a run is not lost by accident

"""Files of a deck beside energy.dat: places, contacts, speeds, emissions, breaks; pictures of forces and numbers."""

import csv

import numpy as np
import pytest

from porescale.cli import demseg
from porescale.common.record.drive import drive
from porescale.common.record.model import Cloud
from porescale.common.record.open_run import open_run
from porescale.dem.measures.contacts import contacts
from porescale.demseg.build import Options
from porescale.demseg.deck import read_deck
from porescale.demseg.outputs import contact_cloud
from porescale.demseg.run import read
from porescale.output.deck_pictures import forces_of_pairs, places_of_bodies, write_deck_pictures
from tests.reference import decks

PAIR = decks.grains("2 1 0", "1 1 1", "0 0 0", "1 1.0d0", "0 .99 0", "2 1 1", "0 0 0", "1 1.0d0", "0 2.98 0",
                    "3 1 1", "0 2 0", "1 4 5", "6 5", dt="1d-9").replace("-980.0d0", "0.0d0")  # fmt: skip
"""Two discs, one on the other on the floor, each pressed in by 0.01; a segment that rises."""


def rows(path):
    """Numbers of each line of a file without its first word lines."""
    text = path.read_text(encoding="utf-8").splitlines()
    return [[float(word) for word in line.split()] for line in text if not line.startswith("#")]


def run(folder, out, steps, every):
    """Drive the deck into ``out`` with all its files, without film; the model at its end."""
    model = read(folder, Options())
    each = every * model.deck.dt
    drive(
        model, out, steps * model.deck.dt, snapshot_interval=each, series_interval=each,
        card={"name": "deck", "scene": {}}, quiet=True, after=model.write,
    )  # fmt: skip
    return model


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    place = tmp_path_factory.mktemp("pair")
    folder = decks.write(place / "deck", PAIR, decks.boundary("0 100 20 10 10", "2", "1", "3", "0"))
    return run(folder, place / "out", 20, 10), place / "out"


def test_places_are_those_of_the_deck_and_steps_count_on(pair):
    model, out = pair
    found = rows(out / "output.dat")
    assert [row[0] for row in found if len(row) == 3] == [100, 110, 120]
    assert found[0] == [100, 0.0, 3]
    assert found[1:4] == [[1, 1, 1, 1.0, 0.0, 0.99, 0.0], [2, 1, 1, 1.0, 0.0, 2.98, 0.0], [3, 1, 2, 4.0, 5.0, 6.0, 5.0]]
    # The segment rises at 2: places of about 5 round by eps 5.
    assert found[-1][4] == pytest.approx(5.0 + 2.0 * 20e-9, abs=5e-15)
    assert found[-2][:3] == [2, 1, 1]
    assert found[-2][4:6] == model.grains.discs.position[1].tolist()


def test_contacts_are_pressed_as_deep_as_they_overlap(pair):
    _, out = pair
    between, sides = rows(out / "cont.dat"), rows(out / "cont2.dat")
    force = 1e8 * 0.01
    # Places of about 3 round by 3 eps: forces by 1e8 3 eps = 7e-8.  In 20 steps of 1e-9 discs of mass 8 move by 1e-11.
    assert between[:1] == [[100, 0.0, 1]]
    assert between[1] == pytest.approx([1, 2, 0, 1.985, 0, force, force, 0], abs=1e-6)
    assert between[-1][5] == pytest.approx(force, rel=1e-8)
    assert sides[:1] == [[100, 0.0, 1]]
    assert sides[1] == pytest.approx([1, -3, 0, 0, 0, -force, force, 0], abs=1e-6)  # -3: the bottom


def test_vertical_speeds_are_those_of_the_recorded_bodies(pair):
    _, out = pair
    assert [row[0] for row in rows(out / "velocity_y.dat")] == [100, 110, 120]
    assert [row[2] for row in rows(out / "velocity_y.dat")] == [2.0, 2.0, 2.0]
    # Body 1 is in balance but for what body 2, of mass 7.9, leaves by: 1e6/7.9 (2e-8)^2/2 = 2.5e-11 in all, which takes
    # 2.5e-3 off the force on it, on its mass for 2e-8.  Body 2 itself comes to 2.5e-3.
    assert rows(out / "velocity_y.dat")[-1][1] == pytest.approx(0.0, abs=2.5e-3 / 7.9 * 2e-8)
    assert not (out / "emissions.dat").exists()
    assert not (out / "breaks.csv").exists()


def test_numbers_in_pictures_are_those_of_bodies(pair, tmp_path):
    _, out = pair
    shot = open_run(out).snapshot(-1, cells=())
    where = places_of_bodies(shot)
    assert list(where) == [1, 2, 3]
    assert where[3] == pytest.approx((5.0, 5.0), abs=1e-6)
    made = write_deck_pictures(open_run(out), tmp_path, (-10.0, 10.0, 0.0, 10.0))
    assert [path.name for path in made] == ["contacts.png", "numbers.png"]
    assert all(path.stat().st_size > 4000 for path in made)


@pytest.mark.slow
def test_a_chain_that_breaks_counts_its_emissions_and_lists_its_breaks(tmp_path):
    bonds = "1 1\n2 -2.0d7\n2 2\n1 -2.0d7\n3 -2.0d7\n3 1\n2 -2.0d7\n"
    pulled = ("0", "2", "1 1 0 1 0 1 0", "3 1 1.0 1 0 1 0")
    folder = decks.write(tmp_path / "deck", decks.chain(3), decks.boundary("3 0 200 20 10", *pulled), in_cf0=bonds)
    model = run(folder, tmp_path / "out", 200, 10)
    counts = np.array(rows(tmp_path / "out" / "emissions.dat"))
    assert counts[0, 1:].tolist() == [2, 0, 0]
    assert counts[-1, 3] == 2 - model.grains.bonds.count > 0
    assert counts[:, 2].sum() == counts[-1, 3]
    assert (counts[:, 1] + counts[:, 3] == 2).all()
    with (tmp_path / "out" / "breaks.csv").open(encoding="utf-8") as file:
        lost = list(csv.DictReader(file))
    assert len(lost) == counts[-1, 3]
    for row in lost:
        step = round(float(row["time"]) / 1e-5)
        before = counts[counts[:, 0] < step, 3].max()
        after = counts[counts[:, 0] >= step, 3].min()
        assert before < after  # it is counted in the row that its time lies in
        assert {int(row["body"]), int(row["other body"])} in ({1, 2}, {2, 3})
        assert float(row["strength"]) == 2e7
    # At the start contact and bond cancel: one row each, of no force, to the round-off of 1e8 50 eps.
    first = rows(tmp_path / "out" / "cont.dat")[:3]
    assert first[0] == [0, 0.0, 2]
    assert np.abs(np.array(first[1:])[:, 4:]).max() < 1e-5


def test_bonded_discs_have_one_row_beside_a_segment_too(tmp_path):
    chain = decks.chain(3).replace("3 0 0", "3 1 0") + "4 1 1\n0 0 0\n1 60 70\n65 70\n"
    bonds = "1 1\n2 -2.0d7\n2 2\n1 -2.0d7\n3 -2.0d7\n3 1\n2 -2.0d7\n4 0\n"
    folder = decks.write(tmp_path / "deck", chain, decks.boundary("3 0 1 1 1"), in_cf0=bonds)
    model = read(folder, Options())
    cloud = contact_cloud(model.built)
    assert np.column_stack((cloud["body"], cloud["other"])).tolist() == [[1, 2], [2, 3]]
    assert np.abs(cloud["normal_force"]).max() < 1e-5  # contact and bond cancel, to the round-off of 1e8 50 eps
    # The check that must fail: the list itself has two rows of each.
    assert contacts(model.grains).count == 4


def test_a_disc_that_touches_nothing_at_first_leaves_its_contacts_all_the_same(tmp_path):
    low = decks.DISC.replace("0.0d0 5.0d0 0.0d0", "0.0d0 2.001d0 0.0d0").replace(
        "0.0d0 0.0d0 0.0d0\n1 2", "0 -80 0\n1 2"
    )
    run(decks.write(tmp_path / "deck", low), tmp_path / "out", 6, 2)
    found = rows(tmp_path / "out" / "cont2.dat")
    assert found[0] == [0, 0.0, 0]  # 0.001 above the floor, 0.004 a step
    assert found[1][2] == 1
    assert len(open_run(tmp_path / "out").snapshot(0, cells=()).clouds["contacts"].position) == 0


@pytest.mark.slow
def test_the_command_leaves_every_file_that_the_documentation_names(tmp_path):
    folder = decks.write(tmp_path / "deck", PAIR, decks.boundary("0 0 20 10 10", "1", "1", "0"))
    assert demseg.run(folder, out=tmp_path / "out", quiet=True) == 0
    names = ("output.dat", "cont.dat", "cont2.dat", "velocity_y.dat", "energy.dat", "f-d_curve.dat", "contacts.png",
             "numbers.png", "new_in_gm.dat", "new_in_bc.dat", "new_in_cf.dat", "new_in_cf0.dat")  # fmt: skip
    assert [name for name in names if not (tmp_path / "out" / name).exists()] == []
    assert read_deck(folder).nstep == 20


def test_contacts_and_bonds_of_a_pair_are_one_line_of_their_net_force():
    # Bodies 1 and 2 touch at two corners and are bonded at both, in either order; 2 and 3 press; 1 stands on the floor.
    body, other = np.array([1, 2, 1, 2, 2, 1, 1]), np.array([2, 1, 2, 1, 3, -3, -3])
    force = np.array([5.0, -5.0 + 1e-10, 3.0, -3.0, 2.0, 4.0, 4.0])
    flat = np.zeros((7, 3))
    data = {"body": body, "other": other, "normal_force": force, "start": flat, "branch": np.ones((7, 3))}
    net, ways = forces_of_pairs(Cloud(flat, data))
    assert sorted(net.tolist()) == [0.0, 2.0, 4.0, 4.0]
    assert ways.shape == (4, 2, 2)
    # The check that must fail: without one of the bonds the pair presses.
    less = {name: np.delete(values, 1, axis=0) for name, values in data.items()}
    assert sorted(forces_of_pairs(Cloud(flat[:-1], less))[0].tolist()) == [2.0, 4.0, 4.0, 5.0]

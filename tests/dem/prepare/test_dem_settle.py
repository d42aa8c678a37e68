"""Settled packings rest, keep to hard-disc geometry, and come from disk with the bits they had."""

import dataclasses

import numpy as np
import pytest

from porescale.benchmarks.dem import BENCHMARKS
from porescale.common.core.errors import InputError, PorescaleError
from porescale.dem.contact.linear import Linear
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.measures import survey as measure
from porescale.dem.prepare import on_disk, settle
from porescale.dem.prepare.settle import Pile, prepare, weights_of

PILE = Pile((0.04, 0.0), 0.02, 120, 1.5e-3, 2500.0, seed=4)
BOX = Box((0.0, 0.0), (0.06, 0.1), top="open")
GATE = Plate(0.04, 0.002, 0.03, velocity=0.5, friction=0.0, name="gate")
LAW = Linear(5e5, 2.0, 1.25e5, 1.0, 0.5)


def test_a_pile_settles_to_hard_discs_at_rest_behind_its_plate():
    grains = Grains(PILE.discs(), LAW, BOX, plates=[GATE])
    settle.settle(grains, PILE)
    assert 0.5 * measure.max_overlap(grains).share < 1e-3
    assert measure.unbalanced(grains) < settle.BALANCE
    discs = grains.discs
    assert (discs.position[:, 0] - discs.radius).min() > 0.04 - 1e-3 * PILE.diameter
    # The floor carries what friction at the wall leaves, never more than the weight (to the net force
    # allowed).
    weight = PILE.gravity * discs.mass.sum()
    floor = -grains.wall_force[grains.wall_names.index("bottom"), 1]
    assert 0.6 * weight < floor < (1.0 + settle.BALANCE) * weight


def test_relaxed_grains_stay_where_they_are_under_the_law_of_the_run(tmp_path):
    still = dataclasses.replace(GATE, velocity=0.0)
    grains = prepare(PILE, BOX, LAW, plates=[still], weight_density=1500.0, folder=tmp_path)
    start = grains.discs.position.copy()
    weights = weights_of(grains.discs, 1500.0)
    grains.step(grains.stable_step(), weights, count=3000)
    # Rest is called at a kinetic energy of 1e-8 m g d per grain: sqrt(2e-8 g d) = 1.7e-5 m/s, for 0.1 s at
    # most.
    assert np.abs(grains.discs.position - start).max() < 1.7e-5 * 0.1
    # Without the gate it flows: the twin that must fail.
    grains.remove_plate("gate")
    grains.step(grains.stable_step(), weights, count=3000)
    assert np.abs(grains.discs.position - start).max() > 0.1 * PILE.diameter


def test_a_packing_from_disk_has_the_bits_it_was_made_with(tmp_path):
    small = dataclasses.replace(PILE, count=30)
    made = prepare(small, BOX, LAW, plates=[GATE], folder=tmp_path)
    found = prepare(small, BOX, LAW, plates=[GATE], folder=tmp_path)
    assert len(list(tmp_path.iterdir())) == 1
    a, b = made.state(), found.state()
    for key in a:
        for name, value in a[key].items() if isinstance(a[key], dict) else [(key, a[key])]:
            other = b[key][name] if isinstance(b[key], dict) else b[key]
            np.testing.assert_array_equal(value, other, err_msg=f"{key}/{name}")
    prepare(dataclasses.replace(small, seed=5), BOX, LAW, plates=[GATE], folder=tmp_path)
    assert len(list(tmp_path.iterdir())) == 2


def cut_short(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def flip_a_bit(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 3] ^= 1
    path.write_bytes(bytes(content))


def leave_out_a_part(path):
    state = on_disk.unpack(path)
    del state["pairs"]["anchor"]
    on_disk.pack(path, state)


def give_another_shape(path):
    state = on_disk.unpack(path)
    on_disk.pack(path, {**state, "discs": {name: part[:-1] for name, part in state["discs"].items()}})


@pytest.mark.parametrize(
    "damage",
    [
        cut_short, flip_a_bit, leave_out_a_part, give_another_shape,
        lambda path: path.write_bytes(b"PK no archive"), lambda path: path.write_bytes(b""),
        lambda path: (path.unlink(), path.mkdir()),
    ],
    ids=["cut", "bit", "part", "shape", "garbage", "empty", "folder"],
)  # fmt: skip
def test_a_damaged_packing_is_settled_anew_and_replaced(tmp_path, damage):
    small = dataclasses.replace(PILE, count=30)
    made = prepare(small, BOX, LAW, plates=[GATE], folder=tmp_path)
    (path,) = tmp_path.iterdir()
    good = path.read_bytes()
    damage(path)
    again = prepare(small, BOX, LAW, plates=[GATE], folder=tmp_path)
    np.testing.assert_array_equal(again.discs.position, made.discs.position)
    np.testing.assert_array_equal(again.pairs.carried, made.pairs.carried)
    if not path.is_dir():  # a folder in its place is somebody's: it is left alone
        assert path.read_bytes() == good


def test_a_cache_that_cannot_be_written_is_done_without(tmp_path):
    (tmp_path / "file").write_text("not a folder")
    small = dataclasses.replace(PILE, count=30)
    made = prepare(small, BOX, LAW, plates=[GATE], folder=tmp_path / "file" / "packings")
    assert made.discs.count == 30
    assert [it.name for it in tmp_path.iterdir()] == ["file"]


def test_a_gate_lower_than_the_pile_is_refused():
    with pytest.raises(InputError, match=r"gate.y_high.*spill"):
        prepare(PILE, BOX, LAW, plates=[dataclasses.replace(GATE, y_high=0.008)])


def test_grains_that_float_do_not_settle():
    with pytest.raises(InputError, match="do not sink"):
        prepare(PILE, BOX, LAW, weight_density=-100.0)


def test_bench_rows_count_disc_steps(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    (row,) = BENCHMARKS.run(["dem"], size=100, threads=1, min_seconds=0.0)
    assert (row.name, row.size, row.dtype, row.unit) == ("dem", 100, "float64", "discs/s")
    assert row.rate == pytest.approx(500 * 100 / row.seconds)
    with pytest.raises(InputError, match="float64"):
        list(BENCHMARKS.run(["dem"], size=100, dtype="float32"))


def sizes_of_one_to_twenty():
    """32 discs of 0.1 to 2 mm, evenly: 1 to 20, a mass ratio of 400."""
    given = tuple(np.linspace(5e-5, 1e-3, 32).tolist())
    return Pile((0.0, 0.0), 8e-3, len(given), 2.0 * sum(given) / len(given), 2500.0, seed=3, given=given)


def test_sizes_of_one_to_twenty_come_to_rest(monkeypatch):
    pile = sizes_of_one_to_twenty()
    box = Box((0.0, 0.0), (pile.width, 0.1), top="open")
    grains = Grains(pile.discs(), LAW, box)
    settle.settle(grains, pile)
    assert measure.unbalanced(grains) < settle.BALANCE
    # Patience is counted in steps of the mean grain: of the smallest ones' it would be too short (the twin that fails).
    monkeypatch.setattr(settle, "PATIENCE", settle.PATIENCE / 400)
    with pytest.raises(PorescaleError, match="did not come to rest"):
        settle.settle(Grains(pile.discs(), LAW, box), pile)

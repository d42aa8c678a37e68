"""Decks of DEMseg run as they are: printed numbers come out, continuations are exact, tensions are those printed."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError, Unstable
from porescale.common.neighbors.placement import place
from porescale.common.record.drive import drive
from porescale.demseg.build import Options, random_discs
from porescale.demseg.deck import read_deck
from porescale.demseg.run import DeckRun, card_of, read
from porescale.demseg.tension import read_tensions, tension_text
from tests.reference import decks

OPTIONS = Options()


def run(folder, out):
    """Drive the deck in ``folder`` into ``out`` without pictures; the model at its end."""
    model = read(folder, OPTIONS)
    deck = model.deck
    drive(
        model, out, deck.nstep * deck.dt, snapshot_interval=float("inf"), series_interval=deck.nprn2 * deck.dt,
        card={"scene": card_of(deck, OPTIONS)}, quiet=True, after=model.write,
    )  # fmt: skip
    return model


def go_on(out, folder, head):
    """A deck made of the files that a run left, with another head line of in_bc.dat."""
    folder.mkdir()
    for name in ("gm", "bc", "cf", "cf0"):
        (folder / f"in_{name}.dat").write_bytes((out / f"new_in_{name}.dat").read_bytes())
    lines = (folder / "in_bc.dat").read_text().splitlines()
    (folder / "in_bc.dat").write_text("\n".join([head, *lines[1:]]) + "\n")
    return folder


@pytest.mark.slow
def test_the_record_printed_in_the_tutorial_comes_out(tmp_path):
    # Section I-3 prints step, body, force x, place x, … to six digits: 10 2 0 -2.99982 0 3.5 0 and 20 2 0 -2.99933.
    folder = decks.write(tmp_path / "deck", decks.PUSHED, decks.boundary("0 0 20 10 10", *decks.PUSH))
    run(folder, tmp_path / "out")
    rows = np.loadtxt(tmp_path / "out" / "f-d_curve.dat")
    printed = [[f"{number:.6g}" for number in row[:7]] for row in rows]
    assert printed[1] == ["10", "2", "0", "-2.99982", "0", "3.5", "0"]
    assert printed[2] == ["20", "2", "0", "-2.99933", "0", "3.5", "0"]
    assert f"{rows[0, 7]:.5g}" == "1.5708"


def test_a_segment_as_wide_as_its_thickness_would_not_give_that_record(tmp_path):  # the twin that must fail
    deck = read_deck(decks.write(tmp_path, decks.PUSHED, decks.boundary("0 0 20 10 10", *decks.PUSH)))
    heavier = DeckRun(deck, Options(rod=0.2), tmp_path)
    assert heavier.grains.steering.clumps.mass[0] == pytest.approx(2.5, rel=1e-12)  # 1.25 is what the record means


KINDS = {"disc": decks.DISC, "clump": decks.CLUMP, "triangle": decks.TRIANGLE}


@pytest.mark.parametrize("kind", ["disc", pytest.param("clump", marks=pytest.mark.slow),
                                  pytest.param("triangle", marks=pytest.mark.slow)])  # fmt: skip
def test_a_run_in_two_parts_is_the_run_in_one_bit_for_bit(tmp_path, kind):
    steps = (1650, 1600) if kind == "disc" else (1300, 2000)  # the first ends within a contact with the floor, or after
    whole = run(decks.write(tmp_path / "a", KINDS[kind], decks.boundary(f"0 0 {sum(steps)} 5000 10")), tmp_path / "b")
    first = run(decks.write(tmp_path / "c", KINDS[kind], decks.boundary(f"0 0 {steps[0]} 5000 10")), tmp_path / "d")
    assert first.step == steps[0]
    second = run(go_on(tmp_path / "d", tmp_path / "e", f"1 {steps[0]} {steps[1]} 5000 10"), tmp_path / "f")
    assert second.deck.iloop == steps[0]
    for name in ("new_in_gm.dat", "new_in_cf.dat", "new_in_cf0.dat"):
        assert (tmp_path / "f" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name
    last = [(tmp_path / out / "energy.dat").read_text().splitlines()[-1] for out in ("b", "f")]
    assert last[0] == last[1]
    assert whole.grains.time == second.grains.time


@pytest.mark.slow
def test_a_pulled_chain_goes_on_with_its_bonds_and_breaks(tmp_path):
    # Halves of the way in halves of the steps: the same velocity to the bit.  At 1250 the end breaks off on the way.
    def told(head, way):
        return decks.boundary(head, "1", "20", "2", "1 1 0 1 0 1 0", f"20 1 {way} 1 0 1 0")

    bonds = {"in_cf0": tension_text(read(decks.write(tmp_path / "p", decks.chain()), OPTIONS).built)}
    folder = decks.write(tmp_path / "a", decks.chain(), told("3 0 400 400 10", "5.0"), **bonds)
    whole = run(folder, tmp_path / "b")
    run(decks.write(tmp_path / "c", decks.chain(), told("3 0 200 400 10", "2.5"), **bonds), tmp_path / "d")
    second = run(go_on(tmp_path / "d", tmp_path / "e", "1 200 200 400 10"), tmp_path / "f")
    for name in ("new_in_gm.dat", "new_in_cf.dat", "new_in_cf0.dat"):
        assert (tmp_path / "f" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name
    assert whole.grains.bonds.count == second.grains.bonds.count < 19


def test_a_run_resumed_from_its_checkpoint_ends_as_the_uninterrupted_one(tmp_path):
    folder = decks.write(tmp_path / "deck", bc=decks.boundary("0 0 3250 500 10"))
    run(folder, tmp_path / "whole")
    for steps, resume in ((1650, False), (3250, True)):  # stopped within a contact with the floor
        model = read(folder, OPTIONS)
        drive(
            model, tmp_path / "parts", steps * 5e-5, snapshot_interval=float("inf"), series_interval=10 * 5e-5,
            card={"scene": card_of(model.deck, OPTIONS)}, quiet=True, resume=resume, after=model.write,
        )  # fmt: skip
    for name in ("energy.dat", "new_in_gm.dat", "new_in_cf.dat"):
        assert (tmp_path / "parts" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes(), name


def test_another_place_than_the_continuation_has_is_refused(tmp_path):
    run(decks.write(tmp_path / "a", bc=decks.boundary("0 0 20 20 10")), tmp_path / "b")
    folder = go_on(tmp_path / "b", tmp_path / "c", "1 20 20 20 10")
    text = (folder / "in_gm.dat").read_text()
    (folder / "in_gm.dat").write_text(text.replace("2.0\n0.0 ", "2.0\n0.5 "))
    with pytest.raises(InputError, match=r"in_gm\.dat: body 1: is not as in_cf\.dat has it"):
        read(folder, OPTIONS)
    (folder / "in_cf.dat").unlink()
    with pytest.raises(InputError, match=r"in_cf\.dat: cannot be read .*jclid 1 needs it"):
        read(folder, OPTIONS)


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        (Options(rule="each"), Options(), ["--rule: is outline, but the run before had each; give --rule each"]),
        (Options(rod=0.3), Options(), ["--rod: is 0.1, but the run before had 0.3; give --rod 0.3"]),
        (Options(), Options(release="force"), ["--release: is force, but the run before had overlap; give --release"]),
        (Options(release="force", rule="printed", rod=0.2), Options(rule="each"), ["--release", "--rule", "--rod"]),
    ],
)
def test_a_run_goes_on_with_its_options_and_no_others(tmp_path, before, after, said):
    first = read(decks.write(tmp_path / "a", decks.SEGMENT), before)
    first.advance(5)
    first.write_next(tmp_path / "a")
    folder = go_on(tmp_path / "a", tmp_path / "b", "1 5 20 20 10")
    assert read(folder, before).options == before
    with pytest.raises(InputError) as caught:
        read(folder, after)
    assert len(caught.value.faults) == len(said)
    for fault, each in zip(caught.value.faults, said, strict=True):
        assert f"{folder / 'in_cf.dat'}: {each}" in fault.line()
    # Files of before options were kept have none, and are read as they are.
    text = (folder / "in_cf.dat").read_text()
    assert text.count("\noptions/") == 3
    lines = text.splitlines(keepends=True)
    gone = [k for k, line in enumerate(lines) if line.startswith("options/")]
    (folder / "in_cf.dat").write_text(
        "".join(line for k, line in enumerate(lines) if k - 1 not in gone and k not in gone)
    )
    read(folder, after)


def test_a_rule_is_no_matter_where_there_are_only_discs(tmp_path):  # nothing to refuse
    first = read(decks.write(tmp_path / "a"), Options(rule="each", rod=0.3))
    first.write_next(tmp_path / "a")
    read(go_on(tmp_path / "a", tmp_path / "b", "1 5 20 20 10"), Options())


def test_the_chain_is_bonded_by_what_the_tutorial_prints(tmp_path):
    # Section II-3: discs 2 apart of radius 1.1, k 1e8: -20000000 with each neighbour.  Coordinates up to 50 round the
    # overlap 0.2 by 50 eps, so the force by 1e8 50 eps < 2e-6.
    model = read(decks.write(tmp_path, decks.chain()), OPTIONS)
    text = tension_text(model.built)
    rows = [[float(word.replace("d", "e")) for word in line.split()] for line in text.splitlines()]
    assert rows[:2] == [[1, 1], [2, pytest.approx(-2e7, abs=2e-6)]]
    assert [row[0] for row in rows[2:8]] == [2, 1, 3, 3, 2, 4]
    assert rows[2][1] == rows[5][1] == 2
    assert model.grains.bonds is None  # told of, not made


@pytest.mark.slow
def test_a_bonded_chain_stays_and_an_unbonded_one_flies_apart(tmp_path):
    printed = decks.boundary("3 1 100 100 10")
    plain = read(decks.write(tmp_path / "a", decks.chain()), OPTIONS)
    kept = {"in_cf0": tension_text(plain.built)}
    bonded = read(decks.write(tmp_path / "b", decks.chain(), printed, **kept), OPTIONS)
    assert bonded.grains.bonds.count == 19
    start = bonded.grains.discs.position.copy()
    for model in (plain, bonded):
        model.advance(100)
    # Forces cancel to round-off, 2e7 eps = 4e-9 on a mass of 9.5: in 1e-3 s that moves them by 2e-16 at most.
    assert np.abs(bonded.grains.discs.position - start).max() < 1e-12
    assert np.abs(plain.grains.discs.position - start).max() > 0.1  # the twin: without bonds they part
    assert tension_text(bonded.built) == kept["in_cf0"]


@pytest.mark.parametrize(("rule", "times"), [("outline", 1.0), ("each", 2.0), ("printed", 2.0)])
def test_a_corner_of_two_segments_presses_on_a_side_twice_where_each_counts(tmp_path, rule, times):
    # thick 0.1, a corner 0.09 over the floor: pressed in by 0.01.  One segment's end, beside it, counts once.
    rows = ("0 2 0", "1 1 3", "0 0 0", "1 -2 .09", "2 4", "2 2 4", "1 7", "3 1 7", "-2 .09",
            "2 1 1", "0 0 0", "1 6 .09", "6 4")  # fmt: skip
    gm = decks.grains(*rows, domain="-10 10 0 10 0.1", dt="1d-9").replace("-980.0d0", "0.0d0")
    model = read(decks.write(tmp_path, gm), Options(rule=rule))
    model.advance(1)
    pressed = 1e8 * 0.01
    # 0.1 - 0.09 rounds by eps 0.1, a part of 1e-15 of 0.01.
    assert model.grains.wall_load[2, 1] == pytest.approx(-pressed * (times + 1.0), rel=1e-13)
    elastic = model.series()["enka"]
    assert elastic == pytest.approx(0.5 * pressed * 0.01 * (times + 1.0), rel=1e-6)  # in 1e-9 s it moves by 1e-9 or so
    bodies = model.grains.contact.table[: 1 if rule == "outline" else -1, : 1 if rule == "outline" else -1]
    assert (bodies == bodies[0, 0]).all()  # between bodies nothing changes


def test_rules_other_than_outline_change_how_a_triangle_bounces(tmp_path):
    # The twin of what was wrong: the rule changed no bit of what bounces on a side of the domain.
    folder = decks.write(tmp_path, decks.TRIANGLE.replace("-2 2", "-2 .1"))
    places = []
    for rule in ("outline", "each", "printed"):
        model = read(folder, Options(rule=rule))
        model.advance(1000)
        places.append(model.grains.discs.position.copy())
    assert np.abs(places[1] - places[0]).max() > 1e-3
    assert (places[2] == places[1]).all()  # at sides both count alike


def test_a_disc_without_a_floor_is_lost_and_named(tmp_path):
    model = read(decks.write(tmp_path), OPTIONS)
    model.check()
    model.grains.discs.position[0, 1] = -20.001  # more than the domain is long below it
    with pytest.raises(Unstable, match=r"distance from the domain = 20 .*at point 1"):
        model.check()


SQUARES = decks.grains(
    "0 2 0", "1 1 4", "0 0 0", "1 0 4", "2 4", "2 2 4", "2 6", "3 2 6", "0 6", "4 0 6", "0 4",
    "2 1 4", "0 0 0", "1 2.19 4", "4.19 4", "2 4.19 4", "4.19 6", "3 4.19 6", "2.19 6", "4 2.19 6", "2.19 4",
    dt="1d-5", domain="-10 10 0 10 0.1",
).replace("-980.0d0", "0.0d0")  # fmt: skip


@pytest.mark.slow
def test_squares_are_bonded_side_to_side_and_stay(tmp_path):
    plain = read(decks.write(tmp_path / "a", SQUARES), OPTIONS)
    kept = {"in_cf0": tension_text(plain.built)}
    bonded = read(decks.write(tmp_path / "b", SQUARES, decks.boundary("3 1 100 100 10"), **kept), OPTIONS)
    assert tension_text(bonded.built) == kept["in_cf0"]
    # Sides 0.19 apart of thickness 0.1 overlap by 0.01: contacts pull with k 0.01 each, of whatever sign they count.
    forces = [abs(float(line.split()[1].replace("d", "e"))) for line in kept["in_cf0"].splitlines() if "d" in line
              or "." in line]  # fmt: skip
    assert len(forces) >= 4
    assert max(forces) == pytest.approx(1e6, rel=1e-9)
    start = bonded.grains.discs.position.copy()
    for model in (plain, bonded):
        model.advance(200)
    # Round-off of forces of 1e6 on masses of 10 over 2e-3.
    assert np.abs(bonded.grains.discs.position - start).max() < 1e-12
    assert np.abs(plain.grains.discs.position - start).max() > 1e-3


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1 1\n30 -2d7\n", "line 2, other = 30: makes no sense, expected 1 to 20, not 1 itself"),
        ("1 1\n2 -2d7\n2 1\n1 -3d7\n", "line 4, tension = -30000000: makes no sense, expected -2e+07, as before"),
        ("1 2\n2 -2d7\n", "line 2, other: the file ends here"),
        ("1 1\n2 -2d7\n", "number 2: has no bond with 1, but 1 has one with it; name each bond at both ends"),
        ("1 1\n2 -2d7\n2 2\n1 -2d7\n3 -2d7\n", "number 3: has no bond with 2, but 2 has one with it"),
        ("1 1\n2 2d7\n2 1\n1 2d7\n", "line 2, tension = 20000000: makes no sense, expected < 0, as a bond cancels"),
        ("1 2\n2 -2d7\n2 -2d7\n2 1\n1 -2d7\n", "line 3, other = 2: makes no sense, expected each once for 1"),
        (
            "1 1\n20 -1\n20 1\n1 -1\n",
            "line 2, other = 20: makes no sense, expected a disc that touches 1: they stand 35.8",
        ),
        ("", "bonds = 0: there are none, and jclid 3 needs some; write jclid 0 in in_bc.dat to run without bonds"),
        ("1 0\n2 0\n", "bonds = 0: there are none"),
    ],
)
def test_malformed_tensions_are_named_by_line(tmp_path, text, said):
    model = read(decks.write(tmp_path, decks.chain(), in_cf0=text), OPTIONS)
    with pytest.raises(InputError) as caught:
        read_tensions(tmp_path / "in_cf0.dat", model.built)
    assert said in str(caught.value)


def test_positive_bonds_of_discs_are_one_line_with_their_number(tmp_path):
    text = tension_text(read(decks.write(tmp_path / "a", decks.chain()), OPTIONS).built).replace("-", "")
    model = read(decks.write(tmp_path / "b", decks.chain(), in_cf0=text), OPTIONS)
    with pytest.raises(InputError) as caught:
        read_tensions(tmp_path / "b" / "in_cf0.dat", model.built)
    assert len(caught.value.faults) == 1
    assert "line 2, tension" in str(caught.value)
    assert str(caught.value).endswith("a bond cancels a contact that presses; so are 37 more rows")  # 38 in all


@pytest.mark.parametrize(
    ("text", "rule", "said"),
    [
        (
            "1 1\n2 -5d6\n2 1\n1 -5d6\n",
            "outline",
            "line 2, other = 2: makes no sense, expected a point of another body: 1",
        ),
        ("1 1\n10 -5d6\n10 1\n1 -5d6\n", "outline", "line 2, other = 10: makes no sense, expected a point of another"),
        ("1 1\n6 5d6\n6 1\n1 5d6\n", "each", "line 2, tension = 5000000: makes no sense, expected < 0, as a bond"),
        ("1 1\n6 5d6\n6 1\n1 5d6\n", "outline", ""),  # the check that must fail
    ],
)
def test_bonds_of_corners_are_between_bodies_and_positive_where_corners_count_once(tmp_path, text, rule, said):
    model = read(decks.write(tmp_path, SQUARES, in_cf0=text), Options(rule=rule))  # points 1 to 8, segments 9 to 16
    if not said:
        assert [row[3] for row in read_tensions(tmp_path / "in_cf0.dat", model.built)] == [-5e6]
        return
    with pytest.raises(InputError) as caught:
        read_tensions(tmp_path / "in_cf0.dat", model.built)
    assert said in str(caught.value)
    assert len(caught.value.faults) == 1


def test_random_discs_are_as_many_as_the_tutorial_has(tmp_path):
    # I-7: box 80 by 80, radii 1 to 2, void ratio 0.5: 6400/1.5/(7 pi/3) = 582.05.
    gm = "0 0 0\n5.0d-5 0.0 -980.0d0\n1\n2.5d0 1.0d8 0.25d8 1.0d2 0.5d2 27.0d0\n0 80 0 80 0\n1.0 2.0\n1\n0.5\n"
    deck = read_deck(decks.write(tmp_path, gm))
    bodies = random_discs(deck, deck.random, 0)
    assert len(bodies) == 582
    assert bodies == random_discs(deck, deck.random, 0)
    assert bodies != random_discs(deck, deck.random, 1)
    radius = np.array([body.discs[0][0] for body in bodies])
    assert len(set(radius.tolist())) == 582
    assert radius.min() > 1.0
    assert radius.max() < 2.0
    # Midpoints of 582 shares of the range integrate r^2 to (1/582)^2/12, and 582 is rounded: half a disc of 582.
    assert 6400.0 / (np.pi * radius @ radius) - 1.0 == pytest.approx(0.5, abs=1.5 * 0.5 / 582 + 1e-6)


STRIPS = 8


def strips(along, radius):
    """Share of each of STRIPS strips of a box of 80 by 80 that discs cover."""

    def left(where):
        """Area of each disc to the left of ``where``."""
        t = np.clip((where - along) / radius, -1.0, 1.0)
        return radius**2 * (np.arccos(-t) + t * np.sqrt(1.0 - t * t))

    edges = np.linspace(0.0, 80.0, STRIPS + 1)
    return np.diff([left(edge).sum() for edge in edges]) / (80.0 * 80.0 / STRIPS)


# A strip holds 582/8 = 73 discs.  Drawn independently they scatter by sqrt(73) = 8.5; one in each part of the domain,
# by those that an edge cuts off: of the 24 along each edge about half a disc each, sqrt(2 24)/2 = 3.5 before they part,
# and less after.  Twice that is the most of 8 strips, two directions and six seeds that is allowed: 7 of 73 discs.
EVEN = 7.0 / 73.0 * 2.0 / 3.0


def test_random_discs_are_spread_evenly_for_every_seed(tmp_path):
    gm = "0 0 0\n5.0d-5 0.0 -980.0d0\n1\n2.5d0 1.0d8 0.25d8 1.0d2 0.5d2 27.0d0\n0 80 0 80 0\n1.0 2.0\n1\n0.5\n"
    deck = read_deck(decks.write(tmp_path, gm))
    for seed in range(6):
        rows = np.array([body.discs[0] for body in random_discs(deck, deck.random, seed)])
        for axis in (1, 2):
            assert np.abs(strips(rows[:, axis], rows[:, 0]) - 2.0 / 3.0).max() < EVEN, seed


def test_discs_that_start_anywhere_lie_unevenly():  # the twin that must fail: 0.57 to 0.73 at seed 0
    radius = np.random.default_rng(0).permutation(1.0 + (np.arange(582) + 0.5) / 582)
    where = place((0.0, 0.0), (80.0, 80.0), radii=radius, seed=0).position
    assert np.abs(strips(where[:, 0], radius) - 2.0 / 3.0).max() > EVEN


SMALL = "0 0 0\n5.0d-5 0.0 -980.0d0\n1\n2.5d0 1.0d8 0.25d8 1.0d2 0.5d2 27.0d0\n0 {0} 0 {0} 0\n1.0 2.0\n1\n{1}\n"


def test_few_random_discs_that_jam_are_drawn_again(tmp_path, monkeypatch):
    deck = read_deck(decks.write(tmp_path, SMALL.format(10, 0.5)))
    for seed in range(3):
        assert len(random_discs(deck, deck.random, seed)) == 9
    monkeypatch.setattr("porescale.demseg.build.TRIES", 1)
    jammed = 0
    for seed in range(3):  # the check that must fail: one start is not enough for all of them
        try:
            random_discs(deck, deck.random, seed)
        except InputError:
            jammed += 1
    assert jammed


@pytest.mark.parametrize(
    ("side", "void", "said"),
    [
        (8, 0.5, "line 8, void ratio = 0.5: 6 discs would fill 0.69 of the domain, which is too dense for them to lie"),
        (30, 0.1, "line 8, void ratio = 0.1: 112 discs would fill 0.91 of the domain, which is too dense"),
        (2.9, 0.1, "line 6, r2 = 2.0: makes a disc "),
        (2, 1.5, "line 8, void ratio = 1.5: leaves no room for a disc; give a smaller one"),
    ],
)
def test_random_discs_that_do_not_fit_are_refused_by_line(tmp_path, monkeypatch, side, void, said):
    monkeypatch.setattr("porescale.demseg.build.TRIES", 1)
    deck = read_deck(decks.write(tmp_path, SMALL.format(side, void)))
    with pytest.raises(InputError) as caught:
        random_discs(deck, deck.random, 0)
    assert str(caught.value).startswith(f"{tmp_path / 'in_gm.dat'}: {said}")
    assert len(caught.value.faults) == 1

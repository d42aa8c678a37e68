"""Bodies that no run can begin with are refused in one line with file, line and numbers; resting ones go on."""

import numpy as np
import pytest

from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.core.errors import InputError, Unstable
from porescale.demseg.build import Options
from porescale.demseg.check import SUNK
from porescale.demseg.deck import boundary_text, read_deck
from porescale.demseg.run import read
from tests.reference import decks
from tests.reference.folders import CASES


def body(*rows, discs=False, domain="-10 10 0 10 0"):
    """in_gm.dat of one body: each row two ends of a segment, or radius and centre of a disc."""
    lines = []
    for k, row in enumerate(rows):
        words = row.split()
        lines += [f"{k + 1} {' '.join(words[: 1 if discs else 2])}", " ".join(words[1 if discs else 2 :])]
    return decks.grains("1 0 0" if discs else "0 1 0", f"1 1 {len(rows)}", "0 0 0", *lines, dt="2d-5", domain=domain)


def two_discs(second):
    """in_gm.dat of a disc of radius 2 at (0, 5) and another."""
    return decks.DISC.replace("1 0 0\n1 1 1", "2 0 0\n1 1 1") + f"2 1 1\n0 0 0\n{second}\n"


FLAT = "the polygon has no area: its corners lie on one line"
CENTRE = "has its centre (0, 5) where body 1 has one: no direction parts them"


@pytest.mark.parametrize(
    ("gm", "said"),
    [
        (body("0 2 2 4", "2 4 4 6", "4 6 0 2"), f"line 7, body 1: {FLAT}"),
        (body("-4 1 0 1", "0 1 4 1", "4 1 -4 1"), f"line 7, body 1: {FLAT}"),
        (body("-4 1 0 1", "0 1 4 1", "4 1 2 1", "2 1 -4 1", domain="-10 10 0 10 0.1"), f"line 7, body 1: {FLAT}"),
        (body("0 0.5 2 2", "2 2 2 0.5", "2 0.5 0 2", "0 2 0 0.5"),
         "line 7, body 1: crosses itself: elements 1 and 3; give the outline in its order"),
        (body("0 0.5 2 2", "0 2 0 0.5", "2 2 2 0.5", "2 0.5 0 2"), "body 1: crosses itself: elements 1 and 4"),
        (two_discs("1 2.0\n0 5 0"), f"line 13, body 2, element 1: {CENTRE}"),
        (two_discs("1 1.0\n0 5 0"), f"line 13, body 2, element 1: {CENTRE}"),
        (body("2 0 5 0", "2 0 5 0", discs=True), "line 11, body 1, element 2: lies within element 1, so nothing can"),
        (body("2 0 5 0", "0.5 0.5 5 0", discs=True), "line 11, body 1, element 2: lies within element 1"),
        (body("0.5 0.5 5 0", "2 0 5 0", discs=True), "line 9, body 1, element 1: lies within element 2"),
        (body("0 2 2 4", "0 2 2 4"), "line 11, body 1, element 2: has the ends of element 1; leave it out"),
        (body("0 2 2 4", "2 4 0 2"), "line 11, body 1, element 2: has the ends of element 1; leave it out"),
        (body("-2 -1 2 -0.5"), "line 9, body 1, element 1: (0, -0.75), the middle of this segment, lies outside the"),
    ],
)  # fmt: skip
@pytest.mark.filterwarnings("error")
def test_a_body_without_sense_is_one_line_with_file_and_line(tmp_path, gm, said):
    folder = decks.write(tmp_path, gm)
    with pytest.raises(InputError) as caught:
        read(folder, Options())
    assert str(caught.value).startswith(f"{folder / 'in_gm.dat'}: ")
    assert said in str(caught.value)
    assert len(caught.value.faults) == 1


def test_a_disc_with_its_centre_on_a_side_is_refused(tmp_path):
    for where, name in (("0 0 0", "yc = 0"), ("0 10 0", "yc = 10"), ("-10 5 0", "xc = -10")):
        with pytest.raises(InputError, match=f"line 10, {name}: makes no sense, expected between"):
            read_deck(decks.write(tmp_path, decks.DISC.replace("0.0d0 5.0d0 0.0d0", where)))


@pytest.mark.parametrize("gm", [
    two_discs("1 2.0\n0.1 5 0"),
    body("2 0 5 0", "0.5 1.6 5 0", discs=True),
    body("0 2 2 4", "2 4 4 6.001", "4 6.001 0 2"),
    body("0 2 2 4", "2 4 4 6"),
])  # fmt: skip
def test_bodies_that_are_nearly_so_are_taken(tmp_path, gm):  # the check that must fail
    read(decks.write(tmp_path, gm), Options())


def test_a_segment_may_lie_beyond_a_side_by_what_it_can_press_in(tmp_path):
    least = SUNK * 4.0
    for depth, fine in ((0.999 * least, True), (1.001 * least, False)):
        folder = decks.write(tmp_path, body(f"-2 {-depth} 2 {-depth}"))
        if fine:
            read(folder, Options())
            continue
        with pytest.raises(InputError, match="lies outside the domain, whose sides would throw it; move it inside: x"):
            read(folder, Options())
    held = body("-2 -1 2 -1").replace("0 1 0\n1 1 1", "0 0 1\n1 1 1")
    assert read(decks.write(tmp_path / "held", held), Options()).deck.bodies[0].long


RESTING = body("5 0 8 0", "8 0 8 3", "8 3 5 3", "5 3 5 0")


@pytest.mark.parametrize(("name", "steps"), [("demseg_triangle", 3200), ("demseg_segment", 3198), ("", 1000)])
def test_a_body_pressed_into_a_side_goes_on_bit_for_bit(tmp_path, name, steps):
    folder = CASES / name if name else decks.write(tmp_path / "deck", RESTING)
    whole, first = read(folder, Options()), read(folder, Options())
    first.advance(steps)
    assert first.grains.discs.position[:, 1].min() < 0.0  # thick is 0: a corner in contact lies beyond the side
    (tmp_path / "out").mkdir()
    first.write_next(tmp_path / "out")
    for file in (tmp_path / "out").iterdir():
        file.rename(tmp_path / "out" / file.name.removeprefix("new_"))
    second = read(tmp_path / "out", Options())
    whole.advance(steps)
    for model in (whole, second):
        model.advance(100)
    assert (second.grains.discs.position == whole.grains.discs.position).all()
    assert (second.grains.discs.velocity == whole.grains.discs.velocity).all()
    bc = tmp_path / "out" / "in_bc.dat"
    deck = read_deck(tmp_path / "out")
    bc.write_text(boundary_text(deck).replace("1 ", "0 ", 1), encoding="utf-8")
    assert read(tmp_path / "out", Options()).deck.jclid == 0
    assert main(commands(), ["demseg", "convert", str(tmp_path / "out"), "--out", str(tmp_path / "a.toml")]) == 0


def test_a_place_that_is_no_number_is_named_as_the_deck_counts(tmp_path):
    model = read(decks.write(tmp_path), Options())
    model.grains.discs.position[0, 1] = np.nan
    with pytest.raises(Unstable, match=r"position = nan +at point 1;"):
        model.advance(1)


def test_a_step_beyond_the_stable_one_is_doubted_before_it_is_done(tmp_path, capsys):
    # 2 sqrt(m/k) of the disc is 1.12e-3; discs in any contacts are stable up to 0.365 of it (timestep.py).
    for dt, doubted in (("5.0d-5", False), ("6.7d-4", True)):
        folder = decks.write(tmp_path / dt, decks.DISC.replace("5.0d-5", dt), decks.boundary("0 0 2 2 1"))
        model = read(folder, Options())
        assert len(model.doubts()) == doubted
        assert main(commands(), ["demseg", "run", str(folder), "--out", str(tmp_path / "out" / dt), "--quiet"]) == 0
        said = f"warning: {folder / 'in_gm.dat'}: dt = 0.00067 is beyond 0.000409, up to which"
        assert (said in capsys.readouterr().err) == doubted


@pytest.mark.parametrize(
    ("job", "word", "value"),
    [
        *((job, "--seed", "-1") for job in ("run", "convert", "volonoi")),
        *((job, "--rod", value) for job in ("run", "convert") for value in ("0.0", "inf", "nan")),
    ],
)
def test_options_without_sense_are_refused_by_every_command_that_has_them(tmp_path, capsys, job, word, value):
    folder = decks.write(tmp_path, "0 0 0\n5d-5 0 -980\n1\n2.5 1d8 .25d8 1d2 .5d2 27\n0 30 0 30 0.1\n1 2\n1\n0.5\n")
    assert main(commands(), ["demseg", job, str(folder), "--out", str(tmp_path / "made"), word, value]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"{word} = {value}: is out of range")
    assert said.count("\n") == 1
    assert not (tmp_path / "made").exists()

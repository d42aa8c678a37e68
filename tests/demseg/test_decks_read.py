"""Decks of DEMseg are read as Fortran reads them; what is wrong in one is said by file, line, field and expectation."""

import math
import re

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.demseg.deck import boundary_text, grains_text, read_deck
from porescale.demseg.numbers import Reader, real
from porescale.demseg.state import read_state, state_text
from tests.reference import decks
from tests.reference.folders import CASES


def test_numbers_are_those_of_fortran(tmp_path):
    file = tmp_path / "a.dat"
    file.write_text("! a comment\n\n 5.0d-5, .5E+00 -1.D3 2*7   and words\n# more\n1\n2 3\n", encoding="utf-8")
    reader = Reader(file)
    assert reader.record(*((name, float) for name in "abc"), ("d", int), ("e", int)) == [5e-5, 0.5, -1000.0, 7, 7]
    assert reader.record(*((name, int) for name in "abc")) == [1, 2, 3]  # a record runs over lines
    reader.done()


@pytest.mark.parametrize(
    ("word", "value"),
    [("1.0+8", 1e8), ("-.5-3", -5e-4), ("1.0d0", 1.0), ("2.5D+02", 250.0), ("7.", 7.0), ("3q2", 300.0), ("+1e-1", 0.1)],
)
def test_every_form_of_a_real_is_its_value(tmp_path, word, value):
    file = tmp_path / "a.dat"
    file.write_text(f"{word} 1\n", encoding="utf-8")
    assert Reader(file).record(("a", float), ("b", int)) == [value, 1]


@pytest.mark.parametrize("word", ["1.0d", "1.0+", "+-1", "1.0e+", "1.0x8", "1.0+8.0", "nan", "-inf"])
def test_what_is_no_real_is_no_comment_either(tmp_path, word):
    # Where a comment may stand, after the first value of a line: such a word would drop the rest of the line.
    file = tmp_path / "a.dat"
    file.write_text(f"1 {word} 2\n3 4\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"line 1, b = '.*': is no number"):
        Reader(file).record(("a", float), ("b", float), ("c", float))


@pytest.mark.parametrize(
    "comment", ["information", "- stiffness", "nano", "infinite", "...", ".", "*", "*note*", "+", "nancy 2", "- 2"]
)
def test_words_that_only_begin_as_a_number_may_are_a_comment(tmp_path, comment):
    file = tmp_path / "a.dat"
    file.write_text(f"1 {comment}\n2 3\n", encoding="utf-8")
    reader = Reader(file)
    assert reader.record(*((name, float) for name in "abc")) == [1.0, 2.0, 3.0]
    reader.done()


@pytest.mark.parametrize("word", ["-1x", "+.5x", "2*x", "3*", "Infinity", "+NaN", ".5.", "--1"])
def test_words_that_begin_with_a_digit_or_are_no_finite_number_are_refused(tmp_path, word):  # the check that must fail
    file = tmp_path / "a.dat"
    file.write_text(f"1 {word} 2\n3 4\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"line 1, b = '.*': is no number"):
        Reader(file).record(("a", float), ("b", float), ("c", float))


def test_of_a_mode_that_is_not_known_nothing_else_is_blamed(tmp_path):
    random = "{} 0 0\n5.0d-5 0 -980\n1\n1 1 1 0 0 20\n0 9 0 9 0\n0.5 0.5\n1\n1.0\n"
    assert read_deck(decks.write(tmp_path / "known", random.format(0))).random is not None
    with pytest.raises(InputError) as caught:
        read_deck(decks.write(tmp_path / "other", random.format(2)))
    assert [it.key for it in caught.value.faults] == ["line 1, mode"]


def test_mode_0_refuses_more_discs_than_a_deck_may_have(tmp_path):
    from porescale.demseg.deck import MOST_BODIES, Random

    domain = (0.0, 1.0, 0.0, 1.0)
    fits = (1.0 / (2.0 * math.pi * MOST_BODIES)) ** 0.5  # of a void ratio of 1
    assert Random(fits, fits, 1, 1.0).count(domain) == MOST_BODIES
    assert Random(1e-170, 1e-170, 1, 1.0).count(domain) == MOST_BODIES + 1
    random = "0 0 0\n5.0d-5 0 -980\n1\n1 1 1 0 0 20\n0 1 0 1 0\n{0} {0}\n1\n1.0\n"
    assert read_deck(decks.write(tmp_path / "fits", random.format(1.001 * fits))).random is not None
    with pytest.raises(InputError, match=r"line 8, void ratio = 1: makes no sense, expected a larger one, or larger"):
        read_deck(decks.write(tmp_path / "more", random.format(0.99 * fits)))


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_is_passed_over(tmp_path, encoding):
    plain = read_deck(decks.write(tmp_path))
    for name, end in (("in_gm.dat", "\r\n"), ("in_bc.dat", "\r\n\x1a")):
        text = (tmp_path / name).read_text(encoding="utf-8").rstrip("\n")
        (tmp_path / name).write_bytes((text.replace("\n", "\r\n") + end).encode(encoding))
    assert (tmp_path / "in_gm.dat").read_bytes()[0] > 127  # the mark is there
    assert read_deck(tmp_path) == plain


@pytest.mark.parametrize("value", [0.1, -5e-5, 1e300, 5e-324, -0.0, 123456789.123456789])
def test_a_number_reads_back_to_the_same_bits(tmp_path, value):
    file = tmp_path / "a.dat"
    file.write_text(real(value), encoding="utf-8")
    assert np.array(Reader(file).record(("a", float))).tobytes() == np.array([value]).tobytes()


@pytest.mark.parametrize("gm", [decks.DISC, decks.CLUMP, decks.SEGMENT, decks.TRIANGLE, decks.PUSHED])
def test_a_deck_written_is_the_deck_read(tmp_path, gm):
    bc = decks.boundary("0 3 400 100 10", *decks.PUSH) if gm is decks.PUSHED else ""
    deck = read_deck(decks.write(tmp_path / "a", gm, bc))
    again = read_deck(decks.write(tmp_path / "b", grains_text(deck), boundary_text(deck)))
    assert again == deck


def test_comments_and_blank_lines_are_passed_over(tmp_path):
    plain = read_deck(decks.write(tmp_path / "a"))
    lines = decks.DISC.splitlines()
    noted = "! a disc\n\n" + "\n\n".join(f"{line}   ! {k} 1 2" for k, line in enumerate(lines)) + "\n# end\n"
    words = decks.boundary().replace("400 100 10", "400 100 10   jclid, iloop, nstep")
    assert read_deck(decks.write(tmp_path / "b", noted, words)) == plain
    # As the tutorial has it: names beside the numbers, also on the first line of a record that has two.
    named = "\n".join(f"{line}  ielm rad(ielm) 粒子番号 2.0" for line in lines) + "\n"
    assert read_deck(decks.write(tmp_path / "c", named)) == plain


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("5.0d-5", "5.0x-5", "in_gm.dat: line 2, dt = '5.0x-5': is no number, expected a number such as 5.0d-5"),
        ("5.0d-5", "-5.0d-5", "line 2, dt = -5e-05: makes no sense, expected > 0"),
        ("1 0 0\n5", "2 0 0\n5", "line 1, mode = 2: makes no sense, expected 0 (random discs) or 1 (bodies)"),
        ("1 0 0\n5", "1 0 0 7\n5", "line 1, after mode3 = '7': one value too many"),
        ("2.5d0 1.0d8", "2.5d0 0", "line 4, kn = 0: makes no sense, expected > 0"),
        ("1 1 1", "1 2 1", "line 7, imat = 2: makes no sense, expected 1 to 1"),
        ("1 1 1", "1.5 1 1", "line 7, ic = '1.5': is no whole number"),
        ("1 2.0d0", "1 -2.0d0", "rad = -2: makes no sense, expected > 0"),
        ("0.0d0 5.0d0 0.0d0\n", "0.0d0", "line 10, yc: the file ends here, expected a number"),
        ("5.0d0 0.0d0\n", "5.0d0 0.0d0\n3 4\n", "line 11, after the last record = '3': one value too many"),
        ("1.0d8", "1.0d999", "line 4, kn = '1.0d999': is too large"),
        ("1.0d8", "1.0d200", "line 4, kn = 1e+200: makes no sense, expected 1e-100 to 1e+100"),
        ("2.5d0 1.0d8", "1d-300 1.0d8", "line 4, rho = 1e-300: makes no sense, expected 1e-100 to 1e+100"),
        ("1 2.0d0", "1 1d-300", "rad = 1e-300: makes no sense, expected 1e-100 to 1e+100"),
        (
            "0.0d0 5.0d0 0.0d0",
            "-10.5 5 0",
            "line 10, xc = -10.5: makes no sense, expected between -10 and 10, inside the domain",
        ),
        ("0.0d0 5.0d0 0.0d0", "0 10.1 0", "line 10, yc = 10.1: makes no sense, expected between 0 and 10, inside"),
        ("-10.0d0 10.0d0", "10.0d0 -10.0d0", "line 5, x2 = -10: makes no sense, expected > x1 = 10"),
    ],
)
def test_a_malformed_in_gm_is_named_by_line_and_field(tmp_path, old, new, said):
    assert old in decks.DISC
    with pytest.raises(InputError) as caught:
        read_deck(decks.write(tmp_path, decks.DISC.replace(old, new, 1)))
    assert said in str(caught.value)
    assert len(caught.value.faults) == 1


@pytest.mark.parametrize(
    ("bc", "said"),
    [
        ("2 0 400 100 10\n0\n0", "line 1, jclid = 2: makes no sense, expected 0 (new), 1 (goes on), 3 (bonds)"),
        ("0 0 400 0 10\n0\n0", "line 1, nprn1 = 0: makes no sense, expected 1 or more"),
        ("0 0 400 100 10\n1\n5\n0", "line 3, recorded body 1 = 5: makes no sense, expected 1 to 1"),
        ("0 0 400 100 10\n0\n1\n1 2 0 1 0 1 0", "line 4, kind of x = 2: makes no sense, expected 1 (moved) or"),
        ("0 0 400 100 10\n0\n1\n1 1 0 1 0 1", "value of rotation: the file ends here, expected a number"),
        ("0 0 400 100 10\n0", "line 2, npbd: the file ends here"),
    ],
)
def test_a_malformed_in_bc_is_named_by_line_and_field(tmp_path, bc, said):
    with pytest.raises(InputError) as caught:
        read_deck(decks.write(tmp_path, bc=bc))
    assert said in str(caught.value)
    assert "in_bc.dat: " in str(caught.value)


SHORT = "has 5 of the 6 values rho, kn, ks, cn, cs, mu; then line 5, after mu = '10.0d0': one value too many"
ELEMENT = "of the 5 values ielm, rad, xc, yc, wc; then line 10, wc: the file ends here"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("0.0d0 0.0d0 0.0d0\n-10", "0.0d0 0.0d0\n-10", f"line 4: {SHORT}"),
        ("0.0d0 0.0d0 0.0d0\n-10", "0.0d0 0.0d0 mu\n-10", f"line 4: {SHORT}"),
        ("5.0d-5 0.0 -980.0d0", "5.0d-5 0.0",
         "line 2: has 2 of the 3 values dt, gx, gy; then line 4, nmat = '2.5d0': is no whole number"),
        ("1 0 0\n5", "1 0\n5", "line 1: has 2 of the 3 values mode, mode2, mode3; then line 2, mode3 = '5.0d-5'"),
        ("1 2.0d0", "1", f"lines 9 and 10: have 4 {ELEMENT}"),
        ("5.0d0 0.0d0\n", "5.0d0\n", f"lines 9 and 10: have 4 {ELEMENT}"),
    ],
)  # fmt: skip
def test_a_line_with_too_few_values_is_the_one_that_is_named(tmp_path, old, new, said):
    assert old in decks.DISC
    with pytest.raises(InputError) as caught:
        read_deck(decks.write(tmp_path, decks.DISC.replace(old, new, 1)))
    assert said in str(caught.value)
    assert len(caught.value.faults) == 1


@pytest.mark.parametrize("name", ["in_gm.dat", "in_bc.dat"])
@pytest.mark.parametrize("deck", ["demseg_disc", "demseg_triangle", "demseg_repose", "demseg_control/moved"])
def test_every_line_that_lost_values_is_the_first_that_is_named(tmp_path, deck, name):
    whole = (CASES / deck / name).read_text(encoding="utf-8").splitlines()
    for k, line in enumerate(whole):
        numbers = [word for word in line.split() if word[0] in "+-.0123456789"]
        for left in range(1, len(numbers)):
            for other in ("in_gm.dat", "in_bc.dat"):
                (tmp_path / other).write_bytes((CASES / deck / other).read_bytes())
            text = "\n".join([*whole[:k], " ".join(numbers[:left]), *whole[k + 1 :]])
            (tmp_path / name).write_text(text, encoding="utf-8")
            with pytest.raises(InputError) as caught:
                read_deck(tmp_path)
            first = re.match(r"lines? (\d+)(?: and (\d+))?", caught.value.faults[0].key)
            assert str(k + 1) in first.groups(), caught.value


def test_one_number_a_line_is_no_short_line(tmp_path):
    # As new_in_bc.dat has the recorded bodies; the fault after them is its own.
    bc = decks.boundary("0 0 400 100 10", "2", "1", "2", "7")
    with pytest.raises(InputError) as caught:
        read_deck(decks.write(tmp_path, decks.PUSHED, bc))
    assert caught.value.faults[0].key == "line 5, npbd"


def test_all_faults_of_meaning_are_said_at_once(tmp_path):
    bad = decks.DISC.replace("5.0d-5", "0").replace("2.5d0", "-1").replace("1 2.0d0", "1 0")
    with pytest.raises(InputError) as caught:
        read_deck(decks.write(tmp_path, bad))
    assert [fault.key for fault in caught.value.faults] == ["line 2, dt", "line 4, rho", "line 9, rad"]


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"in_gm\.dat: cannot be read"):
        read_deck(tmp_path)


def test_a_state_is_read_back_bit_for_bit(tmp_path):
    state = {
        "a": {"b": np.array([[0.1, np.nan], [-0.0, 1e-320]]), "c": np.array([1, 0], np.uint8)},
        "n": 3,
        "x": 0.3,
        "none": np.zeros((0, 3)),
        "big": np.arange(20, dtype=np.int32),
    }
    file = tmp_path / "in_cf.dat"
    file.write_text(state_text(state), encoding="utf-8")
    again = read_state(file)
    assert again["a"]["b"].tobytes() == state["a"]["b"].tobytes()
    for name in ("none", "big"):
        assert again[name].dtype == state[name].dtype
        assert again[name].shape == state[name].shape
        assert (again[name] == state[name]).all()
    assert (again["n"], again["x"], again["a"]["c"].tolist()) == (3, 0.3, [1, 0])


@pytest.mark.parametrize("text", ["x float32 1\n1\n", "x float64 2\n1\n", "x int64\nhalf\n", "\x00\x01\n"])
def test_a_damaged_state_is_named_by_line(tmp_path, text):
    file = tmp_path / "in_cf.dat"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"in_cf\.dat: line 1"):
        read_state(file)

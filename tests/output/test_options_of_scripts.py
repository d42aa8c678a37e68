"""Options of scripts of cases: a number below its least, as of a mean of none, is refused before anything is done."""

import runpy
import sys
from pathlib import Path

import pytest

from porescale.output.case import options
from tests.reference.folders import ROOT


def asked(monkeypatch, packings):
    """What a script is asked for on a command line with so many packings."""
    monkeypatch.setattr(sys, "argv", ["script", "--packings", str(packings)])
    return options("A script.", Path("case"), packings=(int, 4, "packings", 1), discs=(int, 0, "discs"))


@pytest.mark.parametrize("packings", [0, -1])
def test_no_packing_is_refused_with_exit_code_2(monkeypatch, capsys, packings):
    with pytest.raises(SystemExit) as caught:
        asked(monkeypatch, packings)
    assert caught.value.code == 2
    said = f"--packings = {packings}: is out of range (allowed: 1 or more)"
    assert said in capsys.readouterr().err


def test_one_packing_is_enough(monkeypatch):  # the check that must fail
    assert asked(monkeypatch, 1).packings == 1


def test_any_option_with_a_least_has_it_and_no_other(monkeypatch, capsys):
    for words, more in (
        (["--rows", "4"], {"rows": (int, 9, "rows", 5)}),
        (["--end", "0.1"], {"end": (float, 1.0, "s", 0.5)}),
    ):
        monkeypatch.setattr(sys, "argv", ["script", *words])
        with pytest.raises(SystemExit) as caught:
            options("A script.", Path("case"), **more)
        assert caught.value.code == 2
        assert f"{words[0]} = {words[1]}: is out of range (allowed: " in capsys.readouterr().err
    monkeypatch.setattr(sys, "argv", ["script", "--packings", "-1"])
    assert options("A script.", Path("case"), packings=(int, 4, "one without a least")).packings == -1


@pytest.mark.parametrize("given", ["nan", "inf", "-inf"])
def test_a_number_that_is_not_finite_is_refused(monkeypatch, capsys, given):
    """nan is not below a least, and an end at inf is never reached."""
    monkeypatch.setattr(sys, "argv", ["script", f"--end={given}"])
    with pytest.raises(SystemExit) as caught:
        options("A script.", Path("case"), end=(float, 1.0, "s", 0.5))
    assert caught.value.code == 2
    assert f"--end = {given}: is not finite" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("script", "words", "said"),
    [
        ("clay_bar/clay_bar", ["--rows", "1"], "2 or more"),  # no row between its ends: the largest of nothing
        ("clay_bar/clay_bar", ["--turns", "0"], "0.001 or more"),  # a mean over no time
        ("turned_stressed_block/turned_stressed_block", ["--steps", "1"], "2 or more"),  # nan
        ("liquid_columns/liquid_columns", ["--across", "3"], "4 or more"),  # what a scene asks for at least
        ("oscillating_drop/oscillating_drop", ["--across", "6"], "7 or more"),  # two cutoffs in a period
        ("sph_corrections/sph_corrections", ["--across", "6"], "7 or more"),  # likewise
        ("collapsing_water_column/release", ["--across", "3"], "4 or more"),
        ("dry_levee/safety", ["nowhere"], "no run here"),
        ("micro_to_macro/micro_to_macro", ["--rows", "x"], "argument --rows: invalid"),
        ("micro_to_macro/micro_to_macro", ["--rows", "9,6"], "argument --rows: invalid"),  # not few to many
        ("micro_to_macro/micro_to_macro", ["--beds", "-1"], "0 or more"),
        ("micro_to_macro/micro_to_macro", ["--columns", "1"], "2 or more"),  # no bar
        ("micro_to_macro/micro_to_macro", ["--slopes", "-1"], "0 or more"),
        ("micro_to_macro/micro_to_macro", ["--squeezed", "-1"], "0 or more"),
    ],
)
def test_scripts_of_the_continuum_refuse_what_they_cannot_run(monkeypatch, capsys, tmp_path, script, words, said):
    """Each ended in a traceback, or in numbers that are none."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["script", *words])
    with pytest.raises(SystemExit) as caught:
        runpy.run_path(str(ROOT / "cases" / f"{script}.py"), run_name="__main__")
    assert caught.value.code == 2
    assert said in capsys.readouterr().err.splitlines()[-1]

"""Options of scripts of cases: a number below its least, as of a mean of none, is refused before anything is done."""

import sys
from pathlib import Path

import pytest

from porescale.output.case import options


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

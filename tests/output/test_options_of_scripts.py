"""Options of scripts of cases: a mean of no packings is refused before anything is computed."""

import sys
from pathlib import Path

import pytest

from porescale.output.case import options


def asked(monkeypatch, packings):
    """What a script is asked for on a command line with so many packings."""
    monkeypatch.setattr(sys, "argv", ["script", "--packings", str(packings)])
    return options("A script.", Path("case"), packings=(int, 4, "packings"))


@pytest.mark.parametrize("packings", [0, -1])
def test_no_packing_is_refused_with_exit_code_2(monkeypatch, capsys, packings):
    with pytest.raises(SystemExit) as caught:
        asked(monkeypatch, packings)
    assert caught.value.code == 2
    said = f"--packings = {packings}: is out of range (allowed: 1 or more)"
    assert said in capsys.readouterr().err


def test_one_packing_is_enough(monkeypatch):  # the check that must fail
    assert asked(monkeypatch, 1).packings == 1

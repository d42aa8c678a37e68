"""What --help says of the commands of both packages, and how texts of options are read."""

from typing import Any

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import commands
from porescale.common.cli import application
from porescale.common.cli.show import _parts


def paths(app: Any, words: tuple[str, ...] = ()) -> list[tuple[str, ...]]:
    """All commands below ``app``, those of groups too, as the words that call them."""
    found = [words] if words else []
    for name in app:
        if not name.startswith("-"):
            found += paths(app[name], (*words, name))
    return found


@pytest.mark.parametrize("package", ["porescale", "continuum-sph"])
def test_no_option_of_any_command_has_two_defaults(package, capsys, monkeypatch) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    app = commands() if package == "porescale" else application.application(CONTINUUM)
    every = paths(app)
    assert ("study", "trade") in every
    for words in every:
        assert application.main(app, [*words, "--help"]) == 0
        shown = " ".join(capsys.readouterr().out.replace("│", "").split())
        twice = [it for it in shown.split(" --")[1:] if "if not given" in it and "[default:" in it]
        # A port of 0 is no second default: it is the word for "one that is free".
        assert not [it for it in twice if not it.startswith("port ")], words


@pytest.mark.parametrize(
    ("text", "parts"),
    [('0,"5 mm/s"', (0.0, "5 mm/s")), ("0, 5 mm/s", (0.0, "5 mm/s")), ("'1 cm',2", ("1 cm", 2.0)), (None, None)],
)
def test_quotes_that_a_shell_leaves_in_a_list_are_those_of_a_scene(text, parts) -> None:
    assert _parts(text) == parts

"""Commands that a command says to call next are read by a shell as they were meant, whatever folders are called."""

import shlex
from pathlib import Path

import pytest

from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.cli.run import summary
from porescale.common.record.drive import Outcome
from tests.reference.folders import CASES


def words_after(said: str, mark: str) -> list[str]:
    """Words of the command that stands behind ``mark`` in its line, as a shell divides them."""
    (line,) = (line for line in said.splitlines() if mark in line)
    return shlex.split(line.partition(mark)[2])


@pytest.mark.parametrize("name", ["plain", "with blank", "it's"])
def test_what_a_command_says_to_call_next_can_be_pasted(tmp_path, monkeypatch, capsys, name):
    monkeypatch.chdir(tmp_path)
    folder = Path(name)
    folder.mkdir()
    ended = Outcome(folder, "finished", 1, 0.1, 1.0, 2, 0.0)
    assert words_after(summary("porescale", "s", folder, ended), "pictures: ") == ["porescale", "show", name]
    file = folder / "clump.toml"
    assert main(commands(), ["demseg", "convert", "demseg_clump", "--out", str(file)]) == 0
    assert words_after(capsys.readouterr().out, "check it with ") == ["porescale", "check", str(file)]
    soil = folder / "soil.toml"
    soil.write_bytes((CASES / "soil_column_collapse" / "scene.toml").read_bytes())
    assert main(commands(), ["check", str(soil)]) == 2
    said = words_after(capsys.readouterr().err, "scenes of continuum-sph; ")
    assert said == ["continuum-sph", "check", str(soil)]
    (folder / "a.png").write_bytes(b"")
    assert main(commands(), ["piv", "compare", name, name]) == 2
    said = words_after(capsys.readouterr().err, "not been measured; ")
    assert said[:4] == ["porescale", "piv", "measure", name]

"""The Tab key completes commands and options."""

import subprocess
from pathlib import Path

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import commands
from porescale.common.cli import application

SHELLS = ("bash", "zsh", "fish", "powershell")


@pytest.mark.parametrize("shell", SHELLS)
def test_a_script_names_every_command_and_option(shell, tmp_path, capsys):
    app, file = commands(), tmp_path / "deep" / shell
    assert application.main(app, ["--install-completion", "--shell", shell, "--output", str(file)]) == 0
    text = file.read_text(encoding="utf-8")
    assert capsys.readouterr().out.strip() == str(file)
    assert all(name in text for name in app if not name.startswith("-"))
    assert all(name in text for name in ("overwrite", "quality", "draft", "trade", "homogenise"))
    assert "explode" not in text


def test_each_package_has_its_own(tmp_path):
    file = tmp_path / "script"
    words = ["--install-completion", "--shell", "bash", "--output", str(file)]
    assert application.main(application.application(CONTINUUM), words) == 0
    text = file.read_text(encoding="utf-8")
    assert "continuum-sph" in text
    assert "extremes" in text
    assert "homogenise" not in text


def test_bash_completes_a_command_that_was_begun(tmp_path):
    file = tmp_path / "script"
    application.main(commands(), ["--install-completion", "--shell", "bash", "--output", str(file)])
    asked = f'source "{file}"; COMP_WORDS=(porescale s); COMP_CWORD=1; _porescale; echo "${{COMPREPLY[@]}}"'
    done = subprocess.run(["bash", "-c", asked], capture_output=True, text=True, check=True, timeout=60)
    assert sorted(done.stdout.split()) == ["schema", "show", "study", "sweep"]


def test_an_unknown_shell_is_asked_for(monkeypatch, capsys):
    import cyclopts.completion

    def unknown() -> str:
        raise cyclopts.completion.ShellDetectionError("none")

    monkeypatch.setattr(cyclopts.completion, "detect_shell", unknown)
    assert application.main(commands(), ["--install-completion"]) == 2
    assert "--shell bash" in capsys.readouterr().err


def test_a_place_that_cannot_be_written_is_said(tmp_path, capsys):
    taken = tmp_path / "file"
    taken.touch()
    words = ["--install-completion", "--shell", "bash", "--output", str(taken / "script")]
    assert application.main(commands(), words) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert Path(taken).read_bytes() == b""

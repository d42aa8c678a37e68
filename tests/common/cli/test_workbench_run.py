"""What `run` makes of a scene's report: it is asked for once, and said before anything is built."""

from dataclasses import replace
from typing import Any

import pytest

from porescale.common.cli.application import application, main
from porescale.common.cli.report import Report
from tests.reference.toy_package import TEMPLATE, TOY


@pytest.fixture
def asked(tmp_path, monkeypatch) -> list[str]:
    """What is asked of a toy package that warns, in order; its scene lies where the test runs."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(TEMPLATE)
    return []


def run(asked: list[str], *words: str) -> int:
    def report(scene: Any) -> Report:
        asked.append("report")
        made = TOY.report(scene)
        made.warn("mind the step")
        return made

    def build(scene: Any) -> Any:
        asked.append("build")
        return TOY.build(scene)

    return main(application(replace(TOY, report=report, build=build)), ["run", "scene.toml", "--quiet", *words])


def test_a_scene_is_judged_once_and_its_warnings_are_said_once(asked, capsys):
    assert run(asked) == 0
    assert asked == ["report", "build"]
    assert capsys.readouterr().err == "warning: mind the step\n"


def test_what_the_report_refuses_is_not_built(asked, capsys):
    assert run(asked, "--set", "decay.rate=1000") == 2
    assert asked == ["report"]
    assert "beyond the stable limit" in capsys.readouterr().err

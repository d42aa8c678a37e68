"""What a case's README states is what its last recorded run measured, within what is expected, with today's choices.

`.ci/tables cases NAME` runs a case, writes its recorded.json, and the table of its README.
"""

import re
import runpy
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.common.schema.sections import load
from tests.architecture.sources import ROOT

WRITER = runpy.run_path(str(ROOT / ".ci" / "tables"))
CASES = sorted(path.parent for path in (ROOT / "cases").glob("*/expected.toml"))
RECORDED = [case for case in CASES if WRITER["kept"](case)]
CHOSEN = [case for case in RECORDED if "choices" in WRITER["kept"](case)]
"""Cases that are scenes: their records hold what the run card said of operators, kernels and laws."""
CELL = re.compile(r"(?<!\\)\|")
Rows = list[dict[str, Any]]


def stated(text: str) -> dict[str, str]:
    """Third cell of every line of the recorded table in a README, by its first."""
    lines = [CELL.split(line) for line in WRITER["inside"](text, "recorded") if line.startswith("| ")][1:]
    return {cells[1].strip().replace("\\|", "|"): cells[3].strip() for cells in lines}


def wrong(text: str, rows: Rows, record: Mapping[str, Any] | None) -> list[str]:
    """Rows that a README states otherwise than they were recorded, or that were recorded outside of the tolerance."""
    lines = WRITER["case_table"](rows, record)
    if "\n".join(lines) not in text:
        said = stated(text)
        right = stated("<!-- recorded -->\n" + "\n".join(lines) + "\n<!-- end of recorded -->")
        return sorted(said.items() ^ right.items()) or ["what is said of the run"]
    return WRITER["outside"](rows, record["numbers"]) if record else []


def other_choices(scene: Mapping[str, Any], record: Mapping[str, Any]) -> list[str]:
    """Choices of a scene that are not those that its run was recorded with."""
    now = WRITER["choices"](scene)
    return sorted({key for key, _ in now.items() ^ record["choices"].items()})


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_a_readme_states_what_was_recorded(case: Path) -> None:
    text, rows, record = WRITER["readme"](case), WRITER["expected"](case), WRITER["kept"](case)
    for row in rows:  # seen with pytest -s, and where the test fails
        found = record["numbers"].get(row["name"]) if record else None
        print(f"{case.name}, {row['name']}: stated {stated(text).get(row['name'])}, recorded {found}")
    assert wrong(text, rows, record) == []  # else: .ci/tables cases NAME, or kept where only words changed


@pytest.mark.parametrize("case", CHOSEN, ids=lambda case: case.name)
def test_a_case_was_recorded_with_the_choices_of_today(case: Path) -> None:
    record = WRITER["kept"](case)
    package = PORESCALE if record["command"].startswith("porescale ") else CONTINUUM
    scene = load(case, package.scene()).model_dump(mode="json")
    assert other_choices(scene, record) == []  # else: .ci/tables cases NAME


ROWS = [
    {"name": "speed", "value": 2.0, "tolerance": 0.5, "unit": "m/s"},
    {"name": "a | b", "value": 1.0, "tolerance": 0.0, "unit": ""},
]
RECORD = {
    "date": "2026-01-02", "commit": "abc", "command": "porescale run cases/x", "choices": {"fluid.operator": "trt"},
    "numbers": {"speed": 2.25, "a | b": 1.0},
}  # fmt: skip


def table(rows: Rows, record: Mapping[str, Any] | None) -> str:
    """A README that holds the table of a record."""
    lines = ["# x", "<!-- recorded -->", *WRITER["case_table"](rows, record), "<!-- end of recorded -->"]
    return "\n".join(lines)


def test_a_readme_that_fell_behind_is_found() -> None:  # the checks that must fail
    text = table(ROWS, RECORD)
    assert wrong(text, ROWS, RECORD) == []
    assert stated(text) == {"speed": "2.25 m/s", "a | b": "1"}
    assert wrong(text.replace("2.25", "2.26"), ROWS, RECORD)
    assert wrong(text.replace("trt", "mrt"), ROWS, RECORD) == ["what is said of the run"]
    assert wrong(text, ROWS[:1], RECORD)
    far = {**RECORD, "numbers": {"speed": 2.6, "a | b": 1.0}}
    assert wrong(table(ROWS, far), ROWS, far) == ["speed"]
    assert wrong(table(ROWS, None), ROWS, RECORD)
    assert wrong(table(ROWS, None), ROWS, None) == []


SCRIPT = """
from porescale.output.case import conclude, options, stage
asked = options("x", __import__("pathlib").Path(__file__).parent)
figure, _ = stage(1)
raise SystemExit(conclude(asked.out.parent / "x", {"height": 1 / 3}, figure, asked.out))
"""


def test_what_a_script_concludes_with_is_kept_to_the_last_digit(tmp_path: Path) -> None:
    case = tmp_path / "x"
    case.mkdir()
    (case / "x.py").write_text(SCRIPT, encoding="utf-8")
    row = 'name = "height"\nvalue = 0.3\ntolerance = 0.1\nunit = "m"\nbecause = "so it is"\n'
    (case / "expected.toml").write_text(f"[[expected]]\n{row}", encoding="utf-8")
    assert WRITER["script_numbers"]([str(case / "x.py")], str(tmp_path)) == {"height": 1 / 3}


def test_another_choice_is_found() -> None:
    scene = {"title": "x", "fluid": {"operator": "trt", "magic": 0.1875}}
    assert other_choices(scene, RECORD) == []
    assert other_choices({"fluid": {"operator": "bgk"}}, RECORD) == ["fluid.operator"]
    assert other_choices({**scene, "contact": {"law": "linear"}}, RECORD) == ["contact.law"]

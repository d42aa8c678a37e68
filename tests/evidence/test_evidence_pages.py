"""Tables and figures of docs/evidence are those of the numbers that are kept: rows, ladders, recorded runs."""

import io
import json
import runpy
import warnings
from dataclasses import replace
from pathlib import Path

import pytest
from PIL import Image

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.common.evidence import convergence_files, files, overhead, validation_files
from porescale.common.evidence.convergence import Row
from tests.architecture.sources import ROOT
from tests.evidence import fronts, pictures

WRITER = runpy.run_path(str(ROOT / ".ci" / "tables"))
EVIDENCE = WRITER["EVIDENCE"]
ROWS = validation_files.stored(EVIDENCE / "rows.json")
TOPICS = list(dict.fromkeys(row["topic"] for row in ROWS.values()))
LADDERS = {package: convergence_files.stored(folder) for package, folder in WRITER["LADDERS"].items()}
AGAIN = "write them again with .ci/tables verify kept, convergence kept, or cases kept"


def described(content: bytes) -> str:
    """What a figure says that it was drawn of."""
    return str(Image.open(io.BytesIO(content)).text.get("Description", ""))  # type: ignore[attr-defined]


def block(topic: str, mark: str) -> list[str]:
    """Lines of a block of a topic's page."""
    return list(WRITER["inside"]((EVIDENCE / f"{topic}.md").read_text(encoding="utf-8"), mark))[1:]


@pytest.mark.parametrize("topic", TOPICS)
def test_table_and_figure_are_of_the_rows_that_are_kept(topic: str) -> None:
    mine = [row for row in ROWS.values() if row["topic"] == topic]
    assert block(topic, f"{topic} verify") == validation_files.table(mine), AGAIN
    assert described((EVIDENCE / f"{topic}.png").read_bytes()) == validation_files.digest(mine), AGAIN
    # The check that must fail: one error in another last digit kept.
    mine[0] = mine[0] | {"error": (mine[0]["error"] or 1.0) * 1.001}
    assert described((EVIDENCE / f"{topic}.png").read_bytes()) != validation_files.digest(mine)


def test_what_is_not_trusted_is_of_the_rows_that_are_kept() -> None:
    assert block("trust", "trust numbers") == validation_files.doubtful(list(ROWS.values())), AGAIN


@pytest.mark.parametrize("package", LADDERS)
def test_every_ladder_stands_in_the_page_of_its_topic(package: str) -> None:
    register = {"porescale": PORESCALE, "continuum_sph": CONTINUUM}[package].convergence
    assert register is not None
    kept = LADDERS[package]
    assert list(kept) == [ladder.name for ladder in register()], "run .ci/tables convergence"
    for ladder in register():
        row = kept[ladder.name]
        known = (row["levels"], row["expected"], row["within"], row["because"], row["title"])
        assert known == (list(ladder.levels), ladder.expected, ladder.within, ladder.because, ladder.title), AGAIN
    folder: Path = WRITER["LADDERS"][package]
    for topic in convergence_files.topics([Row.of(row) for row in kept.values()]):
        mine = [row for name, row in kept.items() if name.startswith(f"{topic}.")]
        assert block(topic, f"{topic} convergence") == convergence_files.table(mine), AGAIN
        drawn = described((folder / f"{topic}.png").read_bytes())
        assert drawn == convergence_files.digest([Row.of(row) for row in mine]), AGAIN


def test_every_recorded_case_stands_in_the_figure() -> None:
    found = pictures.records()
    kept = described((EVIDENCE / "cases.png").read_bytes())
    assert kept == files.digest(found), AGAIN
    name = next(iter(found))
    assert kept != files.digest(found | {name: [*found[name], ("one more", 0.5)]})  # the check that must fail


def test_the_figure_beside_openpiv_is_of_the_table_of_its_case() -> None:
    rows = pictures.pairs(pictures.PAIRS.read_text(encoding="utf-8"))
    assert len(rows) > 10
    assert all(len(numbers) in (2, 5) for _, numbers in rows)
    assert described((EVIDENCE / "peers.png").read_bytes()) == files.digest(dict(rows)), AGAIN


def test_the_figure_of_endurance_is_of_both_studies() -> None:
    rows = pictures.lasting()
    assert len({name for name, _, _ in rows}) == len(rows) > 30
    kept = described((EVIDENCE / "endurance.png").read_bytes())
    assert kept == files.digest({"rows": rows}), AGAIN
    assert kept != files.digest({"rows": rows[1:]})  # the check that must fail


@pytest.mark.parametrize("folder", ["parts", "parts_continuum"])
def test_the_figure_of_parts_is_of_the_times_that_are_kept(folder: str, tmp_path: Path) -> None:
    file = ROOT / "docs" / folder / "parts.json"
    about = json.loads(file.read_text(encoding="utf-8"))
    overhead.write(tmp_path, about, [overhead.Row(**row) for row in about.pop("rows")])
    drawn = described((tmp_path / "parts.png").read_bytes())
    assert drawn == described((file.parent / "parts.png").read_bytes()) != ""


def test_departures_have_a_tolerance_where_the_error_is_theirs() -> None:
    row = {"reference": [2.0, 4.0], "measured": [2.02, 4.02], "tolerance": 0.02}
    off, allowed = validation_files.departures(row | {"error": 0.01})  # the largest relative error
    assert off.tolist() == pytest.approx([0.01, 0.005])
    assert allowed is not None
    assert allowed.tolist() == [0.02, 0.02]
    _, allowed = validation_files.departures(row | {"error": 0.02})  # the largest absolute one
    assert allowed is not None
    assert allowed.tolist() == [0.01, 0.005]
    # The check that must fail: an error that is neither has no tolerance to draw.
    assert validation_files.departures(row | {"error": 0.015})[1] is None
    assert validation_files.departures(row | {"error": 0.01, "of": 3})[1] is None


def test_a_number_beyond_two_per_cent_is_doubtful_unless_it_keeps_a_bound() -> None:
    row = {"name": "r.a", "reference": 1.0, "measured": 1.1, "error": 0.1, "tolerance": 0.2, "because": "so",
           "passed": True}  # fmt: skip
    assert validation_files.doubtful([row])[2:] == ["| r.a | +10.0 % | 0.2 | so |"]
    assert validation_files.doubtful([row | {"measured": 1.01, "error": 0.01}])[2:] == []
    assert validation_files.doubtful([row | {"error": 0.0}])[2:] == []


def test_a_row_that_failed_stands_first_whatever_its_numbers() -> None:
    far = {"name": "r.far", "reference": 1.0, "measured": 9.0, "error": 8.0, "tolerance": 9.0, "because": "so",
           "passed": True}  # fmt: skip
    raised = far | {"name": "r.raised", "reference": None, "measured": None, "error": None, "passed": False}
    several = far | {
        "name": "r.several",
        "reference": [1.0, 1.0],
        "measured": [1.0, None],
        "error": None,
        "passed": False,
    }
    near = far | {"name": "r.near", "measured": 1.001, "error": 0.001, "tolerance": 0.0001, "passed": False}
    for fails, off in ((raised, "no number"), (several, "no number"), (near, "+0.1 %")):
        lines = validation_files.doubtful([far, fails])[2:]
        assert [line.partition(" |")[0] for line in lines] == [f"| {fails['name']} **fails**", "| r.far"]
        assert off in lines[0]
    # The check that must fail: the same numbers of a row that passed.
    assert [line.partition(" |")[0] for line in validation_files.doubtful([far, near | {"passed": True}])[2:]] == [
        "| r.far"
    ]


def test_verify_keeps_rows_that_others_ran(tmp_path: Path) -> None:
    first = {"name": "r.a", "topic": "r", "source": "s", "reference": 1.0, "measured": 1.0, "error": 0.0,
             "tolerance": 0.1, "because": "b", "passed": True, "date": "2026-01-01", "commit": "0123abcd"}  # fmt: skip
    fails = first | {"name": "r.b", "error": None, "measured": None, "reference": None, "passed": False}
    validation_files.write(tmp_path, [first, fails])
    assert list(validation_files.stored(tmp_path / "verify.json").values()) == [first, fails]
    assert "| r.b **fails** |" in (tmp_path / "verify.md").read_text(encoding="utf-8")
    assert json.loads((tmp_path / "verify.json").read_text(encoding="utf-8"))[1]["error"] is None
    assert described((tmp_path / "r.png").read_bytes()) == validation_files.digest([first, fails])


def test_a_figure_of_rows_without_a_ratio_is_drawn_without_a_warning() -> None:
    row = next(row for row in ROWS.values() if row["reference"] == 0.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # matplotlib's, of a legend of nothing
        assert described(validation_files.picture([row])) == validation_files.digest([row])


def test_the_page_of_fronts_is_of_the_fronts_that_cases_keep() -> None:
    found, page = fronts.fronts(), WRITER["TRADE_PAGE"]
    again = "write it again with .ci/tables trade"
    assert list(WRITER["inside"](page.read_text(encoding="utf-8"), "fronts"))[1:] == fronts.lines(found), again
    kept = described(page.with_suffix(".png").read_bytes())
    assert kept == files.digest(fronts.drawn(found)), again
    # The check that must fail: a front that lost a point.
    name, front = next(iter(found.items()))
    fewer = found | {name: replace(front, points=front.points[:-1])}
    assert fronts.lines(fewer) != fronts.lines(found)
    assert kept != files.digest(fronts.drawn(fewer))

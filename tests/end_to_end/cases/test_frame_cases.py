"""Cases of bodies of segments that are scenes: a mixed heap in a tray weighs what it is made of."""

import re

import pytest

from porescale import open_run
from tests.end_to_end.cases.test_cases import CASES, expected, missed

CASE = "tipping_tray"
SETTLED = "time.end=0.5"


def test_the_case_says_what_it_is_and_shows_it():
    text = (CASES / CASE / "README.md").read_text(encoding="utf-8")
    assert text.startswith("# ")
    assert "## Source" in text
    assert f"porescale run cases/{CASE}" in text
    assert re.search(r"!\[.+\]\(picture\.png\)", text)
    assert len((CASES / CASE / "picture.png").read_bytes()) < 150_000


@pytest.mark.slow
@pytest.mark.parametrize(("density", "off"), [(2500, []), (2550, ["weight of what the tray holds"])])
def test_the_tray_bears_what_lies_in_it(porescale, tmp_path, density, off):
    # Until it tips; the twin, of denser grains, is told from it.
    settings = ["--set", SETTLED, "--set", f"grains.density={density}", "--set", "output.snapshot_interval=0.25"]
    assert porescale("run", CASES / CASE, "--out", tmp_path / "out", "--quiet", *settings) == 0
    run, rows = open_run(tmp_path / "out"), [row for row in expected(CASE) if row["at"] == 0.495]
    assert [it.partition(":")[0] for it in missed(run.series, rows, run.table)] == off

"""Scripts of levees and of the sheet pile that fails: what each measures and draws, on coarse ground and short."""

from dataclasses import replace

import numpy as np
import pytest

from porescale.output.case import expected
from tests.reference.folders import CASES, script

pytestmark = pytest.mark.slow


def test_the_levee_measures_its_rows_and_draws_its_stages(tmp_path, monkeypatch, capsys):
    case = script("saturated_levee")
    levee = case.lab.Levee(rows=8, end=1.3)
    monkeypatch.setattr(case.lab, "Levee", lambda: levee)
    monkeypatch.setattr("sys.argv", ["saturated_levee", "--out", str(tmp_path), "--rows", "8"])
    assert case.main() == 1  # what has not come over the crest within 0.8 s is no number, and missed
    said = capsys.readouterr().out
    for row in expected(CASES / "saturated_levee"):
        late = row["name"] == "from crest to overtopping"
        assert (f"MISSED  {row['name']}" in said) == late
    assert (tmp_path / "picture.png").stat().st_size > 10_000


def test_the_film_of_the_levee_shows_it_move():
    case = script("saturated_levee")
    first, *_, last = case.frames(case.lab.Levee(rows=8, end=0.9), 0.2)
    assert first.shape == last.shape
    assert np.abs(first.astype(int) - last.astype(int)).max() > 100


def test_the_pile_measures_an_onset_within_its_ground(tmp_path, monkeypatch, capsys):
    case = script("sheet_pile_failure")
    one = {0.5: replace(case.cases(8)[0.5], reach=0.75, rate=1.5, first=2.7)}
    monkeypatch.setattr(case, "cases", lambda rows: one)
    monkeypatch.setattr(case, "conclude", lambda folder, numbers, figure, out: print(numbers) or 0)
    monkeypatch.setattr("sys.argv", ["sheet_pile_failure", "--out", str(tmp_path)])
    assert case.main() == 0
    found = float(capsys.readouterr().out.split(":")[1].strip(" }\n"))
    # Half as many rows over s as the case has, 4, sides nearer by a third, and a ramp three times as fast: a band from
    # half of the prism's bound to half again as much as that of the exit gradient.
    low, high = case.heave.BOUNDS[0.5]
    assert 0.5 * low < found < 1.5 * high

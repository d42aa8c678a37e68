"""Scripts that compare packings: what tables say where some never come to it, and which runs are not mixed."""

import importlib.util
import math
import runpy
import subprocess
from pathlib import Path

import numpy as np
import pytest

import porescale as ps

ROOT = Path(__file__).resolve().parents[3]


def script(name):
    spec = importlib.util.spec_from_file_location(Path(name).stem + "_script", ROOT / "cases" / name)
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


def falling(at, end=0.0102):
    """Rows of a column whose centre of mass falls evenly, half of it at a time (s)."""
    time = np.linspace(0.0, 0.5, 51)
    height = np.maximum(0.036 - 0.5 * (0.036 - 0.0102) * time / at, end)
    return np.array([time, height, 0.09 - 0.1 * time]).T.tolist()


def test_a_row_of_lambda_with_slow_packings_has_their_median_and_no_deviation():
    made = script("column_collapse/lambda.py")
    assert made.spread([0.4, 0.42, 0.44], 1.0, 2) == "0.42 ± 0.02"
    assert made.spread([0.4, math.inf, 0.42, 0.44, math.inf], 1.0, 2) == "median 0.44, 2 of 5 > 0.5"
    assert made.spread([0.4, math.inf], 1.0, 2) == "1 of 2 > 0.5"  # the median is beyond the end as well
    assert made.spread([math.inf] * 3, 1.0, 2) == "> 0.5"
    row = made.table({("draft", 0.8, "a"): [falling(at) for at in (0.2, 0.3, 0.9)]})[-1]
    assert "| median 0.30, 1 of 3 > 0.5 |" in row
    assert row.endswith("| a |")


def opened(card, **tables):
    """In place of ``ps.open_run``: a run with this card, and these tables beside its series."""

    class Opened:
        outcome, commit, series = card["outcome"], card["commit"], tables.pop("series")

        def table(self, name):
            return tables[name]

    Opened.card = card
    return lambda path: Opened()


def test_lambda_reads_the_runs_of_a_sweep_up_to_its_end_and_mixes_no_commits(tmp_path, monkeypatch):
    made = script("column_collapse/lambda.py")
    (tmp_path / "seed=1").mkdir()
    time = np.arange(0.0, 0.8, 0.005)
    series = {"time (s)": time, "centre of mass y (m)": 0.036 - 0.03 * time, "front (m)": 0.09 - 0.1 * time}
    (tmp_path / "seed=1" / "card.json").write_text("{}")
    card = {"outcome": "finished", "quality": "draft", "commit": "a"}
    card |= {"scene": {"grains": {"hydraulic_radius_ratio": 0.8}}}
    monkeypatch.setattr(ps, "open_run", opened(card, series=series))
    ((key, (rows,)),) = made.swept([tmp_path]).items()
    assert key == ("draft", 0.8, "a")
    assert np.array(rows) == pytest.approx(np.array([column[:101] for column in series.values()]).T)
    assert len(made.table({key: [rows], ("draft", 0.8, "b"): [rows]})) == 4
    monkeypatch.setattr(ps, "open_run", opened(card | {"outcome": "unstable"}, series=series))
    assert made.swept([tmp_path]) == {}


def test_levels_differ_packing_by_packing(tmp_path, monkeypatch):
    """Packings differ by more than levels do: that cancels where the seeds are the same."""
    made = script("column_collapse/levels.py")
    head = ["name", "outcome", "grains.packing.seed", *made.SHOWN]
    for level, shift in (("draft", 0.5), ("fine", 0.0)):
        (tmp_path / level).mkdir()
        rows = [f"seed={k},finished,{k}," + ",".join([str(k + shift)] * len(made.SHOWN)) for k in (1, 2, 3)]
        (tmp_path / level / "sweep.csv").write_text("\n".join([",".join(head), *rows, "seed=4,unstable,4"]))
    monkeypatch.setattr(
        ps,
        "open_run",
        lambda path: opened({"quality": path.parent.name, "outcome": "", "commit": "a"}, series={})(path),
    )
    levels, commits = made.read([tmp_path / "draft", tmp_path / "fine"])
    assert commits == {"a"}
    assert made.table(levels)[2] == "| half of the fall (s) | 2.5 ± 1 | 2 ± 1 | +0.5 ± 0 |"
    del levels["draft"]["1"]
    assert made.table(levels)[2].endswith("| +0.5 |")  # two packings have no interval


def test_a_bed_that_never_gets_there_has_no_mean_in_its_table():
    made = script("loose_and_dense_collapse/compare.py")
    assert made.spread([12.0, 14.0]) == "13 ± 1"
    assert made.spread([12.0, math.inf, 14.0]) == "median 14, 1 of 3 never"
    assert made.spread([12.0, math.inf]) == "1 of 2 never"
    time = np.linspace(0.0, 1.0, 41)
    still = np.array([time, 0 * time + 0.024, 0 * time + 0.0168, 0 * time + 300.0]).T
    one = {"fraction": 0.8, "rows": still, "profile": {0.001: 0.01, 0.002: 0.01}}
    row = next(line for line in made.table({"draft": {"dense": [one, one]}}) if line.startswith("| dense"))
    assert "| never |" in row
    assert "inf" not in row
    assert "nan" not in row


@pytest.mark.parametrize(
    ("packing", "bed"),
    [((True, 0.0), "dense"), ((True, 1.0), "medium"), ((False, 0.0), "loose")],
)
def test_beds_are_told_apart_and_not_mixed_over_commits(tmp_path, monkeypatch, packing, bed):
    made = script("loose_and_dense_collapse/compare.py")
    for name in "ab":
        (tmp_path / name).mkdir()
        (tmp_path / name / "card.json").write_text("{}")
    settle, friction = packing
    card = {"scene": {"grains": {"packing": {"settle": settle, "settling_friction": friction}}}}
    card |= {"outcome": "finished", "quality": "draft", "commit": "a"}
    time = np.linspace(0.0, 0.9, 5)
    tables = {
        "series": {"time (s)": time, "front (m)": 0.024 + time, "highest grain (m)": 0.02 - 0.01 * time},
        "regions": {"column porosity ()": 0.2 + 0 * time}, "probes": {"probe 1 mean pressure (Pa)": 235.0 + time},
        "profile": {"time (s)": time, "height at x = 0.001 m (m)": 0.01 + time},
    }  # fmt: skip
    monkeypatch.setattr(ps, "open_run", opened(card, **tables))
    beds, made_by = made.read(tmp_path)
    assert (list(beds), len(beds[bed]), made_by) == ([bed], 2, {("draft", "a")})
    one = beds[bed][0]
    assert one["fraction"] == pytest.approx(0.8)
    assert one["profile"] == {0.001: pytest.approx(0.91)}
    rows = np.array([*tables["series"].values(), 235.0 + time]).T
    assert one["rows"] == pytest.approx(rows)
    made.draw(beds, tmp_path / "compare.png")
    cards = iter([card, card | {"commit": "b"}])
    monkeypatch.setattr(ps, "open_run", lambda path: opened(next(cards), **tables)(path))
    monkeypatch.setattr("sys.argv", ["compare.py", str(tmp_path)])
    with pytest.raises(SystemExit, match="finished runs of 2 qualities and commits, where one is needed"):
        made.main()


def test_a_refused_sweep_writes_no_table(tmp_path, monkeypatch):
    writer = runpy.run_path(str(ROOT / ".ci" / "tables"))
    assert "ensemble [folder]" in writer["USAGE"]
    done = [0]
    monkeypatch.setattr(subprocess, "run", lambda *words, **options: subprocess.CompletedProcess(words, done[0]))
    monkeypatch.setattr(writer["ensembles"], "members", lambda folder: ([], []))
    with pytest.raises(SystemExit, match="no packing finished"):
        writer["ensemble"](tmp_path, tmp_path)
    done[0] = 2
    with pytest.raises(SystemExit, match="the sweep was refused: nothing is written"):
        writer["ensemble"](tmp_path, tmp_path)

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
    runs = {("draft", 0.8): [{"commit": "a", "rows": falling(at)} for at in (0.2, 0.3, 0.9)]}
    row = made.table(runs)[-1]
    assert "| median 0.30, 1 of 3 > 0.5 |" in row
    assert row.endswith("| a |")


def test_a_row_of_lambda_mixes_no_commits():
    made = script("column_collapse/lambda.py")
    one, other = ({"commit": commit, "rows": falling(0.3)} for commit in ("a", "b"))
    assert len(made.table({("draft", 0.8): [one, one], ("draft", 0.9): [other]})) == 4
    with pytest.raises(SystemExit, match="runs of several commits, a, b: not mixed"):
        made.table({("draft", 0.8): [one, other]})


def test_lambda_reads_the_runs_of_a_sweep_up_to_its_end(tmp_path, monkeypatch):
    made = script("column_collapse/lambda.py")
    (tmp_path / "seed=1").mkdir()
    time = np.arange(0.0, 0.8, 0.005)
    series = {"time (s)": time, "centre of mass y (m)": 0.036 - 0.03 * time, "front (m)": 0.09 - 0.1 * time}
    (tmp_path / "seed=1" / "card.json").write_text("{}")
    card = {"outcome": "finished", "quality": "draft", "commit": {"hash": "0123456789", "changed": True}}
    card |= {"scene": {"grains": {"hydraulic_radius_ratio": 0.8}}}
    monkeypatch.setattr(ps, "open_run", lambda path: type("Run", (), {"card": card, "series": series}))
    ((key, (run,)),) = made.swept([tmp_path]).items()
    assert (key, run["commit"]) == (("draft", 0.8), "01234567+")
    assert np.array(run["rows"]) == pytest.approx(np.array([column[:101:2] for column in series.values()]).T)
    card["outcome"] = "unstable"
    assert made.swept([tmp_path]) == {}


def test_a_bed_that_never_gets_there_has_no_mean_in_its_table():
    made = script("loose_and_dense_collapse/compare.py")
    assert made.spread([12.0, 14.0]) == "13 ± 1"
    assert made.spread([12.0, math.inf, 14.0]) == "median 14, 1 of 3 never"
    assert made.spread([12.0, math.inf]) == "1 of 2 never"
    time = np.linspace(0.0, 1.0, 41)
    still = np.array([time, 0 * time + 0.024, 0 * time + 0.0168, 0 * time + 300.0]).T.tolist()
    one = {"commit": "a", "fraction": 0.8, "rows": still, "tops": [0.01] * 48}
    row = next(line for line in made.table({"dense": [one, one]}) if line.startswith("| dense"))
    assert "| never |" in row
    assert "inf" not in row
    assert "nan" not in row
    assert made.commit_of({"dense": [one], "loose": [one]}) == "a"
    with pytest.raises(SystemExit, match="runs of several commits, unknown, a: not mixed"):
        made.commit_of({"dense": [one], "loose": [{"rows": still}]})


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


@pytest.mark.parametrize("name", ["column_collapse/lambda.py", "loose_and_dense_collapse/compare.py"])
def test_a_run_is_kept_with_the_commit_of_the_tree(name, tmp_path, monkeypatch):
    made = script(name)
    head = ["git", "-C", str(tmp_path)]
    monkeypatch.setattr(made, "HERE", tmp_path)
    assert made.commit() == ""
    subprocess.run([*head, "init", "-q"], check=True)
    (tmp_path / "scene.toml").write_text("a")
    subprocess.run([*head, "add", "."], check=True)
    who = ["-c", "user.name=a", "-c", "user.email=a@b"]
    subprocess.run([*head, *who, "commit", "-q", "-m", "a"], check=True)
    whole = subprocess.run([*head, "rev-parse", "HEAD"], check=True, capture_output=True, text=True).stdout
    assert made.commit() == whole[:8]
    (tmp_path / "scene.toml").write_text("b")
    assert made.commit() == whole[:8] + "+"

"""The hydraulic radius ratio over resolution and packing: lambda.png, and a table of how far the column has fallen.

    python cases/column_collapse/lambda.py --packings 3 --levels draft standard
    python cases/column_collapse/lambda.py --kept --sweep runs/column_collapse_sweep

Every run is kept in the folder with its commit, so that a call that was stopped goes on; what was not run is left out
of the table.  A row of the table is of one commit: runs of another are refused.  With --sweep the runs of a sweep of
the scene are read as well, up to END; their rows replace those of the folder.
"""

import argparse
import datetime
import json
import subprocess
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import porescale as ps

HERE = Path(__file__).resolve().parent
README = HERE / "README.md"
RATIOS = (0.7, 0.8, 0.87, 0.9)
END, EVERY = 0.5, 0.01  # s: the fall and the tongue; between rows
COLUMNS = ("centre of mass y (m)", "front (m)")
HIGH, LOW = 0.036, 0.0102  # m, of the centre of mass: where it starts, where it ends
SHOWN = (0.25, 0.5)  # s

Rows = list[list[float]]
"""Time (s), height of the centre of mass (m), front (m)."""
Runs = dict[tuple[str, float], list[dict[str, Any]]]
"""Runs by level and ratio, one for each packing: {"commit": that it was made at, "" where not known, "rows": Rows}."""


def commit() -> str:
    """Eight digits of the commit of the tree that this script lies in, with a + where files have changed since; ""
    outside of one."""
    words = ["git", "-C", str(HERE), "describe", "--always", "--exclude=*", "--abbrev=8", "--dirty=+"]
    try:
        return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return ""


def run(level: str, ratio: float, seed: int) -> Rows:
    """One collapse up to END."""
    changes = {"grains.hydraulic_radius_ratio": ratio, "grains.packing.seed": seed, "time.end": END}
    sim = ps.build(ps.load(HERE / "scene.toml", quality=level).with_(changes))
    steps, rows = round(EVERY / sim.step_seconds), []
    while True:
        it = sim.series()
        rows.append([it["time (s)"], *(it[name] for name in COLUMNS)])
        if sim.time > END - 0.5 * EVERY:
            return rows
        sim.advance(steps)


def swept(folders: list[Path]) -> Runs:
    """The finished runs of sweeps of the scene, up to END, in rows EVERY apart."""
    runs: Runs = {}
    for path in sorted(it.parent for folder in folders for it in folder.glob("[!.]*/card.json")):
        run = ps.open_run(path)
        time, known = run.series["time (s)"], run.card.get("commit")
        if run.card["outcome"] != "finished" or time[-1] < END - 0.5 * EVERY:
            continue
        every = round(EVERY / (time[1] - time[0]))
        columns = [run.series[name][time < END + 0.5 * EVERY] for name in ("time (s)", *COLUMNS)]
        made_at = known["hash"][:8] + "+" * known["changed"] if known else ""
        rows = np.array(columns).T[:: max(1, every)].tolist()
        ratio = run.card["scene"]["grains"]["hydraulic_radius_ratio"]
        runs.setdefault((run.card["quality"], ratio), []).append({"commit": made_at, "rows": rows})
    return runs


def commit_of(runs: list[dict[str, Any]], where: str) -> str:
    """The one commit that all of ``runs`` were made at; ends the script where they are of several."""
    commits = sorted({it["commit"] for it in runs})
    if len(commits) > 1:
        raise SystemExit(f"{where}: runs of several commits, {', '.join(it or 'unknown' for it in commits)}: not mixed")
    return commits[0]


def half(rows: Rows) -> float:
    """When half of the fall is done, s; infinite where it is not by the end."""
    time, height, _ = np.array(rows).T
    return float(time[height <= 0.5 * (HIGH + LOW)][0]) if height[-1] <= 0.5 * (HIGH + LOW) else float("inf")


def spread(values: list[float], unit: float, digits: int) -> str:
    """Mean and deviation of one packing in a unit; the median where some are beyond the end, for a mean and a deviation
    of the others would leave the slowest out."""
    found = np.array(values) / unit
    late = int(np.isinf(found).sum())
    if late:
        middle = float(np.median(found)) if 2 * late < len(found) else np.inf
        said = f"median {middle:.{digits}f}, " if np.isfinite(middle) else ""
        return f"> {END}" if late == len(found) else f"{said}{late} of {len(found)} > {END}"
    bar = f" ± {found.std(ddof=1):.{digits}f}" if len(found) > 1 else ""
    return f"{found.mean():.{digits}f}{bar}"


def table(runs: Runs) -> list[str]:
    """Lines of a table, a row for each level and ratio; ± is the deviation of one packing."""
    head = (
        "level",
        "λ",
        "packings",
        "half of the fall, s",
        "fallen at 0.25 s, %",
        "at 0.5 s, %",
        "front's way then, %",
        "commit",
    )
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    for (level, ratio), made in sorted(runs.items()):
        at, many = commit_of(made, f"{level}, λ = {ratio:g}") or "–", [it["rows"] for it in made]
        fallen = [[100.0 * (HIGH - np.interp(t, *np.array(one).T[:2])) / (HIGH - LOW) for one in many] for t in SHOWN]
        front = [100.0 * (0.09 - one[-1][2]) / 0.09 for one in many]
        cells = [spread([half(one) for one in many], 1.0, 2), *(spread(it, 1.0, 0) for it in (*fallen, front))]
        lines.append(f"| {level} | {ratio:g} | {len(many)} | " + " | ".join([*cells, at]) + " |")
    return lines


def draw(runs: Runs, path: Path) -> None:
    """Centre of mass over time, a panel for each level, a band of packings for each ratio."""
    levels = sorted({level for level, _ in runs})
    figure = Figure(figsize=(4.6 * len(levels) + 1.0, 3.8), layout="constrained")
    for k, level in enumerate(levels):
        ax = figure.add_subplot(1, len(levels), k + 1)
        for number, ratio in enumerate(RATIOS):
            for j, one in enumerate(runs.get((level, ratio), [])):
                time, height, _ = np.array(one["rows"]).T
                ax.plot(time, 100.0 * height, color=f"C{number}", lw=1.0, label=f"λ = {ratio:g}" if j == 0 else None)
        ax.axhline(50.0 * (HIGH + LOW), color="0.6", ls=":")
        ax.set(xlabel="time (s)", ylabel="centre of mass (cm)", title=level, ylim=(1.0, 3.7))
        ax.grid(alpha=0.3)
        ax.legend()
    figure.savefig(path, dpi=90)


def write(runs: Runs) -> None:
    """Picture and table, with the date, into this folder: between the marks of the README."""
    lines = table(runs)
    draw(runs, HERE / "lambda.png")
    head, _, rest = README.read_text(encoding="utf-8").partition("<!-- lambda -->")
    tail = rest.partition("<!-- end of lambda -->")[2]
    made = "Made on " + datetime.date.today().isoformat() + " by `lambda.py`."
    block = "\n".join(["<!-- lambda -->", *lines, "", made, "<!-- end of lambda -->"])
    README.write_text(head + block + tail, encoding="utf-8")


def main() -> None:
    """Run what is not there yet, write the picture, print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--packings", type=int, default=3)
    parser.add_argument("--levels", nargs="+", default=["draft", "standard"])
    parser.add_argument("--out", type=Path, default=Path("runs/column_collapse_lambda"), help="folder")
    parser.add_argument(
        "--sweep", type=Path, nargs="+", default=[], help="folders of sweeps of the scene, read as well"
    )
    parser.add_argument("--kept", action="store_true", help="run none, show what is there")
    parser.add_argument("--write", action="store_true", help="picture and table into the README of the case")
    asked = parser.parse_args()
    asked.out.mkdir(parents=True, exist_ok=True)
    runs: Runs = {}
    others = swept(asked.sweep)
    for level, seed, ratio in product(asked.levels, range(1, asked.packings + 1), RATIOS):
        if (level, ratio) in others:
            continue
        file = asked.out / f"{level}-{ratio}-{seed}.json"
        if not file.exists() and not asked.kept:
            made = {"commit": commit(), "rows": run(level, ratio, seed)}
            file.write_text(json.dumps(made), encoding="utf-8")
            print(f"{level}, lambda {ratio}, packing {seed}: done", flush=True)
        if file.exists():
            found = json.loads(file.read_text(encoding="utf-8"))
            found = {"commit": "", "rows": found} if isinstance(found, list) else found  # kept before commits were
            runs.setdefault((level, ratio), []).append(found)
    runs |= others
    lines = table(runs)
    draw(runs, asked.out / "lambda.png")
    if asked.write:
        write(runs)
    print("\n".join(lines))


if __name__ == "__main__":
    main()

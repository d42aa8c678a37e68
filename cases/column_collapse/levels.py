"""What draft and standard miss of fine, packing by packing: a table over sweeps that repeat the scene to its end.

    porescale sweep cases/column_collapse --repeat 3 --quality draft --out runs/draft
    porescale sweep cases/column_collapse --repeat 3 --quality standard --out runs/standard
    porescale sweep cases/column_collapse --repeat 3 --quality fine --out runs/fine
    python cases/column_collapse/levels.py runs/draft runs/standard runs/fine --write

Reads sweep.csv of each folder.  A difference from fine is that of packings with the same seed.
"""

import argparse
import csv
import datetime
from pathlib import Path

import numpy as np
from scipy.stats import t as student

import porescale as ps

HERE = Path(__file__).resolve().parent
README = HERE / "README.md"
REFERENCE = "fine"
SHOWN = {
    "half of the fall (s)": 1.0, "centre of mass at 0.25 s (m)": 100.0, "centre of mass at 0.6 s (m)": 100.0,
    "front at the left wall (s)": 1.0, "centre of mass at the end (m)": 100.0, "run-out (m)": 100.0,
    "lowest density": 1.0, "core-seconds (s)": 1.0,
}  # fmt: skip
"""Columns of sweep.csv, and by what they are multiplied: lengths are shown in cm."""

Levels = dict[str, dict[str, dict[str, float]]]
"""By level and seed the numbers of a run."""


def read(folders: list[Path]) -> tuple[Levels, set[str]]:
    """The numbers of the finished runs of sweeps, and the commits that made them."""
    levels: Levels = {}
    commits = set()
    for folder in folders:
        with (folder / "sweep.csv").open(encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                if row["outcome"] == "finished":
                    run = ps.open_run(folder / row["name"])
                    numbers = {name: unit * float(row[name] or "nan") for name, unit in SHOWN.items()}
                    levels.setdefault(run.card["quality"], {})[row["grains.packing.seed"]] = numbers
                    commits.add(run.commit)
    return levels, commits


def mean_of(values: list[float]) -> str:
    """Mean and deviation of one packing."""
    return f"{np.mean(values):.3g}" + (f" ± {np.std(values, ddof=1):.1g}" if len(values) > 1 else "")


def less(level: dict[str, dict[str, float]], fine: dict[str, dict[str, float]], name: str) -> str:
    """Mean difference from fine over the packings that both have, and half of its interval at 95 % (Student's t)."""
    found = [level[seed][name] - fine[seed][name] for seed in level if seed in fine]
    if len(found) < 3:
        return f"{np.mean(found):+.2g}" if found else ""
    bar = student.ppf(0.975, len(found) - 1) * np.std(found, ddof=1) / np.sqrt(len(found))
    return f"{np.mean(found):+.2g} ± {bar:.1g}"


def table(levels: Levels) -> list[str]:
    """Lines of a table: a row for each number, a column for each level and for what it differs from fine."""
    fine, others = levels[REFERENCE], [it for it in ("draft", "standard") if it in levels]
    head = ["", *(f"{it}, {len(levels[it])} packings" for it in (*others, REFERENCE))]
    head += [f"{it} less fine" for it in others]
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    for name in SHOWN:
        shown = [mean_of([run[name] for run in levels[it].values()]) for it in (*others, REFERENCE)]
        apart = [less(levels[it], fine, name) if "core" not in name else "" for it in others]
        lines.append("| " + " | ".join([name.replace("(m)", "(cm)"), *shown, *apart]) + " |")
    return lines


def write(levels: Levels, commits: set[str]) -> None:
    """The table, with date and commits, between the marks of the README."""
    head, _, rest = README.read_text(encoding="utf-8").partition("<!-- levels -->")
    tail = rest.partition("<!-- end of levels -->")[2]
    made = (
        f"Made on {datetime.date.today().isoformat()} by `levels.py` from runs at commit {', '.join(sorted(commits))}."
    )
    block = "\n".join(["<!-- levels -->", *table(levels), "", made, "<!-- end of levels -->"])
    README.write_text(head + block + tail, encoding="utf-8")


def main() -> None:
    """Print the table, or write it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=Path, nargs="+", help="of sweeps of the scene")
    parser.add_argument("--write", action="store_true", help="into the README of the case")
    asked = parser.parse_args()
    levels, commits = read(asked.folders)
    if REFERENCE not in levels:
        raise SystemExit(f"no run in {', '.join(map(str, asked.folders))} is of quality {REFERENCE}")
    if asked.write:
        write(levels, commits)
    print("\n".join(table(levels)))


if __name__ == "__main__":
    main()

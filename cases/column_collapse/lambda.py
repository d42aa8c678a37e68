"""The hydraulic radius ratio over resolution and packing: lambda.png, and a table of how far the column has fallen.

    porescale sweep cases/column_collapse --vary grains.hydraulic_radius_ratio=0.7,0.8,0.87,0.9 --repeat 3 \\
        --set time.end=0.5
    python cases/column_collapse/lambda.py runs/column_collapse_sweep --write

Reads the finished runs of any number of sweeps of the scene, up to END; a row of the table is of one commit.
"""

import argparse
import datetime
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import porescale as ps

HERE = Path(__file__).resolve().parent
README = HERE / "README.md"
END = 0.5  # s: the fall and the tongue
COLUMNS = ("time (s)", "centre of mass y (m)", "front (m)")
HIGH, LOW = 0.036, 0.0102  # m, of the centre of mass: where it starts, where it ends
SHOWN = (0.25, 0.5)  # s
LEVELS = ("draft", "standard", "fine")

Rows = list[list[float]]
"""Time (s), height of the centre of mass (m), front (m)."""
Runs = dict[tuple[str, float, str], list[Rows]]
"""Packings by level, ratio, and the commit that made them ("" where not known)."""


def swept(folders: list[Path]) -> Runs:
    """The finished runs of sweeps of the scene, up to END."""
    runs: Runs = {}
    for path in sorted(it.parent for folder in folders for it in folder.glob("[!.]*/card.json")):
        run = ps.open_run(path)
        time = run.series["time (s)"]
        if run.outcome == "finished" and time[-1] > 0.99 * END:
            rows = np.array([run.series[name][time < 1.01 * END] for name in COLUMNS]).T.tolist()
            ratio = run.card["scene"]["grains"]["hydraulic_radius_ratio"]
            runs.setdefault((run.card["quality"], ratio, run.commit), []).append(rows)
    return runs


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
    """Lines of a table, a row for each level, ratio and commit; ± is the deviation of one packing."""
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
    for (level, ratio, commit), made in sorted(runs.items(), key=lambda it: (LEVELS.index(it[0][0]), *it[0][1:])):
        fallen = [[100.0 * (HIGH - np.interp(t, *np.array(one).T[:2])) / (HIGH - LOW) for one in made] for t in SHOWN]
        front = [100.0 * (0.09 - one[-1][2]) / 0.09 for one in made]
        cells = [spread([half(one) for one in made], 1.0, 2), *(spread(it, 1.0, 0) for it in (*fallen, front))]
        lines.append(f"| {level} | {ratio:g} | {len(made)} | " + " | ".join([*cells, commit or "–"]) + " |")
    return lines


def draw(runs: Runs, path: Path) -> None:
    """Centre of mass over time, a panel for each level, a line for each packing, a colour for each ratio."""
    levels = sorted({level for level, *_ in runs}, key=LEVELS.index)
    ratios = sorted({ratio for _, ratio, _ in runs})
    figure = Figure(figsize=(4.6 * len(levels) + 1.0, 3.8), layout="constrained")
    for k, level in enumerate(levels):
        ax = figure.add_subplot(1, len(levels), k + 1)
        for number, ratio in enumerate(ratios):
            many = [one for (at, of, _), made in runs.items() if (at, of) == (level, ratio) for one in made]
            for j, one in enumerate(many):
                time, height, _ = np.array(one).T
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
    """Write the picture, print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=Path, nargs="+", help="of sweeps of the scene")
    parser.add_argument("--write", action="store_true", help="picture and table into the README of the case")
    asked = parser.parse_args()
    runs = swept(asked.folders)
    if not runs:
        raise SystemExit(f"no run in {', '.join(map(str, asked.folders))} has finished and comes to {END} s")
    if asked.write:
        write(runs)
    else:
        draw(runs, asked.folders[0] / "lambda.png")
    print("\n".join(table(runs)))


if __name__ == "__main__":
    main()

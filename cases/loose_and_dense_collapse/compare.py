"""Dense, medium and loose columns over several packings, beside the experiment: compare.png, a table.

    porescale sweep cases/loose_and_dense_collapse cases/loose_and_dense_collapse/beds.csv --repeat 3
    python cases/loose_and_dense_collapse/compare.py runs/loose_and_dense_collapse_sweep --write

Reads the finished runs of sweeps, each of one quality and one commit; the figure is that of the last.  Lengths are
over the column's length, pressures over its buoyant weight on the base, times over sqrt(H/g), H its height.
"""

import argparse
import datetime
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import porescale as ps

HERE = Path(__file__).resolve().parent
COLOURS = {"dense": "tab:blue", "medium": "tab:green", "loose": "tab:red"}
LENGTH = 0.024  # m, of the column
SMOOTH = 20  # rows, of the pore pressure: 0.05 s, ten times what sound takes through the column
BUOYANT = 1500.0  # kg/m3, of grains in the liquid
HYDROSTATIC = 1000.0 * ps.GRAVITY * (0.026 - 0.002)  # Pa, at the probe

# Rondon, Pouliquen & Aussillous (2011), as digitised by the authors of SedFoam (tutorials/Py/DATA/Rondon2012 of its
# repository), rounded to what a figure gives.  Columns of 6 cm: 4.2 cm at a solid fraction of 0.60, 4.8 cm at 0.55.
EXPERIMENT: dict[str, dict[str, Any]] = {
    "dense": {
        "height": 0.042, "fraction": 0.60,
        "time": [0.55, 1.2, 1.9, 2.5, 3.1, 3.8, 4.4, 5.0, 6.2, 7.5, 8.7, 10.0],
        "front": [8.8, 8.4, 9.3, 9.5, 9.8, 10.4, 11.2, 11.5, 12.1, 12.0, 12.1, 12.1],
        "pressure time": [1.1, 2.0, 3.4, 6.2, 7.3, 8.7, 10.4, 13.2, 16.9, 20.8, 25.4, 29.0],
        "pressure": [-126, -64, -52, -52, -57, -41, -28, -19, -8, -7, -7, 0],
        "x": [0.4, 1.6, 2.2, 2.7, 3.2, 3.6, 4.1, 5.0, 6.0, 6.8, 8.0, 9.3, 10.3, 11.3, 12.0],
        "y": [4.22, 4.17, 4.04, 3.75, 3.46, 3.13, 2.94, 2.55, 1.93, 1.56, 1.17, 0.76, 0.49, 0.31, 0.10],
    },
    "loose": {
        "height": 0.048, "fraction": 0.55,
        "time": [0.09, 0.64, 1.3, 1.9, 2.6, 3.2, 3.9, 4.5, 5.9],
        "front": [6.9, 16.3, 19.7, 20.3, 20.7, 21.0, 21.2, 21.2, 21.2],
        "pressure time": [1.1, 2.0, 3.4, 4.5, 5.9, 8.2, 10.7, 13.0, 15.2, 20.0, 24.8],
        "pressure": [133, 144, 126, 104, 82, 51, 38, 22, 8, 3, 0],
        "x": [0.1, 0.9, 2.2, 3.2, 4.3, 5.4, 6.4, 7.6, 9.3, 11.1, 12.9, 14.3, 16.5, 18.3, 20.4],
        "y": [2.62, 2.44, 2.36, 2.36, 2.20, 2.05, 1.89, 1.74, 1.58, 1.37, 1.17, 0.96, 0.70, 0.47, 0.10],
    },
}  # fmt: skip
LIQUID, BEADS = 1010.0, 2500.0  # kg/m3

Beds = dict[str, list[dict[str, Any]]]
"""Runs by bed: dense, medium, loose."""


def read(folder: Path) -> tuple[Beds, set[tuple[str, str]]]:
    """The finished runs of a sweep, by bed: numbers at the start, rows of time, front, height and pore pressure, shape
    at the end; and the qualities and commits that they are of."""
    beds: Beds = {}
    made_by = set()
    for path in sorted(it.parent for it in folder.glob("[!.]*/card.json")):
        run = ps.open_run(path)
        if run.outcome != "finished":
            continue
        packing = run.card["scene"]["grains"]["packing"]
        made = "loose" if not packing["settle"] else "medium" if packing["settling_friction"] else "dense"
        porosity = next(values for name, values in run.table("regions").items() if "porosity" in name)
        pressure = next(values for name, values in run.table("probes").items() if "mean pressure" in name)
        series = [run.series[name] for name in ("time (s)", "front (m)", "highest grain (m)")]
        profile = {float(name.split()[4]): value[-1] for name, value in run.table("profile").items() if " x = " in name}
        one = {"fraction": 1.0 - float(porosity[0]), "rows": np.array([*series, pressure]).T, "profile": profile}
        beds.setdefault(made, []).append(one)
        made_by.add((run.card["quality"], run.commit))
    return beds, made_by


def numbers(one: dict[str, Any]) -> dict[str, float]:
    """What is compared of a run: lengths over the column's, pressure over its weight on the base, times over sqrt(H/g);
    weight on the base (Pa) and that time (s)."""
    time, front, top, pressure = np.array(one["rows"]).T
    height, excess = top[0], np.convolve(pressure - HYDROSTATIC, np.full(SMOOTH, 1.0 / SMOOTH), "valid")
    weight, fall = BUOYANT * ps.GRAVITY * one["fraction"] * height, float(np.sqrt(height / ps.GRAVITY))
    gone = (front - LENGTH) / LENGTH
    half = time[gone >= 0.5]
    return {
        "solid fraction": one["fraction"],
        "pore pressure": float(excess[np.abs(excess).argmax()] / weight),
        "half a length": float(half[0] / fall) if len(half) else float("inf"),
        "run-out": float(gone[-1]),
        "height": float(top[-1] / height),
        "fall": fall, "weight": weight,
    }  # fmt: skip


def observed(made: str) -> dict[str, float]:
    """The same numbers of the experiment, the pressure where it is largest."""
    it = EXPERIMENT[made]
    weight, fall = scales(it)
    gone = (np.array(it["front"]) - 6.0) / 6.0
    pressure = np.array(it["pressure"])
    return {
        "solid fraction": it["fraction"],
        "pore pressure": float(pressure[np.abs(pressure).argmax()] / weight),
        "half a length": float(np.interp(0.5, gone, it["time"]) / fall),
        "run-out": float(gone[-1]), "height": float(max(it["y"]) / (100.0 * it["height"])),
    }  # fmt: skip


def scales(it: dict[str, Any]) -> tuple[float, float]:
    """Weight on the base (Pa) and sqrt(H/g) (s) of an experiment."""
    height = float(it["height"])
    return (BEADS - LIQUID) * ps.GRAVITY * it["fraction"] * height, float(np.sqrt(height / ps.GRAVITY))


def draw(runs: Beds, path: Path) -> None:
    """Front and pore pressure over time, and shapes at the end, with the experiment as circles."""
    figure = Figure(figsize=(11, 7.5), layout="constrained")
    axes: list[Axes] = [figure.add_subplot(2, 2, k) for k in (1, 2)] + [figure.add_subplot(2, 1, 2)]
    for made, many in sorted(runs.items()):
        for k, one in enumerate(many):
            it, label = numbers(one), f"{made}, {one['fraction']:.3f}" if k == 0 else None
            time, front, _, pressure = np.array(one["rows"]).T
            line: dict[str, Any] = {"color": COLOURS[made], "lw": 1.0, "label": label}
            axes[0].plot(time / it["fall"], front / LENGTH, **line)
            axes[1].plot(time / it["fall"], (pressure - HYDROSTATIC) / it["weight"], **line)
            axes[2].plot(*(np.array([*one["profile"].items()]).T / LENGTH), **line)
        if made in EXPERIMENT:
            it = EXPERIMENT[made]
            hollow: dict[str, Any] = {"color": COLOURS[made], "marker": "o", "mfc": "none", "ls": "none"}
            weight, fall = scales(it)
            axes[0].plot(np.array(it["time"]) / fall, np.array(it["front"]) / 6.0, **hollow)
            axes[1].plot(np.array(it["pressure time"]) / fall, np.array(it["pressure"]) / weight, **hollow)
            axes[2].plot(np.array(it["x"]) / 6.0, np.array(it["y"]) / 6.0, **hollow, label=f"{made}, experiment")
    for ax, x, y in (
        (axes[0], "time / √(H/g)", "front / length of the column"),
        (axes[1], "time / √(H/g)", "excess pore pressure / weight on base"),
        (axes[2], "x / length of the column", "height / length of the column"),
    ):
        ax.set(xlabel=x, ylabel=y)
        ax.grid(alpha=0.3)
    for ax in axes[:2]:
        ax.set_xscale("log")
        ax.set_xlim(0.5, 500.0)
    axes[2].set_aspect("equal")
    axes[2].legend(fontsize=8)
    figure.savefig(path, dpi=80)


def spread(values: Any) -> str:
    """Mean and deviation of one packing; the median where some never come to it, for a mean of the others would leave
    the slowest out."""
    found = np.asarray(values, float)
    never = int(np.isinf(found).sum())
    if never:
        said = f"median {np.median(found):.3g}, " if 2 * never < len(found) else ""
        return "never" if never == len(found) else f"{said}{never} of {len(found)} never"
    return f"{found.mean():.3g}" + (f" ± {found.std(ddof=1):.1g}" if len(found) > 1 else "")


def table(levels: dict[str, Beds]) -> list[str]:
    """Lines of a table: means over packings with the deviation of one, by bed and level, beside the experiment."""
    names = ("solid fraction", "pore pressure", "half a length", "run-out", "height")
    lines = ["| | level | packings | " + " | ".join(names) + " |", "|---" * (len(names) + 3) + "|"]
    for made in sorted({made for runs in levels.values() for made in runs}):
        for level, many in ((level, runs[made]) for level, runs in levels.items() if made in runs):
            found = {name: np.array([numbers(one)[name] for one in many]) for name in names}
            cells = [spread(values) for values in found.values()]
            lines.append(f"| {made} | {level} | {len(many)} | " + " | ".join(cells) + " |")
        if made in EXPERIMENT:
            lines.append(
                f"| experiment, {made} | | | " + " | ".join(f"{v:.3g}" for v in observed(made).values()) + " |"
            )
    return lines


def write(levels: dict[str, Beds], made_by: dict[str, str]) -> None:
    """Picture and table, with date and commits, into this folder: between the marks of the README."""
    draw(list(levels.values())[-1], HERE / "compare.png")
    readme = HERE / "README.md"
    head, _, rest = readme.read_text(encoding="utf-8").partition("<!-- compare -->")
    tail = rest.partition("<!-- end of compare -->")[2]
    by = ", ".join(f"{level} at commit {commit or '–'}" for level, commit in made_by.items())
    made = f"Made on {datetime.date.today().isoformat()} by `compare.py`: {by}."
    block = "\n".join(["<!-- compare -->", *table(levels), "", made, "<!-- end of compare -->"])
    readme.write_text(head + block + tail, encoding="utf-8")


def main() -> None:
    """Write the picture, print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=Path, nargs="+", help="of the sweeps")
    parser.add_argument("--write", action="store_true", help="picture and table into the README of the case")
    asked = parser.parse_args()
    levels: dict[str, Beds] = {}
    made_by: dict[str, str] = {}
    for folder in asked.folders:
        runs, found = read(folder)
        if len(found) != 1:
            raise SystemExit(f"{folder}: finished runs of {len(found)} qualities and commits, where one is needed")
        ((level, commit),) = found
        levels[level], made_by[level] = runs, commit
    if asked.write:
        write(levels, made_by)
    else:
        draw(list(levels.values())[-1], asked.folders[-1] / "compare.png")
    print("\n".join(table(levels)))


if __name__ == "__main__":
    main()

"""Displacements of synthetic pairs, known exactly, as this package measures them and as OpenPIV does beside it."""

import io
import time
from contextlib import redirect_stdout
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from porescale import Floats, set_threads
from porescale.output import conclude, options, stage
from porescale.piv.estimate import Settings, measure
from porescale.piv.images import Camera, Pair, flows, pair
from porescale.validation.piv import pairs as lab

HERE = Path(__file__).resolve().parent
SHIFTS = np.linspace(0, 1, 11)
COARSE = ("clean", "uniform", "shear", "stagnation", "lamb_oseen", "taylor_green_128")
"""Rows that the table has for windows of 32 px too."""


def openpiv(made: Pair, window: int) -> tuple[Floats, Floats, Floats, Floats]:
    """x, y, u, v as OpenPIV measures them: 64, 32 (and 16) px with deformation, half overlap, its defaults."""
    from openpiv.settings import PIVSettings
    from openpiv.windef import simple_multipass

    sizes = tuple(size for size in (64, 32, 16) if size >= window)
    settings = PIVSettings(windowsizes=sizes, overlap=tuple(size // 2 for size in sizes), num_iterations=len(sizes))
    first, second = (np.where(made.solid, 0, it).astype(np.int32) for it in (made.first, made.second))
    if made.solid.any():
        settings.static_mask = made.solid
    with redirect_stdout(io.StringIO()):
        x, y, u, v, _ = simple_multipass(first, second, settings)
    return x[0], y[::-1, 0], np.nan_to_num(u), -np.nan_to_num(v)


def theirs(made: Pair, window: int) -> tuple[float, float, float, float]:
    """OpenPIV's rms over all vectors of the fluid, beyond and within 16 px of a solid, px, and its seconds."""
    start = time.process_time()
    x, y, u, v = openpiv(made, window)
    spent = time.process_time() - start
    grid = np.meshgrid(x, y)
    exact = made.flow.displacement(*grid)
    off = np.stack([u - exact[0], v - exact[1]])
    distance = made.flow.discs.distance(*grid)
    parts = (distance > 0, distance > lab.NEAR, (distance > 0) & (distance <= lab.NEAR))
    values = [float(np.sqrt(np.mean(off[:, part] ** 2))) if part.any() else 0.0 for part in parts]
    return values[0], values[1], values[2], spent


def compare(name: str, window: int, seeds: range) -> dict[str, float]:
    """Means over the seeds of a row: "ours" and, where OpenPIV is there, "openpiv", by part and with seconds."""
    flow, camera = lab.TABLE[name]
    settings = Settings(window=window)
    ours, others, stated = [], [], []
    for seed in seeds:
        made = pair(flow, camera, seed)
        start = time.process_time()
        found = measure(made.first, made.second, made.solid if made.solid.any() else None, settings)
        spent = time.process_time() - start
        stated.append(float(np.sqrt(np.mean(found.uncertainty[found.valid] ** 2))))
        off, distance = lab.errors(made, found)
        counted = np.where(found.valid, off, lab.INVALID)
        fluid = ~found.solid
        near = fluid & (distance <= lab.NEAR)
        parts = [off[:, fluid], *((counted[:, fluid & ~near], counted[:, near]) if near.any() else ())]
        ours.append([*(float(np.sqrt(np.mean(it**2))) for it in parts), *[0.0] * (3 - len(parts)), spent])
        if find_spec("openpiv"):
            others.append(theirs(made, window))
    keys = ("rms", "far", "near", "seconds")
    mean = {f"ours {key}": value for key, value in zip(keys, np.mean(ours, 0), strict=True)}
    mean["stated"] = float(np.sqrt(np.mean(np.square(stated))))
    if others:
        mean |= {f"openpiv {key}": value for key, value in zip(keys, np.mean(others, 0), strict=True)}
    return mean


def their_bias(diameter: float, size: int = 256) -> Floats:
    """OpenPIV's mean error of u on the pairs of ``experiments.bias``, px."""
    camera, found = Camera((size, size), diameter=diameter, noise=0.0, lost=0.0), []
    for seed, shift in enumerate(SHIFTS):
        found.append(float(openpiv(pair(flows.uniform(shift, 0.0), camera, seed), 16)[2].mean()) - shift)
    return np.array(found)


def main() -> int:
    """Measure every row, print the table, judge it, draw it."""
    words = "write the table into README.md"
    given = options(__doc__ or "", HERE, seeds=(int, 10, "pairs of every row", 1), readme=(bool, False, words))
    set_threads(1)
    warm = pair(*lab.TABLE["discs"], 0)
    for solid in (None, warm.solid):
        measure(warm.first, warm.second, solid)  # kernels are compiled before anything is timed
    numbers: dict[str, float] = {}
    bars: list[tuple[str, float, float | None]] = []
    lines: list[str] = []
    for window, names in ((16, tuple(lab.TABLE)), (32, COARSE)):
        for name in names:
            row = compare(name, window, range(given.seeds))
            for part in ("far", "near") if name == "discs" else ("rms",):
                label = name.replace("_", " ") + {"far": ", far", "near": ", near", "rms": ""}[part] + f", {window} px"
                numbers[label] = row[f"ours {part}"]
                bars.append((label, row[f"ours {part}"], row.get(f"openpiv {part}")))
                theirs_ = row.get(f"openpiv {part}", float("nan")), row.get("openpiv seconds", float("nan"))
                cells = (row[f"ours {part}"], theirs_[0], row["stated"], row["ours seconds"], theirs_[1])
                lines.append(f"| {label} | " + " | ".join(f"{it:.4f}" for it in cells) + " |")
                print(lines[-1], flush=True)
    curves = {diameter: lab.bias(diameter, SHIFTS) for diameter in (2.8, 2.0)}
    for diameter, curve in curves.items():
        numbers[f"bias, tracers {diameter:g} px"] = float(np.abs(curve).max())
        lines.append(
            f"| largest bias, tracers of {diameter:g} px | {np.abs(curve).max():.4f} | {_beside(diameter)} | | | |"
        )
        print(lines[-1], flush=True)
    if given.readme:
        into_readme(lines)
    return conclude(HERE, numbers, drawn(bars, curves), given.out)


def _beside(diameter: float) -> str:
    return f"{np.abs(their_bias(diameter)).max():.4f}" if find_spec("openpiv") else "nan"


def into_readme(lines: list[str]) -> None:
    """Put the table's rows between its heading and the next empty line."""
    path = HERE / "README.md"
    text = path.read_text(encoding="utf-8")
    start = text.index("|---|") + len("|---|---|---|---|---|---|\n")
    stop = text.index("\n\n", start)
    path.write_text(text[:start] + "\n".join(lines) + text[stop:], encoding="utf-8")


def drawn(bars: list[tuple[str, float, float | None]], curves: dict[float, Floats]) -> Figure:
    """Errors of every row, and bias over the sub-pixel part of the displacement."""
    figure, (left, right) = stage(2, 11.0, 4.6)
    at = np.arange(len(bars))[::-1]
    left.barh(at + 0.2, [bar[1] for bar in bars], 0.4, label="porescale", color="#1f4e79")
    if all(bar[2] is not None for bar in bars):
        left.barh(at - 0.2, [bar[2] or 0.0 for bar in bars], 0.4, label="OpenPIV 0.26.1", color="#f0a860")
    left.set(yticks=at, yticklabels=[bar[0] for bar in bars], xscale="log", xlabel="rms error of a component, px")
    left.tick_params(axis="y", labelsize=7)
    left.legend(fontsize=8)
    for diameter, style in ((2.8, "o-"), (2.0, "s--")):
        right.plot(SHIFTS, curves[diameter], style, color="#1f4e79", ms=4, label=f"porescale, tracers {diameter:g} px")
        if find_spec("openpiv"):
            right.plot(SHIFTS, their_bias(diameter), style, color="#f0a860", ms=4, label=f"OpenPIV, {diameter:g} px")
    right.set(xlabel="displacement, px", ylabel="mean error, px")
    right.axhline(0, color="0.7", lw=0.8, zorder=0)
    right.legend(fontsize=8)
    return figure


if __name__ == "__main__":
    raise SystemExit(main())

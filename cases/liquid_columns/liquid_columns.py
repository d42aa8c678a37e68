"""Two columns of liquid collapse, one of water and one a thousand times more viscous, from the start of the paper."""

from pathlib import Path
from typing import Any

import numpy as np

from continuum_sph import Scene, Simulation, build
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
WIDTH, HEIGHT, TANK = 0.05, 0.1, 0.2  # m
VISCOSITIES = {"figure 6": 1.002e-3, "figure 7": 1.002}  # Pa s
SHOWN = (0.0, 0.06, 0.12, 0.2, 0.5)  # s
SETTLED = 8.0  # s, after which water is level
COMPARED = 0.12  # s, while both are on their way


def column(viscosity: float, across: int, end: float) -> Simulation:
    """A column with all its particles at ρ0, those of its right face at √(2g(H - y)), between walls that hold it."""
    made = {
        "gravity": 9.8,
        "tank": {"width": TANK, "height": 1.5 * HEIGHT, "walls": "stick"},
        "water": {
            "viscosity": viscosity,
            "pressure": "none",
            "push": "face",
            "column": [{"width": WIDTH, "height": HEIGHT}],
        },
        "numerics": {"spacing": WIDTH / across},
        "time": {"end": end},
        "output": {"snapshot_interval": end, "series_interval": end},
    }
    return build(Scene.model_validate(made))


def watch(model: Simulation, end: float) -> tuple[dict[str, np.ndarray], dict[float, np.ndarray]]:
    """Front and mean height (m) over time (s) to ``end``, and positions (n, 2) m at SHOWN."""
    rows: list[tuple[float, float, float]] = []
    shown: dict[float, np.ndarray] = {}
    layer = model.flow.layer
    n, half = layer.fluid, 0.5 * model.scene.numerics.spacing
    while True:
        x = layer.x[:n]
        rows.append((model.time, float(x[:, 0].max()) + half, float(x[:, 1].mean())))
        for time in SHOWN:
            if time not in shown and model.time >= time:
                shown[time] = x.copy()
        if model.time >= end:
            break
        model.advance(10)
        model.check()
    return dict(zip(("time", "front", "height"), np.array(rows).T, strict=True)), shown


def unevenness(model: Simulation) -> float:
    """Largest difference of the water's height between ten parts of the tank, m."""
    x = model.flow.layer.x[: model.flow.layer.fluid]
    part = np.minimum((x[:, 0] / TANK * 10).astype(int), 9)
    tops = [np.sort(x[part == k, 1])[-3:].mean() if (part == k).sum() >= 3 else 0.0 for k in range(10)]
    return float(max(tops) - min(tops))


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(__doc__ or "", HERE, across=(int, 10, "particles across the width of a column", 4))
    models = {name: column(viscosity, given.across, SETTLED) for name, viscosity in VISCOSITIES.items()}
    seen: dict[str, Any] = {}
    figure, axes = stage(len(SHOWN), 11.0, 3.6)
    for ax in axes:
        ax.remove()
    grid = figure.add_gridspec(2, len(SHOWN))
    for line, (name, model) in enumerate(models.items()):
        seen[name], shown = watch(model, SETTLED if name == "figure 6" else max(SHOWN))
        for place, (time, x) in enumerate(sorted(shown.items())):
            ax = figure.add_subplot(grid[line, place])
            ax.plot(x[:, 0], x[:, 1], ".", markersize=3, color="#1f5fa8")
            ax.set(xlim=(0, TANK), ylim=(0, 1.2 * HEIGHT), aspect="equal", xticks=[], yticks=[])
            ax.set_title(f"{time:g} s", fontsize=9)
            if place == 0:
                ax.set_ylabel(f"{name}\n{VISCOSITIES[name]:g} Pa s", fontsize=9)
    fronts = {name: float(np.interp(COMPARED, rows["time"], rows["front"])) for name, rows in seen.items()}
    heights = {name: float(np.interp(COMPARED, rows["time"], rows["height"])) for name, rows in seen.items()}
    numbers = {
        "figure 6: unevenness of the surface": unevenness(models["figure 6"]) / HEIGHT,
        "figure 6: height at rest": float(seen["figure 6"]["height"][-1]) / (0.5 * WIDTH * HEIGHT / TANK),
        "figure 7: way of the front over figure 6's": (fronts["figure 7"] - WIDTH) / (fronts["figure 6"] - WIDTH),
        "figure 7: height of the middle over figure 6's": heights["figure 7"] / heights["figure 6"],
    }
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())

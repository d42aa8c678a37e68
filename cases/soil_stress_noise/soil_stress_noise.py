"""What keeps stresses of soil smooth and what lets it creep: a collapsing column and level ground by seven methods."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from continuum_sph.builders import geostatic
from continuum_sph.soil import XX, YY, Material, SoilFlow
from continuum_sph.validation.soil import setups
from porescale.common.neighbors import square_lattice
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
METHODS: dict[str, dict[str, float | bool]] = {
    "as printed": {
        "corrected": False, "printed_damping": True, "damping": 0.001, "diffusion": 0.0, "spacing_recovery": 0.0,
    },
    "printed, alpha 1": {
        "corrected": False, "printed_damping": True, "damping": 1.0, "diffusion": 0.0, "spacing_recovery": 0.0,
    },
    "zig-zags damped": {"corrected": False, "diffusion": 0.0, "spacing_recovery": 0.0},
    "corrected gradients": {"diffusion": 0.0, "spacing_recovery": 0.0},
    "diffusion by sound": {"diffusion": 0.0, "sound_diffusion": 0.1, "spacing_recovery": 0.0},
    "diffusion by shear": {"spacing_recovery": 0.0},
    "and parting": {},
}  # fmt: skip
"""More of `SoilLaw`."""
GIVEN = {"damping": 0.2, "diffusion": 100.0}
"""α and χ of all methods that say nothing else, so that one thing changes at a time."""
MATERIAL = Material(1e6, 2040.0, sin_friction=float(np.sin(np.radians(21.9))))
WIDTH, HEIGHT = 0.2, 0.1  # m
PARTNERS = 12  # nearest particles that a plane of stress is laid through


def column(name: str, spacing: float, tank: tuple[float, float], width: float) -> SoilFlow:
    """A column of soil ``width`` (m) wide in the left corner of a ``tank`` (m)."""
    x = square_lattice((0.0, 0.0), (width, HEIGHT), spacing)
    stress = geostatic(HEIGHT - x[:, 1], MATERIAL)
    return setups.in_tank(x, stress, tank, spacing, MATERIAL, **(GIVEN | METHODS[name]))  # type: ignore[arg-type]


def noise(flow: SoilFlow) -> float:
    """Departure of mean stress from the plane through its neighbours' (root mean square) over its mean, of particles
    with neighbours all around."""
    soil, n, spacing = flow.soil, flow.soil.soil, flow.law.spacing
    x: NDArray[np.float64] = soil.x[:n]
    pressure = 0.5 * (soil.stress[:n, XX] + soil.stress[:n, YY])
    distance, near = cKDTree(x).query(x, PARTNERS + 1)
    departures, inside = [], []
    for i in np.flatnonzero(distance[:, PARTNERS] < 2.5 * spacing):
        others = near[i, 1:]
        weight = np.exp(-((distance[i, 1:] / (2.0 * spacing)) ** 2))
        plane = np.column_stack((np.ones(PARTNERS), x[others] - x[i])) * weight[:, None]
        departures.append(pressure[i] - np.linalg.lstsq(plane, pressure[others] * weight, rcond=None)[0][0])
        inside.append(pressure[i])
    return float(np.sqrt(np.mean(np.square(departures))) / np.mean(inside))


def flowing(name: str, spacing: float) -> tuple[float, float, float]:
    """(noise of stress, nearest two particles over the spacing, front m) of a column 0.2 s after it was let go."""
    flow = column(name, spacing, (0.5, 0.15), WIDTH)
    try:
        setups.run_until(flow, 0.2)
    except ValueError:  # positions that are no numbers
        return float("nan"), float("nan"), float("nan")
    n = flow.soil.soil
    nearest = float(cKDTree(flow.soil.x[:n]).query(flow.soil.x[:n], 2)[0][:, 1].min())
    return noise(flow), nearest / spacing, float(flow.soil.x[:n, 0].max()) + 0.5 * spacing


def creep(name: str, spacing: float, seconds: float) -> float:
    """Largest displacement of level ground in ``seconds``, over its depth."""
    flow = column(name, spacing, (8 * spacing, 0.15), 8 * spacing)
    first = flow.soil.x[: flow.soil.soil].copy()
    setups.run_until(flow, seconds)
    return float(np.hypot(*(flow.soil.x[: flow.soil.soil] - first).T).max()) / HEIGHT


def main() -> int:
    """Measure every method, compare with expected.toml, draw."""
    words = options(
        __doc__ or "", HERE, rows=(int, 20, "particles in the height", 1), seconds=(float, 2.0, "that ground rests")
    )
    spacing = HEIGHT / words.rows
    numbers: dict[str, float] = {}
    table = []
    for name in METHODS:
        stress, nearest, front = flowing(name, spacing)
        moved = creep(name, spacing, words.seconds)
        table.append((stress, nearest, moved))
        numbers |= {f"noise, {name}": stress, f"nearest, {name}": nearest, f"front, {name}": front}
        numbers[f"creep, {name}"] = moved
        print(
            f"{name:20}  noise {stress:.3f}  nearest {nearest:.2f}  front {front:.4f} m  creep {moved:.2e}", flush=True
        )
    figure, axes = stage(3, 11.0, 3.6)
    labels = ("noise of stress in flow", "nearest two / spacing", "creep / depth")
    for panel, values, label in zip(axes, zip(*table, strict=True), labels, strict=True):
        panel.barh(range(len(METHODS)), values, color="#8a6d3b")
        panel.set_yticks(range(len(METHODS)), list(METHODS) if panel is axes[0] else [""] * len(METHODS))
        panel.invert_yaxis()
        panel.set_xlabel(label)
    axes[2].set_xscale("log")
    return conclude(HERE, numbers, figure, words.out)


if __name__ == "__main__":
    raise SystemExit(main())

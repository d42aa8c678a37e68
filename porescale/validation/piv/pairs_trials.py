"""Synthetic pairs measured: what ``verify`` judges, cases tabulate and tests vary."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.piv.estimate.interpolate import coefficients, sample
from porescale.piv.estimate.measure import Settings, Vectors, measure
from porescale.piv.fields.field import in_pixels
from porescale.piv.fields.surface import of_grains, of_solids
from porescale.piv.fields.vortices import vortices
from porescale.piv.images import flows
from porescale.piv.images.flows import Flow
from porescale.piv.images.spots import add_spots
from porescale.piv.images.synth import Camera, Pair, pair

Array = NDArray[np.float64]

SIZE = (512, 512)
CAMERA = Camera(SIZE)
"""0.05 tracers a pixel, diameter 2.8 px, noise 3 grey levels, 5 % lost pairs."""
CLEAN = Camera(SIZE, noise=0.0, lost=0.0)
SEEDS = range(10)
NEAR = 16.0
"""Distance from a solid, px, that a row for vectors near solids ends at."""
INVALID = 1.0
"""px: what an invalid vector counts as beside solids."""

TABLE: dict[str, tuple[Flow, Camera]] = {
    "clean": (flows.lamb_oseen(SIZE, 6.0, 64.0), CLEAN),
    "uniform": (flows.uniform(3.3, 2.4), CAMERA),
    "shear": (flows.shear(SIZE, 4.0), CAMERA),
    "stagnation": (flows.stagnation(SIZE, 4.0), CAMERA),
    "lamb_oseen": (flows.lamb_oseen(SIZE, 6.0, 64.0), CAMERA),
    "taylor_green_128": (flows.taylor_green(SIZE, 4.0, 128.0), CAMERA),
    "taylor_green_64": (flows.taylor_green(SIZE, 2.0, 64.0), CAMERA),
    "discs": (flows.past_discs(SIZE, 2.0, flows.scattered_discs(SIZE)), CAMERA),
}
"""The pairs of the accuracy table: flow and camera."""


@dataclass(frozen=True)
class Outcome:
    """Errors of a component, rms over all fluid vectors and seeds, px.

    rms : of all vectors;  far, near : of those beyond and within NEAR of a solid, invalid ones counted as INVALID;
    largest : of all;  inside : vectors within solids that claim to be none.
    """

    rms: float
    far: float
    near: float
    largest: float
    inside: int


def errors(made: Pair, found: Vectors) -> tuple[Array, Array]:
    """Both components' errors, (2, ny, nx) px, and the distance from the nearest solid, (ny, nx) px."""
    x, y = np.meshgrid(found.x, found.y)
    u, v = made.flow.displacement(x, y)
    return np.stack([found.u - u, found.v - v]), made.flow.discs.distance(x, y)


def trial(flow: Flow, camera: Camera, seeds: Iterable[int], settings: Settings | None = None) -> Outcome:
    """Measure a pair for every seed; rms values are means over the seeds."""
    rows = []
    for seed in seeds:
        made = pair(flow, camera, seed)
        found = measure(made.first, made.second, made.solid if made.solid.any() else None, settings)
        off, distance = errors(made, found)
        fluid = ~found.solid
        counted = np.where(found.valid, off, INVALID)
        far, near = fluid & (distance > NEAR), fluid & (distance <= NEAR)
        rows.append((
            _rms(off[:, fluid]), _rms(counted[:, far]), _rms(counted[:, near]), float(np.abs(off[:, fluid]).max()),
            int((fluid & (distance < -0.5)).sum()),
        ))  # fmt: skip
    table = np.array(rows)
    rms, far, near = table[:, :3].mean(0).tolist()
    return Outcome(rms, far, near, float(table[:, 3].max()), int(table[:, 4].sum()))


def row(name: str, seeds: Iterable[int] = SEEDS, settings: Settings | None = None) -> Outcome:
    """A row of the accuracy table."""
    flow, camera = TABLE[name]
    return trial(flow, camera, seeds, settings)


def stated(name: str, seeds: Iterable[int] = SEEDS) -> tuple[float, float]:
    """Rms error of the valid vectors of a row over the rms of their uncertainties, and the share of errors below it."""
    flow, camera = TABLE[name]
    errors_, spreads = [], []
    for seed in seeds:
        made = pair(flow, camera, seed)
        found = measure(made.first, made.second, made.solid if made.solid.any() else None)
        off, _ = errors(made, found)
        errors_.append(off[:, found.valid])
        spreads.append(np.stack([found.uncertainty[found.valid]] * 2))
    off, spread = np.concatenate(errors_, 1), np.concatenate(spreads, 1)
    return _rms(off) / _rms(spread), float(np.mean(np.abs(off) < spread))


def bias(diameter: float, shifts: Iterable[float], size: int = 256, settings: Settings | None = None) -> Array:
    """Mean error of u on clean pairs of a uniform displacement, px, for each of ``shifts``."""
    camera = Camera((size, size), diameter=diameter, noise=0.0, lost=0.0)
    found = []
    for seed, shift in enumerate(shifts):
        made = pair(flows.uniform(shift, 0.0), camera, seed)
        found.append(float(np.mean(measure(made.first, made.second, None, settings).u)) - shift)
    return np.array(found)


def still(size: int = 256) -> float:
    """Largest displacement between a noisy picture and itself, px."""
    made = pair(flows.uniform(0.0, 0.0), Camera((size, size)), 1)
    found = measure(made.first, made.first)
    return float(max(np.abs(found.u).max(), np.abs(found.v).max()))


def vortex(seed: int = 0) -> tuple[list[float], list[float]]:
    """A Lamb-Oseen vortex found in a measured field: x, y px and circulation of its core px^2, and what they are.

    The circulation is that of a disc of the core's own area around the centre.
    """
    peak, core = 6.0, 64.0
    flow = flows.lamb_oseen(SIZE, peak, core)
    made = pair(flow, CAMERA, seed)
    found = vortices(in_pixels(measure(made.first, made.second)))[0]
    middle = 0.5 * (SIZE[0] - 1)
    _, speed = flow.velocity(np.array([middle + found.radius]), np.array([middle]))
    exact = -2 * np.pi * found.radius * float(speed[0])  # y points down: positive turns with the clock
    return [found.x, found.y, found.circulation], [middle, middle, exact]


def quintic(size: int = 48) -> float:
    """Largest error of the interpolator on a polynomial of fifth degree over its largest value, away from the edges."""
    y, x = np.mgrid[:size, :size] / size

    def value(x: Array, y: Array) -> Array:
        """The polynomial at x, y."""
        return np.asarray((x - 0.3) ** 5 - 2 * x * x * y**3 + y**5 - x * y + 0.5)

    shift = np.random.default_rng(0).uniform(-0.5, 0.5, (2, size, size)).astype(np.float32)
    found = np.empty((size, size), np.float32)
    sample(coefficients(value(x, y).astype(np.float32)), shift[0], shift[1], 0, found)
    exact = value(x + shift[0] / size, y + shift[1] / size)
    inner = slice(20, -20)
    return float(np.abs(found - exact)[inner, inner].max() / np.abs(exact).max())


def turned(angle: float, radius: float) -> tuple[float, float]:
    """Displacement in a rotation by ``angle`` rad at ``radius`` px: integrated, and the chord 2 r sin(angle/2)."""
    side = 2 * round(radius) + 1
    flow = flows.rotation((side, side), angle * radius)
    u, v = flow.displacement(np.array([2 * radius]), np.array([radius]))
    return float(np.hypot(u, v)[0]), 2 * radius * float(np.sin(angle / 2))


def pile(step: float) -> tuple[list[float], list[float]]:
    """Areas below the surface of a disc beside three that stand as a triangle, from discs and from a picture of them.

    step : px of columns.  Radius 40 px; exact: r^2 (2 + pi/2) under a disc, as much under the outer halves of the
    lower two, and r^2 (2 + 2 3^(1/2) + pi/2) under the one on top.  A fifth disc flies.
    """
    r = 40.0
    x = np.array([60.0, 160.0, 240.0, 200.0, 330.0])
    y = np.array([r, r, r, r + np.sqrt(3) * r, 300.0])
    discs = flows.Discs(x, y, np.full(5, r))
    columns: Array = 20.0 + step * (np.arange(round(360 / step), dtype=float) + 0.5)
    rows: Array = 399.5 - np.arange(400, dtype=float)
    solid = discs.inside(*np.meshgrid(columns, rows))
    found = [of_grains(discs, columns), of_solids(columns, rows, solid)]
    exact = r * r * (2 * (2 + np.pi / 2) + 2 + 2 * np.sqrt(3) + np.pi / 2)
    return [float(it.height.sum() * step) for it in found], [float(exact)] * 2


def light(sigma: float) -> float:
    """Light of a spot in the middle of a picture over that of the whole Gaussian, 2 pi sigma^2."""
    image = np.zeros((65, 65))
    add_spots(np.array([32.3]), np.array([31.8]), np.array([1.0]), sigma, image)
    return float(image.sum()) / (2 * np.pi * sigma**2)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0

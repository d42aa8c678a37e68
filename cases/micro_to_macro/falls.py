"""A dry column let go, of grains and of the soil that they make; how far, how high and how soon, read alike of both.

The floor of the soil holds it, so grains fall on held discs of their own size: on a flat floor they slide and roll.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import continuum_sph as cs
import porescale as ps
from porescale import Floats

HERE = Path(__file__).resolve().parent
FRONT = 0.95  # share of the mass that lies behind the front: single grains that roll on for ever do not move it
WALL = 0.01  # m from the wall, where the height is taken
GONE = 0.01  # m that the centre has gone when the time is taken
LOOKS = 0.01  # s between looks at a column
LOOSE = "grains.packing.settling_friction=1", "grains.packing.settling_rolling_friction=0.1"
"""Settings of column.toml for grains as loose as the critical state, whose strength the soil has, as in slope.toml."""


@dataclass(frozen=True)
class Fall:
    """A column that fell: times (t,) s, centre (t,) m its x; place (n, 2) m and mass (n,) kg/m of all that lies there
    at the end."""

    times: Floats
    centre: Floats
    place: Floats
    mass: Floats

    def front(self, share: float = FRONT) -> float:
        """x (m) behind which a share of the mass lies at the end."""
        order = np.argsort(self.place[:, 0])
        behind = np.cumsum(self.mass[order]) - 0.5 * self.mass[order]
        return float(np.interp(share * self.mass.sum(), behind, self.place[order, 0]))

    @property
    def height(self) -> float:
        """Twice the height (m) of the centre of mass of what lies next to the wall: its depth, if evenly filled."""
        there = self.place[:, 0] < WALL
        return 2.0 * float(np.average(self.place[there, 1], weights=self.mass[there]))

    def when(self, way: float = GONE) -> float:
        """Time (s) at which the centre has gone ``way`` (m); nan where it never does."""
        return float(np.interp(way, self.centre - self.centre[0], self.times, right=math.nan))

    @property
    def centre_at_rest(self) -> float:
        """x (m) of the centre of mass at the end."""
        return float(self.centre[-1])


def followed(simulation: Any, centre: Callable[[], float]) -> tuple[Floats, Floats]:
    """Times (t,) s of looks at a column until its scene ends, and its ``centre()`` (t,) m then."""
    rows = [(simulation.time, centre())]
    while simulation.time < simulation.scene.time.end:
        simulation.advance(max(1, round(LOOKS / simulation.step_seconds)))
        rows.append((simulation.time, centre()))
    times, centres = np.array(rows).T
    return times, centres


def held_discs(scene: ps.Scene) -> list[dict[str, float]]:
    """Discs on the floor of a ``scene``, side by side, of about the grains' size: none stands across the gate."""
    assert scene.grains
    assert scene.grains.packing
    assert scene.gate
    size = scene.gate.x / round(scene.gate.x / scene.grains.packing.diameter)
    count = math.floor(scene.domain.width / size + 0.5)
    return [{"x": (k + 0.5) * size, "y": 0.5 * size, "diameter": size} for k in range(count)]


def grains_fall(seed: int, settings: Sequence[str] = (), rough: bool = True) -> Fall:
    """The column of grains of column.toml, loose, with another packing, and ``settings``.

    rough : on held discs, whose tops are the floor that heights are above; else on a flat floor.
    """
    given = [f"grains.packing.seed={seed}", *LOOSE, *settings]
    scene, discs = ps.load(HERE / "column.toml", settings=given), []
    if rough:
        discs = held_discs(scene)
        scene = scene.with_({"disc": discs})
    simulation = ps.build(scene)
    assert simulation.grains
    d = simulation.grains.discs
    free = slice(d.count - len(discs))
    mass, floor = d.mass[free].copy(), discs[0]["diameter"] if discs else 0.0
    times, centre = followed(simulation, lambda: float(np.average(d.position[free, 0], weights=mass)))
    return Fall(times, centre, d.position[free] - (0.0, floor), mass)


def soil_falls(settings: Sequence[str] = ()) -> Fall:
    """The column of soil of ground.toml, which has taken over material.toml, with ``settings``."""
    simulation = cs.build(cs.load(HERE / "ground.toml", settings=settings))
    scene = simulation.scene
    assert scene.soil
    x = simulation.flow.soil.x[: simulation.flow.soil.soil]
    times, centre = followed(simulation, lambda: float(x[:, 0].mean()))
    mass = np.full(len(x), scene.soil.density * scene.numerics.spacing**2)
    return Fall(times, centre, x.copy(), mass)

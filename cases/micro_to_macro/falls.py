"""A dry column let go, of grains and of the soil that they make; how far, how high and how soon, read alike of both."""

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


def grains_fall(seed: int, settings: Sequence[str] = ()) -> Fall:
    """The column of grains of column.toml with another packing, and ``settings``."""
    simulation = ps.build(ps.load(HERE / "column.toml", settings=[f"grains.packing.seed={seed}", *settings]))
    assert simulation.grains
    d = simulation.grains.discs
    times, centre = followed(simulation, lambda: float(np.average(d.position[:, 0], weights=d.mass)))
    return Fall(times, centre, d.position.copy(), d.mass.copy())


def soil_falls(settings: Sequence[str] = ()) -> Fall:
    """The column of soil of ground.toml, which has taken over material.toml, with ``settings``."""
    simulation = cs.build(cs.load(HERE / "ground.toml", settings=settings))
    scene = simulation.scene
    assert scene.soil
    x = simulation.flow.soil.x[: simulation.flow.soil.soil]
    times, centre = followed(simulation, lambda: float(x[:, 0].mean()))
    mass = np.full(len(x), scene.soil.density * scene.numerics.spacing**2)
    return Fall(times, centre, x.copy(), mass)

"""A falling plate flutters or tumbles by its inertia alone: same weight in water, same speed, another density."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from porescale import Floats, build, load
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
SCENE = HERE / "plate.toml"
LENGTH, THICKNESS, FLUID = 0.01, 0.00125, 1000.0  # m, m, kg/m³
LIGHT, HEAVY = 1500.0, 6000.0  # kg/m³
PULL = (LIGHT - FLUID) * 9.81  # kg/(m² s²), weight in water over the area: that of the light one on earth
START = 0.8  # rad, the scene's angle
EVERY = 20  # steps between two places that are kept
FLOOR = 0.02  # m, height at which a fall counts as over


@dataclass
class Fall:
    """A fall, in time (n,) s: position (n, 2) m, angle (n,) rad."""

    density: float
    time: Floats
    position: Floats
    angle: Floats

    @property
    def froude(self) -> float:
        """Square root of the plate's mass over that of the fluid in a square of its length (Belmonte et al. 1998)."""
        return math.sqrt(self.density * THICKNESS / (FLUID * LENGTH))

    @property
    def turns(self) -> float:
        """Whole turns between start and end."""
        return abs(float(self.angle[-1] - self.angle[0])) / (2.0 * math.pi)

    @property
    def tilt(self) -> float:
        """Largest angle to the level on the way, degrees; 90 and more: it has turned over."""
        return math.degrees(float(np.abs(self.angle).max()))

    @property
    def speed(self) -> float:
        """Mean speed down over the second half, m/s."""
        half = len(self.time) // 2
        gone = self.position[half] - self.position[-1]
        return float(gone[1] / (self.time[-1] - self.time[half]))


def fall(density: float, quality: str = "draft") -> Fall:
    """A plate of ``density`` (kg/m³) under the gravity that makes it weigh ``PULL`` in the fluid."""
    g = PULL / (density - FLUID)
    settings = [f"grains.density={density!r}", f"gravity=[0, {-g!r}]"]
    simulation = build(load(SCENE, quality=quality, settings=settings))
    assert simulation.coupled
    plate = simulation.coupled.polygons
    assert plate
    rows = []
    while simulation.time < simulation.scene.time.end and plate.position[0, 1] > FLOOR:
        rows.append((simulation.time, *plate.position[0], plate.angle[0]))
        simulation.advance(EVERY)
        simulation.check()
    time, x, y, angle = np.array(rows).T
    return Fall(density, time, np.column_stack((x, y)), angle + START)


def draw(axes: Axes, one: Fall, colour: str) -> None:
    """The way of a plate, and itself every 30 ms."""
    axes.plot(*one.position.T, color=colour, linewidth=0.6)
    box = 0.5 * np.array([(-LENGTH, -THICKNESS), (LENGTH, -THICKNESS), (LENGTH, THICKNESS), (-LENGTH, THICKNESS)])
    step = max(1, round(0.03 / float(one.time[1] - one.time[0])))
    for at, angle in zip(one.position[::step], one.angle[::step], strict=True):
        c, s = math.cos(angle), math.sin(angle)
        axes.add_patch(Polygon(at + box @ np.array([[c, s], [-s, c]]), color=colour, alpha=0.7, linewidth=0))
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(title=f"density ratio {one.density / FLUID:g}, Fr {one.froude:.2f}", xlabel="x (m)", ylabel="y (m)")


def measure(quality: str = "draft") -> tuple[dict[str, float], Figure]:
    """What is compared with expected.toml, and its picture: both falls."""
    falls = [fall(density, quality) for density in (LIGHT, HEAVY)]
    light, heavy = falls
    figure, axes = stage(3, 10.0, 4.4)
    for one, ax, colour in zip(falls, axes[:2], ("#2b6ca3", "#b0522d"), strict=True):
        draw(ax, one, colour)
        axes[2].plot(
            one.time, one.angle / (2.0 * math.pi), color=colour, label=f"density ratio {one.density / FLUID:g}"
        )
    axes[2].set(xlabel="time (s)", ylabel="turns", title="angle")
    axes[2].legend()
    numbers = {
        "largest tilt of the light plate": light.tilt,
        "turns of the heavy plate": heavy.turns,
        "speed of the light plate": light.speed,
        "speed of the heavy plate": heavy.speed,
    }
    return numbers, figure


def main() -> int:
    """Both falls, their numbers and a picture."""
    told = options(__doc__ or "", HERE, quality=(str, "draft", "draft, standard or fine"))
    return conclude(HERE, *measure(told.quality), told.out)


if __name__ == "__main__":
    raise SystemExit(main())

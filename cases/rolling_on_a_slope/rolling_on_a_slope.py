"""A disc rolls down a slope and on along the floor: springs a hundred times as stiff change nothing."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from porescale import GRAVITY, Floats
from porescale.dem import Box, Grains, Linear, make_discs
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
RADIUS, DENSITY, FRICTION, DAMPING_RATIO = 0.02, 2500.0, 0.5, 0.2  # m, kg/m³, -, -
MASS = math.pi * RADIUS**2 * DENSITY  # kg per metre of depth
STIFFNESSES = (1e7, 1e5)  # N/m: the tutorial's 1e8 g/s² times a metre of depth over a centimetre, and a hundredth
SLOPE, LENGTH, DROP = math.radians(20.0), 0.5, 0.01  # rad, m along the slope, m that the disc falls onto it
LASTS = 0.9  # s


@dataclass
class Track:
    """time (t,) s;  place, velocity (t, 2) m, m/s;  spin (t,) rad/s."""

    time: Floats
    place: Floats
    velocity: Floats
    spin: Floats


def roll(stiffness: float, friction: float = FRICTION, drop: float = DROP, rows: int = 900) -> Track:
    """A disc let go ``drop`` above a slope that ends on a floor at y = 0 and x = 0."""
    damping = 2.0 * DAMPING_RATIO * math.sqrt(stiffness * MASS)
    law = Linear(stiffness, damping, 0.5 * stiffness, 0.5 * damping, friction)
    along, normal = np.array([math.cos(SLOPE), -math.sin(SLOPE)]), np.array([math.sin(SLOPE), math.cos(SLOPE)])
    start = -LENGTH * along + (RADIUS + drop) * normal
    discs = make_discs([start], RADIUS, DENSITY)
    box = Box((-2.0, 0.0), (2.0, 2.0), "open", "open", top="open")
    grains = Grains(discs, law, box)
    grains.add_wall("slope", (0.0, 0.0), (float(normal[0]), float(normal[1])))
    weight = np.array([[0.0, -MASS * GRAVITY]])
    each = math.ceil(LASTS / rows / grains.stable_step(steps_per_contact=50.0))
    dt = LASTS / rows / each
    seen = []
    for _ in range(rows):
        grains.step(dt, weight, count=each)
        seen.append((grains.time, *discs.position[0], *discs.velocity[0], discs.spin[0]))
    table = np.array(seen)
    return Track(table[:, 0], table[:, 1:3], table[:, 3:5], table[:, 5])


def on_slope(path: Track) -> NDArray[np.bool_]:
    """Rows where the disc rolls on the slope: bounces are over, the floor not yet reached."""
    foot = -RADIUS * math.tan(0.5 * SLOPE)
    return np.asarray((path.time > 0.25) & (path.place[:, 0] < foot - 0.02))


def measure() -> tuple[dict[str, float], Figure]:
    """Accelerations against the exact one, differences between stiffnesses, and the picture."""
    stiff, soft = (roll(k) for k in STIFFNESSES)
    rolling = 2.0 / 3.0 * GRAVITY * math.sin(SLOPE)
    numbers = {}
    for name, path in (("stiff", stiff), ("soft", soft)):
        on = on_slope(path)
        speed = path.velocity[on] @ (math.cos(SLOPE), -math.sin(SLOPE))
        numbers[f"{name}: acceleration over 2/3 g sin"] = float(np.polyfit(path.time[on], speed, 1)[0]) / rolling
        numbers[f"{name}: spin times radius over speed"] = float(-path.spin[on][-1] * RADIUS / speed[-1])
    way, apart_at_end = stiff.place[-1] - stiff.place[0], stiff.place[-1] - soft.place[-1]
    numbers["difference of places at the end, of the way"] = float(np.hypot(*apart_at_end) / np.hypot(*way))
    both = on_slope(stiff) & on_slope(soft)
    apart = float(np.abs(stiff.velocity[both, 1] - soft.velocity[both, 1]).max())
    numbers["difference of vertical speeds on the slope, of the largest"] = apart / float(
        np.abs(stiff.velocity[both, 1]).max()
    )
    return numbers, draw(stiff, soft)


def draw(stiff: Track, soft: Track) -> Figure:
    """Where the disc goes, and its vertical velocity over time."""
    figure, axes = stage(2, 10.0, 3.4)
    up = LENGTH * np.array([-math.cos(SLOPE), math.sin(SLOPE)])
    axes[0].plot([1.1 * up[0], 0.0, 0.6], [1.1 * up[1], 0.0, 0.0], "k", lw=2)
    for k, path, style in ((STIFFNESSES[0], stiff, "-"), (STIFFNESSES[1], soft, "--")):
        axes[0].plot(*path.place.T, style, label=f"k = {k:g} N/m")
        axes[1].plot(path.time, path.velocity[:, 1], style, label=f"k = {k:g} N/m", lw=1.2)
    for k in range(0, len(stiff.time), 90):
        turn = np.linspace(0.0, 2.0 * math.pi, 60)
        at = stiff.place[k]
        axes[0].plot(at[0] + RADIUS * np.cos(turn), at[1] + RADIUS * np.sin(turn), color="0.6", lw=0.8)
    axes[0].set(aspect="equal", xlabel="x, m", ylabel="y, m", title="centre of the disc")
    exact = -2.0 / 3.0 * GRAVITY * math.sin(SLOPE) ** 2
    on = on_slope(stiff)
    time, speed = stiff.time[on], stiff.velocity[on, 1]
    axes[1].plot(time, speed[0] + exact * (time - time[0]), "k:", lw=2, label="⅔ g sin² θ")
    axes[1].set(xlabel="time, s", ylabel="vertical velocity, m/s", title="vertical velocity")
    for ax in axes:
        ax.legend(fontsize=7)
        ax.title.set_fontsize(9)
    return figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))

"""A pulse runs along a chain of discs: the exact profile, and the speed that a plot of it shows."""

import math
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.special import jn_zeros, jnp_zeros, jv

from porescale import Floats
from porescale.dem import Box, Grains, Linear, make_discs
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
APART, RADIUS, STIFFNESS, DENSITY = 2.0, 1.1, 1e8, 2.5  # cm, cm, dyn/cm, g/cm³: the tutorial's
MASS = math.pi * RADIUS**2 * DENSITY  # g per cm
RATE = math.sqrt(STIFFNESS / MASS)  # 1/s
FASTEST = APART * RATE  # cm/s, the speed of long waves
KICK = 100.0  # cm/s: moves discs by 0.015 cm, they overlap by 0.2 cm and stay in touch
DT = 0.01 / RATE  # s


def chain(count: int) -> Grains:
    """Discs in a row between two walls, all pressed alike: a wall is as far behind the overlap as a neighbour's rim."""
    x = APART * np.arange(count)
    inset = RADIUS - (2.0 * RADIUS - APART)
    box = Box((-inset, -50.0), (float(x[-1]) + inset, 50.0), bottom="open", top="open")
    return Grains(make_discs(np.column_stack((x, np.zeros(count))), RADIUS, DENSITY), Linear(STIFFNESS), box)


def kicked(count: int = 21, lasts: float = 20.0) -> tuple[Floats, Floats, Floats]:
    """Times (t,) s of velocities, velocities (t, count) cm/s and displacements (t, count) cm, half a step later, after
    the middle disc got KICK; ``lasts`` in 1/(2 RATE)."""
    grains = chain(count)
    rest = grains.discs.position[:, 0].copy()
    grains.discs.velocity[count // 2, 0] = KICK
    steps = int(lasts / (2.0 * RATE * DT))
    time, speed, moved = np.zeros(steps), np.zeros((steps, count)), np.zeros((steps, count))
    for k in range(steps):
        grains.step(DT)
        time[k] = (k + 0.5) * DT  # of the velocity: it started half a step before the first force
        speed[k], moved[k] = grains.discs.velocity[:, 0], grains.discs.position[:, 0] - rest
    return time, speed, moved


def first_top(time: Floats, values: Floats) -> float:
    """Time of the first maximum above half of the largest, by a parabola through three points."""
    inner = values[1:-1]
    k = int(np.flatnonzero((inner > values[:-2]) & (inner >= values[2:]) & (inner > 0.5 * values.max()))[0]) + 1
    left, middle, right = values[k - 1 : k + 2]
    return float(time[k] + 0.5 * (left - right) / (left - 2.0 * middle + right) * (time[1] - time[0]))


def packet(phase: float, count: int = 601, width: float = 20.0) -> float:
    """Group speed, cm/s, of a packet of waves with ``phase`` (rad) from disc to disc, ``width`` discs wide."""
    grains = chain(count)
    discs, n = grains.discs, np.arange(count) - 150
    rest = discs.position[:, 0].copy()
    wave = np.fft.fft(1e-3 * np.exp(-(n**2) / (4.0 * width**2) + 1j * phase * n))
    along = np.fft.fftfreq(count)
    frequency = 2.0 / DT * np.arcsin(np.sin(np.pi * along) * RATE * DT)  # that of leap-frog; all run to the right
    discs.position[:, 0] += np.fft.ifft(wave).real
    discs.velocity[:, 0] = np.fft.ifft(-1j * frequency * np.exp(0.5j * frequency * DT) * wave).real
    grains.refresh()
    middle = []
    steps = int(150.0 * APART / (FASTEST * math.cos(0.5 * phase)) / DT)
    for _ in range(2):
        grains.step(DT, count=steps // 2)
        moved = discs.position[:, 0] - rest
        weight = MASS * discs.velocity[:, 0] ** 2
        weight[:-1] += STIFFNESS * np.diff(moved) ** 2
        middle.append(float(weight @ rest / weight.sum()))
    return (middle[1] - middle[0]) / (steps // 2 * DT)


def measure() -> tuple[dict[str, float], Figure]:
    """Profile and speeds against the exact ones, and their picture."""
    time, speed, moved = kicked()
    later = time + 0.5 * DT
    middle = speed.shape[1] // 2
    n = np.abs(np.arange(speed.shape[1]) - middle)
    early = 2.0 * RATE * time < 15.0  # the front comes back from a wall at 2 RATE t = 20 and more
    exact = KICK * jv(2 * n[None, :], 2.0 * RATE * time[early, None])
    numbers = {
        "speed of long waves": FASTEST,
        "largest difference from the Bessel profile": float(np.abs(speed[early] - exact).max()) / KICK,
    }
    tops = {disc: first_top(later, moved[:, middle + disc]) for disc in (2, 4, 6)}
    crests = {disc: first_top(time, speed[:, middle + disc]) for disc in (2, 4, 6)}
    for near, far in ((2, 4), (4, 6)):
        pair = f"from No. {11 + near} to No. {11 + far}"
        numbers[f"displacement, {pair}"] = 2.0 * APART / (tops[far] - tops[near])
        numbers[f"velocity, {pair}"] = 2.0 * APART / (crests[far] - crests[near])
    numbers["displacement, mean of both"] = 4.0 * APART / (tops[6] - tops[2])
    phases = {"0.1 pi": 0.1, "0.5 pi": 0.5, "0.8 pi": 0.8}
    found = {name: packet(math.pi * share) for name, share in phases.items()}
    numbers |= {f"packet, phase {name}": value / FASTEST for name, value in found.items()}
    return numbers, draw(later, moved, middle, found)


def draw(time: Floats, moved: Floats, middle: int, found: dict[str, float]) -> Figure:
    """Displacements over time, read-off speeds over distance, group speeds over phase."""
    figure, axes = stage(3, 10.5, 3.3)
    x = 2.0 * RATE * time
    shown = x < 18.0
    for disc, colour in zip((0, 2, 4, 6), ("0.4", "#2a6f97", "#c96a4a", "#4d2a4f"), strict=True):
        axes[0].plot(1e5 * time[shown], 10.0 * moved[shown, middle + disc], color=colour, label=f"No. {11 + disc}")
        exact = KICK / (2.0 * RATE) * 2.0 * sum(jv(2 * disc + 1 + 2 * k, x) for k in range(30))
        axes[0].plot(1e5 * time[shown][::90], 10.0 * exact[shown][::90], ".", color=colour, ms=4)
        if disc:
            top = first_top(time, moved[:, middle + disc])
            axes[0].axvline(1e5 * top, color=colour, lw=0.6, ls=":")
    axes[0].set(xlabel="time, 10⁻⁵ s", ylabel="displacement, mm", title="pulse (lines), exact (dots)")
    axes[0].legend(fontsize=7)
    far = np.arange(2, 200, 2)
    for name, zero, colour in (("displacement", jn_zeros, "#2a6f97"), ("velocity", jnp_zeros, "#c96a4a")):
        at = np.array([zero(2 * disc, 1)[0] for disc in far])
        axes[1].semilogx(far[1:], 4.0 / np.diff(at) * FASTEST, color=colour, label=f"crests of {name}")
    axes[1].axhline(FASTEST, color="k", lw=0.8, label=f"a√(k/m) = {FASTEST:.1f}")
    axes[1].plot([4, 6], [5700, 5700], "k_", ms=14, label="the tutorial reads 5700")
    axes[1].set(xlabel="discs from the kick", ylabel="speed, cm/s", title="read off between discs two apart")
    axes[1].legend(fontsize=7)
    phase = np.linspace(0.0, 1.0, 100)
    axes[2].plot(phase, FASTEST * np.cos(0.5 * np.pi * phase), color="k", lw=0.8, label="V₀ cos(qa/2)")
    axes[2].plot([float(name.split()[0]) for name in found], list(found.values()), "o", label="packets")
    axes[2].set(xlabel="phase from disc to disc, π", ylabel="group speed, cm/s", title="dispersion")
    axes[2].legend(fontsize=7)
    for ax in axes:
        ax.title.set_fontsize(9)
    return figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))

"""A disc bounces on a floor: restitution 1 and 0.5 under both rules for the end of a contact."""

import math
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from porescale import GRAVITY
from porescale.dem import Box, Grains, Linear, make_discs
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
RADIUS = 1e-3  # m
MASS = math.pi * RADIUS**2 * 25.0  # kg per metre of depth: 0.025 g/mm² over 1 m
STIFFNESS = 1e5  # N/m: 1e8 g/s²
DAMPING = 1.205  # N s/m: 0.1205e4 g/s, by which the tutorial means e = 0.5
DROP = 0.05  # m, gap below the disc at the start
LAWS = {
    "e = 1": Linear(STIFFNESS, 0.0),
    "e = 0.5, ends without force": Linear.from_restitution(0.5, MASS, STIFFNESS, release="force"),
    "e = 0.5, ends without overlap": Linear.from_restitution(0.5, MASS, STIFFNESS, release="overlap"),
    "the tutorial's c, ends without force": Linear(STIFFNESS, DAMPING, release="force"),
    "the tutorial's c, ends without overlap": Linear(STIFFNESS, DAMPING, release="overlap"),
}


def path(law: Linear, lasts: float = 0.5, steps_per_contact: int = 1000) -> tuple[NDArray[np.float64], ...]:
    """(time s, gap below the disc m) of a disc let go DROP above the floor, for ``lasts`` s."""
    discs = make_discs([(0.0, DROP + RADIUS)], RADIUS, MASS / (math.pi * RADIUS**2))
    grains = Grains(discs, law, Box((-1.0, 0.0), (1.0, 1.0), "open", "open", top="open"))
    weight = np.array([[0.0, -MASS * GRAVITY]])
    dt = math.pi * math.sqrt(MASS / STIFFNESS) / steps_per_contact
    chunk = 2 * steps_per_contact
    track = [(0.0, DROP)]
    while track[-1][0] < lasts:
        grains.step(dt, weight, count=chunk)
        track.append((grains.time, float(discs.position[0, 1]) - RADIUS))
    time, gap = np.array(track).T
    return time, gap


def tops(gap: NDArray[np.float64]) -> NDArray[np.float64]:
    """Heights (b,) of the tops after each bounce over DROP."""
    inner = gap[1:-1]
    return inner[(inner > gap[:-2]) & (inner >= gap[2:]) & (inner > 1e-3 * DROP)] / DROP


def measure(steps_per_contact: int = 1000) -> tuple[dict[str, float], Figure]:
    """Heights after the first bounces over those before, and their picture."""
    figure, axes = stage(2)
    numbers = {}
    for k, (name, law) in enumerate(LAWS.items()):
        time, gap = path(law, steps_per_contact=steps_per_contact)
        high = tops(gap)
        numbers[f"{name}: first height"] = float(high[0])
        numbers[f"{name}: second over first"] = float(high[1] / high[0])
        left = name.startswith("e")
        axes[0 if left else 1].plot(time, 1e3 * gap, "-" if k != 2 else "--", label=name, lw=1.2)
    for ax, shares in zip(axes, ((1.0, 0.25, 0.0625), (0.25, 0.3027)), strict=True):
        for share in shares:
            ax.axhline(1e3 * DROP * share, color="0.7", lw=0.6, zorder=0)
        ax.set(xlabel="time, s", ylabel="height, mm", ylim=(-1, 70))
        ax.legend(fontsize=7, loc="upper right")
    axes[0].set_title("restitution as input: both rules bounce alike", fontsize=9)
    axes[1].set_title("damping as input: the rule decides", fontsize=9)
    return numbers, figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))

"""How long a step may be: bisected for a disc on a floor, mapped over damping, and what it does to one that bounces."""

import math
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from porescale import Floats
from porescale.output import conclude, options, stage
from porescale.validation.dem import critical_step as lab
from porescale.validation.dem import setups

HERE = Path(__file__).resolve().parent
UNIT = math.sqrt(setups.MASS / setups.STIFFNESS)  # s
RATIOS = (0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0)
SHARES = (0.02, 0.05, 0.1, *np.linspace(0.125, 0.95, 34))
PHASES = 200


def lagged(ratio: Floats | float) -> Floats:
    """Longest stable step over sqrt(m/k) of leap-frog with the damping force of the last half step."""
    h = np.asarray(ratio, float)
    limit: Floats = 2.0 * (np.sqrt(1.0 + h**2) - h)
    return limit


def growth(ratio: float, step: float, steps: int = 60) -> float:
    """Factor per step by which a small disturbance of a disc pressed on a floor grows, ``step`` in sqrt(m/k)."""
    grains = setups.on_floor(setups.law_at(ratio), -0.1 * setups.RADIUS)
    load = np.array([[0.0, -0.1 * setups.RADIUS * setups.STIFFNESS]])
    d = grains.discs
    rest = d.position.copy()
    d.position[0, 1] += 1e-12 * setups.RADIUS
    grains.refresh()
    size = []
    for _ in range(steps):
        grains.step(step * UNIT, load)
        off = abs(float(d.position[0, 1] - rest[0, 1])) + abs(float(d.velocity[0, 1])) * UNIT
        size.append(off)
        if off > 1e-3 * setups.RADIUS or off < 1e-16:
            break
    half = len(size) // 3
    return float((size[-1] / size[half]) ** (1.0 / max(len(size) - 1 - half, 1)))


def gains(share: float, ratio: float = 0.0) -> Floats:
    """Kinetic energy after over before one bounce, less one, (PHASES,), at ``share`` of the longest stable step, for
    touches at all moments of a step."""
    dt = share * float(lagged(ratio)) * UNIT
    speed = 1.0
    law = setups.law_at(ratio)
    gap = speed * dt * (np.arange(PHASES) + 0.5) / PHASES
    grains = setups.on_floor(law, gap)
    grains.discs.velocity[:, 1] = -speed
    grains.step(dt, count=int(6.0 * UNIT / dt) + 4)
    found: Floats = (grains.discs.velocity[:, 1] / speed) ** 2 - 1.0
    return found


def measure() -> tuple[dict[str, float], Figure]:
    """Limits against both formulas, gains of a bounce, and their picture."""
    found = {ratio: lab.critical_step(ratio) for ratio in RATIOS}
    numbers = {f"longest step, h = {ratio:g}": value for ratio, value in found.items()}
    worst = {share: gains(share) for share in SHARES}
    for share in (0.1, 0.02):
        numbers[f"largest gain of a bounce at {share:g} of it"] = float(worst[share].max())
    numbers["largest gain of a bounce below half of it"] = max(float(worst[it].max()) for it in SHARES if it < 0.5)
    return numbers, draw(found, worst)


def draw(found: dict[float, float], worst: dict[float, Floats]) -> Figure:
    """Growth over step and damping ratio with the limits, and the energy error of one bounce over the step."""
    figure, axes = stage(2, 10.0, 4.0)
    h, steps = np.linspace(0.0, 2.0, 41), np.linspace(0.05, 2.6, 52)
    rate = np.array([[growth(ratio, step) for ratio in h] for step in steps])
    shown = axes[0].pcolormesh(h, steps, np.log10(np.clip(rate, 1e-2, 1e2)), cmap="RdBu_r", vmin=-1, vmax=1)
    figure.colorbar(shown, label="log₁₀ of the growth in a step")
    fine = np.linspace(0.0, 2.0, 200)
    axes[0].plot(fine, lagged(fine), "k", lw=1.4, label="lagged: 2(√(1 + h²) − h)")
    axes[0].axhline(2.0, color="k", ls="--", lw=1.0, label="central: 2")
    axes[0].axhline(1.0, color="k", ls=":", lw=1.0, label="Courant: 1")
    axes[0].plot(list(found), list(found.values()), "o", mfc="w", mec="k", ms=5, label="bisected")
    axes[0].set(xlabel="damping ratio h", ylabel="step over √(m/k)", title="a disc pressed on a floor")
    axes[0].legend(fontsize=7, loc="upper right")
    share = np.array(list(worst))
    high = np.array([values.max() for values in worst.values()])
    low = np.array([values.min() for values in worst.values()])
    axes[1].fill_between(share, low, high, alpha=0.3, label="all moments of touch")
    axes[1].plot(share, high, ".-", ms=3)
    axes[1].plot(share, low, ".-", ms=3, color="C0")
    axes[1].axvline(0.1, color="k", lw=0.8, ls=":", label="a tenth of the limit")
    axes[1].set(xlabel="step over the longest stable one", ylabel="energy gained in a bounce, share of it",
                title="a disc that bounces, e = 1")  # fmt: skip
    axes[1].set_yscale("symlog", linthresh=1e-3)
    axes[1].legend(fontsize=7, loc="upper left")
    for ax in axes:
        ax.title.set_fontsize(9)
    return figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))

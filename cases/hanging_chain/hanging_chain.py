"""A chain of 20 bonded discs hangs as a catenary, is pulled taut, and breaks at F = k δ0."""

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from porescale import GRAVITY, Floats
from porescale.dem import Grains, Linear, Moved, Table
from porescale.output import Shot, by_piece, conclude, draw_bodies, frame, options, shot, stage
from porescale.validation.dem import segments, setups

HERE = Path(__file__).resolve().parent
COUNT = 20
SPAN = 0.7  # of the length: distance of the ends while it hangs
LAW = Linear(1e6, 500.0)  # N/m and N s/m: 0.4 of critical for two discs
PRESSED = 0.04  # radii of overlap when they are bonded
STRENGTH = LAW.stiffness * PRESSED * setups.RADIUS  # N/m, k δ0
LENGTH = (COUNT - 1) * (2.0 - PRESSED) * setups.RADIUS  # m
TAUT = 0.985  # of the length: from there on the pull is slow
FAST, SLOW = 0.03, 1e-3  # m/s; the slow one makes waves of v √(k m) = 0.9 N/m
DRAG = 10.0  # 1/s, twice √(g/length): swings end, while 0.24 N/m a disc resist the fast pull
STILL, RAMP = 0.1, 0.02  # s at rest, and in which a speed is changed
EACH = 2e-3  # s between rows
AFTER = (0.03, 0.08)  # s after the break, of the shapes shown


@dataclass
class Pull:
    """span m between the ends, force (r, 2) N/m on the moved end, broken bonds (r,);  shots and their times: at rest,
    just before the break, and after it;  grains at the end."""

    grains: Grains
    span: Floats
    force: Floats
    broken: NDArray[np.int64]
    shots: list[Shot] = field(default_factory=list)

    @property
    def last(self) -> int:
        """The last row before a bond broke."""
        return int(np.argmax(self.broken > 0)) - 1


def pull(strength: float = STRENGTH) -> Pull:
    """The chain hangs, its right end moves away, a bond breaks, and what is left of it falls; strength N/m of bonds."""
    grains = segments.hung(COUNT, SPAN, pressed=strength / (LAW.stiffness * setups.RADIUS), law=LAW)
    grains.reset_clock()
    assert grains.bonds is not None
    start, whole = float(np.ptp(grains.discs.position[:, 0])), grains.bonds.count
    until = STILL + (TAUT * LENGTH - start) / FAST
    speed = Table([STILL, STILL + RAMP, until, until + RAMP], [0.0, FAST, FAST, SLOW])
    grains.steering.control(0, Moved(), Moved(), Moved())
    grains.steering.control(COUNT - 1, Moved(speed), Moved(), Moved())
    grains.steering.watch(COUNT - 1)
    dt, load = grains.stable_step(), segments.weights(grains.discs)
    rows: list[tuple[float, ...]] = []
    count, shots = round(EACH / dt), [shot(grains)]
    before = shots[0]
    while not rows or rows[-1][3] == 0:
        before = shot(grains)
        grains.step(dt, load, count=count, drag=DRAG)
        record = grains.steering.record()[0]
        rows.append((start + record.displacement[0], *record.contact[:2], whole - grains.bonds.count))
    shots.append(before)
    done = 0.0
    for seconds in AFTER:
        grains.step(dt, load, count=round((seconds - done) / dt))
        shots.append(shot(grains))
        done = seconds
    span, x, y, broken = np.array(rows).T
    return Pull(grains, span, np.column_stack((x, y)), broken.astype(np.int64), shots)


def measure(strength: float = STRENGTH) -> tuple[dict[str, float], Figure]:
    """Shape and support against the catenary, pull and slope at which a bond breaks, over what is expected."""
    made = pull(strength)
    at = made.shots[0].position
    curve = segments.catenary(at)
    sag = -float(curve.min())
    middle = 0.5 * (at[0, 0] + at[-1, 0])
    size = 0.5 * (at[-1, 0] - middle) ** 2 / sag  # a of the catenary by Newton's method, from that of a parabola
    for _ in range(20):
        ratio = (at[-1, 0] - middle) / size
        size -= (size * (math.cosh(ratio) - 1.0) - sag) / (math.cosh(ratio) - 1.0 - ratio * math.sinh(ratio))
    weight = setups.MASS * GRAVITY / float(np.hypot(*np.diff(at, axis=0).T).mean())  # N/m a metre of chain
    pulled = np.hypot(*made.force.T)
    numbers = {
        "hanging: largest distance from the catenary, of the sag": float(np.abs(curve - at[:, 1]).max()) / sag,
        "hanging: weight borne by one end, over half of 18 discs": -float(made.force[0, 1])
        / (9.0 * setups.MASS * GRAVITY),
        "hanging: horizontal pull over that of the catenary": -float(made.force[0, 0]) / (weight * size),
        "pull that breaks it over k δ0": float(pulled[made.last]) / STRENGTH,
        "slope of the end when it breaks": float(made.force[made.last, 1] / made.force[made.last, 0]),
        "bonds broken within 2 ms": float(made.broken[-1]),
        "bonds broken in the end": float((made.shots[-1].whole == 0).sum()),
    }
    return numbers, draw(made)


def draw(made: Pull) -> Figure:
    """The chain at rest with its catenary, taut, and broken; the pull over the span."""
    figure, axes = stage(2, 11.0, 4.0)
    names = ("at rest", "before it breaks", *(f"{1e3 * after:.0f} ms later" for after in AFTER))
    for k, (at, name) in enumerate(zip(made.shots, names, strict=True)):
        down = (0.0, 0.2, 0.28, 0.36)[k]
        shown = Shot(at.position - (0.0, down), at.whole)
        draw_bodies(axes[0], made.grains, shown, by_piece(made.grains, shown))
        axes[0].text(0.27, -down - 0.01, name, fontsize=8)
        if k == 0:
            axes[0].plot(at.position[:, 0], segments.catenary(at.position), color="#b3122b", lw=1.2, label="catenary")
    axes[0].legend(fontsize=7, loc=(0.66, 0.75))
    frame(axes[0], (-0.15, 0.42, -0.44, 0.03))
    axes[1].plot(1e3 * made.span, np.hypot(*made.force.T), color="#2a6f97", lw=1.2, label="pull at the moved end")
    axes[1].axhline(STRENGTH, color="k", ls=":", lw=1, label="k δ0")
    half = 9.0 * setups.MASS * GRAVITY
    axes[1].axhline(half, color="0.6", ls="--", lw=1, label="half of the weight")
    axes[1].set(xlabel="distance of the ends, mm", ylabel="N/m", ylim=(0.0, 1.15 * STRENGTH),
                title="pulled until it breaks")  # fmt: skip
    axes[1].legend(fontsize=7)
    return figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))

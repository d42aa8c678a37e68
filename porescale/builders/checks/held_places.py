"""Where held discs must not come, how near to each other they are, and what a ring cannot be beside."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np

from porescale.common.core.errors import Fault
from porescale.common.core.types import Floats
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.lbm.scales import Scales
from porescale.scene.bodies.disc import Disc

if TYPE_CHECKING:
    from porescale.scene.scene import Scene

TOUCH = 1e-3
"""Share of a radius by which a disc may be in something."""
CLOSE, MOST = 0.01, 20_000
"""Share of a radius that a disc goes at most between two places that are looked at; most places of one disc."""
MANY = 1000
"""Discs up to which every pair is looked at for the narrowest gap."""


def path_of(it: Disc, end: float) -> tuple[Floats, Floats]:
    """Times (t,) s up to ``end`` (s) and centres (t, 2) m of a held disc, close to each other."""
    x, y, _ = (abs(value) for value in it.motion(0.0))
    x, y = (fn.largest if fn else value for fn, value in ((it.velocity_x, x), (it.velocity_y, y)))
    count = min(MOST, 1 + math.ceil(math.hypot(x, y) * end / (CLOSE * 0.5 * it.diameter)))
    times = np.linspace(0.0, end, count) if count > 1 else np.zeros(1)
    return times, np.array([(it.x, it.y)]) + np.array([it.travelled(float(time))[:2] for time in times])


def check_ring(scene: Scene) -> list[Fault]:
    """What is wrong with [ring] beside the rest of a scene: fluid, a closed box around it, held discs in it."""
    ring, d = scene.ring, scene.domain
    if ring is None:
        return []
    faults, radius = [], 0.5 * ring.diameter
    if scene.fluid is None:
        faults.append(Fault("ring", None, "stands in fluid", repair="add [fluid], or leave it out"))
    beside = {"grains": "which it does not touch", "rectangle": "which is no part of it", "gate": "which it would cut"}
    faults += [
        Fault("ring", None, f"does not go with [{name}], {why}", repair="leave one of them out")
        for name, why in beside.items() if getattr(scene, name)
    ]  # fmt: skip
    for name, side in d.sides.items():
        if side.boundary.periodic or side.open:
            faults.append(Fault(f"domain.{name}", side.kind, "a ring stands in a closed box", "", "wall or slip"))
    for key, at, size in (("x", ring.x, d.width), ("y", ring.y, d.height)):
        if not radius <= at <= size - radius:
            problem, allowed = "the ring reaches out of the box", f"{radius:g} to {size - radius:g}"
            repair = "move it, or make it smaller"
            if 2.0 * radius > size:
                allowed, repair = "", f"make ring.diameter {size:g} m at most"
            faults.append(Fault(f"ring.{key}", at, problem, "m", allowed, repair))
    for k, it in enumerate(scene.disc):
        times, centres = path_of(it, scene.time.end)
        out = np.hypot(*(centres - (ring.x, ring.y)).T) + 0.5 * it.diameter > radius + TOUCH * 0.5 * it.diameter
        if out.any():
            time = float(times[int(out.argmax())])
            problem = "stands in the ring" if time == 0.0 else f"runs into the ring after {time:.4g} s"
            faults.append(Fault(f"disc[{k}]", None, problem, repair="move one of them"))
    return faults


def narrow_gap(scene: Scene, scales: Scales) -> str:
    """A warning of the narrowest gap between held discs that stand, periodic images among them, or nothing.

    Expected is what square arrays of such gaps were off by (``SolidOperator.gaps``), between which it goes linearly.
    """
    assert scene.fluid
    table = SOLID_OPERATORS[scene.fluid.solid_operator].gaps
    discs = [it for it in scene.disc if it.fastest == 0.0]
    if not table or not discs or len(discs) > MANY:
        return ""
    at, radius = np.array([(it.x, it.y) for it in discs]), np.array([it.diameter / 2 for it in discs])
    periods = [size if d else 0.0 for size, d in zip((scene.domain.width, scene.domain.height), scene.domain.periodic,
                                                     strict=True)]  # fmt: skip
    least = np.inf
    for shift in itertools.product(*((-p, 0.0, p) if p else (0.0,) for p in periods)):
        gap = np.hypot(*np.moveaxis(at[:, None] - at + shift, -1, 0)) - radius[:, None] - radius
        if shift == (0.0,) * 2:
            np.fill_diagonal(gap, np.inf)
        least = min(least, float(gap.min()))
    cells, widest = least / scales.spacing, table[-1][0]
    if not 0.0 < cells < widest * (1 - 1e-9):
        return ""
    off = float(np.interp(cells, [gap for gap, _ in table], [share for _, share in table]))
    more = "at least " if cells < table[0][0] else ""
    others = " or ".join(f"fluid.solid_operator = {n!r}" for n, it in SOLID_OPERATORS.items() if it.narrow_gaps)
    return (
        f"held discs stand {cells:.2g} cells apart: of an array of such gaps the drag is {more}{100 * off:.0f} % too"
        f" small; a spacing of {least / widest:.2g} m, or {others}, mends it"
    )

"""Held discs so near to each other that the lattice lets too much through between them."""

import itertools

import numpy as np

from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.lbm.scales import Scales
from porescale.scene.scene import Scene

MOST = 1000
"""Discs up to which every pair is looked at."""


def narrow_gap(scene: Scene, scales: Scales) -> str:
    """A warning of the narrowest gap between held discs that stand, periodic images among them, or nothing.

    Expected is what square arrays of such gaps were off by (``SolidOperator.gaps``), between which it goes linearly.
    """
    assert scene.fluid
    table = SOLID_OPERATORS[scene.fluid.solid_operator].gaps
    discs = [it for it in scene.disc if it.fastest == 0.0]
    if not table or not discs or len(discs) > MOST:
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
    others = " or ".join(f"fluid.solid_operator = {n!r}" for n, it in SOLID_OPERATORS.items() if it.free_refused)
    return (
        f"held discs stand {cells:.2g} cells apart: of an array of such gaps the drag is {more}{100 * off:.0f} % too"
        f" small; a spacing of {least / widest:.2g} m, or {others}, mends it"
    )

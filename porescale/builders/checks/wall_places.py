"""What stands across free walls."""

import math
from typing import Any

import numpy as np

from porescale.common.core.errors import Fault
from porescale.scene.scene import Scene


def across_walls(
    scene: Scene, x: np.ndarray[Any, Any], r: np.ndarray[Any, Any], names: list[str], touch: float
) -> list[Fault]:
    """The first of what is placed, x (n, 2) m, r (n,) m, that stands across each free wall; packings by corners."""
    faults = []
    packing = scene.grains.packing if scene.grains else None
    for k, it in enumerate(scene.wall):
        normal = np.array(it.normal) / math.hypot(*it.normal)
        apart = (x - np.array([it.x, it.y])) @ normal
        behind = apart < r * (1 - 2 * touch)  # as deep as in another of its size: a share of the diameter
        if behind.any():
            i = int(behind.argmax())
            where = f"({x[i, 0]:g}, {x[i, 1]:g})"
            problem = f"stands across or behind wall[{k}] by {float(r[i] - apart[i]):.3g} m"
            faults.append(Fault(names[i], where, problem, "m", repair="move one of them"))
        if packing:
            ends = (packing.left, packing.left + packing.width), (packing.bottom, packing.bottom + packing.height)
            corners = np.array([(a, b) for a in ends[0] for b in ends[1]])
            deepest = float(((corners - np.array([it.x, it.y])) @ normal).min())
            if deepest < -1e-9 * scene.domain.width:
                problem = f"reaches {-deepest:.3g} m behind wall[{k}]"
                faults.append(Fault("grains.packing", None, problem, "m", repair="move one of them"))
    return faults

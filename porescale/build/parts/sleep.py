"""Grains that sleep."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from porescale.dem.grains import Grains
from porescale.scene.scene import Scene

Array = NDArray[np.floating]


def let_sleep(scene: Scene, grains: Grains, weight: Array) -> None:
    """Let the grains sleep where the scene says so; weight (n, 2) N/m: of each, less lift."""
    from porescale.dem.resting.sleep import Sleep as Sleepers

    if scene.sleep is not None:
        size = np.hypot(weight[:, 0], weight[:, 1]).astype(float)
        grains.sleep = Sleepers(grains, size, scene.sleep.share, scene.sleep.after)


def sleep_row(grains: Grains) -> dict[str, float]:
    """Columns of the series, where grains may sleep."""
    if grains.sleep is None:
        return {}
    return {
        "grains asleep ()": float(grains.sleep.count),
        "energy taken by sleep (J/m)": float(grains.sleep.removed.sum()),
    }

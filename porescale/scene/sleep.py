"""[sleep]: grains that rest are left out of contact steps until something disturbs them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.dem.grains import Grains
from porescale.scene.walls import moving_sides

if TYPE_CHECKING:
    from porescale.scene.sections import Scene

Array = NDArray[np.floating]


class Sleep(Section):
    """Grains fall asleep that are slow and in balance, and wake when they are out of balance by ``share`` of their
    weight (in fluid: less lift): dem/resting/sleep.py.  Off without this section; series.csv says how many sleep.
    """

    share: float = quantity("", 0.05, gt=0, le=0.5, help="share of a grain's weight by which it may be out of balance")
    after: float | None = quantity(
        "s", None, gt=0, le=1e9, help="time for which a grain must rest (default: 100 oscillations of a contact)"
    )


def judge_sleep(scene: Scene) -> list[Fault]:
    """Faults of [sleep] in a scene: what has no grains, or more than discs and walls that stand or rise."""
    if scene.sleep is None:
        return []
    if scene.grains is None:
        return [Fault("sleep", None, "there are no grains", repair="add [grains] or leave it out")]
    if scene.gravity == (0.0, 0.0):
        return [Fault("sleep", None, "grains without weight have no share of it", repair="leave it out")]
    others = {
        "clump": scene.clump, "segment": scene.segment, "polygon": scene.polygon, "container": scene.container,
        "bonds": scene.bonds, "rock": scene.rock, "control": scene.control, "wall": scene.wall, "cell": scene.cell,
        "lubrication": scene.lubrication, "domain": moving_sides(scene),
    }  # fmt: skip
    return [
        Fault("sleep", None, f"does not know [{name}]", repair="leave one of them out")
        for name, section in others.items()
        if section
    ]


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

"""Water kept at levels: the reservoirs of a scene, and what is recorded of them."""

import math
from typing import Any

import numpy as np

from continuum_sph.scene.reservoir import ReservoirSection
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage import Reservoir, Seepage, Supply
from continuum_sph.seepage.halving import HEAVY
from porescale.common.core.errors import Unstable
from porescale.common.core.types import Floats
from porescale.common.record.part import Part

HIGHER = 0.1
"""Share of the tank's height by which the water of a reservoir may stand over it, or under its bottom: splashes."""


class ReservoirPart(Part):
    """The reservoirs of a flow.

    supply : of ``flow``;  height : of the tank, m.
    """

    key = "supply"

    def __init__(self, supply: Supply, flow: Seepage, height: float) -> None:
        self.supply, self.flow, self.height = supply, flow, height

    def check(self) -> None:
        """Raise Unstable when a level lies below its bottom or over the tank."""
        margin = HIGHER * self.height
        for it in self.supply.reservoirs:
            if not it.bottom - margin <= it.level <= self.height + margin:
                raise Unstable(
                    f"the strip of {it.name}", "level", it.level, "m", self.flow.step, self.flow.time,
                    "its strip is too narrow, or water comes in faster than it leaves: widen it",
                )  # fmt: skip

    def row(self) -> dict[str, float]:
        """Level, mass let in and out, and mass passed on, of each.

        NAME level (m) : height of the reservoir's water
        NAME let in (kg/m) : mass that it has let into the tank
        NAME let out (kg/m) : mass that it has taken out
        NAME passed on (kg/m) : mass that has gone from it towards the next reservoir, below zero for what has come
            from there, in the mean over all sections between its strip and halfway: let in less let out, which go in
            steps of whole particles, and less what more is held up to there
        """
        row = {}
        for it in self.supply.reservoirs:
            row[f"{it.name} level (m)"] = it.level
            row[f"{it.name} let in (kg/m)"] = it.let_in
            row[f"{it.name} let out (kg/m)"] = it.let_out
            row[f"{it.name} passed on (kg/m)"] = self.supply.passed(it)
        return row

    def state(self) -> dict[str, Any]:
        """What was let in and out."""
        return self.supply.state()

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from a state of the same reservoirs."""
        self.supply.restore(state)


def spare(scene: Scene, x: Floats) -> int:
    """Particles of water that wait: what the tank holds up to its highest level, less those at ``x`` (n, 2) m there."""
    if not scene.reservoir:
        return 0
    rows = math.ceil(scene.highest / scene.numerics.spacing) + 1
    present = int((x[:, 1] < scene.highest).sum())
    return max(round(scene.inner[0] / scene.numerics.spacing) * rows - present, 0) + 1


def halves(scene: Scene, soil: int, porosity: float) -> int:
    """Particles of water that wait to be halves of what comes into pores (`seepage.halving`) about ``soil`` particles:
    full pores hold at most 4/3 as many as there are of these, and have as many at the start."""
    return soil // 3 + 1 if scene.reservoir and HEAVY * porosity < 1.0 else 0


def reservoir(section: ReservoirSection, name: str, width: float) -> Reservoir:
    """The reservoir of a section, called ``name``, in a tank of a ``width``, m."""
    times, levels = (np.array(column, np.float64) for column in zip(*section.table, strict=True))
    walls = section.left <= 0.0, section.right >= width * (1.0 - 1e-9)
    return Reservoir(name, section.left, section.right, section.bottom, times, levels, walls)

"""Polygons in fluid, as scenes have them: convex, and resolved by the cells."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from porescale.builders.checks.discs_alone import check_beside_polygons
from porescale.common.core.errors import Fault, InputError
from porescale.coupling.coverage.polygon import convex, least_width

if TYPE_CHECKING:
    from porescale.builders.initial.frames import Placed
    from porescale.scene.scene import Scene

THINNEST = 2.0
"""Cells across a polygon below which there is no full cell between its faces: of a plate of one cell drag is off by up
to 12 % and torque by 10 %, as it lies in the cells; of 2 cells by 1 and 3 %, of 3 by 1 and 2 %."""

LIGHTEST = ((4.0, 0.2), (3.0, 0.3), (2.0, 0.5))
"""Cells across, and the density ratio from which on free polygons held for 1000 steps at relaxation time 0.8: plates up
to 24 cells long, and triangles; squares of 6 cells held at 0.1, too."""
TRAVEL = 0.05
"""Of the smallest thickness that the speed to expect may go in a contact step: a quarter of what the run's health
allows."""


def longest_step(placed: Sequence[Placed], speed: float) -> float:
    """Contact step (s) in which no polygon goes too far at the ``speed`` (m/s) to expect; infinite if none is thick."""
    thickness = min((it.frame.thickness for it in placed if it.frame.thickness > 0.0), default=math.inf)
    return TRAVEL * thickness / speed if speed > 0.0 else math.inf


def check_in_fluid(scene: Scene, frames: Sequence[str]) -> list[Fault]:
    """What of the sections ``frames`` of bodies of segments cannot be in fluid: all but convex polygons."""
    repair = "take [[polygon]], [[rectangle]] or [[clump]], or leave [fluid] out"
    faults = [Fault(it, None, "is for dry grains", repair=repair) for it in frames if it != "polygon"]
    for k, each in enumerate(scene.polygon):
        try:
            convex(each.points, f"polygon[{k}]")
        except InputError as error:
            faults += error.faults
    return faults + (check_beside_polygons(scene) if scene.polygon else [])


def widths(placed: Sequence[Placed]) -> list[float]:
    """Least width (m) of each polygon."""
    return [least_width(np.array(it.frame.corners)) for it in placed]


def too_few_cells(placed: Sequence[Placed], spacing: float) -> str:
    """A warning where a polygon is less than ``THINNEST`` cells across, or nothing."""
    narrow = [(it.key, width / spacing) for it, width in zip(placed, widths(placed), strict=True)]
    thin = [(key, cells) for key, cells in narrow if cells < THINNEST]
    if not thin:
        return ""
    key, cells = min(thin, key=lambda it: it[1])
    return (
        f"{key} is {cells:.2g} cells across: below {THINNEST:g} its faces share cells and its drag is some per cent"
        " off; take a smaller spacing"
    )


def too_light(placed: Sequence[Placed], spacing: float, density: float) -> str:
    """A warning where a free polygon is below the stability limit in fluid of ``density`` (kg/m³), or nothing."""
    for it, width in zip(placed, widths(placed), strict=True):
        least = next((ratio for cells, ratio in LIGHTEST if width / spacing >= cells), 1.0)
        own = it.frame.mass_properties()
        ratio = own.mass / ((own.area or 1.0) * density)
        if it.free and ratio < least:
            return (
                f"{it.key} has a density ratio of {ratio:.2g}: with {width / spacing:.2g} cells across it is known to"
                f" hold from {least:g} on; take a smaller spacing"
            )
    return ""

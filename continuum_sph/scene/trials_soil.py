"""Small bodies of soil that validations and tests set up and watch.  SI."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.scene.soil_build import placed
from continuum_sph.smoothing import Smoothing
from continuum_sph.soil import Material, SoilFlow, SoilLaw
from porescale.ground.constants import GRAVITY

Floats = NDArray[np.float64]
RATIO = 1.3  # smoothing length over spacing
SKIN = 0.15  # of the pair list, over the smoothing length


def in_tank(
    x: Floats,
    stress: Floats,
    tank: tuple[float, float],
    spacing: float,
    material: Material,
    *,
    gravity: float = GRAVITY,
    tilt: float = 0.0,
    floor: str = "hold",
    sides: str = "slip",
    **law: Any,
) -> SoilFlow:
    """Soil at ``x`` (n, 2) m with ``stress`` (n, 4) Pa in a tank (width, height), m, lower left corner at the origin.

    tilt : rad, of the floor: gravity leans to the right;  floor, sides : "hold" the soil or let it "slip", sides
    "none": endless soil, periodic across;  law : more of `SoilLaw`.  Wendland C2 with h = 1.3 spacings.
    """
    lean = (gravity * math.sin(tilt), -gravity * math.cos(tilt))
    given = SoilLaw(Smoothing("wendland", RATIO * spacing), spacing, (material,), lean, **law)
    return placed(x, stress, tank, given, floor=floor, sides=sides, skin=SKIN)


def run_until(flow: SoilFlow, time: float, each: Callable[[SoilFlow], None] | None = None) -> SoilFlow:
    """Advance ``flow`` to ``time`` (s) or just beyond, calling ``each`` after every step."""
    while flow.time < time:
        flow.advance()
        if each is not None:
            each(flow)
    return flow

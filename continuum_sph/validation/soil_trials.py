"""Small bodies of soil that validations and tests set up and watch.  SI."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.build.soil import placed
from continuum_sph.soil import Material, Soil, SoilFlow, SoilLaw
from continuum_sph.water.smoothing import Smoothing
from porescale.common.core.constants import GRAVITY
from porescale.common.neighbors import PairList, square_lattice

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


def body(
    x: Floats, spacing: float, material: Material, stress: tuple[float, float, float, float], **law: Any
) -> SoilFlow:
    """Soil at ``x`` (n, 2) m without walls and weight, under one ``stress`` (4,) Pa, free on all sides."""
    n = len(x)
    smoothing = Smoothing("wendland", RATIO * spacing)
    soil = Soil(
        n, x.copy(), np.zeros((n, 2)), np.full(n, material.density * spacing**2), np.full(n, material.density),
        np.tile(np.array(stress), (n, 1)),
    )  # fmt: skip
    reach = float(np.abs(x).max()) + 4.0 * spacing
    pairs = PairList(n, SKIN * smoothing.length, (-reach, -reach), (reach, reach), full=True)
    flow = SoilFlow(soil, SoilLaw(smoothing, spacing, (material,), (0.0, 0.0), **law), pairs)
    flow.start()
    return flow


def turn(flow: SoilFlow, angle: float, steps: int) -> tuple[Floats, Floats]:
    """Turn soil rigidly about the origin by ``angle`` (rad) in ``steps``, whatever it would do by itself.

    Returns the angles (steps,) rad and the largest change of a particle's stress in the frame that turns with it, over
    its largest component at the start, (steps,).
    """
    soil, n, step = flow.soil, flow.soil.soil, 1.0 / steps
    first = soil.stress[:n].copy()
    share = angle / steps
    cosine, sine = math.cos(share), math.sin(share)
    errors: Floats = np.zeros(steps)
    angles: Floats = np.arange(1.0, steps + 1.0) * share
    for k in range(steps):
        by = share * (k + 1)
        at = soil.x[:n]
        ahead = np.column_stack((cosine * at[:, 0] - sine * at[:, 1], sine * at[:, 0] + cosine * at[:, 1]))
        soil.acceleration[:] = 0.0
        soil.v[:n] = (ahead - at) / step
        flow.begin(step)
        flow.strain(step)
        c, s = math.cos(by), math.sin(by)
        xx, yy, xy = soil.stress[:n, 0], soil.stress[:n, 1], soil.stress[:n, 2]
        own = np.column_stack((
            c * c * xx + s * s * yy + 2.0 * c * s * xy,
            s * s * xx + c * c * yy - 2.0 * c * s * xy,
            (c * c - s * s) * xy + c * s * (yy - xx),
        ))  # fmt: skip
        errors[k] = np.abs(own - first[:, :3]).max() / np.abs(first).max()
    return angles, errors


def bar_that_spins(pull: float, *, rows: int = 20, **law: Any) -> SoilFlow:
    """A bar of cohesive soil, 1 m by 0.4 m, free, without stress, that begins to spin.

    pull : tension in its middle, ρ ω² L²/8, over E' = E/(1 - ν²), which is plane strain's;  rows : particles over its
    length;  law : more of `SoilLaw`.
    """
    spacing = 1.0 / rows
    x = square_lattice((-0.5, -0.2), (0.5, 0.2), spacing)
    material = Material(1e6, 1600.0, sin_friction=0.0, cohesion_intercept=1e5, tension=1e5)
    stiff = material.stiffness / (1.0 - material.poisson**2)
    omega = math.sqrt(8.0 * pull * stiff / material.density)
    flow = body(x, spacing, material, (0.0, 0.0, 0.0, 0.0), **law)
    flow.soil.v[:, 0], flow.soil.v[:, 1] = -omega * x[:, 1], omega * x[:, 0]
    flow.start()
    return flow


def elongation(flow: SoilFlow, pull: float, turns: float) -> float:
    """Elongation of such a bar over the exact one, ρ ω² L³/12 E', mean of the second half of ``turns``."""
    soil, spacing = flow.soil, flow.law.spacing
    ends = soil.x[:, 0] < -0.5 + spacing, soil.x[:, 0] > 0.5 - spacing
    omega = float(np.hypot(*soil.v[0]) / np.hypot(*soil.x[0]))
    end, lengths, seconds = 2.0 * math.pi * turns / omega, 0.0, 0.0
    while flow.time < end:
        step = flow.next_step
        flow.advance()
        if flow.time > 0.5 * end:
            length = float(np.hypot(*(soil.x[ends[1]].mean(axis=0) - soil.x[ends[0]].mean(axis=0))))
            lengths, seconds = lengths + step * (length / (1.0 - spacing) - 1.0), seconds + step
    return lengths / seconds / (pull * 2.0 / 3.0)


def spun(turns: float, pull: float, *, rows: int = 20, **law: Any) -> float:
    """`elongation` of a bar that spins for ``turns``."""
    return elongation(bar_that_spins(pull, rows=rows, **law), pull, turns)

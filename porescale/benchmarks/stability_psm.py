"""Where each solid operator and weight stays stable and where it is right: flows of the stability map, lattice units.

Discs that fall, are towed, fly and stand in beds, each from mild to extreme, and started at once.
"""

import math
from typing import Any

import numpy as np

from porescale.benchmarks.stability_lbm import LOOK_EVERY, PERIODIC
from porescale.common.core.errors import Unstable
from porescale.common.core.types import Reals
from porescale.common.evidence.stability import Axis, Stability, Tried
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.coupling.step import Coupled
from porescale.coupling.weighting.choose import WEIGHTINGS, fitting_weight
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import viscosity
from porescale.lbm.sanity import SOUND, WORST_MACH, sane
from porescale.lbm.scales import Scales
from porescale.validation.coupling.setups import LAW
from porescale.validation.coupling.towed import faxen
from porescale.validation.lbm.channels import one_thread

STABILITY = Stability()

RATIOS = Axis("density ratio", (1000, 100, 10, 2.5, 1.25, 0.8, 0.5, 0.3, 0.2, 0.1), (100, 2.5, 0.3))
SIZES = Axis("cells per diameter", (16, 10, 5, 3), (10, 5))
EXCESS = Axis(
    "relaxation time - 1/2",
    (1.5, 0.5, 0.3, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0001),
    (0.3, 0.02, 0.0005),
)
TOUCHING = math.pi / 4
FRACTIONS = Axis("solid fraction", (0.1, 0.2, 0.4, 0.6, 0.7, TOUCHING, 0.85, 0.95), (0.2, 0.95))

ARRAY_DRAG = {0.1: 24.83, 0.2: 51.53, 0.4: 217.9, 0.6: 1763.6}
"""F/(mu U) of a square array of fixed cylinders in Stokes flow, by solid fraction (Sangani & Acrivos 1982)."""
OFF_CENTRE = (0.3, 0.1)
"""Where in its cell a disc lies: nowhere special."""


def variants(quick: bool) -> dict[str, dict[str, Any]]:
    """Operators by name: every solid operator with every weight that fits it; the first pair also in float32.

    The first pair and the odd half of SC1 also with central moments.  Keys solid_operator, weighting, operator, dtype.
    """
    plain = {"operator": "trt", "dtype": np.float64}
    pairs = {
        f"{s} {w}": {"solid_operator": s, "weighting": w, **plain}
        for s in SOLID_OPERATORS for w in WEIGHTINGS if _fits(s, w)
    }  # fmt: skip
    first = next(iter(pairs))
    if quick:
        return {first: pairs[first]}
    liked = [name for name in pairs if name == first or name.startswith("odd-SC1")]
    more = {f"{name}, central": {**pairs[name], "operator": "central"} for name in liked}
    return pairs | more | {f"{first}, float32": {**pairs[first], "dtype": np.float32}}


def _fits(solid_operator: str, weighting: str) -> bool:
    try:
        return fitting_weight(solid_operator, weighting) == weighting
    except ValueError:
        return False


def laws(quick: bool) -> list[str]:
    """Names of the variants."""
    return list(variants(quick))


def immersed(
    law: str, cells: tuple[int, int], tau: float, sides: Sides, discs: tuple[Any, ...], acceleration: float = 0.0
) -> Coupled:
    """Discs (position, radius, density, velocity) under the law of that name in a box of fluid at rest."""
    parts = variants(False)[law]
    fluid = Fluid(*cells, tau, sides=sides, operator=parts["operator"], dtype=parts["dtype"])
    kind = "periodic" if sides.left == "periodic" else "solid"
    box = Box((0.0, 0.0), (float(cells[0]), float(cells[1])), *[kind] * 4)
    return Coupled(
        fluid, Grains(make_discs(*discs), LAW, box), Scales(1.0, 1.0, tau, 1.0), hydraulic_ratio=1.0, contact_steps=4,
        acceleration=(0.0, -acceleration), solid_operator=parts["solid_operator"], weighting=parts["weighting"],
    )  # fmt: skip


def lasts(coupled: Coupled, steps: int, fastest: float = WORST_MACH * SOUND) -> bool:
    """Advance; whether fluid and discs stayed in bounds, no disc faster than ``fastest``, checked every 50 steps."""
    velocity = coupled.grains.discs.velocity
    with np.errstate(over="ignore", invalid="ignore"), one_thread():
        for step in range(1, steps + 1):
            try:
                coupled.advance()
                if step % LOOK_EVERY == 0 or step == steps:
                    coupled.grains.check()
                    if not sane(coupled.fluid) or not bool(np.all(np.abs(velocity) < fastest)):
                        return False
            except Unstable:
                return False
    return True


@STABILITY.flow(
    "coupling.fall",
    title="A free disc sinks, or rises, between walls 3 diameters apart, tau 0.8, Reynolds number below 0.1",
    x=RATIOS,
    y=SIZES,
    laws=laws,
    right=0.1,
    because="drag at its own speed within 10 % of Faxen 1946; the deficit is second order, 7 % at 10 cells in a square"
    " array; unstable: ten times as fast as it should",
)
def fall(law: str, x: float, y: float) -> Tried:
    """Density ratio against cells per diameter.  It starts at its terminal speed, so that heavy ones are there."""
    tau, speed, d = 0.8, 5e-4, y
    nu, area = viscosity(tau), math.pi / 4 * d**2
    width, height = round(3 * d), round(5 * d)
    wanted = faxen(d / width) * nu
    place = [(width / 2, height / 2 + OFF_CENTRE[1])]
    pull = wanted * speed / ((x - 1) * area)
    coupled = immersed(law, (width, height), tau, Sides(), (place, d / 2, x, (0.0, -speed)), pull)
    if not lasts(coupled, math.ceil(3 * width**2 / (math.pi**2 * nu)), 10 * speed):
        return Tried(False)
    drag = float((coupled.force - coupled.weight)[0, 1])
    ratio = -drag / (float(coupled.grains.discs.velocity[0, 1]) * wanted)
    return Tried(True, abs(ratio - 1), {"drag over the known one": ratio})


@STABILITY.flow(
    "coupling.tow",
    title="A disc of 10 cells towed from rest at once, 3 diameters far, in a closed box",
    x=EXCESS,
    y=Axis("Mach number", (0.02, 0.1, 0.3), (0.1,)),
    laws=laws,
    right=0.05,
    because="noise: what of the drag repeats with every cell that is passed (rms) within 5 % of its mean; the drag"
    " itself is not judged",
    limit="cell Reynolds number",
)
def tow(law: str, x: float, y: float) -> Tried:
    """tau - 1/2 against the Mach number of the towing."""
    d, nx, ny = 10.0, 60, 40
    parts, speed = variants(False)[law], y * SOUND
    fluid = Fluid(nx, ny, 0.5 + x, operator=parts["operator"], dtype=parts["dtype"])
    wet = SaturatedCells(
        fluid, np.array([d / 2]), solid_operator=parts["solid_operator"], weighting=parts["weighting"]
    )  # fmt: skip
    slope = 0.2  # 11 degrees
    velocity, no_spin = np.array([[speed, slope * speed]]), np.zeros(1)
    numbers = {"cell Reynolds number": speed / viscosity(0.5 + x)}
    place, steps = np.array([[1.5 * d, 1.7 * d]]), math.ceil(3 * d / speed)
    drag, phase = np.zeros(steps), np.zeros(steps)
    with np.errstate(over="ignore", invalid="ignore"), one_thread():
        for step in range(steps):
            wet.advance(fluid, place, velocity, no_spin)
            drag[step], phase[step] = -wet.force[0, 0], place[0, 0] % 1
            place += velocity
            if (step % LOOK_EVERY == 0 or step == steps - 1) and not sane(fluid):
                return Tried(False, None, numbers)
    noise = cell_noise(drag, phase, round(1 / speed))
    return Tried(True, noise, {**numbers, "noise": noise})


def cell_noise(drag: Reals, phase: Reals, period: int, bins: int = 4) -> float:
    """Rms over the mean of what repeats with each cell passed: less the moving mean over a cell, folded by ``phase``.

    The first third, in which the flow starts, is left out; sound that rings in the box has no fixed phase and falls
    out of the means.
    """
    smooth = np.convolve(drag, np.full(period, 1 / period), mode="same")
    keep = slice(len(drag) // 3, len(drag) - period)
    left, place = (drag - smooth)[keep], np.floor(phase[keep] * bins).astype(int)
    means = [left[place == k].mean() for k in range(bins) if np.any(place == k)]
    return float(np.sqrt(np.mean(np.square(means))) / abs(drag[keep].mean()))


@STABILITY.flow(
    "coupling.fly",
    title="A free disc of 10 cells shot at Mach 0.1 into fluid at rest, 1000 steps",
    x=EXCESS,
    y=Axis("density ratio", (100, 2.5, 0.8, 0.3), (2.5, 0.3)),
    laws=laws,
    right=0.0,
    because="nothing is known to judge it by, only whether it lasts",
)
def fly(law: str, x: float, y: float) -> Tried:
    """tau - 1/2 against the density ratio."""
    d, n, speed = 10.0, 60, 0.1 * SOUND
    place = [(n / 2 + OFF_CENTRE[0], n / 2 + OFF_CENTRE[1])]
    coupled = immersed(law, (n, n), 0.5 + x, PERIODIC, (place, d / 2, y, (0.98 * speed, 0.2 * speed)))
    return Tried(lasts(coupled, 1000))


@STABILITY.flow(
    "coupling.bed",
    title="Square beds, tau 0.6: free discs fly at each other (stable?), fixed ones resist flow (right?)",
    x=FRACTIONS,
    y=Axis("cells per diameter", (15, 10, 5), (10,)),
    laws=laws,
    right=0.1,
    because="drag within 10 % of Sangani & Acrivos 1982, at 0.7 of Gebart 1992; touching or overlapping discs leak at"
    " most 10 % of what flows at 0.6",
)
def bed(law: str, x: float, y: float) -> Tried:
    """Solid fraction, to discs that overlap by a fifth of their radius, against cells per diameter."""
    if not _collide(law, x, y):
        return Tried(False)
    drag = _resistance(law, x, y)
    if drag is None:
        return Tried(False)
    if x >= TOUCHING:  # K = (cell of the array)/(F/mu U), in diameters², against that of the open array
        leak = (TOUCHING / x / drag) / (TOUCHING / 0.6 / ARRAY_DRAG[0.6])
        return Tried(True, abs(leak), {"leak": leak})
    return Tried(True, abs(drag / known_drag(x) - 1), {"drag over the known one": drag / known_drag(x)})


def known_drag(solid_fraction: float) -> float:
    """F/(mu U) of the square array: the table, else Gebart's K/R² = 16/(9 pi sqrt 2) (sqrt(pi/4c) - 1)^(5/2)."""
    if solid_fraction in ARRAY_DRAG:
        return ARRAY_DRAG[solid_fraction]
    gap = math.sqrt(TOUCHING / solid_fraction) - 1
    return math.pi / solid_fraction / (16 / (9 * math.pi * math.sqrt(2)) * math.pow(gap, 2.5))


def _pitch(fraction: float, diameter: float, across: int) -> tuple[int, float]:
    """Cells of a periodic box with ``across``² discs of some ``diameter``, and the radius that gives the fraction."""
    cells = round(across * diameter * math.sqrt(TOUCHING / fraction))
    return cells, cells / across * math.sqrt(fraction / math.pi)


def _lattice_of_discs(cells: int, across: int) -> Reals:
    """Centres (across², 2) of a square array."""
    at = (np.arange(across) + 0.5) * cells / across
    return np.array([(x + OFF_CENTRE[0], y + OFF_CENTRE[1]) for y in at for x in at])


def _collide(law: str, fraction: float, diameter: float) -> bool:
    """Whether nine discs of density ratio 2.5, each flying its own way at Mach 0.09, last 600 steps."""
    cells, radius = _pitch(fraction, diameter, 3)
    turn = 2.4 * np.arange(9)
    velocity = 0.05 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    place = _lattice_of_discs(cells, 3)
    coupled = immersed(law, (cells, cells), 0.6, PERIODIC, (place, radius, 2.5, velocity - velocity.mean(axis=0)))
    return lasts(coupled, 600)


def _resistance(law: str, fraction: float, diameter: float) -> float | None:
    """F/(mu U) of fixed discs of which one is in each cell of the array; None: unstable.

    A body force G on the fluid; U is the conserved flux.  Until that changes by 1e-4 in a fifth of its memory or
    longer, or for 20 000 steps; discs that touch on all sides are four in the box, as none may be wider than it.
    """
    across = 1 if fraction < TOUCHING else 2
    cells, radius = _pitch(fraction, diameter, across)
    tau, parts = 0.6, variants(False)[law]
    nu = viscosity(tau)
    force = 1e-5 * nu
    fluid = Fluid(
        cells, cells, tau, operator=parts["operator"], dtype=parts["dtype"], force=(force, 0.0), sides=PERIODIC
    )  # fmt: skip
    count = across**2
    wet = SaturatedCells(
        fluid, np.full(count, radius), solid_operator=parts["solid_operator"], weighting=parts["weighting"]
    )  # fmt: skip
    place, rest, no_spin = _lattice_of_discs(cells, across), np.zeros((count, 2)), np.zeros(count)
    flux, change, block = 0.0, 1.0, max(200, (cells // across) ** 2 // 5)
    with np.errstate(over="ignore", invalid="ignore"), one_thread():
        while abs(change) > 1e-4 and fluid.step < 20_000:
            for _ in range(block):
                wet.advance(fluid, place, rest, no_spin)
            if not sane(fluid):
                return None
            now = fluid.momentum()[0] / cells**2
            flux, change = now, (now - flux) / (abs(now) + 1e-300)
    return float(force * (cells / across) ** 2 / (nu * flux))

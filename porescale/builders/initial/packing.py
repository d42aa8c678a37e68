"""Radii of a packing, packings that are pressed together, and void ratios that settling did not reach."""

from dataclasses import replace

import numpy as np

from porescale.common.core.errors import InputError, warn
from porescale.common.core.types import Floats
from porescale.common.neighbors.grading import given_radii, graded_radii, lognormal_radii
from porescale.common.neighbors.placement import draw_radii
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.linear import Linear
from porescale.dem.grains import Grains
from porescale.dem.measures.porosity import porosity, void_ratio
from porescale.dem.measures.region import Region
from porescale.dem.prepare.compaction import Compactor, Compressed, kept
from porescale.dem.prepare.obstacles import NOTHING, Obstacles
from porescale.scene.packing import Packing

MISSED = 0.02
"""Share by which the void ratio of a settled bed may miss the wanted one unmentioned: beds of some hundred grains
scatter by as much."""


def radii_of(packing: Packing) -> Floats | None:
    """Radii (n,) m of a packing with given sizes, a grading, lognormal sizes or compression; None for the plain one,
    drawn later."""
    if packing.sizes:
        return given_radii(packing.sizes)
    area = packing.packing_fraction * packing.width * packing.height
    if packing.grading:
        return graded_radii(packing.grading, area)
    if packing.log_spread is not None:
        per_grain = np.pi / 4.0 * packing.diameter**2
        relative = lognormal_radii(1000, 1.0, packing.log_spread)
        count = max(1, round(area / (per_grain * 4.0 * float(np.mean(relative**2)))))
        return lognormal_radii(count, packing.diameter, packing.log_spread)
    if packing.compress:
        spread = packing.size_spread
        count = max(1, round(area / (np.pi / 4.0 * packing.diameter**2 * (1.0 + spread**2 / 3.0))))
        even = (np.arange(count) + 0.5) / count
        return np.asarray(0.5 * packing.diameter * (1.0 + spread * (2.0 * even - 1.0)))
    return None


def drawn_radii(packing: Packing) -> Floats:
    """Radii (n,) m of the plain packing that stays where it is placed, drawn with its seed as `place` draws them.

    Raises InputError, by the keys of [grains.packing], where its fraction is denser than discs can be placed.
    """
    rng, area = np.random.default_rng(packing.seed), packing.width * packing.height
    try:
        return draw_radii(area, packing.diameter, packing.size_spread, None, packing.packing_fraction, rng)
    except InputError as error:
        raise by_packing(error) from None


def compressed(
    packing: Packing, density: float, periodic: tuple[bool, bool], law: ContactLaw, around: Obstacles = NOTHING
) -> Compressed:
    """The packing pressed to its pressure or fraction; density: of the grains, kg/m³;  periodic: the sides of its
    rectangle;  around: discs that stand in it, which come after the packing's, held.  Keys of faults are those of the
    scene."""
    assert isinstance(law, Linear)  # check_compressed has made sure
    radius = radii_of(packing)
    assert radius is not None
    box = (packing.left, packing.bottom), (packing.left + packing.width, packing.bottom + packing.height)
    press = Compactor(*box, law, periodic, packing.settling_friction, density, packing.seed,
                      packing.settling_rolling_friction, around)  # fmt: skip
    try:
        return kept(press, radius, packing.pressure)
    except InputError as error:
        raise by_packing(error) from None


def by_packing(error: InputError) -> InputError:
    """Faults of how grains are placed by the keys of [grains.packing]."""
    return InputError([replace(fault, key=f"grains.packing.{fault.key}") for fault in error.faults])


def settled_void_ratio(packing: Packing, grains: Grains, around: Obstacles = NOTHING) -> float:
    """Void ratio of a bed that settled, between a tenth and seven tenths of its height: without floor and surface.

    around : what stands in it, after the packing's discs, which is neither pores nor grains.
    """
    count = grains.discs.count - len(around.discs)
    height = float(np.max((grains.discs.position[:, 1] + grains.discs.radius)[:count])) - packing.bottom
    lower, upper = packing.bottom + 0.1 * height, packing.bottom + 0.7 * height
    return void_ratio_in((packing.left, lower), (packing.left + packing.width, upper), grains, around)


def void_ratio_in(
    lower: tuple[float, float], upper: tuple[float, float], grains: Grains, around: Obstacles = NOTHING
) -> float:
    """Pores over grains in a rectangle (m); what stands ``around`` is neither."""
    discs, count = grains.discs, grains.discs.count - len(around.discs)
    region = Region(lower, upper)
    found = porosity(region, discs.position[:count], discs.radius[:count], grains.box.period)
    if around:
        room = 1.0 - around.area(lower, upper) / region.area
        found = 1.0 - (1.0 - found) / room
    return void_ratio(found)


def say_void_ratio(packing: Packing, grains: Grains, around: Obstacles = NOTHING) -> None:
    """A PorescaleWarning where a wanted void ratio set the number of grains, and they came to another; for those that
    did not settle, only around what stands in their rectangle."""
    if packing.void_ratio is None:
        return
    if not packing.settle:
        corner = packing.left, packing.bottom
        found = void_ratio_in(corner, (corner[0] + packing.width, corner[1] + packing.height), grains, around)
        if abs(found - packing.void_ratio) > MISSED * packing.void_ratio:
            warn(
                f"grains.packing.void_ratio = {packing.void_ratio:g} sets the number of grains by the whole rectangle;"
                f" around what stands in it their void ratio is {found:.3g} (solid fraction {1 / (1 + found):.3g})"
            )
        return
    found = settled_void_ratio(packing, grains, around)
    if abs(found - packing.void_ratio) > MISSED * packing.void_ratio:
        warn(
            f"grains.packing.void_ratio = {packing.void_ratio:g} sets the number of grains; the bed settled to"
            f" {found:.3g} (solid fraction {1 / (1 + found):.3g}): settling_friction and settling_rolling_friction"
            " loosen it, compress = true reaches a void ratio exactly"
        )

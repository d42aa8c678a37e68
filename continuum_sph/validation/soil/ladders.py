"""Convergence of soil, at several spacings: the friction of an endless layer that slides, from a strewn lattice, the
creep of a slope, fast flow, and how far columns run out."""

from functools import partial
from typing import Any

import numpy as np

from continuum_sph.soil import Rate
from continuum_sph.validation.soil import fast_flow, slides, softening
from continuum_sph.validation.soil.run_outs import (
    BEADS,
    RUBBING_BEADS,
    RUBBING_SAND,
    SAND,
    Grains,
    run_outs,
)
from continuum_sph.validation.soil.setups import TAN_PHI
from continuum_sph.validation.soil.slopes import NEAR, slope, strewn_friction, sunk
from porescale.common.evidence.convergence import Ladders

LADDERS = Ladders()
ROTATING = (
    "no order is expected: half of the row at the floor is held, 0.5/N of what drives; upright columns of soil that "
    "rotate side by side are weaker, and form the easier the finer the soil is"
)
TURNED = (
    "no order is expected: half of the row at the floor is held, 0.5/N of what drives.  In the first seconds upright "
    "columns that rotate side by side bear less, the longer the finer the soil is: the slide breaks them"
)


def friction_error(options: dict[str, Any], rows: float) -> float:
    """|friction that a layer shows over sin φ, less 1|;  options : of `strewn_friction`."""
    return abs(strewn_friction(int(rows), **options) / TAN_PHI - 1.0)


for name, title, because, options in (
    ("soil.friction", "Relative error of the friction of an endless layer of strewn particles on a slope of 30°",
     ROTATING, {}),
    ("soil.friction_near_the_limit", "The same on a slope of 28°, 1.4° beyond its limit, between 3 s and 4 s",
     TURNED, {"degrees": 28.0, "between": (3.0, 4.0)}),
):  # fmt: skip
    LADDERS.ladder(name, title=title, along="rows of particles", levels=(10, 20, 40, 80), because=because)(
        partial(friction_error, options)
    )


@LADDERS.ladder(
    "soil.slip_that_softens",
    title="Largest error of the shear stress of a layer that softens along a band, over the strength that is lost",
    along="rows of particles",
    levels=(10, 20, 40),
    because="no order is expected: with 10 rows there are but 4 between the platens, and what damping bears of the "
    "slip, 0.055 ρ α c h v/Δx, 0.3, 0.7 and 1.4 % here, grows as the spacing falls",
)
def slip_error(rows: float) -> float:
    """Of a layer of clay that is sheared slowly."""
    return softening.course(int(rows))


@LADDERS.ladder(
    "soil.slide_on_a_seam",
    title="Relative error of the acceleration of a slab that slides on a weak seam a tenth of the layer thick, damping "
    "bounded",
    along="rows of particles of the layer",
    levels=slides.LEVELS,
    expected=1.0,
    within=0.5,
    because="damping bears less of a seam the more rows it has, and where it slips is known to half a spacing",
)
def slide_error(rows: float) -> float:
    """Of the acceleration of what lies over the seam."""
    return abs(slides.acceleration(int(rows)) / slides.EXACT - 1.0)


@LADDERS.ladder(
    "soil.creep_near_the_limit",
    title="Largest displacement in 5 s of a slope 1 m high, 2° below its limit, m",
    along="rows of particles over its height",
    levels=(20, 40, 80),
    because="no order is expected: below the limit nothing shears; 1 mm is allowed, a shear strain of 1e-3",
)
def creep(rows: float) -> float:
    """Displacement (m) of the particle that moves farthest; none does exactly."""
    return slope(NEAR, 5.0, int(rows))


@LADDERS.ladder(
    "soil.fast_flow",
    title="Root mean square error of the speeds of a layer on 32° whose friction grows with the rate of shear, over "
    "that of Bagnold's profile",
    along="rows of particles",
    levels=(10, 20, 40),
    expected=1.0,
    within=0.1,
    because="the floor holds half of its row; speeds of strewn particles fluctuate by a hundredth",
)
def fast_flow_error(rows: float) -> float:
    """Of the speeds, 8 s after the layer was let go."""
    return fast_flow.error(int(rows))


@LADDERS.ladder(
    "soil.height_of_what_slides",
    title="By how much the middle of a layer 1 m deep sinks while it slides 8 m on its floor, m",
    along="rows of particles",
    levels=(10, 20, 40, 80),
    because="no order is expected: shear changes no volume; where surface and floor lie is known to half of a row",
)
def sinking(rows: float) -> float:
    """Of a slope of 32°, after 4 s."""
    return abs(sunk(int(rows)))


def run_out_error(grains: Grains, rate: Rate | None, rows: float) -> float:
    """Largest |run-out over that of the experiments' law, less 1| of columns of H/L 0.5 to 4;  rate : of their
    friction."""
    return float(np.abs(run_outs(grains, int(rows), rate) - 1.0).max())


for name, what, grains, rate in (
    ("sand", "sand", SAND, None),
    ("beads", "glass beads", BEADS, None),
    ("rubbing_sand", "sand of 0.8 mm whose friction grows with the rate of shear", SAND, RUBBING_SAND),
    ("rubbing_beads", "glass beads of 1 mm whose friction grows with the rate of shear", BEADS, RUBBING_BEADS),
):
    LADDERS.ladder(
        f"soil.run_out_of_{name}",
        title=f"Largest relative error of the run-outs of columns of {what}, H/L 0.5 to 4, from the experiments' law",
        along="rows of particles to the root of a column's area",
        levels=(10, 20, 40, 80),
        because="no order is expected: a law drawn through experiments is no limit; coarse deposits are few "
        "particles deep, and a front is known to half a particle",
    )(partial(run_out_error, grains, rate))

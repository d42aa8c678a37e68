"""Validations of segments, polygons and bonds: exact answers, and energy that closes."""

from __future__ import annotations

import math

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.bodies.frames import chain, from_ends, polygon
from porescale.validation.dem import segments_trials as lab
from porescale.validation.dem.discs_trials import RADIUS, momentum_drift

VALIDATIONS = Validations()

ROOT_EPS = 1e-13
TUTORIAL = "Matsushima, DEMseg tutorial"
BODIES = ("segment", "polygon")


@VALIDATIONS.row(
    "dem.mass_of_frames",
    source="shoelace and parallel axes by hand; " + TUTORIAL + " I-2",
    because="a few tens of roundings of numbers of one size",
    tolerance=1e-14,
)
def masses() -> Measured:
    """Mass, centroid and inertia of a triangle given by segments, of an L of three squares and of two rods at right
    angles, over density and lengths.
    """
    triangle = from_ends([[(0, 0), (3, 0)], [(3, 0), (0, 6)], [(0, 6), (0, 0)]], 0.1, 2.0).mass_properties()
    bent = polygon([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 0.0, 3.0).mass_properties()
    rods = chain([(2, 0), (0, 0), (0, 2)], 0.05, 5.0).mass_properties()
    # Right triangle: bh/2, thirds, bh(b^2 + h^2)/36.  Three unit squares about (5/6, 5/6): 3/6 + distances squared
    # 2/9 + 2 (1/9 + 4/9) - ... = (1/3)^2 2 + 2 ((2/3)^2 + (1/3)^2).  Rods 2 by 0.1 about (1/2, 1/2), 1/sqrt 2 away.
    exact = (
        18.0, 1.0, 2.0, 2.0 * 18.0 * 45.0 / 36.0,
        9.0, 5.0 / 6.0, 5.0 / 6.0, 3.0 * (3.0 / 6.0 + 2.0 / 9.0 + 2.0 * 5.0 / 9.0),
        2.0, 0.5, 0.5, 2.0 * ((4.0 + 0.01) / 12.0 + 0.5),
    )  # fmt: skip
    found = [value for body in (triangle, bent, rods) for value in (body.mass, *body.centroid, body.inertia)]
    return Measured(exact, found, float(np.max(np.abs(np.divide(found, exact) - 1.0))))


@VALIDATIONS.row(
    "dem.energy_of_bouncing_segments",
    source="first law; " + TUTORIAL + " I-2: segment and polygon that bounce, without loss",
    because="asked for: below 1e-3 of the kinetic energy, here at 200 steps in a contact",
    tolerance=1e-3,
)
def bouncing() -> Measured:
    """Largest unaccounted energy of a single segment and of a pentagon that bounce about a container with edges up and
    down, over the largest kinetic energy.
    """
    found = [float(lab.bouncing(what, 200.0).max()) for what in BODIES]
    return Measured((0.0,) * len(found), found, max(found))


@VALIDATIONS.row(
    "dem.energy_of_bouncing_segments_closes_with_the_step",
    source="leap-frog is of second order, of first where contacts begin and end",
    because="first order, 0.2 below it for the phases at which some ten contacts begin",
    tolerance=0.2,
    slow=True,
)
def bouncing_order() -> Measured:
    """Order at which that falls from 50 to 400 steps in a contact."""
    orders = []
    for what in BODIES:
        coarse, fine = (float(lab.bouncing(what, steps).max()) for steps in (50.0, 400.0))
        orders.append(math.log(coarse / fine, 8.0))
    return Measured((1.0,) * len(orders), orders, max(0.0, 1.0 - min(orders)))


@VALIDATIONS.row(
    "dem.energy_of_polygons_that_rub",
    source="first law: polygons, rods, discs and clumps that collide, rub and lose energy in dashpots",
    because="a dashpot is booked half a step too long at touch: 2 h w0 dt = 2 0.1 pi/200 of what it takes",
    tolerance=0.2 * math.pi / 200.0,
)
def rubbing() -> Measured:
    """Largest unaccounted energy over the kinetic energy at the start, 36 bodies in free space."""
    found = float(lab.residuals(lab.mixed_cloud(energy=True), 0.04, 200.0, gravity=0.0).max())
    return Measured(0.0, found, found)


@VALIDATIONS.row(
    "dem.momentum_of_segments",
    source="Newton's third law, forces of both bodies at one point",
    because="36 bodies, 5000 steps: round-off 1e-16 per sum, growing like its root, 1e-13 at most",
    tolerance=ROOT_EPS,
)
def momenta() -> Measured:
    """Polygons, rods, discs and clumps that collide and rub in free space: relative drift of both momenta."""
    drift = momentum_drift(lab.mixed_cloud(), 5000)
    return Measured((0.0, 0.0), drift, max(drift))


@VALIDATIONS.row(
    "dem.bond_strength",
    source=TUTORIAL + " II-3: F = k d0",
    because="the pull grows by 1.1/20 000 of the strength a step, the last of which is not seen: 5.5e-5",
    tolerance=6e-5,
)
def strength() -> Measured:
    """Largest tension of two bonded discs, of two squares bonded along a side at its two corners, and of a chain of 20
    discs, over k d0.
    """
    exact, found = (1.0, 2.0, 1.0), [lab.bond_strength(what) for what in ("discs", "squares", "chain")]
    return Measured(exact, found, max(abs(a / b - 1.0) for a, b in zip(found, exact, strict=True)))


@VALIDATIONS.row(
    "dem.hanging_chain",
    source="catenary; " + TUTORIAL + " II-3: bonded chain of 20 discs",
    because="straight links l have the slope of the curve at their middles: heights err by l^2/(24 a), a = 4.4 l its"
    " smallest radius, 1.6e-3 of the sag of 6 l; a quarter more, for x errs alike",
    tolerance=2e-3,
)
def hanging() -> Measured:
    """Largest distance in height of 20 discs from the catenary of their length and span, over its sag."""
    at = lab.hanging_chain(20)
    curve = lab.catenary(at)
    sag = -float(curve.min())
    return Measured(sag / RADIUS, -float(at[:, 1].min()) / RADIUS, float(np.abs(curve - at[:, 1]).max()) / sag)

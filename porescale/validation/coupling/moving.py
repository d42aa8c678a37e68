"""Validations of discs that move as told, or freely: oscillation, shear, streams, falls."""

from __future__ import annotations

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.coupling import falling_trials as falls
from porescale.validation.coupling import moving_trials as lab
from porescale.validation.coupling.towed import RADIUS
from porescale.validation.coupling.towed_trials import jeffrey_onishi

VALIDATIONS = Validations()

OSCILLATIONS = ((5.0, 10.0, 0.6), (20.0, 10.0, 0.53), (100.0, 20.0, 0.515))
"""Frequency a² w/nu, radius in cells, tau."""
SHEAR = {0.25: 0.48208, 0.125: 0.49567}
"""Spin over shear rate of a free disc midway between walls in slow flow, by diameter over their distance: point forces
(tests/reference/stokes_box.py), five digits; 1/2 without walls."""
SINKING = (0.8, 2.5, 10.0)
KISS = 0.173


@VALIDATIONS.row(
    "coupling.oscillating_disc",
    source="Stokes 1851: force -rho pi a² G dU/dt, G 2.284 - 1.637 i, 1.635 - 0.7287 i, 1.283 - 0.3025 i; images of the"
    " dipole in the box (10 a wide) added",
    because="4 %, as for the release from rest: the rim is a cell thick where the viscous layer has 6, 3 and 3, and"
    " the box counts to the fourth power, (a/W)⁴ 3.4² = 0.1 %",
    tolerance=0.04,
    slow=True,
)
def oscillation() -> Measured:
    """Added mass and damping, real and less the imaginary part of G, at a² w/nu = 5, 20, 100; error |dG|/|G|."""
    exact = [lab.oscillation_in_a_box(frequency) for frequency, _, _ in OSCILLATIONS]
    found = [lab.oscillation(f, radius=a, relaxation_time=tau) for f, a, tau in OSCILLATIONS]
    error = float(max(abs(one - two) / abs(two) for one, two in zip(found, exact, strict=True)))
    return Measured(_parts(exact), _parts(found), error)


def _parts(values: list[complex]) -> list[float]:
    return [part for value in values for part in (value.real, -value.imag)]


@VALIDATIONS.row(
    "coupling.neutral_disc_in_shear",
    source="half the shear rate (Einstein 1906; Ding & Aidun 2000 for small Re and blockage), walls by point forces",
    because="0.1 %: walls take 4 k² of half the rate, up to 3.6 %, which goes as R²: 0.05 % for a radius 0.73 % off,"
    " and as much that the two places leave; at one of them a disc looks up to 0.6 % longer across than along, and the"
    " strain turns it by as much, at the other the same the other way",
    tolerance=1e-3,
    slow=True,
)
def shear() -> Measured:
    """Spin over shear rate, diameter over the distance of the walls 0.25 and 0.125, Re 0.01, 10 cells per diameter.

    Mean over two places in the cell that change places when along and across do.
    """
    found = [float(np.mean([lab.shear_spin(k, place=place) for place in ((0.3, 0.0), (0.0, 0.3))])) for k in SHEAR]
    return Measured(list(SHEAR.values()), found, float(np.abs(np.divide(found, list(SHEAR.values())) - 1).max()))


@VALIDATIONS.row(
    "coupling.galilean_invariance",
    source="the same drag whether the disc stands or the fluid",
    because="1e-3: the lattice's error of third order in speed, 3 u² = 1.2e-3 of the viscosity at 0.02",
    tolerance=1.2e-3,
)
def galilean() -> Measured:
    """Mean drag over 20 cells of way, seen from the disc, from halfway and from the fluid at rest."""
    means = [float(lab.stream_drag(frame)[1000:].mean()) for frame in (0.0, 0.5, 1.0)]
    return Measured(means[0], means, float(np.abs(np.divide(means, means[0]) - 1).max()))


@VALIDATIONS.row(
    "coupling.terminal_speed",
    source="(s - 1) g pi a²/(mu K), K by Faxen 1946 for a channel, k 0.2",
    because="0.73 % of the radius, as on arrays, the speed goes as its power 1.15: 0.84 %; for every density alike",
    tolerance=1.15 * RADIUS,
    slow=True,
)
def terminal() -> Measured:
    """Speed over the expected one of a free disc of density ratio 0.8, 2.5 and 10."""
    found = [lab.settled_speed(ratio, relaxation_time=0.6) for ratio in SINKING]
    return Measured([1.0] * len(found), found, float(np.abs(np.subtract(found, 1)).max()))


@VALIDATIONS.row(
    "coupling.terminal_speed_of_a_heavy_disc",
    source="as for lighter ones",
    because="as for lighter ones",
    tolerance=1.15 * RADIUS,
    slow=True,
)
def heavy() -> Measured:
    """Speed over the expected one of a free disc of density ratio 100."""
    found = lab.settled_speed(100.0, relaxation_time=0.6)
    return Measured(1.0, found, abs(found - 1))


@VALIDATIONS.row(
    "coupling.gravity_in_the_fluid",
    source="a disc sinks alike where the fluid has weight and where the pressure is the reduced one",
    because="0.3 %: forces act half a step apart from velocities, and half a step of gravity is 0.23 % of the speed;"
    " what cells bear of a disc at rest, put right, is the same everywhere",
    tolerance=3e-3,
    slow=True,
)
def gravity() -> Measured:
    """Terminal speed with gravity in the fluid, over that with the reduced pressure, density ratio 2.5."""
    pair = [lab.settled_speed(2.5, relaxation_time=0.6, gravity_in_fluid=pulled) for pulled in (False, True)]
    return Measured(pair[0], pair[1], abs(pair[1] / pair[0] - 1))


@VALIDATIONS.row(
    "coupling.approach_to_the_bottom",
    source="Jeffrey & Onishi 1981: speed W (alpha - tanh alpha)/(4 pi mu) of a disc that sinks to a floor, weight W",
    because="3.3 %: the other walls of the box add 1.1 to a drag of 47 at the largest gap, 2.4 % (point forces, as for"
    " the cylinder near a wall); a quarter of 0.73 % of the radius, 20 cells wide, in the gap of 3 cells to the power"
    " 3/2, 0.9 %",
    tolerance=0.033,
    slow=True,
)
def approach() -> Measured:
    """Speed over the law's at gaps of 0.6, 0.4 and 0.3 radii; radius 10 cells, density ratio 2, tau 0.6."""
    gaps = (0.6, 0.4, 0.3)
    found = [v * jeffrey_onishi("towards", gap) for v, gap in zip(falls.approach(gaps), gaps, strict=True)]
    return Measured([1.0] * len(found), found, float(np.abs(np.subtract(found, 1)).max()))


@VALIDATIONS.row(
    "coupling.drafting_and_kissing",
    source="Feng, Hu & Joseph 1994; Uhlmann 2005: two discs in a channel of 8 x 24 diameters touch after 0.173 s",
    because="2 %: three digits of the source, and at half the resolution the time differs by 3 %, so here by 1 % if"
    " the error falls at second order, 1.5 % at first",
    tolerance=0.02,
)
def kissing() -> Measured:
    """Time of the first touch, s, at 20 cells per diameter, tau 0.512."""
    found, _ = falls.kiss(20)
    return Measured(KISS, found, abs(found / KISS - 1))

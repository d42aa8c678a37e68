"""Free bodies of soil: a block that is turned rigidly, one that spins, a bar that its spin draws out.  SI."""

import math
from typing import Any

import numpy as np

from continuum_sph.soil import Material, SoilFlow
from continuum_sph.validation.soil.setups import DENSITY, body
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

EPS = float(np.finfo(np.float64).eps)
VALIDATIONS = Validations()


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


def turned_error(steps: int = 90, **law: bool) -> float:
    """Largest change of stress, over its largest component, in the frame of a block of 10 by 6 particles turned rigidly
    by 90° in ``steps``, at any time on the way."""
    spacing = 0.1
    x = square_lattice((-0.5, -0.3), (0.5, 0.3), spacing)
    flow = body(x, spacing, Material(1e7, DENSITY, yields=False), (3e3, 1e4, 2e3, 4e3), **law)
    return float(turn(flow, 0.5 * math.pi, steps)[1].max())


@VALIDATIONS.row(
    "continuum.soil_turned_keeps_its_stress",
    source="exact: rigid rotation does not strain; eq. 45 of Maeda & Sakai 2004 with the sign of eq. 19",
    because="velocities of places of 0.6 m have round-off 0.6 eps over neighbours 0.13 m away, times E/σ = 1e3 in "
    "stress, over 4 and 90 steps, whose errors add at worst; K magnifies up to fourfold",
    tolerance=4.0 * 1e3 * 0.6 / 0.13 * 90 * EPS,
)
def turned_row() -> Measured:
    """Largest change of stress in the block's frame, turned by 90° in 4 steps and in 90, corners included."""
    return Measured.absolute(0.0, [turned_error(4), turned_error(90)])


def kept(corrected: bool = True, seconds: float = 0.1, one_sided: bool = False) -> tuple[float, float]:
    """(change of linear momentum over Σ m |v|, change of angular momentum over its start) of a stressed block of 10 by
    6 particles that is let go spinning at 20 rad/s.

    one_sided : leave out half of the forces on the first particle.
    """
    spacing = 0.1
    x = square_lattice((-0.5, -0.3), (0.5, 0.3), spacing)
    flow = body(
        x,
        spacing,
        Material(1e7, DENSITY, yields=False),
        (3e3, 1e4, 2e3, 4e3),
        corrected=corrected,
        spacing_recovery=0.0,
    )
    soil = flow.soil
    soil.v[:, 0], soil.v[:, 1] = -20.0 * x[:, 1], 20.0 * x[:, 0]

    def momenta() -> tuple[float, float, float]:
        """Momentum x, y and angular momentum about the origin."""
        px, py = (soil.mass[:, None] * soil.v).sum(axis=0)
        return px, py, float((soil.mass * (soil.x[:, 0] * soil.v[:, 1] - soil.x[:, 1] * soil.v[:, 0])).sum())

    scale, start = float((soil.mass * np.hypot(soil.v[:, 0], soil.v[:, 1])).sum()), momenta()
    while flow.time < seconds:
        if one_sided:
            soil.acceleration[0] *= 0.5
        flow.advance()
    end = momenta()
    return math.hypot(end[0] - start[0], end[1] - start[1]) / scale, abs(end[2] / start[2] - 1.0)


@VALIDATIONS.row(
    "continuum.soil_momentum",
    source="exact: forces of a pair are opposite, and stress does no work in rigid turning (Bonet & Lok 1999)",
    because="about 300 steps, each of which rounds velocities of 60 particles: 300 eps at worst, tenfold for forces "
    "that are large beside their sum",
    tolerance=10 * 300 * EPS,
)
def momentum_row() -> Measured:
    """Change of linear and of angular momentum of a spinning stressed block, 0.1 s."""
    return Measured.absolute(0.0, list(kept()))


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


PULL = 0.0045  # of the stiffness: a strong clay


@VALIDATIONS.row(
    "continuum.soil_under_tension_holds_together",
    source="exact: a bar that spins bears ρ ω² (L² - 4 x²)/8 and is longer by ρ ω² L³/12 E'",
    because="ends known to half a spacing of 30 over the length, of which the elongation is a cube",
    tolerance=3 * 0.5 / 30,
    slow=True,
)
def spinning_row() -> Measured:
    """Elongation of a cohesive bar over a turn and a half, over the exact one; tension 0.45 % of the stiffness."""
    return Measured.absolute(1.0, spun(1.5, PULL, rows=30))

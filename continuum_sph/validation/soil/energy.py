"""The energy of soil that moves, and what becomes of it: a budget that closes.  SI.

Kinetic and potential energy go into the work of stress on the soil (what it stores and what friction turns into heat),
the damping of zig-zags and particles stopped at a wall's surface.  Two entries come from nowhere: `parting` moves
particles without a force, up as well as down, and walls, which are images of the soil before them, do a little work.
Volume that particles exchange is no energy: it only shifts the work of the next step.  What is left is that of
the steps in time: (ω Δt)²/8 of what moves, ω up to 2 c/h, Δt 0.25 h/c.
"""

import math
from typing import Any

import numpy as np

from continuum_sph.builders.parts.soil import geostatic
from continuum_sph.soil import Material, SoilFlow
from continuum_sph.soil.momentum import Choices, accelerate
from continuum_sph.soil.state import GXX, GXY, GYX, GYY, VOLUME
from continuum_sph.soil.stress import XX, XY, YY
from continuum_sph.validation.soil.setups import in_tank, run_until
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()

ENTRIES = ("stress", "damping", "stopped", "parting", "walls")
GIVEN = ("parting", "walls")  # what energy comes from; the others are what it goes into


class EnergyBudget:
    """Moves a flow step by step and adds up its energies, J/m: ``turned`` over by name, and ``start`` of both kinds."""

    def __init__(self, flow: SoilFlow) -> None:
        self.flow, soil = flow, flow.soil
        self.turned = dict.fromkeys(ENTRIES, 0.0)
        self.bare = np.zeros_like(soil.acceleration), np.zeros_like(soil.spread), np.zeros_like(soil.drift)
        self.start = self.mechanical()

    def mechanical(self) -> float:
        """Sum of kinetic and potential energy, J/m."""
        soil, n = self.flow.soil, self.flow.soil.soil
        mass, lean = soil.mass[:n], np.array(self.flow.law.gravity)
        return float((mass * (0.5 * (soil.v[:n] ** 2).sum(axis=1) - soil.x[:n] @ lean)).sum())

    def taken(self, stress: Floats) -> float:
        """Power (W/m) that soil under ``stress`` (n, 4) Pa takes up at the flow's velocity gradients."""
        n = self.flow.soil.soil
        record = self.flow.soil.record[:n]
        shear = stress[:, XY] * (record[:, GXY] + record[:, GYX])
        strained = stress[:, XX] * record[:, GXX] + stress[:, YY] * record[:, GYY] + shear
        return -float((record[:, VOLUME] * strained).sum())

    def advance(self) -> None:
        """Advance the flow by one time step, and add its energies to the budget."""
        flow, soil, law = self.flow, self.flow.soil, self.flow.law
        n, step, lean = soil.soil, flow.next_step, np.array(law.gravity)
        mass, turned = soil.mass[:n], self.turned
        before = soil.stress[:n].copy()
        kicked = soil.v[:n] + 0.5 * step * soil.acceleration
        turned["parting"] -= step * float((mass * (soil.drift @ lean)).sum())
        flow.begin(step)
        turned["stopped"] += 0.5 * float((mass * ((kicked**2).sum(axis=1) - (soil.v[:n] ** 2).sum(axis=1))).sum())
        flow.strain(step)
        flow.push()
        undamped = self.bare[0]
        accelerate(
            n, soil.record, soil.facing, soil.force, soil.stress, *self.bare, flow.near,
            Choices(*law.gravity, 0.0, False, law.diffusion, 0.0, 0.0, 0.0, law.spacing, False),
        )  # fmt: skip
        turned["stress"] += step * self.taken(0.5 * (before + soil.stress[:n]))
        pushed = float((mass * (soil.v[:n] * (undamped - lean)).sum(axis=1)).sum())
        turned["walls"] += step * (pushed + self.taken(soil.stress[:n]))
        damping = soil.acceleration - undamped
        flow.end(step)
        turned["damping"] -= step * float((mass * (soil.v[:n] * damping).sum(axis=1)).sum())
        flow.step += 1
        flow.time += step

    def missing(self, *, without: str = "") -> float:
        """What does not add up, over what the soil has lost of its height and speed;  without: an entry left out."""
        lost = self.start - self.mechanical()
        found = sum(-value if name in GIVEN else value for name, value in self.turned.items() if name != without)
        return (found - lost) / lost


def released_column(rows: int = 10, stiffness: float = 1e6, **law: Any) -> SoilFlow:
    """A column of soil, 0.2 m by 0.1 m, that is let go;  law : more of `SoilLaw`."""
    spacing = 0.1 / rows
    x = square_lattice((0.0, 0.0), (0.2, 0.1), spacing)
    material = Material(stiffness, 2040.0, sin_friction=math.sin(math.radians(21.9)))
    return in_tank(x, geostatic(0.1 - x[:, 1], material), (0.5, 0.15), spacing, material, **law)


def run_out(stiffness: float, rows: int = 10, seconds: float = 0.6, **law: Any) -> float:
    """Mean distance of the column's soil from the wall after ``seconds``, m."""
    flow = run_until(released_column(rows, stiffness, **law), seconds)
    return float(flow.soil.x[: flow.soil.soil, 0].mean())


def collapse(seconds: float = 0.3) -> EnergyBudget:
    """The energy budget of the column, collapsing for ``seconds``."""
    budget = EnergyBudget(released_column())
    while budget.flow.time < seconds:
        budget.advance()
    return budget


@VALIDATIONS.row(
    "continuum.soil_energy",
    source="exact: what soil loses of height and speed goes into the work of stress, damping and stops, less what "
    "parting and walls give",
    because="steps in time leave (ω Δt)²/8, ω Δt up to 0.5, of the finest waves, which hold no more than damping takes "
    "from them, a fifth",
    tolerance=0.5**2 / 8 / 5,
    slow=True,
)
def energy_row() -> Measured:
    """Error of the energy budget of a collapse, 0.3 s, over what was lost."""
    return Measured.absolute(0.0, collapse().missing())


SOFT, STIFF = 1e6, 5.84e6  # Pa
FINE = 20  # rows


def run_outs(rows: int = FINE, **law: Any) -> tuple[float, float]:
    """Mean distances (m) from the wall of a column of soft and of stiff soil, once collapsed."""
    return run_out(SOFT, rows, **law), run_out(STIFF, rows, **law)


@VALIDATIONS.row(
    "continuum.soil_runs_out_alike_at_any_stiffness",
    source="derived: strains of 1e-3 change no run-out; what damping takes is the same where α c h is",
    because="a front is a particle of 0.1 m / 20: half of it; the centre of a wedge lies at a third of its length",
    tolerance=0.5 * 0.1 / FINE / 3.0,
    slow=True,
)
def run_out_row() -> Measured:
    """Mean distance from the wall of soil of 1 MPa that has run out against that of 5.84 MPa, m."""
    soft, stiff = run_outs()
    return Measured.absolute(stiff, soft)

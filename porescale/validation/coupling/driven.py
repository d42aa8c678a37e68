"""Validations of what drives a fluid as it acts on the bodies in it: drag in arrays, discs that go with the water."""

import math

import numpy as np

from porescale.builders.build import build
from porescale.builders.scene import Scene
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.schema.sections import validate
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.coupling.step import Coupled
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling.setups import DEFAULT, PERIODIC, TAU, Method, immersed
from porescale.validation.coupling.towed import steady, towed
from porescale.validation.lbm.channels import one_thread

VALIDATIONS = Validations()

CELLS = 20
"""Side of the box, one disc in it."""
FRACTIONS = (0.1, 0.4)
"""Solid fractions: 7 and 14 cells a diameter."""
ALL = [Method(name, way) for name, row in SOLID_OPERATORS.items() for way in ((None,) if row.weight else ("B1", "B2"))]
"""Every solid operator with every weight that it goes with."""


def on_disc(coupled: Coupled) -> float:
    """Force along x on the first disc: its load, and what drives the fluid."""
    return float(coupled.fluid_force[0, 0] + coupled.push[0, 0])


def share_of_drive(solid_fraction: float, method: Method = DEFAULT) -> float:
    """Force on the disc of a square array over what drives its cell, G L², in steady flow."""
    nu, radius = viscosity(TAU), CELLS * math.sqrt(solid_fraction / math.pi)
    force = 1e-4 * nu
    coupled = towed(
        (CELLS, CELLS), [(CELLS / 2 + 0.3, CELLS / 2 + 0.1)], radius, sides=PERIODIC, force=(force, 0.0),
        method=method,
    )  # fmt: skip
    steady(coupled, lambda: coupled.fluid.momentum()[0], CELLS**2 / (nu * 20), 1e-6)
    return on_disc(coupled) / (force * CELLS**2)


def start(ratio: float, density: float = 1.0, steps: int = 400, method: Method = DEFAULT) -> tuple[float, float]:
    """Speeds over G t of water and of free discs in it, a periodic box driven by G from rest.

    ratio: hydraulic over mechanical radius;  density: of the discs over the water's.
    """
    force = 1e-7
    coupled = immersed(
        (60, 40), [(14.3, 11.2), (44.6, 27.7)], [6.0, 5.0], density, sides=("periodic", "periodic"), ratio=ratio,
        force=(force, 0.0), method=method,
    )  # fmt: skip
    with one_thread():
        for _ in range(steps):
            coupled.advance()
    reached = force * steps
    water = coupled.fluid.momentum()[0] / (60 * 40)
    return water / reached, float(np.mean(coupled.grains.discs.velocity[:, 0])) / reached


@VALIDATIONS.row(
    "coupling.drag_balances_what_drives",
    source="balance of forces: a disc that stands in a periodic array bears G L², all that drives its cell",
    because="required: 0.2 %; the flow is steady to 1e-6 over its memory, and the push is exact but where discs share"
    " cells; without it the load is 1 - c",
    tolerance=2e-3,
)
def arrays_bear_what_drives() -> Measured:
    """Force over G L² at solid fraction 0.1 and 0.4, exact walls and every solid operator with every weight."""
    found = [share_of_drive(fraction, method) for method in ALL for fraction in FRACTIONS]
    return Measured.absolute([1.0] * len(found), found)


@VALIDATIONS.row(
    "coupling.neutral_discs_start_with_the_water",
    source="a pressure gradient accelerates water and discs of its density alike, G t, at rest to each other",
    because="0.5 %: the virtual mass of a body and the water in it answer a step late each, two of 400 steps; without"
    " the push discs lag by 18 %",
    tolerance=5e-3,
)
def neutral_start() -> Measured:
    """Speed over G t after 400 steps of the water and of two free discs, exact walls at lambda 1 and 0.8."""
    found = [value for ratio in (1.0, 0.8) for value in start(ratio)]
    return Measured.absolute([1.0] * len(found), found)


def clump_start() -> float:
    """Speed over G t of a free clump of two discs of the fluid's density that overlap, after 0.4 s, by exact walls."""
    periodic = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")
    scene = {
        "domain": {"width": 9e-3, "height": 7e-3, **periodic}, "gravity": (0.0, 0.0), "time": {"end": 1.0},
        "output": {"snapshot_interval": 1.0, "series_interval": 1.0},
        "fluid": {"density": 1000.0, "viscosity": 2.5e-5, "spacing": 5e-4, "relaxation_time": 0.8,
                  "body_force": (1.0, 0.0), "solid_operator": "exact-wall"},
        "grains": {"density": 1000.0, "hydraulic_radius_ratio": 1.0},
        "clump": [{"discs": [[0, 0, 1.3e-3], [1.2e-3, 0, 1.0e-3]], "at": [[4e-3, 3e-3]]}],
        "contact": {"stiffness": 1e4, "restitution": 0.5},
    }  # fmt: skip
    simulation = build(validate(Scene, scene))
    simulation.advance(400)
    return float(simulation.velocities[0, 0]) / (1e-3 * simulation.time)


@VALIDATIONS.row(
    "coupling.neutral_clumps_start_with_the_water",
    source="a pressure gradient accelerates water and bodies of its density alike, G t",
    because="0.5 % as for discs; a push that counts twice where members overlap, 2.4 % of the box, speeds all of it up",
    tolerance=5e-3,
)
def neutral_clump() -> Measured:
    """Speed over G t of a clump whose members overlap by a fifth of it."""
    return Measured.absolute(1.0, clump_start())

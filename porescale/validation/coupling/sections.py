"""In a steady flow through discs as much flows through every section, and solid that stands carries nothing."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from porescale.builders.build import build
from porescale.builders.scene import Scene
from porescale.builders.simulation import Simulation
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.schema.sections import validate

VALIDATIONS = Validations()

LENGTH, HEIGHT, SPACING = 9e-3, 7e-3, 5e-4
DISCS = ((1.6e-3, 1.5e-3), (6.3e-3, 2.2e-3), (4.0e-3, 5.5e-3))
"""Centres, m: sections cut them everywhere but where none is."""
DIAMETER, STEP = 2.6e-3, 1e-3
SECTIONS = (0.3e-3, 1.5e-3, 3.7e-3, 6.0e-3, 8.8e-3)
"""Places of the sections along the flow, m."""
STANDING = [{"x": x, "y": y, "diameter": DIAMETER} for x, y in DISCS]
MOVING = [{**disc, "velocity": (0.0, HEIGHT / (700 * STEP))} for disc in STANDING]
"""Across the flow, two hundredths of a cell a step: along it sections would be alike by symmetry."""


def _built(solid_operator: str, relaxation_time: float, discs: Sequence[Mapping[str, Any]]) -> Simulation:
    """Discs in a periodic box, at time 0."""
    # The viscosity for a step of 1 ms at the relaxation time, and a force that gives Mach 1e-3 or less.
    viscosity = (relaxation_time - 0.5) / 3 * SPACING**2 / STEP
    scene = {
        "domain": {"width": LENGTH, "height": HEIGHT, **dict.fromkeys(("left", "right", "bottom", "top"), "periodic")},
        "time": {"end": 1.0},
        "output": {"snapshot_interval": 1.0, "series_interval": 1.0},
        "gravity": (0.0, 0.0),
        "fluid": {"density": 1000.0, "viscosity": viscosity, "spacing": SPACING, "relaxation_time": relaxation_time,
                  "body_force": (1.0, 0.0), "operator": "trt", "solid_operator": solid_operator},
        "disc": list(discs),
        "flux": [{"start": (x, 0.0), "end": (x, HEIGHT)} for x in SECTIONS],
    }  # fmt: skip
    return build(validate(Scene, scene))


def _fluxes(simulation: Simulation) -> tuple[list[float], list[float]]:
    """Fluxes of volume and of solid through the sections, m²/s."""
    row = simulation.tables()["flux"]
    flux = [value for name, value in row.items() if "volume flux" in name]
    return flux, [value for name, value in row.items() if "flux of solid" in name]


def fluxes(solid_operator: str, relaxation_time: float = 0.8, steps: int = 10000) -> tuple[list[float], list[float]]:
    """Fluxes of volume and of solid (m²/s) through the sections once a force has driven the fluid for so many steps."""
    simulation = _built(solid_operator, relaxation_time, STANDING)
    simulation.advance(steps)
    return _fluxes(simulation)


def spread(flux: list[float]) -> float:
    """Largest difference of fluxes over their mean."""
    return float(np.ptp(flux) / abs(np.mean(flux)))


def _stored(simulation: Simulation) -> Floats:
    """Area of fluid of the density of rest between the left side and each section, m²."""
    columns = simulation.field("density").sum(axis=0) / simulation.scene.fluid.density * SPACING**2
    centres = (np.arange(len(columns) + 1) + 0.5) * SPACING  # the first column follows on the last
    below = np.append(columns.cumsum() - 0.5 * columns, columns.sum() + 0.5 * columns[0])
    return np.asarray(np.interp(SECTIONS, centres, below))


def imbalance(
    solid_operator: str,
    relaxation_time: float = 0.8,
    discs: Sequence[Mapping[str, Any]] = STANDING,
    before: int = 10000,
    steps: int = 20,
) -> float:
    """What passes any section in so many steps, less what passes the first and what is stored between, over it.

    A flow need not be steady for it to be zero, but for the change of its change within the first and the last step.
    """
    simulation = _built(solid_operator, relaxation_time, discs)
    simulation.advance(before)
    stored, passed = _stored(simulation), 0.5 * np.array(_fluxes(simulation)[0])
    for _ in range(steps):
        simulation.advance(1)
        passed += (flux := np.array(_fluxes(simulation)[0]))
    passed = (passed - 0.5 * flux) * STEP
    total = passed + (_stored(simulation) - stored)
    return float(np.ptp(total) / abs(passed.mean()))


def _row(solid_operator: str) -> None:
    name = f"coupling.sections_{solid_operator.replace('-', '_')}"
    because = "what two sections differ by is stored between them; after 10000 steps the flow changes by less than this"

    @VALIDATIONS.row(name, source="continuity: the same flux through every section", because=because, tolerance=1e-10)
    def _() -> Measured:
        """Five sections across three discs that stand, through fluid and solid; and what the solid carries."""
        flux, solid = fluxes(solid_operator)
        return Measured(0.0, spread(flux), max(spread(flux), *map(abs, solid)))


for _operator in ("exact-wall", "SC2", "SC3"):
    _row(_operator)


@VALIDATIONS.row(
    "coupling.sections_SC1",
    source="continuity: what passes a section, less what is stored behind it",
    because="SC1 is never steady, but what two sections differ by is stored between; how fast changes by less",
    tolerance=1e-10,
)
def sections_of_what_drifts() -> Measured:
    """The same sections with SC1, whose fluxes differ by 5e-7 without end."""
    found = imbalance("SC1")
    return Measured(0.0, found, found)


@VALIDATIONS.row(
    "coupling.sections_of_moving_discs",
    source="continuity: over a period as much passes every section",
    because="the flow repeats itself from the sixth period on to less than this",
    tolerance=1e-10,
)
def sections_of_what_moves() -> Measured:
    """The same discs on their way across the flow, over the 700 steps of a period; by exact walls, SC1, SC2 and SC3."""
    found = [imbalance(name, discs=MOVING, before=4200, steps=700) for name in ("exact-wall", "SC1", "SC2", "SC3")]
    return Measured([0.0] * len(found), found, max(found))

"""In a steady flow through discs as much flows through every section, and solid that stands carries nothing."""

import numpy as np

from porescale.builders.build import build
from porescale.builders.scene import Scene
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.schema.sections import validate

VALIDATIONS = Validations()

LENGTH, HEIGHT, SPACING = 9e-3, 7e-3, 5e-4
DISCS = ((1.6e-3, 1.5e-3), (6.3e-3, 2.2e-3), (4.0e-3, 5.5e-3))
"""Centres, m: sections cut them everywhere but where none is."""
DIAMETER = 2.6e-3
SECTIONS = (0.3e-3, 1.5e-3, 3.7e-3, 6.0e-3, 8.8e-3)
"""Places of the sections along the flow, m."""


def fluxes(solid_operator: str, relaxation_time: float = 0.8, steps: int = 10000) -> tuple[list[float], list[float]]:
    """Fluxes of volume and of solid (m²/s) through the sections once a force has driven the fluid for so many steps."""
    # The viscosity for a step of 1 ms at the relaxation time, and a force that gives Mach 1e-3 or less.
    viscosity = (relaxation_time - 0.5) / 3 * SPACING**2 / 1e-3
    scene = {
        "domain": {"width": LENGTH, "height": HEIGHT, **dict.fromkeys(("left", "right", "bottom", "top"), "periodic")},
        "time": {"end": 1.0},
        "output": {"snapshot_interval": 1.0, "series_interval": 1.0},
        "gravity": (0.0, 0.0),
        "fluid": {"density": 1000.0, "viscosity": viscosity, "spacing": SPACING, "relaxation_time": relaxation_time,
                  "body_force": (1.0, 0.0), "operator": "trt", "solid_operator": solid_operator},
        "disc": [{"x": x, "y": y, "diameter": DIAMETER} for x, y in DISCS],
        "flux": [{"start": (x, 0.0), "end": (x, HEIGHT)} for x in SECTIONS],
    }  # fmt: skip
    simulation = build(validate(Scene, scene))
    simulation.advance(steps)
    row = simulation.tables()["flux"]
    flux = [value for name, value in row.items() if "volume flux" in name]
    return flux, [value for name, value in row.items() if "flux of solid" in name]


def spread(flux: list[float]) -> float:
    """Largest difference of fluxes over their mean."""
    return float(np.ptp(flux) / abs(np.mean(flux)))


def _row(solid_operator: str) -> None:
    name = f"coupling.sections_{solid_operator.replace('-', '_')}"
    because = "what two sections differ by is stored between them; after 10000 steps the flow changes by less than this"

    @VALIDATIONS.row(name, source="continuity: the same flux through every section", because=because, tolerance=1e-10)
    def _() -> Measured:
        """Five sections across three discs that stand, through fluid and solid; and what the solid carries."""
        flux, solid = fluxes(solid_operator)
        return Measured(0.0, spread(flux), max(spread(flux), *map(abs, solid)))


for _operator in ("exact-wall", "SC2"):
    _row(_operator)

"""A saturated levee slides under a river that rises, and the river runs over it: its times at two spacings.  SI."""

import functools

import numpy as np

from continuum_sph.builders.parts.soil import SoilPart
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.seepage.levee import Levee
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()

SINKS = Levee(height=0.96, crest=0.48, low=0.5, pool=0.72, plain=1.92, end=3.2)
"""The levee of `cases/saturated_levee`: its crest sinks below the river."""
EVERY = 0.02  # s, between rows of the course, as of the case's files
VOLUME = 0.2  # m² of water, a layer of 0.42 m on the crest: four times what the slide itself carries through there
ROWS = (16, 32)
LEVEL = "crest"


@functools.cache
def times(rows: int) -> tuple[float, ...]:
    """When (s after the river began to rise) toe, middle and crest of `SINKS` have slid by a fifth of the height and
    `VOLUME` of water has run through the land-side edge of its crest; ``rows``: particles over the height."""
    given = Levee(**(vars(SINKS) | {"rows": rows}))
    table = given.table() | {"level": [{"name": LEVEL, "x": given.corners[2]}]}
    model, due, gone, course = Simulation(Scene.model_validate(table)), given.settle, 0.0, []
    soil, last, before = model.part(SoilPart), given.settle, 0.0
    parts = given.watched(soil.first.copy())
    while model.time < given.end:
        model.advance(1)
        if not soil.counted or model.time < due:
            continue
        due += EVERY
        through = model.tables()["levels"][f"{LEVEL} discharge (m2/s)"]
        gone += 0.5 * (before + through) * (model.time - last)
        last, before = model.time, through
        moved = soil.displacement()
        course.append([model.time - given.settle, *(moved[part].mean() for part in parts.values()), gone])
    found = given.times(np.array(course), VOLUME)
    return tuple(found.values())


@VALIDATIONS.row(
    "continuum.levee_times",
    source="Maeda & Sakai 2004, fig. 15: toe, middle, crest, then the river over it, at any spacing",
    because="a tenth was asked, from 16 to 32 rows; the surface of soil and the level of a river are known to half of a"
    " spacing each, the head over the crest is a fifth of H, and the discharge goes with its power of 1.5",
    tolerance=0.1,
    slow=True,
)
def levee_row() -> Measured:
    """Times of toe, middle, crest and of overtopping by 0.2 m² with 16 rows over those with 32."""
    coarse, fine = (times(rows) for rows in ROWS)
    found = [one / other for one, other in zip(coarse, fine, strict=True)]
    return Measured.absolute([1.0] * len(found), found)

"""A saturated levee slides under a river that rises, and the river runs over it: its times at two spacings.  SI."""

import functools
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from continuum_sph.validation.seepage.levee import Levee
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()

HEIGHT = 0.96  # m
VOLUME = 0.2  # m² of water, a layer of 0.42 m on the crest: four times what the slide itself carries through there
ROWS = (16, 32)
LEVEL = "crest"


@dataclass(frozen=True)
class Sinking(Levee):
    """The levee of `cases/saturated_levee`, whose crest sinks below the river; a level stands on its land-side edge."""

    height: float = HEIGHT
    crest: float = 0.5 * HEIGHT
    pool: float = 0.72
    plain: float = 1.92
    low: float = 0.5
    end: float = 3.2
    over: ClassVar[float] = VOLUME / HEIGHT**2

    def table(self) -> dict[str, Any]:
        """The scene of it, as a file would have it."""
        return super().table() | {"level": [{"name": LEVEL, "x": self.corners[2]}]}


SINKING = Sinking()


@functools.cache
def times(rows: int) -> tuple[float, ...]:
    """When (s after the river began to rise) toe, middle and crest have slid by a fifth of the height and `VOLUME` of
    water has run through the land-side edge of the crest, by the trapezoidal rule.  rows : particles over H."""
    given = replace(SINKING, rows=rows)
    gone, last, before, course = 0.0, 0.0, 0.0, []
    for row, model in given.course():
        through = model.tables()["levels"][f"{LEVEL} discharge (m2/s)"]
        gone += 0.5 * (before + through) * (row[0] - last)
        last, before = row[0], through
        course.append([*row[:-1], gone])
    return tuple(given.times(np.array(course)).values())


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

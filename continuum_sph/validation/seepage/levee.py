"""A saturated levee under a sudden rise of the river: when its toe, its slope and its crest have moved.  SI."""

import functools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from continuum_sph.builders.parts.soil import SoilPart
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations

WATER = 1000.0  # kg/m³
STIFF = 10.0  # K_w/(n M) of the water
GRAINS = 2650.0  # kg/m³
GRAVITY = 9.8  # m/s², of Maeda & Sakai 2004
PARTS = {"toe": (0.0, 0.25), "middle": (0.4, 0.65), "crest": (0.8, 1.01)}
"""Heights of the land side's surface over that of the crest, from and to."""
SHALLOW = 0.15  # depth below the surface of what is watched, over the height of the crest
FAR = 0.2  # displacement over that height: soil has left its neighbours
OVER = 0.02  # water over that height squared: a layer on the slope, three particles of the coarsest


@dataclass(frozen=True)
class Levee:
    """A levee on a rigid floor that holds it, its pores full; the river rises within ``rising`` (s) once it is settled.

    rows : particles over its height;  height, crest : m;  river, land : run of its slopes over the height;  pool,
    plain : breadth of river and land beside it, m;  stiffness : E, Pa;  ratio : K_w/(n M) of the water;  permeability
    m/s;  friction : degrees;  cohesion : Pa;  low, high : levels of the river over the height;  diffusion : χ of the
    soil, left out: as of any ground (`soil.steadying`);  bounded : its damping;  end : s.
    """

    rows: int = 12
    height: float = 1.0
    crest: float = 0.4
    river: float = 2.0
    land: float = 2.0
    pool: float = 0.8
    plain: float = 2.0
    stiffness: float = 0.5e6
    ratio: float = STIFF
    permeability: float = 5e-3
    friction: float = 30.0
    cohesion: float = 0.0
    low: float = 0.6
    high: float = 0.95
    diffusion: float | None = None
    bounded: bool = False
    settle: float = 0.5
    rising: float = 0.5
    end: float = 5.5
    porosity: float = 0.4
    over: ClassVar[float] = OVER

    @property
    def spacing(self) -> float:
        """Spacing of the particles, m."""
        return self.height / self.rows

    def whole(self, length: float) -> float:
        """A length (m) in whole spacings."""
        return round(length / self.spacing) * self.spacing

    @property
    def corners(self) -> tuple[float, float, float, float]:
        """Where the river side, the crest, the land side begin and where that ends, m."""
        foot = self.whole(self.pool)
        top = foot + self.whole(self.river * self.height)
        edge = top + self.whole(self.crest)
        return foot, top, edge, edge + self.whole(self.land * self.height)

    @property
    def modulus(self) -> float:
        """M of a column, Pa, with ν = 0.3."""
        return self.stiffness * 0.7 / (1.3 * 0.4)

    def table(self) -> dict[str, Any]:
        """The scene of it, as a file would have it."""
        foot, top, edge, toe = self.corners
        width = toe + self.whole(self.plain)
        low, high = self.low * self.height, self.high * self.height
        given: dict[str, Any] = {} if self.diffusion is None else {"stress_diffusion": self.diffusion}
        if self.bounded:
            given["damping_of"] = "bounded"
        covered = self.whole(foot + (top - foot) * self.low)
        return {
            "title": "A saturated levee under a sudden rise of the river",
            "gravity": GRAVITY,
            "tank": {"width": width, "height": self.whole(1.4 * self.height), "lid": False},
            "water": {
                "sound_speed": (self.ratio * self.porosity * self.modulus / WATER) ** 0.5,
                "column": [{"width": covered, "height": self.whole(low)}],
            },
            "soil": {
                "stiffness": self.stiffness, "permeability": self.permeability, "saturated": True,
                "density": (1.0 - self.porosity) * GRAINS, "porosity": self.porosity,
                "friction_angle": f"{self.friction} degree", "cohesion": self.cohesion,
                "numerics": {"settle": self.settle} | given,
                "body": [{"outline": [[foot, 0], [toe, 0], [edge, self.height], [top, self.height]]}],
            },
            "reservoir": [
                {
                    "name": "river", "left": 0, "right": self.whole(0.7 * foot), "bottom": 0,
                    "rise": [[0.0, low], [self.settle, low], [self.settle + self.rising, high]],
                },
                {"name": "land", "left": width - self.whole(0.6), "right": width, "bottom": 0, "level": 0},
            ],
            "numerics": {"spacing": self.spacing},
            "time": {"end": self.end},
            "output": {"snapshot_interval": 0.1, "series_interval": 0.02},
        }  # fmt: skip

    def watched(self, x: Floats) -> dict[str, NDArray[np.bool_]]:
        """Which of soil at ``x`` (n, 2) m at the start each of the PARTS of the land side is, (n,)."""
        _, top, edge, toe = self.corners
        surface = np.minimum(1.0, (toe - x[:, 0]) / (toe - edge)) * self.height
        shallow = (surface - x[:, 1] < SHALLOW * self.height) & (x[:, 0] > 0.5 * (top + edge))
        height = surface / self.height
        return {name: shallow & (height > low) & (height <= high) for name, (low, high) in PARTS.items()}

    def course(self, every: float = 0.02) -> Iterator[tuple[Floats, Simulation]]:
        """((time s since the river began to rise, mean displacement m of each of the PARTS, water m² of the river
        beyond the crest), the model), ``every`` so many seconds."""
        model, due = Simulation(Scene.model_validate(self.table())), self.settle
        flow, n = model.flow.water, model.flow.water.layer.fluid
        river = (flow.porosity == 1.0) | (flow.layer.mass[:n] == 0.0)
        parts, edge = self.watched(model.part(SoilPart).first.copy()), self.corners[2]
        while model.time < self.end:
            model.advance(1)
            if model.part(SoilPart).counted and model.time >= due:
                due += every
                moved = model.part(SoilPart).displacement()
                over = flow.layer.mass[:n][river & (flow.layer.x[:n, 0] > edge)].sum() / WATER
                row = [model.time - self.settle, *(moved[part].mean() for part in parts.values()), over]
                yield np.array(row), model

    def times(self, rows: Floats) -> dict[str, float]:
        """When (s) each of the PARTS had moved by FAR and water was ``over`` the crest, on straight lines between the
        rows of the course (m, 5); nan for never."""
        limits = [FAR * self.height] * len(PARTS) + [self.over * self.height**2]
        found = {}
        for column, (name, limit) in enumerate(zip((*PARTS, "overtopped"), limits, strict=True), 1):
            beyond = np.flatnonzero(rows[:, column] > limit)
            last = rows[beyond[0] - 1 : beyond[0] + 1] if beyond.size and beyond[0] else rows[:1]
            found[name] = float(np.interp(limit, last[:, column], last[:, 0])) if beyond.size else float("nan")
        return found


VALIDATIONS = Validations()

QUICK = Levee(rows=8, end=1.4)
STIFFER = 4.0
"""Times as stiff as the other."""


@functools.cache
def gone(given: Levee = QUICK) -> tuple[float, ...]:
    """When (s) toe, middle and crest have moved."""
    times = given.times(np.array([row for row, _ in given.course()]))
    return tuple(times[name] for name in PARTS)


@VALIDATIONS.row(
    "continuum.levee_stiffness",
    source="Maeda & Sakai 2004, fig. 15: E is a numerical choice, and the course of the failure does not hang on it",
    because="between 0.5 and 2 MPa: soil strains by γ'H²/M before it yields, 0.014 or 0.004 of H, at 0.7 m/s a "
    "difference of 0.015 s; what was braked until the river rose starts with 0.09 or 0.05 m/s, 0.02 m in 0.5 s, "
    "0.03 s; displacements are read every 0.02 s and lines drawn between: 0.05 s",
    tolerance=0.05,
    slow=True,
)
def stiffness_row() -> Measured:
    """When toe, middle and crest of levees of E 0.5 and 2 MPa go, s, the largest difference; 8 particles over H."""
    return Measured.absolute(gone(), gone(replace(QUICK, stiffness=STIFFER * QUICK.stiffness)))

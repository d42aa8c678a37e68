"""Ground cut by a sheet pile, under water whose level rises on one side until the ground on the other heaves.  SI."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.build.exit_gradient import reach, steepness
from continuum_sph.build.seepage_model import SeepageSimulation
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage.sheet_pile import Pile
from continuum_sph.validation.seepage_steady_trials import Face, flux, held_ground
from porescale.common.core.constants import GRAVITY

Floats = NDArray[np.float64]

WATER, GRAINS = 1000.0, 2650.0  # kg/m³
FREELY = 4.0  # of the rise that elasticity explains: the rest is flow of soil that yields
BARELY = 0.01  # i_c s, by which a head that is held rises all the same
STIFF = 10.0  # K_w/(n M) of the water: what soil squeezes out is not stored


def rests(rise: Floats, most: float) -> bool:
    """Whether ground whose ``rise`` (3,) is known at the ends of three thirds of a time rises less in the last than in
    the one before, and by less than ``most`` in all."""
    before, then, now = rise
    return bool(now - then < then - before and now < most)


@dataclass(frozen=True)
class Heave:
    """Level ground of depth T on an impervious base under water, cut by a sheet pile to the depth s.

    Upstream, on the left, the water rises to the head ``first``, stands there until ``calm`` (s), while motion is
    braked, and then rises by ``rate`` a second; heads are over i_c s.
    share : s/T;  rows : particles over T;  depth : T, m;  reach : of each side over T;  cover : of the water at rest
    over T;  modulus : M of a column, Pa;  permeability m/s;  friction, dilatancy : angles, degrees;  rough : the pile's
    faces hold the soil;  grains : kg/m³.
    """

    share: float = 0.5
    rows: int = 16
    depth: float = 1.0
    reach: float = 1.5
    cover: float = 0.25
    modulus: float = 1e6
    permeability: float = 1e-2
    friction: float = 30.0
    dilatancy: float = 0.0
    rough: bool = False
    first: float = 2.0
    last: float = 4.5
    rate: float = 0.4
    calm: float = 1.0
    porosity: float = 0.4
    poisson: float = 0.3
    grains: float = GRAINS

    @property
    def spacing(self) -> float:
        """m."""
        return self.depth / self.rows

    @property
    def buried(self) -> float:
        """s, m."""
        return self.share * self.depth

    @property
    def critical(self) -> float:
        """i_c = (G_s - 1)(1 - n)."""
        return (self.grains / WATER - 1.0) * (1.0 - self.porosity)

    @property
    def elastic(self) -> float:
        """Rise over s of an elastic column as deep as the pile that loses all its weight: i_c ρ g s/2M."""
        return self.critical * WATER * GRAVITY * self.buried / (2.0 * self.modulus)

    @property
    def end(self) -> float:
        """When the head is the last, s."""
        return self.calm + (self.last - self.first) / self.rate

    def head(self, time: float) -> float:
        """Head over i_c s at a ``time`` (s)."""
        return float(np.interp(time, *np.array(self.steps).T))

    @property
    def steps(self) -> tuple[tuple[float, float], ...]:
        """Rows of time (s) and head over i_c s."""
        return (0.0, 0.0), (0.5 * self.calm, self.first), (self.calm, self.first), (self.end, self.last)

    @property
    def scene(self) -> Scene:
        """The scene of it."""
        side, spacing = round(self.reach * self.rows), self.spacing
        width, beside = (2 * side + 1) * spacing, side * spacing
        level = self.depth + round(self.cover * self.rows) * spacing
        unit = self.critical * self.buried
        highest = level + self.last * unit
        nu = self.poisson
        table: dict[str, Any] = {
            "gravity": GRAVITY,
            "tank": {"width": width, "height": (round(highest / spacing) + 4) * spacing, "lid": False},
            "water": {
                "density": WATER,
                "sound_speed": (STIFF * self.porosity * self.modulus / WATER) ** 0.5,
                "column": [{"width": width, "height": level}],
            },
            "soil": {
                "density": (1.0 - self.porosity) * self.grains,
                "porosity": self.porosity,
                "stiffness": self.modulus * (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu),
                "poisson": nu,
                "friction_angle": f"{self.friction} degree",
                "dilatancy_angle": f"{self.dilatancy} degree",
                "permeability": self.permeability,
                "numerics": {"settle": self.calm},
                "body": [{"outline": [[0, 0], [width, 0], [width, self.depth], [0, self.depth]]}],
            },
            "pile": {
                "x": 0.5 * width,
                "tip": self.depth - self.buried,
                "faces": "hold" if self.rough else "slip",
            },
            "reservoir": [
                {
                    "name": "upstream", "left": 0.0, "right": beside, "bottom": self.depth,
                    "rise": [[time, level + head * unit] for time, head in self.steps],
                },
                {
                    "name": "downstream", "left": width - beside, "right": width, "bottom": self.depth,
                    "level": level,
                },
            ],
            "numerics": {"spacing": spacing, "tension": "cut", "artificial_viscosity": 0.1},
            "time": {"end": self.end},
            "output": {"snapshot_interval": 0.1, "series_interval": 0.02},
        }  # fmt: skip
        return Scene.model_validate(table)

    def prism(self, model: SeepageSimulation) -> NDArray[np.bool_]:
        """Which soil particles, (soil,), were at the surface of Terzaghi's prism, s/2 wide by the pile, at first."""
        x, edge = model.soil.first, (round(self.reach * self.rows) + 1) * self.spacing
        chosen: NDArray[np.bool_] = (
            (x[:, 1] > self.depth - self.spacing) & (x[:, 0] > edge) & (x[:, 0] < edge + 0.5 * self.buried)
        )
        return chosen

    def course(self, every: float = 0.01) -> Iterator[tuple[float, float, float, SeepageSimulation]]:
        """(time s, head over i_c s, mean rise of the prism's surface over s since it stood calm, the model), ``every``
        so many seconds until the head is its last."""
        model, due = SeepageSimulation(self.scene), self.calm
        while model.time < self.end:
            model.advance(1)
            if model.soil.counted and model.time >= due:
                due += every
                x = model.both.water.skeleton.x
                rise = float((x - model.soil.first)[self.prism(model), 1].mean()) / self.buried
                yield model.time, self.head(model.time), rise, model

    def onset(self, times: float = FREELY) -> float:
        """Head over i_c s at which the surface of the prism has risen ``times`` as much as elasticity explains; nan if
        it never does."""
        return next((head for _, head, rise, _ in self.course() if rise > times * self.elastic), float("nan"))

    def stands(self, head: float, most: float, seconds: float = 2.2) -> bool:
        """Whether ground under a ``head`` (over i_c s) that is held for so many ``seconds`` comes to rest before its
        surface, that of the prism, has risen by ``most`` s: see `rests`."""
        held = replace(self, first=head, last=head + BARELY, rate=BARELY / seconds)
        time, _, rise = np.array([row[:3] for row in held.course(seconds / 60.0)]).T
        return rests(np.interp(self.calm + seconds * np.array([1.0, 2.0, 3.0]) / 3.0, time, rise), most)


@dataclass(frozen=True)
class Around:
    """Seepage around a pile that both sides touch, in ground of depth T = 1 m that is held, under a head of 1 m.

    share : s/T;  rows : particles over T;  reach : of each side over T;  permeability m/s.
    """

    share: float
    rows: int
    reach: float = 1.0
    permeability: float = 1e-3

    def run(self, steps: int) -> tuple[float, float]:
        """(q/(k h), i_E T/h) after ``steps``: mean of what goes in and comes out; the first term of i d + c d³, d the
        depth of particles beside the pile, down to 0.6 s or three rows."""
        spacing, k = 1.0 / self.rows, self.permeability
        width = (2 * round(self.reach * self.rows) + 1) * spacing
        left, right = 0.5 * (width - spacing), 0.5 * (width + spacing)
        pile = Pile.instead_of(0.5 * width, 1.0 - self.share, spacing, rough=False)
        faces = [Face("lid", 1.0, end=left), Face("lid", 0.0, start=right)]
        both = held_ground((width, 1.0), spacing, faces, k, pile=pile)
        for _ in range(steps):
            both.advance()
        x, q, volume = flux(both)
        band = (x[:, 1] > 1.0 - 6.0 * spacing) & (x[:, 1] < 1.0 - 2.0 * spacing)
        out, down = x[:, 0] > right, x[:, 0] < left
        through = (volume * q[:, 1])[band & out].sum() - (volume * q[:, 1])[band & down].sum()
        column = out & (x[:, 0] < right + spacing) & (x[:, 1] > 1.0 - reach(self.share, spacing))
        head = both.water.layer.pressure[: len(x)][column] / (WATER * GRAVITY)
        return 0.5 * float(through) / (4.0 * spacing * k), steepness(1.0 - x[column, 1], head)

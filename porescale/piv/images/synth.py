"""Synthetic pictures of tracers of exact displacement."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.ranges import FINITE, Range
from porescale.common.core.types import Floats
from porescale.piv import given
from porescale.piv.estimate.grid import Grid
from porescale.piv.fields.field import Field
from porescale.piv.images.flows import Discs, Flow
from porescale.piv.images.spots import REACH, add_spots, coverage

Picture = NDArray[np.uint8]


@dataclass(frozen=True)
class Camera:
    """How tracers look.

    size : rows, columns;  density : tracers a pixel;  diameter : px, four standard deviations of a spot;  peak : grey
    levels of a tracer in the middle of the light sheet;  sheet : how far the light falls towards the sheet's faces,
    exp(-sheet) there;  background, noise : grey levels, mean and standard deviation of what every pixel has without
    tracers;  lost : share of the tracers of each picture that the other does not show;  disc : grey level of solids,
    bright or dark.
    """

    size: tuple[int, int] = (512, 512)
    density: float = 0.05
    diameter: float = 2.8
    peak: float = 200.0
    sheet: float = 1.0
    background: float = 16.0
    noise: float = 3.0
    lost: float = 0.05
    disc: float = 180.0

    def check(self) -> None:
        """Raises InputError with every bound that is broken."""
        size = self.size if isinstance(self.size, tuple | list) and len(self.size) == 2 else (self.size,)
        sides = [fault for it in size for fault in given.within("size", it, Range("px", ge=8, whole=True))]
        given.refuse(
            sides[:1],
            given.within("density", self.density, Range(gt=0, le=1)),
            given.within("diameter", self.diameter, Range("px", ge=0.1, le=50)),
            given.within("noise", self.noise, Range(ge=0)),
            *(given.within(key, getattr(self, key), FINITE) for key in ("peak", "sheet", "background", "disc")),
            given.within("lost", self.lost, Range(ge=0, le=1)),
        )


@dataclass(frozen=True)
class Pair:
    """Two pictures (rows, columns), the solids in both (True inside), and the flow between them."""

    first: Picture
    second: Picture
    solid: NDArray[np.bool_]
    flow: Flow


def pair(flow: Flow, camera: Camera | None = None, seed: int = 0) -> Pair:
    """Pictures half an interval before and after mid time.  InputError for a camera or seed out of bounds."""
    camera = camera or Camera()
    camera.check()
    given.refuse(given.within("seed", seed, Range(ge=0, whole=True)))
    random = np.random.default_rng(seed)
    x, y, light = seeded(flow, camera, random, shares=1 + camera.lost)
    count = round(len(x) * (1 - camera.lost) / (1 + camera.lost))  # in both; the rest half in each
    only = (len(x) - count) // 2
    one, two = np.r_[:count, count : count + only], np.r_[:count, count + only : len(x)]
    pictures = []
    for which, time in ((one, -0.5), (two, 0.5)):
        at = flow.carried(x[which], y[which], time)
        pictures.append(expose(*at, light[which], flow.discs, camera, random))
    rows, columns = np.mgrid[: camera.size[0], : camera.size[1]].astype(float)
    return Pair(pictures[0], pictures[1], flow.discs.inside(columns, rows), flow)


def exact(made: Pair, window: int, step: int) -> Field:
    """The exact displacement on the grid of a measurement with windows of ``window`` px, ``step`` px apart."""
    grid = Grid((made.first.shape[0], made.first.shape[1]), window, step)
    x, y = np.meshgrid(grid.x, grid.y)
    u, v = made.flow.displacement(x, y)
    solid = made.flow.discs.inside(x, y)
    zero, none = np.zeros(x.shape), np.zeros(x.shape, bool)
    u, v = np.where(solid, np.nan, u), np.where(solid, np.nan, v)
    return Field(grid.x, grid.y, u, v, ~solid, none, solid, zero + 1, zero)


def seeded(
    flow: Flow, camera: Camera, random: np.random.Generator, shares: float = 1.0
) -> tuple[Floats, Floats, Floats]:
    """Tracers at mid time, uniform over the picture and as far around it as they move, none in a solid: x, y, peak."""
    rows, columns = camera.size
    edge_x = np.r_[np.linspace(-0.5, columns - 0.5, 33), np.full(33, -0.5), np.full(33, columns - 0.5)]
    edge_y = np.r_[np.full(33, -0.5), np.linspace(-0.5, rows - 0.5, 66)]
    u, v = flow.displacement(edge_x, edge_y)
    margin = REACH * camera.diameter / 4 + 1.0 + float(np.hypot(u, v).max())
    area = (rows + 2 * margin) * (columns + 2 * margin)
    count = round(shares * camera.density * area)
    x = random.uniform(-0.5 - margin, columns - 0.5 + margin, count)
    y = random.uniform(-0.5 - margin, rows - 0.5 + margin, count)
    z = random.uniform(-1.0, 1.0, count)
    free = ~flow.discs.inside(x, y)
    return x[free], y[free], camera.peak * np.exp(-camera.sheet * z[free] ** 2)


def expose(x: Floats, y: Floats, light: Floats, discs: Discs, camera: Camera, random: np.random.Generator) -> Picture:
    """One picture: spots, discs in front of them, noise, grey levels 0 to 255."""
    image = np.full(camera.size, camera.background)
    add_spots(x, y, light, camera.diameter / 4, image)
    share = np.zeros(camera.size)
    coverage(discs, share)
    image = image * (1 - share) + camera.disc * share
    image += random.normal(0.0, camera.noise, camera.size)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)

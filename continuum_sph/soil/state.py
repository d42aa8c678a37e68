"""State of a layer of soil: arrays, soil particles first, wall particles after them."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.ranges import Range, require_arrays, require_in_range
from porescale.common.core.types import Floats

X, Y, VX, VY, VOLUME, MASS, SOUND_OVER_DENSITY, SHEAR_RATE, TXX, TXY, TYX, TYY, GXX, GXY, GYX, GYY = range(16)
"""Columns of a record, two cache lines: m, m, m/s, m/s, m², kg/m, c/ρ in m⁴/(kg s), rate of shear strain (of plastic
strain with `SoilLaw.bounded`) in 1/s; σ·K, Pa (xy: row x, column y); velocity gradient ∂v_x/∂x, ∂v_x/∂y, ∂v_y/∂x,
∂v_y/∂y, 1/s."""


@dataclass
class Soil:
    """Particles of soil and of the walls that hold it.

    soil : number of soil particles, the first rows of every array;
    x (n, 2) m;  v (n, 2) m/s, of walls the wall's own;  mass (n,) kg per metre of depth, of soil that of its grains;
    density (soil,) kg/m³, grains per whole volume;  stress (n, 4) Pa, effective, of walls that of the soil before them;
    material (n,) number of the particle's material.  What has happened to a particle: separation_strain (soil,)
    by how much of its volume it has come apart, plastic_shear (soil,) shear strain that did not come back,
    of soil that softens that of its surroundings, see `softening`.
    The rest is made of these.  Raises InputError for arrays of other shapes; they are kept, not copied.
    """

    soil: int
    x: Floats
    v: Floats
    mass: Floats
    density: Floats
    stress: Floats
    material: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    force: Floats = field(init=False)  # (soil, 2) N/m, of other layers
    acceleration: Floats = field(init=False)  # (soil, 2) m/s²
    drift: Floats = field(init=False)  # (soil, 2) m/s, what keeps particles apart adds to the velocity of moving
    spread: Floats = field(init=False)  # (soil, 7) of `momentum`: diffusion of stress, volume; p around less p; crowd
    separation_strain: Floats = field(init=False)
    plastic_shear: Floats = field(init=False)
    record: Floats = field(init=False)  # (n, 16) all that a pair reads of a partner
    matrix: Floats = field(init=False)  # (soil, 5) of the gradient correction, see `gradient`
    swelling: Floats = field(init=False)  # (soil, 2), see `stress.deform`; without rows unless pores need it
    facing: Floats = field(init=False)  # (n, 4) of walls: nearest point of the surface, normal into the soil
    length: Floats = field(init=False)  # (n,) m, smoothing lengths, set by the flow

    def __post_init__(self) -> None:
        n = len(np.atleast_1d(self.x))
        require_in_range("soil", vars(self), {"soil": Range(ge=0, le=n, whole=True)})
        if not np.size(self.material):
            self.material = np.zeros(n, np.int64)
        shapes = {"x": (n, 2), "v": (n, 2), "mass": (n,), "density": (self.soil,), "stress": (n, 4), "material": (n,)}
        require_arrays("soil", vars(self), shapes)
        self.force, self.acceleration, self.drift = (np.zeros((self.soil, 2)) for _ in range(3))
        self.spread = np.zeros((self.soil, 7))
        self.separation_strain, self.plastic_shear = np.zeros(self.soil), np.zeros(self.soil)
        self.swelling = np.zeros((0, 2))
        self.record, self.facing, self.length = np.zeros((n, 16)), np.zeros((n, 4)), np.zeros(n)
        self.matrix = np.tile([1.0, 0.0, 1.0, 0.0, 0.0], (self.soil, 1))

    @property
    def count(self) -> int:
        """Number of all particles, soil and walls."""
        return len(self.x)

    @property
    def gradient(self) -> Floats:
        """Velocity gradients of the last step, (soil, 4) 1/s: ∂v_x/∂x, ∂v_x/∂y, ∂v_y/∂x, ∂v_y/∂y.  A view."""
        return self.record[: self.soil, GXX:]

    KEPT = (
        ("x", "x"), ("v", "v"), ("mass", "mass"), ("density", "density"), ("stress", "stress"), ("force", "force"),
        ("acceleration", "acceleration"), ("drift", "drift"), ("spread", "spread"), ("opening", "separation_strain"),
        ("plastic", "plastic_shear"), ("record", "record"), ("matrix", "matrix"), ("length", "length"),
    )  # fmt: skip
    """Names in a checkpoint, and the attributes that they are of."""

    def state(self) -> dict[str, Floats]:
        """Copies of the arrays that later steps depend on."""
        return {name: getattr(self, own).copy() for name, own in self.KEPT}

    def restore(self, state: dict[str, Floats]) -> None:
        """Take over what `state` of an equal soil gave."""
        for name, own in self.KEPT:
            getattr(self, own)[:] = state[name]

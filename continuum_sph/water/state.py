"""State of a layer of smoothed particles: arrays, fluid particles first, wall particles after them."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.ranges import Range, require_arrays, require_in_range
from porescale.common.core.types import Floats

X, Y, VX, VY, RHO, P, VOLUME, COMPRESSIBILITY = range(8)
"""Columns of a record: m, m, m/s, m/s, kg/m³, Pa, m/ρ (m²), ρ/c² (kg s²/m⁵)."""
VISCOUS, DIFFUSIVE, BY_WALLS, BY_TENSION, BY_SHIFTING, STOPPED = range(6)
"""Columns of energy turned over: by viscosity into heat, by density diffusion into nothing, given by walls, by
surface tension, by shifting; lost by particles stopped at a wall's surface."""


@dataclass
class Layer:
    """Particles of the fluids and of the walls that hold them.

    fluid : number of fluid particles, the first rows of every array;
    x (n, 2) m;  v (n, 2) m/s, of walls the wall's own;  mass (n,) kg per metre of depth;
    density (fluid,) kg/m³;  material (n,) number of the particle's fluid, of a wall particle 1 where fluid slips past
    walls that else hold it;  the rest is made of these: pressure (n,) Pa and what the pass over pairs reads,
    of which ghost, properties, lengths, matrix and facing have no rows unless a flow needs them.  Raises InputError for
    arrays of other shapes; they are kept, not copied.
    """

    fluid: int
    x: Floats
    v: Floats
    mass: Floats
    density: Floats
    material: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    acceleration: Floats = field(init=False)  # (fluid, 2) m/s²
    rate: Floats = field(init=False)  # (fluid,) kg/(m³ s), over the last step
    rate_before: Floats = field(init=False)  # (fluid,) over the one before
    predicted: Floats = field(init=False)  # (fluid,) kg/m³, density at the end of the step
    pressure: Floats = field(init=False)  # (n,) Pa
    record: Floats = field(init=False)  # (n, 8) all that a pair reads of a partner, in one cache line
    smoothed: Floats = field(init=False)  # (fluid, 2) m/s, what XSPH adds to the velocity of moving
    drift: Floats = field(init=False)  # (fluid, 2) m/s, what shifting adds
    ghost: Floats = field(init=False)  # (n, 2) m/s, velocity that makes fluid at a wall stick (rows of walls)
    length: Floats = field(init=False)  # (n,) m, smoothing lengths, set by the flow
    properties: Floats = field(init=False)  # (fluid, 2) number and viscosity (Pa s) of the fluid, for pairs of several
    lengths: Floats = field(init=False)  # (n, 2) `length`, for pairs where it varies, and nothing
    matrix: Floats = field(init=False)  # (fluid, 4) xx, xy, yy of the gradient correction, how closed in: `correction`
    facing: Floats = field(init=False)  # (n, 4) of walls: nearest point of the surface, normal into the fluid
    power: Floats = field(init=False)  # (fluid, 6) W/m, see VISCOUS, …, STOPPED; (0, 6) without `keep_budget`
    energy: Floats = field(init=False)  # the same summed over time, J/m
    renewed: NDArray[np.bool_] = field(init=False)  # (fluid,) those that were put where they are since the last look
    has_budget: bool = field(init=False, default=False)  # whether a budget of them is kept

    def __post_init__(self) -> None:
        n = len(np.atleast_1d(self.x))
        require_in_range("layer", vars(self), {"fluid": Range(ge=0, le=n, whole=True)})
        if not np.size(self.material):
            self.material = np.zeros(n, np.int64)
        shapes = {"x": (n, 2), "v": (n, 2), "mass": (n,), "density": (self.fluid,), "material": (n,)}
        require_arrays("layer", vars(self), shapes)
        self.acceleration, self.smoothed = np.zeros((self.fluid, 2)), np.zeros((self.fluid, 2))
        self.drift = np.zeros((self.fluid, 2))
        self.rate, self.rate_before = np.zeros(self.fluid), np.zeros(self.fluid)
        self.predicted, self.pressure = np.zeros(self.fluid), np.zeros(n)
        self.record, self.length = np.zeros((n, 8)), np.zeros(n)
        self.renewed = np.zeros(self.fluid, np.bool_)
        self.properties, self.lengths = np.zeros((0, 2)), np.zeros((0, 2))
        self.ghost, self.facing, self.matrix = np.zeros((0, 2)), np.zeros((0, 4)), np.zeros((0, 4))
        self.power, self.energy = np.zeros((0, 6)), np.zeros((0, 6))

    def keep_budget(self) -> None:
        """Add up from now on what energies become: kernels do so where ``power`` and ``energy`` have rows."""
        self.power, self.energy = np.zeros((self.fluid, 6)), np.zeros((self.fluid, 6))
        self.has_budget = True

    @property
    def count(self) -> int:
        """Number of all particles, fluid and walls."""
        return len(self.x)

    KEPT = ("x", "v", "mass", "density", "acceleration", "rate", "rate_before", "smoothed", "drift", "pressure",
    "length")  # fmt: skip
    BUDGET = ("power", "energy")

    def kept(self) -> tuple[str, ...]:
        """Names of the arrays that later steps depend on."""
        return self.KEPT + (self.BUDGET if self.has_budget else ())

    def state(self) -> dict[str, Floats]:
        """Copies of the arrays that later steps depend on."""
        return {name: getattr(self, name).copy() for name in self.kept()}

    def restore(self, state: dict[str, Floats]) -> None:
        """Take over what `state` of an equal layer gave."""
        for name in self.kept():
            getattr(self, name)[:] = state[name]

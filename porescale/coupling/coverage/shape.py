"""The contract of a body that is no disc.

A new one is one more file with a class of this kind: the rows of the lattice, the loads and the sides of the box work
on patches alone (rows.py).  Lattice units throughout.
"""

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.types import Integers, Reals
from porescale.lbm.fluid import Fluid


class Shape(ABC):
    """A body with prescribed motion: its owner sets place, velocity and spin between steps.

    velocity (2,) cells per step;  spin: about ``centre``, radians per step.
    """

    def __init__(self, velocity: ArrayLike = (0.0, 0.0), spin: float = 0.0) -> None:
        self.velocity = np.array(velocity, float)
        self.spin = float(spin)
        if self.velocity.shape != (2,):
            raise ValueError(f"a velocity is two numbers, not {self.velocity.shape}")

    @property
    @abstractmethod
    def centre(self) -> Reals:
        """What it spins and its torque is taken about, (2,) cells."""

    @property
    @abstractmethod
    def place(self) -> Reals:
        """Numbers that its patch follows from, (k,); while they stay the patch is not filled again."""

    @abstractmethod
    def size(self, fluid: Fluid, shift: float) -> tuple[int, int]:
        """Cells (along x, along y) of a patch that holds it wherever it moves.

        shift: cells², what exact walls add to a radius times the radius; 0 without them.  ValueError where it does not
        fit.
        """

    @abstractmethod
    def fill(self, fluid: Fluid, corner: Integers, fraction: NDArray[np.floating]) -> None:
        """Put the patch's lower left cell into corner (2,), and its solid fractions into fraction (height, stride)."""

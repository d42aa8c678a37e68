"""Richards' equation in one direction by finite differences: slow, obvious, and of nothing that it is held to.

    ∂(n S)/∂t = ∂/∂y {k k_r (∂ψ_p/∂y + 1)},   ψ_p = p/(ρ_w g), negative under suction

on cells of equal height, implicit, the mixed form by modified Picard iterations, which keeps mass: Celia, Bouloutas &
Zarba, Water Resour. Res. 26 (1990) 1483.  Means of k_r between cells are arithmetic.  Pores and water do not give.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_banded

from porescale.common.core.types import Floats

ENOUGH = 1e-9  # of the heads, m, that one iteration changes
MOST = 200  # iterations of a step


@dataclass(frozen=True)
class VanGenuchtenMualem:
    """alpha 1/m;  n;  residual : S_r;  connectivity : l;  constant : k_r = 1 (for checks that must fail)."""

    alpha: float
    n: float
    residual: float
    connectivity: float = 0.5
    constant: bool = False

    def saturation(self, head: Floats) -> Floats:
        """S at a pressure ``head`` (m)."""
        m = 1.0 - 1.0 / self.n
        part = (1.0 + (self.alpha * np.maximum(0.0, -head)) ** self.n) ** -m
        found: Floats = self.residual + (1.0 - self.residual) * part
        return found

    def relative(self, head: Floats) -> Floats:
        """k_r at a pressure ``head`` (m)."""
        if self.constant:
            return np.ones_like(head)
        m = 1.0 - 1.0 / self.n
        part = (1.0 + (self.alpha * np.maximum(0.0, -head)) ** self.n) ** -m
        found: Floats = part**self.connectivity * (1.0 - (1.0 - part ** (1.0 / m)) ** m) ** 2
        return found


@dataclass(frozen=True)
class Gardner:
    """k_r = exp(a ψ_p), S the same (Gardner, Soil Sci. 85 (1958) 228): steady flow has a closed form.

    rate : a, 1/m.
    """

    rate: float

    def saturation(self, head: Floats) -> Floats:
        """S at a pressure ``head`` (m)."""
        found: Floats = np.exp(self.rate * np.minimum(head, 0.0))
        return found

    def relative(self, head: Floats) -> Floats:
        """k_r at a pressure ``head`` (m)."""
        return self.saturation(head)

    def steady(self, height: Floats, flux: float) -> Floats:
        """Pressure head (m) at a ``height`` (m) over the water table under an upward ``flux`` over k: integrating
        flux = -exp(a ψ)(ψ' + 1) from ψ = 0: exp(a ψ) = (1 + flux) exp(-a y) - flux."""
        found: Floats = np.log((1.0 + flux) * np.exp(-self.rate * height) - flux) / self.rate
        return found


@dataclass
class Column:
    """soil : its laws;  height m, of ``cells``;  permeability m/s;  porosity;  bottom, top : pressure head (m) held
    at an end, or None: closed, unless ``flux`` (m/s, upward) leaves through the top."""

    soil: VanGenuchtenMualem | Gardner
    height: float
    cells: int
    permeability: float
    porosity: float
    bottom: float | None = None
    top: float | None = None
    flux: float = 0.0

    @property
    def y(self) -> Floats:
        """Heights of the cells' middles, m."""
        found: Floats = (np.arange(self.cells) + 0.5) * self.height / self.cells
        return found

    def advance(self, head: Floats, seconds: float, steps: int) -> Floats:
        """The pressure heads (cells,) m that become of ``head`` in ``seconds``, in so many equal ``steps``."""
        for _ in range(steps):
            head = self.step(head, seconds / steps)
        return head

    def step(self, head: Floats, seconds: float) -> Floats:
        """One step; ArithmeticError when the iterations do not end."""
        old, now = self.porosity * self.soil.saturation(head), head.copy()
        for _ in range(MOST):
            more = self._change(now, old, seconds)
            now = now + more
            if np.abs(more).max() < ENOUGH:
                return now
        raise ArithmeticError("no convergence: more steps")

    def _change(self, head: Floats, old: Floats, seconds: float) -> Floats:
        """What one iteration adds to ``head``, from water ``old`` (cells,) of the last step."""
        dy, k = self.height / self.cells, self.permeability
        slope = 1e-7
        capacity = (
            self.porosity * (self.soil.saturation(head + slope) - self.soil.saturation(head - slope)) / (2 * slope)
        )
        relative = self.soil.relative(head)
        between = 0.5 * k * (relative[1:] + relative[:-1])
        flux = np.zeros(self.cells + 1)  # upward, at the faces
        flux[1:-1] = -between * ((head[1:] - head[:-1]) / dy + 1.0)
        end = np.zeros(2)
        for which, (held, cell, face, sign) in enumerate(((self.bottom, 0, 0, 1.0), (self.top, -1, -1, -1.0))):
            if held is not None:
                end[which] = 0.5 * k * (float(self.soil.relative(np.array([held]))[0]) + relative[cell])
                flux[face] = -end[which] * (sign * (head[cell] - held) / (0.5 * dy) + 1.0)
        if self.top is None:
            flux[-1] = self.flux
        rest = -(self.porosity * self.soil.saturation(head) - old) / seconds - (flux[1:] - flux[:-1]) / dy
        bands = np.zeros((3, self.cells))
        bands[0, 1:] = bands[2, :-1] = -between / dy**2
        bands[1] = capacity / seconds
        bands[1, :-1] += between / dy**2
        bands[1, 1:] += between / dy**2
        bands[1, 0] += 2.0 * end[0] / dy**2
        bands[1, -1] += 2.0 * end[1] / dy**2
        found: Floats = solve_banded((1, 1), bands, rest)
        return found


def relaxed(column: Column, head: Floats, seconds: float, most: float, first: float = 1e-3) -> Floats:
    """The heads after ``seconds`` in steps that grow from ``first`` by a tenth each, to ``most`` (s) at most."""
    time, step = 0.0, first
    while time < seconds - 1e-12:
        step = min(step, most, seconds - time)
        head = column.step(head, step)
        time += step
        step *= 1.1
    return head

"""One element of soil under prescribed strains and stresses.  SI, compression positive."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from continuum_sph.soil import Material
from continuum_sph.soil.plasticity import new_stress

Floats = NDArray[np.float64]
ROUNDS = 60  # of halving an interval that starts a strain step wide: 1e-18 of it


class Element:
    """stress (4,) Pa;  opening;  plastic : shear strain that did not come back;  strain (2,) across and upright."""

    def __init__(self, material: Material, stress: tuple[float, float, float, float]) -> None:
        self.row = material.row()
        self.stress: tuple[float, ...] = stress
        self.opening = self.plastic = 0.0
        self.strain = np.zeros(2)

    def after(self, across: float, upright: float, shear: float = 0.0, turn: float = 0.0) -> tuple[float, ...]:
        """σ_xx, σ_yy, σ_xy, σ_zz (Pa), opening and plastic shear of a further strain (tensor components, compression
        positive) and turn (rad)."""
        xx, yy, xy, zz = self.stress
        found: tuple[float, ...] = new_stress(
            xx, yy, xy, zz, -across, -shear - turn, -shear + turn, -upright, 1.0, self.opening, self.row
        )
        return found

    def take(self, across: float, upright: float, shear: float = 0.0, turn: float = 0.0) -> None:
        """Strain it so."""
        *stress, self.opening, flow = self.after(across, upright, shear, turn)
        self.stress, self.plastic = tuple(stress), self.plastic + flow
        self.strain += across, upright

    def press(self, upright: float) -> None:
        """Strain it upright under the stress that it has across: the strain across is found by halving."""
        kept = self.stress[0]
        low, high = -4.0 * abs(upright), 4.0 * abs(upright)
        for _ in range(ROUNDS):
            middle = 0.5 * (low + high)
            if self.after(middle, upright)[0] < kept:
                low = middle
            else:
                high = middle
        self.take(0.5 * (low + high), upright)


def biaxial(material: Material, pressure: float, strain: float = 0.02, steps: int = 400) -> tuple[Element, Floats]:
    """An element under ``pressure`` (Pa) from all sides, then pressed by ``strain`` upright; the element, and every
    step's (upright strain, across strain, σ_yy, σ_xx), (steps + 1, 4)."""
    element = Element(material, (pressure, pressure, 0.0, 2.0 * material.poisson * pressure))
    rows = [(0.0, 0.0, pressure, pressure)]
    for _ in range(steps):
        element.press(strain / steps)
        rows.append((element.strain[1], element.strain[0], element.stress[1], element.stress[0]))
    return element, np.array(rows)


def confined(material: Material, strain: float = 0.01, steps: int = 100) -> Element:
    """An element without stress pressed by ``strain`` upright that cannot widen."""
    element = Element(material, (0.0, 0.0, 0.0, 0.0))
    for _ in range(steps):
        element.take(0.0, strain / steps)
    return element


def squeezed(material: Material, pressure: float, strain: float, steps: int) -> float:
    """Mean stress (Pa) of an element under ``pressure`` (Pa) from all sides, pressed by ``strain`` both ways."""
    element = Element(material, (pressure, pressure, 0.0, 2.0 * material.poisson * pressure))
    for _ in range(steps):
        element.take(strain / steps, strain / steps)
    return 0.5 * (element.stress[0] + element.stress[1])

"""One element of soil under prescribed strains and stresses: failure, dilation, pressure at rest, stiffness.

SI, compression positive.
"""

import math

import numpy as np

from continuum_sph.soil import Material
from continuum_sph.soil.plasticity import new_stress
from continuum_sph.soil.stress import XX, YY
from continuum_sph.validation.soil.setups import DENSITY, POISSON, TAN_PHI
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations

EPS = float(np.finfo(np.float64).eps)
VALIDATIONS = Validations()

ROUNDS = 62  # of halving an interval that starts twenty strain steps wide: 1e-17 of a step


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
        gradient = -across, -shear - turn, -shear + turn, -upright
        found: tuple[float, ...] = new_stress(self.stress, 0.0, gradient, 1.0, self.opening, self.plastic, self.row)
        return found

    def take(self, across: float, upright: float, shear: float = 0.0, turn: float = 0.0) -> None:
        """Apply the strain and rotation of `after`: stress, opening and plastic strain are overwritten."""
        *stress, self.opening, flow = self.after(across, upright, shear, turn)
        self.stress, self.plastic = tuple(stress), self.plastic + flow
        self.strain += across, upright

    def press(self, upright: float) -> None:
        """Strain it upright under the stress that it has across: the strain across is found by halving."""
        kept = self.stress[0]
        low, high = -20.0 * abs(upright), 20.0 * abs(upright)
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


def failure_ratio(friction: float, dilatancy: float = 0.0) -> float:
    """σ1/σ3 of an element pressed to failure under 100 kPa; sines of the angles."""
    element, _ = biaxial(Material(1e7, DENSITY, sin_friction=friction, sin_dilatancy=dilatancy), 1e5, 0.05)
    return element.stress[YY] / element.stress[XX]


@VALIDATIONS.row(
    "continuum.soil_fails_at_three_to_one",
    source="Maeda & Sakai 2004: τ_f = p tan φ, tan φ = 0.5; Mohr-Coulomb, φ = 30°: (1 + sin φ)/(1 - sin φ)",
    because="the way back to yield is exact; the strain across is halved down to 1e-18 of 5e-4, which leaves the "
    "stress across round-off, in 400 steps",
    tolerance=3.0 * 400 * 2.0 * EPS,
)
def biaxial_row() -> Measured:
    """σ1/σ3 of a biaxial element at failure, without dilatancy and with ψ = φ."""
    return Measured.absolute(3.0, [failure_ratio(TAN_PHI), failure_ratio(TAN_PHI, TAN_PHI)])


def dilation(dilatancy: float) -> float:
    """-dε_v/dγ of an element that fails in a biaxial test with ψ of that sine."""
    _, rows = biaxial(Material(1e7, DENSITY, sin_friction=TAN_PHI, sin_dilatancy=dilatancy), 1e5)
    upright, across = rows[-1, :2] - rows[-11, :2]
    return float(-(upright + across) / (upright - across))


@VALIDATIONS.row(
    "continuum.soil_dilates_as_told",
    source="definition of the angle of dilatancy in plane strain: dε_v = -sin ψ dγ",
    because="strains of ten steps of 5e-5, each across found to 1e-18 of 2e-4 but added up to 0.02: round-off of that, "
    "over ten steps",
    tolerance=0.02 * 20.0 * EPS / (10 * 5e-5),
)
def dilation_row() -> Measured:
    """-dε_v/dγ at failure for sin ψ = 0, 0.2, 0.5."""
    wanted = [0.0, 0.2, 0.5]
    return Measured.absolute(wanted, [dilation(value) for value in wanted])


def confined(material: Material, strain: float = 0.01, steps: int = 100) -> Element:
    """An element without stress pressed by ``strain`` upright that cannot widen."""
    element = Element(material, (0.0, 0.0, 0.0, 0.0))
    for _ in range(steps):
        element.take(0.0, strain / steps)
    return element


def rest_ratio(modulus: str, yields: bool = True) -> float:
    """K0 of an element that is pressed and cannot widen."""
    element = confined(Material(1e7, DENSITY, sin_friction=TAN_PHI, modulus=modulus, yields=yields))
    return element.stress[XX] / element.stress[YY]


@VALIDATIONS.row(
    "continuum.soil_pressure_at_rest",
    source="derived: plane strain ν/(1 - ν), elastic (G/B = 0.4 < 0.5); eq. 43's modulus has G/B = 0.538 > 0.5, yields "
    "at once and keeps (1 - 0.5)/(1 + 0.5); elastic it would keep ν",
    because="100 equal steps: round-off of each",
    tolerance=100 * EPS,
)
def rest_row() -> Measured:
    """K0 with the plane-strain modulus, with eq. 43 of Maeda & Sakai 2004, and with the latter without yield."""
    wanted = [POISSON / (1.0 - POISSON), 1.0 / 3.0, POISSON]
    found = [rest_ratio("plane strain"), rest_ratio("printed"), rest_ratio("printed", yields=False)]
    return Measured.absolute(wanted, found)


def squeezed(material: Material, pressure: float, strain: float, steps: int) -> float:
    """Mean stress (Pa) of an element under ``pressure`` (Pa) from all sides, pressed by ``strain`` both ways."""
    element = Element(material, (pressure, pressure, 0.0, 2.0 * material.poisson * pressure))
    for _ in range(steps):
        element.take(strain / steps, strain / steps)
    return 0.5 * (element.stress[0] + element.stress[1])


GROWING = Material(1e7, DENSITY, exponent=0.5, yields=False)
SQUEEZE = (1e5, 0.004, 100)  # Pa, strain both ways, steps


def stiffened(material: Material = GROWING) -> tuple[float, float]:
    """(exact mean stress, Pa, of an element of `GROWING` squeezed from all sides, the one that ``material`` finds)."""
    pressure, strain, steps = SQUEEZE
    slope = 0.5 * GROWING.area_modulus * GROWING.stiffness / math.sqrt(GROWING.reference)
    return (math.sqrt(pressure) + slope * 2.0 * strain) ** 2, squeezed(material, pressure, strain, steps)


@VALIDATIONS.row(
    "continuum.soil_stiffens_with_pressure",
    source="exact: dp = B0 (p/p0)^m dε_v of eq. 42 with m = 0.5: √p grows evenly",
    because="midpoints: a step h misses -h² a²/4 (ln √p)' of p, a = (√p)': 1.48/4 ln(438/316) Pa of 0.19 MPa, and as "
    "much again for the next order",
    tolerance=2.0 * 0.12 / 1.9e5,
)
def stiffness_row() -> Measured:
    """Mean stress of an element squeezed from all sides, 0.1 MPa to 0.19 MPa in 100 steps."""
    return Measured.relative(*stiffened())

"""Flows in which collision operators differ: moving frames, thin shear layers, eddy viscosity.  Lattice units."""

import math

import numpy as np

from porescale.common.core.types import Reals
from porescale.common.evidence.validations import Measured, Validations
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.choose import OPERATORS
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import relaxation_time, viscosity
from porescale.validation.lbm import channels
from porescale.validation.lbm.channels import run

PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")


def wave_viscosity(operator: str, frame: float, *, cells: int = 32, tau: float = 0.6, size: float = 1e-4) -> float:
    """Viscosity over that of the relaxation time, from the decay of a shear wave that is carried along x.

    The wave, v = size sin(2 pi x/cells), moves with the fluid at ``frame``; a quarter of its decay time is left out,
    half of it is measured.
    """
    k = 2 * math.pi / cells
    fluid = Fluid(cells, 4, tau, operator=operator, sides=PERIODIC)
    fluid.set_flow(frame, size * np.sin(k * np.arange(cells))[None, :])
    half = round(0.5 / (viscosity(tau) * k**2))
    run(fluid.advance, half // 2)
    first = _amplitude(fluid)
    run(fluid.advance, half)
    return math.log(first / _amplitude(fluid)) / (viscosity(tau) * k**2 * half)


def _amplitude(fluid: Fluid) -> float:
    return float(np.abs(np.fft.fft(fluid.fields()[2][0])[1]))


def shear_layers(
    operator: str, *, cells: int = 128, reynolds: float = 1e4, speed: float = 0.05, passages: float = 2.0
) -> Reals:
    """Kinetic energy over that at the start, at ten times, (10,), of two thin shear layers that roll up.

    Minion & Brown 1997: u = tanh(80 (y - 1/4)) or tanh(80 (3/4 - y)), v = 0.05 sin(2 pi (x + 1/4)) in a periodic unit
    square, Re = speed * side / viscosity.  passages: time in units of side/speed.
    """  # fmt: skip
    fluid = Fluid(cells, cells, relaxation_time(speed * cells / reynolds), operator=operator, sides=PERIODIC)
    y, x = (np.mgrid[0:cells, 0:cells] + 0.5) / cells
    ux = speed * np.tanh(80 * np.where(y < 0.5, y - 0.25, 0.75 - y))
    uy = 0.05 * speed * np.sin(2 * math.pi * (x + 0.25))
    fluid.set_flow(ux, uy)
    start = np.sum(ux**2 + uy**2)
    energy = np.empty(10)
    with np.errstate(all="ignore"):  # an operator that blows up is a result
        for k in range(10):
            for _ in range(round(passages * cells / speed / 10)):
                fluid.advance()
            _, ux, uy = fluid.fields()
            energy[k] = np.sum(ux**2 + uy**2) / start
    return energy


def eddy_channel(
    operator: str, height: int = 32, *, smagorinsky: float = 2.0, tau: float = 0.6, force: float = 3e-5
) -> tuple[Reals, Reals]:
    """Velocity of each row of a driven channel whose viscosity is nu + C²|u'|, measured and exact, (height,).

    Exact: (nu + C²|u'|) u' = -F (y - H/2), so |u'| = (sqrt(nu² + 4 C² F s) - nu)/(2 C²) at a distance s from the
    middle, integrated from the wall.  Started from it, and run for ten memories H²/(pi² nu).  The constant is large
    so that eddies and molecules count alike in a slow flow.
    """
    nu, square = viscosity(tau), smagorinsky**2
    s = np.abs(np.arange(height) + 0.5 - height / 2)

    def integral(s: Reals) -> Reals:
        """Integral over s of the shear rate at a distance ``s`` from the axis, lattice units."""
        return ((nu**2 + 4 * square * force * s) ** 1.5 / (6 * square * force) - nu * s) / (2 * square)

    exact = integral(np.array(height / 2)) - integral(s)
    fluid = Fluid(
        3, height, tau, operator=operator, smagorinsky=smagorinsky, force=(force, 0.0),
        sides=Sides("periodic", "periodic"),
    )  # fmt: skip
    fluid.set_flow(exact[:, None], 0.0)
    run(fluid.advance, round(10 * height**2 / (math.pi**2 * nu)))
    return fluid.fields()[1][:, 1], exact


VALIDATIONS = Validations()

FRAMES = (0.05, 0.1, 0.2)
CELLS = 32
HEIGHT = 32
SPEEDS = (0.05, 0.2)
WAVE_NUMBER = 2 * np.pi / CELLS


@VALIDATIONS.row(
    "lbm.taylor_green_order_of_each_operator",
    source="Taylor & Green 1937, vortices that a uniform flow carries; diffusive scaling",
    because="the next term of the error is fourth order: (16/32)² of a few % of 16's own error, 0.01; 0.1 required",
    tolerance=0.1,
)
def taylor_green() -> Measured:
    """Order of convergence over 16, 32 and 64 cells, of every operator."""
    orders = [
        channels.order([channels.taylor_green(cells, operator=name) for cells in (16, 32, 64)]) for name in OPERATORS
    ]
    return Measured.absolute([2.0] * len(orders), orders)


@VALIDATIONS.row(
    "lbm.viscosity_in_a_moving_frame",
    source="Galilean invariance: no change;  central moments (Geier, Greiner & Korvink 2006)",
    because="dispersion of the lattice, k² V² of the viscosity at V = 0.2 and 32 cells: 0.0015",
    tolerance=float((WAVE_NUMBER * FRAMES[-1]) ** 2),
)
def frame_central() -> Measured:
    """Largest relative change of a shear wave's viscosity with the speed of the frame, central moments."""
    return Measured.absolute([1.0] * len(FRAMES), in_frames("central"))


def in_frames(operator: str) -> list[float]:
    """Viscosity in each of the `FRAMES` over that at rest."""
    rest = wave_viscosity(operator, 0.0, cells=CELLS)
    return [wave_viscosity(operator, frame, cells=CELLS) / rest for frame in FRAMES]


@VALIDATIONS.row(
    "lbm.viscosity_of_a_second_order_equilibrium_in_a_moving_frame",
    source="1 - 3 V²: the cubic defect of the equilibrium (Qian & Zhou 1998)",
    because="dispersion of the lattice, k² = 0.04 of the defect 3 V² at V = 0.2, and k² V²",
    tolerance=float(WAVE_NUMBER**2 * (3 + 1) * FRAMES[-1] ** 2),
)
def frame_trt() -> Measured:
    """Viscosity in a moving frame with two relaxation times, against the exact defect."""
    return Measured.absolute([1 - 3 * frame**2 for frame in FRAMES], in_frames("trt"))


@VALIDATIONS.row(
    "lbm.eddy_viscosity_in_a_channel",
    source="exact profile of nu + C²|u'| in a driven channel (Smagorinsky 1963; Hou et al. 1996)",
    because="second order: the kink of u' in the middle is smeared over a cell, 1/H of the slope there and 1/H of its"
    " length, 2/H² of the peak",
    tolerance=2 / HEIGHT**2,
)
def eddies() -> Measured:
    """Largest deviation of the profile over the peak, of every operator."""
    pairs = [eddy_channel(name, HEIGHT) for name in OPERATORS]
    worst = max(float(np.abs(found - exact).max() / exact.max()) for found, exact in pairs)
    return Measured([1.0] * len(pairs), [float(found.max() / exact.max()) for found, exact in pairs], worst)


@VALIDATIONS.row(
    "lbm.thin_shear_layers_stay_stable",
    source="Minion & Brown 1997, Re 1e4 on 128² cells, layers of 1.6 cells: kinetic energy falls",
    because="no flow without force gains energy; from one tenth of the time to the next it loses 0.2 % and more",
    tolerance=0.0,
)
def layers() -> Measured:
    """Largest gain of energy between two of ten times, lid speeds 0.05 and 0.2, central moments; nan if it blew up."""
    energies = [shear_layers("central", speed=speed) for speed in SPEEDS]
    gain = max(float(np.diff(energy, prepend=1.0).max()) for energy in energies)
    return Measured(
        [1.0] * len(SPEEDS), [float(energy[-1]) for energy in energies], gain if np.isnan(gain) else max(gain, 0.0)
    )

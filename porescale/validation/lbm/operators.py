"""Validations of collision operators beside one another."""

from __future__ import annotations

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.lbm.collision.choose import OPERATORS
from porescale.validation.lbm import channels_flows as channels
from porescale.validation.lbm import operators_flows as lab

VALIDATIONS = Validations()

FRAMES = (0.05, 0.1, 0.2)
CELLS = 32
HEIGHT = 32
SPEEDS = (0.05, 0.2)
WAVE_NUMBER = 2 * np.pi / CELLS


@VALIDATIONS.row(
    "lbm.taylor_green_order_of_each_operator",
    source="Taylor & Green 1937, vortices that a uniform flow carries; diffusive scaling",
    because="the next term of the error is fourth order: (16/32)² of a few % of 16's own error, 0.01; 0.1 asked for",
    tolerance=0.1,
)
def taylor_green() -> Measured:
    """Order of convergence over 16, 32 and 64 cells, of every operator."""
    orders = [
        channels.order([channels.taylor_green(cells, operator=name) for cells in (16, 32, 64)]) for name in OPERATORS
    ]
    return Measured([2.0] * len(orders), orders, max(abs(found - 2.0) for found in orders))


@VALIDATIONS.row(
    "lbm.viscosity_in_a_moving_frame",
    source="Galilean invariance: no change;  central moments (Geier, Greiner & Korvink 2006)",
    because="dispersion of the lattice, k² V² of the viscosity at V = 0.2 and 32 cells: 0.0015",
    tolerance=float((WAVE_NUMBER * FRAMES[-1]) ** 2),
)
def frame_central() -> Measured:
    """Largest relative change of a shear wave's viscosity with the speed of the frame, central moments."""
    rest = lab.wave_viscosity("central", 0.0, cells=CELLS)
    found = [lab.wave_viscosity("central", frame, cells=CELLS) / rest for frame in FRAMES]
    return Measured([1.0] * len(FRAMES), found, max(abs(value - 1) for value in found))


@VALIDATIONS.row(
    "lbm.viscosity_of_a_second_order_equilibrium_in_a_moving_frame",
    source="1 - 3 V²: the cubic defect of the equilibrium (Qian & Zhou 1998)",
    because="dispersion of the lattice, k² = 0.04 of the defect 3 V² at V = 0.2, and k² V²",
    tolerance=float(WAVE_NUMBER**2 * (3 + 1) * FRAMES[-1] ** 2),
)
def frame_trt() -> Measured:
    """The same of two relaxation times, against the known defect."""
    rest = lab.wave_viscosity("trt", 0.0, cells=CELLS)
    found = [lab.wave_viscosity("trt", frame, cells=CELLS) / rest for frame in FRAMES]
    exact = [1 - 3 * frame**2 for frame in FRAMES]
    return Measured(exact, found, max(abs(a - b) for a, b in zip(found, exact, strict=True)))


@VALIDATIONS.row(
    "lbm.eddy_viscosity_in_a_channel",
    source="exact profile of nu + C²|u'| in a driven channel (Smagorinsky 1963; Hou et al. 1996)",
    because="second order: the kink of u' in the middle is smeared over a cell, 1/H of the slope there and 1/H of its"
    " length, 2/H² of the peak",
    tolerance=2 / HEIGHT**2,
)
def eddies() -> Measured:
    """Largest deviation of the profile over the peak, of every operator."""
    worst, tops = 0.0, []
    for name in OPERATORS:
        found, exact = lab.eddy_channel(name, HEIGHT)
        worst = max(worst, float(np.abs(found - exact).max() / exact.max()))
        tops.append(float(found.max() / exact.max()))
    return Measured([1.0] * len(tops), tops, worst)


@VALIDATIONS.row(
    "lbm.thin_shear_layers_stay_stable",
    source="Minion & Brown 1997, Re 1e4 on 128² cells, layers of 1.6 cells: kinetic energy falls",
    because="no flow without force gains energy; from one tenth of the time to the next it loses 0.2 % and more",
    tolerance=0.0,
)
def layers() -> Measured:
    """Largest gain of energy between two of ten times, lid speeds 0.05 and 0.2, central moments; nan if it blew up."""
    energies = [lab.shear_layers("central", speed=speed) for speed in SPEEDS]
    gain = max(float(np.diff(energy, prepend=1.0).max()) for energy in energies)
    return Measured(
        [1.0] * len(SPEEDS), [float(energy[-1]) for energy in energies], gain if np.isnan(gain) else max(gain, 0.0)
    )

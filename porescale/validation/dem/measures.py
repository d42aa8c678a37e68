"""Validations of what is measured on grains: porosity, stress, fabric and coarse-grained fields, all known exactly."""

from __future__ import annotations

import math

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.dem import discs_trials as lab
from porescale.validation.dem import measures_trials as measured

VALIDATIONS = Validations()

COMMENSURATE = (((0.0, 0.0), (8.0, 6.0)), ((1.0, 2.0), (3.0, 5.0)), ((0.5, 0.5), (3.5, 2.5)), ((0.3, 0.2), (2.3, 3.2)))
"""Corners, in diameters, of regions whole numbers of diameters wide and high: any such region holds whole discs."""
CUTS = (0.1, 0.25, 0.4)
GOLDHIRSCH = "Goldhirsch 2010, Granular Matter 12, 239; at walls Weinhart et al. 2012, Granular Matter 14, 289"


@VALIDATIONS.row(
    "dem.porosity_of_a_square_lattice",
    source="n = 1 - pi/4 for touching discs on a square lattice; circular segments where an edge cuts them",
    because="round-off: sums of some 40 disc areas of order one, each from a dozen terms, over areas of 4 or more",
    tolerance=1e-14,
)
def square_lattice() -> Measured:
    """Porosity from regions that hold whole discs wherever they lie, and from regions whose edge cuts a row."""
    whole = [measured.square_lattice_porosity(*corners) for corners in COMMENSURATE]
    cut = [measured.square_lattice_porosity((0.0, 0.0), (2.0, 2.0 - shift)) for shift in CUTS]
    exact = [1.0 - math.pi / 4.0] * len(whole) + [measured.cut_lattice_porosity(shift) for shift in CUTS]
    return Measured(exact, whole + cut, float(np.abs(np.subtract(whole + cut, exact)).max()))


@VALIDATIONS.row(
    "dem.stress_of_a_loaded_column",
    source="balance of forces: stress times width = load + weight above (Love 1927, Weber 1966)",
    because="overlaps of 1e-4 m are read off positions known to 3e-17 m, 3e-13; ten times that where a step's round-off"
    " keeps it moving",
    tolerance=3e-12,
)
def column() -> Measured:
    """Vertical stress between neighbouring centres of twelve discs under 1 kN/m."""
    found, exact = measured.column_stress(*measured.loaded_column())
    return Measured(exact.tolist(), found.tolist(), lab.relative(found, exact))


@VALIDATIONS.row(
    "dem.hexagonal_packing_under_pressure",
    source="sigma = sqrt(3) k strain/(1 - strain) times unity, coordination 6, fabric one half of unity",
    because="overlaps of 2e-5 m are read off positions of 0.1 m known to 1.4e-17 m, 7e-13",
    tolerance=2e-12,
)
def hexagonal() -> Measured:
    """Stress over its exact value (xx, yy, xy), coordination number and fabric (xx, yy, xy), periodic, strain 1e-3."""
    stress, neighbours, fabric = measured.lattice_stress(measured.pressed_lattice())
    scaled = stress / measured.pressed_lattice_stress()
    found = [
        scaled[0, 0],
        scaled[1, 1],
        scaled[0, 1],
        neighbours,
        *(fabric.tensor[k] for k in ((0, 0), (1, 1), (0, 1))),
    ]
    exact = (1.0, 1.0, 0.0, 6.0, 0.5, 0.5, 0.0)
    return Measured(exact, [float(it) for it in found], float(np.abs(np.subtract(found, exact)).max()))


@VALIDATIONS.row(
    "dem.stress_of_a_strained_cell",
    source="Love 1927, Weber 1966 with images of the sheared cell; virial of Evans & Morriss 1990, section 6.3",
    because="overlaps of some 1e-4 m are read off places of 0.1 m, images of images, known to 1e-16 m: 1e-12, and"
    " members of clumps share forces as large",
    tolerance=1e-11,
)
def strained() -> Measured:
    """Stress of a rectangle across the sides of a cell, over its largest part, of discs and of clumps (xx, xy, yx,
    yy)."""
    pairs = [measured.strained_stress(clumps) for clumps in (False, True)]
    found, exact = (np.array([pair[k] / np.abs(pair[1]).max() for pair in pairs]).ravel() for k in (0, 1))
    return Measured(exact.tolist(), found.tolist(), float(np.abs(found - exact).max()))


@VALIDATIONS.row(
    "dem.coarse_grained_mass",
    source=GOLDHIRSCH + "; weights scaled to one on the grid",
    because="round-off of sums over 60 discs and some thousand cells, growing like its root",
    tolerance=1e-13,
)
def mass() -> Measured:
    """Integral of density, of solid fraction and of contact stress over mass, area, and force times branch, in a heap
    whose walls cut the kernels off."""
    found = measured.totals(measured.heap())
    return Measured((1.0, 1.0, 1.0), found.tolist(), float(np.abs(found - 1.0).max()))


@VALIDATIONS.row(
    "dem.coarse_grained_momentum",
    source=GOLDHIRSCH + ": div sigma = rho g + wall force at rest",
    because="central differences err by h²/6 s''': Lucy's third derivative is at most 48/c³, the stress at most that of"
    " five widths of height, so (48/6) 5 (h/c)² = 1e-2 at 64 cells a width",
    tolerance=1e-2,
)
def momentum() -> Measured:
    """Largest imbalance over the largest weight of a heap at rest, everywhere, walls included."""
    worst = measured.imbalance(measured.heap_fields(measured.heap(), 64))
    return Measured(0.0, worst, worst)


@VALIDATIONS.row(
    "dem.rigid_rotation_has_no_strain_rate",
    source="affine motion fitted by least squares, Itasca PFC measurement regions",
    because="round-off: eps times the speed of 2.6 m/s over (0.01)² of the worst second moment admitted and the width,"
    " 2e-10 1/s",
    tolerance=2e-10,
)
def rigid() -> Measured:
    """Largest strain rate (1/s) on a grid over a heap that moves as one body at 2 m/s and 3 rad/s, and its rotation."""
    fields = measured.heap_fields(measured.turned(measured.heap()), 8)
    strain = float(np.nanmax(np.abs(fields.strain_rate)))
    gradient = fields.velocity_gradient
    spin = float(np.nanmax(np.abs(0.5 * (gradient[..., 1, 0] - gradient[..., 0, 1]) - 3.0)))
    return Measured((0.0, 0.0), (strain, spin), max(strain, spin))

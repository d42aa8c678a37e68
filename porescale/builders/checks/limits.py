"""Every threshold that ``check`` warns from: those of the map of stability (coupling/limits.py), and a few that no map
has.

A scene is judged before it runs, by the largest speed to expect: its cell Reynolds number |u| h/nu, its Mach number,
its pressures, and the cells that its grains have.
"""

from porescale.coupling import limits
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.lbm.scales import Scales

DENSITY_WARN, DENSITY_REFUSE = 0.05, limits.DENSITY
"""Density variation by the weight of a column: measured runs varied by twice this estimate (0.05: 4-10 %)."""
MACH_WARN, MACH_REFUSE = 0.1, limits.MACH
"""Errors of compressibility grow as the square of the Mach number: 1 % at the first."""
CELLS_THICK = 2.0
"""A rectangle thinner than this may fill no cell wholly, wherever it lies, and lets fluid through."""
SOUND_WARN = 0.3
"""Angle of an oscillation in which sound crosses the box, rad: it changes pressures by its square, a tenth.  In the map
(coupling.sound) damping is right up to it with exact walls and the operator with two relaxation times, with 5 cells per
diameter and more."""
RING_CELLS = 4.0
"""Fewest cells across the hole of a ring."""
SMALLEST = 0.7
"""Smallest over mean diameter below which the smallest grain is judged by itself: its drag, per weight, is twice as
large, 1/0.7²."""
CELLS_LEAST = 3.0
"""Cells per hydraulic diameter below which a grain is hardly there for the fluid: fewest that any map has tried."""
SINGLE_PRECISION = 1e-5
"""Speed in cells per step at which the round-off of float32, 6e-8 of populations of order 0.1 and collected over a
momentum's memory of some hundred steps, is about a hundredth of it."""


def thin(scales: Scales, speed: float, operator: str, *, eddies: bool, lid: bool) -> str:
    """Where a speed (m/s) is more than the viscosity damps, the measured limit and a repair; "" where not."""
    reynolds, holds = speed * scales.spacing / scales.viscosity, limits.cell_reynolds(operator, eddies=eddies, lid=lid)
    if reynolds <= holds:
        return ""
    what = f"{operator!r}{' with eddies' if eddies else ''}{' under a moving lid' if lid else ''}"
    best = ""
    if limits.cell_reynolds(limits.STEADIEST, eddies=eddies, lid=lid) >= reynolds:
        best = f", or take operator = {limits.STEADIEST!r}"
    elif not eddies and limits.cell_reynolds(limits.STEADIEST, eddies=True, lid=lid) >= reynolds:
        best = f", or take operator = {limits.STEADIEST!r} with smagorinsky = 0.1"
    return (
        f"relaxation time {scales.relaxation_time:.4f} at a speed of {speed:.3g} m/s: cell Reynolds number"
        f" {reynolds:.3g}, and {what} is known to hold up to {holds:g};"
        f" a spacing of {0.95 * holds / reynolds * scales.spacing:.2g} m keeps below it{best}"
    )


def light(ratio: float, cells: float, solid_operator: str, weighting: str, spacing: float) -> str:
    """Where free grains of a density ratio and size (cells per diameter) are beyond the stability limit; a repair."""
    least = limits.lightest(cells, solid_operator, weighting)
    if ratio >= least:
        return ""
    sizes = sorted({size for rows in limits.LIGHTEST.values() for size, _ in rows})
    enough = [size for size in sizes if limits.lightest(size, solid_operator, weighting) <= ratio]
    finer = (
        f"a spacing of {spacing * cells / enough[0]:.2g} m gives them {enough[0]:g}" if enough else "take heavier ones"
    )
    return (
        f"density ratio {ratio:.3g} with {cells:.3g} cells per grain: less than {least:g} is not known to hold with so"
        f" few; {finer}"
    )


def coarse(cells: float, solid_operator: str, weighting: str, spacing: float, solid_fraction: float = 0.0) -> str:
    """Where bodies have too few cells per diameter for their drag to be within a tenth, and what repairs it.

    solid_fraction : of a bed, with the radii used in the fluid; 0 for single bodies.
    """
    name = f"{solid_operator} {weighting}"
    needed = limits.CELLS_RIGHT.get(name, max(limits.CELLS_RIGHT.values()))
    if solid_fraction:
        needed = max(needed, limits.cells_in_bed(solid_fraction, solid_operator, weighting))
    if cells >= needed:
        return ""
    bed = f" in a bed of solid fraction {solid_fraction:.2g}" if solid_fraction else ""
    if needed == float("inf"):
        return f"{bed.strip()} drag is off by a tenth or more at any resolution tried; [permeability] measures it"
    return (
        f"{cells:.3g} cells per diameter{bed}: below {needed:g} the drag is off by a tenth or more;"
        f" a spacing of {spacing * cells / needed:.2g} m gives as many"
    )


def coarse_smallest(smallest: float, mean: float, spacing: float) -> str:
    """Where the smallest grains have too few cells per hydraulic diameter, though the mean ones may have enough."""
    if smallest >= CELLS_LEAST:
        return ""
    return (
        f"{smallest:.2g} cells per hydraulic diameter of the smallest grain ({mean:.2g} of the mean): below"
        f" {CELLS_LEAST:g} its drag and pores are not there; a spacing of {spacing * smallest / CELLS_LEAST:.2g} m"
        " gives as many, or narrow the sizes"
    )


def slow(relaxation_time: float, solid_operator: str) -> str:
    """Where the relaxation time is too long for drag to be right.

    Up to 2 the lattice's own viscosity is right (lbm.shear).
    """
    most = SOLID_OPERATORS[solid_operator].longest_relaxation_time
    if relaxation_time <= most:
        return ""
    return f"relaxation time {relaxation_time:.3g}: above {most:g} viscosity or drag is off; shorten the step"

"""The permeability of a bed as it stands: grains held, a body force drives slow flow through them.

Darcy: K = mu U/G,  U superficial velocity (that of the conserved flux, without half the force), G what drives it.
Where the window is the whole of a periodic box the flow is periodic and G the body force itself.  Any other window is
followed along the flow by its mirror image, which has pressure constant over both faces, and has slip on its flanks,
as between mirrors; discs are cut by the faces, those with their centre beyond are left out, so G is read as in a
permeameter: body force less pressure gradient, fitted to the mean pressure of the rows at least a diameter inside.

Compared to  Gebart 1992, flow across regular arrays of cylinders of solid fraction c,
K/R² = C (sqrt(c_max/c) - 1)^(5/2),  square C = 16/(9 pi sqrt 2), c_max = pi/4,  hexagonal 16/(9 pi sqrt 6) and
pi/(2 sqrt 3);  and Kozeny & Carman,  K/R² = (1 - c)³/(4 k c²),  k = 5.  R, d and c are those used in the fluid: lambda
times the grains'.

Grains have the solid operator for narrow gaps unless another is given: gaps of a few cells carry what they should, and
K is there with half the cells (docs/theory/hydraulic_radius.md).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats, Reals
from porescale.coupling.limits import FOR_NARROW_GAPS, RECOMMENDED
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.solid.choose import solid_operator
from porescale.lbm.boundary.sides import Kind, Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import viscosity

TAU = 0.6
"""Relaxation time unless given: drag depends least on it where it is small."""
SLOWNESS = 1e-6
"""Body force over viscosity: Reynolds numbers of the pores stay below 1e-4."""
STEADY = 2e-5
"""Relative change of the flux over the last fifth of the steps, below which it is steady."""
FIRST, MOST = 500, 200_000
"""Steps before the flux is looked at for the first time, and at most: a sealed bed never gets steady."""
SHORTEST = 4.0
"""Diameters of the grains that a window has along the flow, which is no whole period: its ends disturb one each."""
KOZENY = 5.0


@dataclass(frozen=True)
class Measured:
    """Permeability of a window.  Lengths in the unit of the input: m.

    permeability : K, m²;  relative : K/d²;  solid_fraction : c of the discs in the fluid;  diameter : mean d of it, m;
    cells : per diameter;  steady : whether the flux was;  steps : of the lattice.
    """

    permeability: float
    relative: float
    solid_fraction: float
    diameter: float
    cells: float
    steady: bool
    steps: int


def gebart(solid_fraction: float, *, hexagonal: bool = False) -> float:
    """K/R² across a regular array of cylinders (Gebart 1992); 0 where they touch."""
    constant, densest = (6.0, math.pi / (2 * math.sqrt(3))) if hexagonal else (2.0, math.pi / 4)
    gap = math.sqrt(densest / solid_fraction) - 1
    return float(16 / (9 * math.pi * math.sqrt(constant)) * max(gap, 0.0) ** 2.5)


def kozeny_carman(solid_fraction: float) -> float:
    """K/R² of a bed of cylinders by its hydraulic radius, Kozeny constant 5."""
    return (1 - solid_fraction) ** 3 / (4 * KOZENY * solid_fraction**2)


def bed_of_spheres(porosity: float) -> float:
    """K/d² of a bed of spheres (Kozeny & Carman), what a bed of discs stands for in three dimensions."""
    return porosity**3 / (180.0 * (1.0 - porosity) ** 2)


def ratio_for(relative: float, solid_fraction: float) -> float | None:
    """Hydraulic radius ratio lambda at which a bed of discs of that ``solid_fraction``, as they are, has K/d².

    relative : K/d², d that of the grains.  By Gebart's hexagonal array of solid fraction lambda² c, which dense random
    beds follow within a tenth at 0.8: K/d² = (lambda/2)² K/R_h², falling with lambda.  None where even the largest or
    the least lambda, 1 and 0.01, has less or more.
    """

    def found(ratio: float) -> float:
        """K/d² at a ratio."""
        return 0.25 * ratio**2 * gebart(ratio**2 * solid_fraction, hexagonal=True)

    low, high = 0.01, 1.0
    if not found(high) <= relative <= found(low):
        return None
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if found(middle) > relative else (low, middle)
    return 0.5 * (low + high)


def standing(at: Floats, radius: Floats, extent: Sequence[float], whole: Sequence[bool]) -> NDArray[np.bool_]:
    """Which discs (n,) stand in a window: those with their centre between its faces that reach in between its flanks.

    at : centres (n, 2) from its lower corner, the direction of the flow first;  extent : its lengths in the same unit
    and order;  whole : along which of them it is a whole period, where all discs stand in it.
    """
    inside = np.ones(len(at), bool)
    for axis, length in enumerate(extent):
        reach = 0.0 if axis == 0 else radius
        if not whole[axis]:
            inside &= (at[:, axis] > -reach) & (at[:, axis] < length + reach)
    return inside


def with_images(
    position: Reals, radius: Reals, box: Sequence[float], periodic: Sequence[bool], extent: Sequence[float], near: float
) -> tuple[Floats, Floats, tuple[bool, bool]]:
    """Discs and their images through the periodic sides of a ``box``, as a window in it has them: centres (m, 2) and
    radii (m,), the discs first; and along which axes the window is a whole period, where no image is wanted.

    extent : lengths of the window, along x and y as those of the box, in the unit of ``position`` (n, 2);  near : by
    how much less than the box is as long.
    """
    at, size = np.asarray(position, float), np.asarray(radius, float)
    whole = [periodic[axis] and extent[axis] > box[axis] - near for axis in range(2)]
    for axis, length in enumerate(box):
        if periodic[axis] and not whole[axis]:
            shift = length * np.eye(2)[axis]
            at, size = np.concatenate([at, at - shift, at + shift]), np.tile(size, 3)
    return at, size, (whole[0], whole[1])


def measure(
    position: Reals,
    radius: Reals,
    lower: tuple[float, float],
    upper: tuple[float, float],
    spacing: float,
    *,
    direction: str = "y",
    periodic: tuple[bool, bool] = (False, False),
    walls: tuple[bool, bool] = (False, False),
    relaxation_time: float = TAU,
    laws: Mapping[str, Any] | None = None,
    solid_laws: Mapping[str, Any] | None = None,
) -> Measured:
    """Permeability of the discs at ``position`` (n, 2) m with the ``radius`` (n,) m used in the fluid.

    lower, upper : corners of the window, m;  spacing : of the lattice, m;  direction : of the flow, "x" or "y";
    periodic : whether the window is a whole period along x and y;  walls : whether a no-slip wall stands at its lower
    and its upper flank (otherwise the bed goes on like its mirror image);  relaxation_time, laws, solid_laws : of the
    lattice, keyword arguments of ``Fluid`` and ``SaturatedCells``: those of a run show what its bed lets through in it;
    left out, the solid operator for narrow gaps.

    Raises InputError for a window without discs or, unless it is periodic, shorter than four diameters; and for a magic
    parameter that the solid operator is not made for.
    """
    given = {"solid_operator": FOR_NARROW_GAPS} if solid_laws is None else solid_laws
    _check_magic(given, laws or {})
    order = [0, 1] if direction == "x" else [1, 0]  # the flow runs along the first axis
    at = (np.asarray(position, float) - lower)[:, order] / spacing
    size = (np.asarray(radius, float)) / spacing
    whole = [periodic[k] for k in order]
    cells = [round((upper[k] - lower[k]) / spacing - 1e-6) for k in order]
    inside = standing(at, size, cells, whole)
    at, size = at[inside], size[inside]
    if len(at) == 0:
        raise InputError(Fault("permeability.window", None, "holds no grain", repair="move it into the bed"))
    across = 2 * float(size.mean())
    margin = 0 if whole[0] else math.ceil(across)
    if not whole[0] and cells[0] < SHORTEST * across:
        problem = f"is {cells[0] / across:.2g} diameters long"
        allowed = f">= {SHORTEST:g} diameters along the flow"
        raise InputError(Fault("permeability.window", None, problem, allowed=allowed, repair="make it longer"))
    length = cells[0]
    if not whole[0]:
        at = np.concatenate([at, np.stack([2 * length - at[:, 0], at[:, 1]], axis=1)])
        size = np.concatenate([size, size])
    low: Kind = "periodic" if whole[1] else "wall" if walls[0] else "slip"
    high: Kind = "periodic" if whole[1] else "wall" if walls[1] else "slip"
    nu = viscosity(relaxation_time)
    fluid = Fluid(
        length if whole[0] else 2 * length, cells[1], relaxation_time, force=(SLOWNESS * nu, 0.0),
        sides=Sides("periodic", "periodic", low, high), **(laws or {}),
    )  # fmt: skip
    wet = SaturatedCells(fluid, size, **given)
    reach = wet.covering_radius
    below, above = (not whole[1] and not wall for wall in walls)  # flanks that are mirrors
    mirrored = (below & (at[:, 1] < reach)) | (above & (at[:, 1] > cells[1] - reach))
    wet.cut = np.flatnonzero(mirrored)
    k, share, steady = _flow(fluid, wet, at, length, margin)
    return Measured(
        k * spacing**2, k / across**2, share, across * spacing, across, steady, fluid.step,
    )  # fmt: skip


def _check_magic(solid_laws: Mapping[str, Any], laws: Mapping[str, Any]) -> None:
    """Refuse a magic parameter that the solid operator is not made for: K of narrow gaps would be some 10 % off."""
    name = solid_laws.get("solid_operator", RECOMMENDED)
    made_for = solid_operator(name).magic
    if made_for is not None and laws.get("magic", made_for) != made_for:
        problem = f"is not what the solid operator {name!r} is made for"
        repair = "leave it out, or name another solid_operator in solid_laws"
        raise InputError(Fault("laws.magic", laws["magic"], problem, allowed=f"{made_for:g}", repair=repair))


def _flow(fluid: Fluid, wet: SaturatedCells, at: Reals, length: int, margin: int) -> tuple[float, float, bool]:
    """K (cells²), solid fraction and whether steady, of discs held at ``at`` in flow along x, driven until steady.

    length : columns of the sample;  margin : of these, columns at each face that are left out of the gradient.
    """
    rest, no_spin = np.zeros_like(at), np.zeros(len(at))
    nu, force = viscosity(fluid.relaxation_time), fluid.force[0]
    flux, change, block = 0.0, 1.0, FIRST
    while abs(change) > STEADY and fluid.step < MOST:
        for _ in range(block):
            wet.advance(fluid, at, rest, no_spin)
        now = fluid.momentum()[0] / (fluid.nx * fluid.ny)
        flux, change = now, 1 - flux / now
        block = max(FIRST, fluid.step // 4 // 2 * 2)
    wet.covering_radius = wet.radius  # only looked at from here on: what is solid, without what walls need
    wet.cover(at, rest, no_spin)
    free = 1 - np.minimum(wet.solid[:, :length], 1)
    gradient = 0.0
    if margin:
        rho = fluid.fields()[0][:, :length]
        pressure = ((rho - 1) * free).sum(axis=0) / free.sum(axis=0) / 3
        x = np.arange(length)[margin : length - margin]
        gradient = float(np.polyfit(x, pressure[margin : length - margin], 1)[0])
    share = 1 - free[:, margin : length - margin or None]
    return nu * flux / (force - gradient), float(share.mean()), abs(change) <= STEADY

"""Fields and numbers of the fluid: rows of series.csv, vorticity, stream function."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from porescale.common.api.fields import Field
from porescale.common.core.types import Reals
from porescale.lbm.fields import stream_function
from porescale.lbm.fluid import Fluid
from porescale.lbm.scales import Scales
from porescale.lbm.totals import Totals
from porescale.output.lines import LAMBDA
from porescale.scene.grains import Grains


def ratio_column(grains: Grains | None) -> dict[str, float]:
    """The column of lambda, which every record of grains in fluid carries; none where grains have no such ratio.

    hydraulic radius ratio () : radius that the fluid sees, over that of the grain
    """
    return {LAMBDA: grains.hydraulic_radius_ratio} if grains and grains.hydraulic_radius_ratio else {}


def total_pressure(gravity: tuple[float, float], scales: Scales, excess: Reals) -> Reals:
    """Pressure (Pa) of a density excess (kg/m³), both (ny, nx): with the hydrostatic part that the lattice leaves out,
    zero in the upper left corner of the box."""
    ny, nx = excess.shape
    depth, across = (ny - 0.5 - np.arange(ny)) * scales.spacing, (np.arange(nx) + 0.5) * scales.spacing
    gx, gy = gravity
    still = scales.density * (-gy * depth[:, None] + gx * across[None, :])
    return np.asarray(excess / scales.density * scales.pressure + still)


def fluid_row(excess: Reals, ux: Reals, uy: Reals, solid: Reals, scales: Scales) -> dict[str, float]:
    """`flow_columns` of the fluid between the grains; arrays (ny, nx), SI."""
    square = ux**2 + uy**2
    energy = 0.5 * float(np.sum((scales.density + excess) * square * (1 - solid))) * scales.spacing**2
    extremes = float(excess.min()) / scales.density, float(excess.max()) / scales.density
    return flow_columns(energy, float(np.sqrt(square.max())), *extremes, scales)


def plain_row(totals: Totals, scales: Scales) -> dict[str, float]:
    """`flow_columns` of a fluid with nothing in it."""
    energy = totals.energy * scales.density * (scales.velocity * scales.spacing) ** 2
    return flow_columns(energy, totals.fastest * scales.velocity, totals.thinnest, totals.densest, scales)


def flow_columns(energy: float, speed: float, low: float, high: float, scales: Scales) -> dict[str, float]:
    """Columns of the series for the fluid: energy J/m, speed m/s, extremes of the relative density less 1.

    kinetic energy of fluid (J/m) : of the fluid between the grains, per metre of depth
    largest fluid speed (m/s) : in any cell
    Mach number () : that speed over the lattice's speed of sound
    lowest relative density () : in any cell, over the density at rest; below 1 where the fluid is thinned
    highest relative density () : in any cell, over the density at rest
    """
    return {
        "kinetic energy of fluid (J/m)": energy,
        "largest fluid speed (m/s)": speed,
        "Mach number ()": speed / scales.sound_speed,
        "lowest relative density ()": 1 + low,
        "highest relative density ()": 1 + high,
    }


UNITS = {"vorticity": "1/s", "stream_function": "m²/s"}
"""Fields that a scene may request besides velocity and pressure, and their units."""


def derived_fields(
    names: Sequence[str], fluid: Fluid, ux: Reals, uy: Reals, scales: Scales
) -> dict[str, NDArray[np.float32]]:
    """Fields called ``names`` in the centres of cells, (ny, nx), of a velocity (ny, nx) m/s of ``fluid``.

    The stream function is the mean of the four corners of a cell (lbm/fields.py).
    """
    fields = {}
    if "vorticity" in names:
        fields["vorticity"] = vorticity(ux, uy, scales.spacing).astype(np.float32)
    if "stream_function" in names:
        psi = stream_function(fluid, ux / scales.velocity, uy / scales.velocity)
        centres = 0.25 * (psi[1:, 1:] + psi[1:, :-1] + psi[:-1, 1:] + psi[:-1, :-1])
        fields["stream_function"] = (centres * scales.velocity * scales.spacing).astype(np.float32)
    return fields


def all_fields(
    gravity: tuple[float, float], scales: Scales, fluid: Fluid, excess: Reals, ux: Reals, uy: Reals, solid: Reals
) -> dict[str, Field]:
    """Every field of a fluid by name: speed and velocity (m/s), pressure (Pa), solid fraction, and those of UNITS.

    gravity : m/s²;  excess : of density, kg/m³;  ux, uy : m/s;  solid : fraction; each (ny, nx).
    """
    more = derived_fields(list(UNITS), fluid, ux, uy, scales)
    return {
        "speed": Field(np.hypot(ux, uy), "m/s"),
        "velocity_x": Field(np.array(ux), "m/s"),
        "velocity_y": Field(np.array(uy), "m/s"),
        "pressure": Field(total_pressure(gravity, scales, excess), "Pa"),
        "density": Field(scales.density + excess, "kg/m³"),
        "solid_fraction": Field(np.array(solid), ""),
        **{name: Field(more[name], unit) for name, unit in UNITS.items()},
    }


def vorticity(ux: Reals, uy: Reals, spacing: float) -> Reals:
    """dv/dx - du/dy in every cell, (ny, nx) 1/s: central differences, one-sided at the sides; in a box one cell wide
    nothing differs across it."""
    along: Reals = np.gradient(uy, spacing, axis=1) if uy.shape[1] > 1 else np.zeros_like(uy)
    up: Reals = np.gradient(ux, spacing, axis=0) if ux.shape[0] > 1 else np.zeros_like(ux)
    return along - up

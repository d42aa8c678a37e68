"""Air among the grains of a scene's soil: a second fluid of the layer of water.

Both fluids are particles of one layer in the pores, each takes up volume of its own, so together they fill them; what
flows through a unit area is water, air and grains (`continuum_sph.seepage`), and the sums over neighbours keep pressure
the same on both sides of a front.  Drag on air: β = n² μ_a/κ of the same intrinsic permeability κ = k μ_w/(ρ_w g), so
that ρ g/k of water stands there times μ_a/μ_w; its own conductivity is k_a = k (μ_w/μ_a) ρ_a/ρ_w.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from continuum_sph.scene.air import AirSection
from continuum_sph.scene.sections import Scene
from continuum_sph.scene.water import Column
from continuum_sph.seepage import PoreFlow
from continuum_sph.water.eos.law import Given
from continuum_sph.water.eos.register import laws
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.state import P
from porescale.common.api.report import Report
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.record.part import Part

WATER, AIR = 0, 1
"""Materials of the layer in pores."""
HEAVY = 0.03
"""Of the water's density: the pressure at which water stops would be off by as much."""


def air_fluid(air: AirSection) -> Fluid:
    """The air of a section."""
    law = laws()[air.law].of(Given(air.density, None, air.pressure, air.exponent, 0.0))
    return Fluid(law, air.viscosity)


class AirPart(Part):
    """Columns of the air in the pores of a ``flow``."""

    def __init__(self, flow: PoreFlow) -> None:
        self.flow = flow

    def row(self) -> dict[str, float]:
        """Columns of the air in series.csv, see `air_row`."""
        return air_row(self.flow)


def with_air(law: Law, fluid: Fluid) -> Law:
    """A law of water that has a gas as well."""
    return replace(law, fluids=(law.fluids[WATER], fluid))


def dry_pores(columns: tuple[Column, ...], soil: Floats) -> Floats:
    """Places (m, 2) m of ``soil`` particles (n, 2) that none of the ``columns`` of water covers."""
    covered = np.zeros(len(soil), np.bool_)
    for column in columns:
        right, top = column.left + column.width, column.bottom + column.height
        x, y = soil[:, 0], soil[:, 1]
        covered |= (x > column.left) & (x < right) & (y > column.bottom) & (y < top)
    return soil[~covered].copy()


def air_pores(scene: Scene, soil: Floats) -> Floats:
    """Places (m, 2) m of the air in pores of ``soil`` (n, 2) m, none without [air]; InputError where it has no room."""
    if scene.air is None:
        return np.zeros((0, 2))
    found = dry_pores(scene.water.column, soil)
    if not len(found):
        raise InputError(Fault("air", "given", "has no room: water.column covers all pores of the soil",
                               repair="lower the water, or take out [air]"))  # fmt: skip
    return found


def specific_weights(material: NDArray[np.int64], law: Law, gravity: float) -> Floats:
    """What stands for ρ g in the drag on each particle, (n,) N/m³: that of water times μ/μ_w."""
    viscosity = np.array([fluid.viscosity for fluid in law.fluids])
    found: Floats = (law.state.density * gravity * viscosity / viscosity[WATER])[material]
    return found


def air_report(out: Report, scene: Scene, law: Law, particles: int) -> None:
    """What the air of a scene adds to its report; warns of air that weighs too much."""
    assert scene.air is not None
    water, air = law.fluids[WATER], law.fluids[AIR]
    out.heading("air in pores")
    out.row("air particles", particles)
    out.row("goes through soil as water does", water.viscosity / air.viscosity, "times", "as easily")
    out.row("longest step for sound at its surface", law.limits(0.0, 0.0)[0], "s")
    weight = air.state.density * scene.gravity * scene.inner[1]
    out.row("weight of a column of it", weight, "Pa", f"pressure of the room {scene.air.pressure:g} Pa")
    if weight > HEAVY * scene.water.density * scene.gravity * scene.inner[1]:
        out.warn(f"air weighs {air.state.density / scene.water.density:.2g} of the water: lower air.density")


def air_row(flow: PoreFlow) -> dict[str, float]:
    """Mass of both fluids, what pore volume the air takes up, its pressures (above the room's) and how much is out.

    water: mass (kg/m) : per metre of depth
    air: mass (kg/m) : per metre of depth
    air: pore volume (m2) : what the air takes up
    air: mean pressure (Pa) : by volume, above the room's
    air: highest pressure (Pa) : above the room's
    air: share that has left the soil () : of its mass
    """
    layer, n = flow.layer, flow.layer.fluid
    air = layer.material[:n] == AIR
    mass, pressure = layer.mass[:n], layer.record[:n, P]
    volume = mass[air] / layer.density[air]
    whole, weight = float(volume.sum()), float(mass[air].sum())
    return {
        "water: mass (kg/m)": float(mass[~air].sum()),
        "air: mass (kg/m)": weight,
        "air: pore volume (m2)": whole,
        "air: mean pressure (Pa)": float((volume * pressure[air]).sum()) / whole,
        "air: highest pressure (Pa)": float(pressure[air].max()),
        "air: share that has left the soil ()": float(mass[air & (flow.porosity >= 1.0)].sum()) / weight,
    }

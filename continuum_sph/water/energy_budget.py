"""The energies of a flow and what became of them: a budget that closes.

kinetic + potential + compressive + heat (viscosity) + diffused (density diffusion) + stopped (at a wall's surface) less
the work of walls, of surface tension and of shifting stays what it was, but for the steps in time, for particles held
at the least density, and for XSPH, which moves particles, and the filter, which changes densities, otherwise than their
rates do.
"""

import numpy as np

from continuum_sph.water.state import BY_SHIFTING, BY_TENSION, BY_WALLS, DIFFUSIVE, STOPPED, VISCOUS
from continuum_sph.water.step import Flow

LOST, GIVEN = [VISCOUS, DIFFUSIVE, STOPPED], [BY_WALLS, BY_TENSION, BY_SHIFTING]


def held(flow: Flow) -> dict[str, float]:
    """Energies that flow and water hold, in J per metre of depth, by name."""
    layer, law = flow.layer, flow.law
    n = layer.fluid
    mass, v, x = layer.mass[:n], layer.v[:n], layer.x[:n]
    kinetic = 0.5 * float((mass * (v * v).sum(axis=1)).sum())
    potential = -float((mass * (x @ np.array(law.gravity))).sum())
    compressive = 0.0
    for number, fluid in enumerate(law.fluids):
        own = layer.material[:n] == number
        density = layer.density[own]
        if law.cut:
            density = np.maximum(density, fluid.state.density)
        compressive += float((mass[own] * fluid.state.energy(density)).sum())
    return {"kinetic energy": kinetic, "potential energy": potential, "compressive energy": compressive}


def budget(flow: Flow) -> dict[str, float]:
    """The same, what was turned over since `Layer.keep_budget`, "total energy", which is that held, and "energy
    balance", which adds what was turned over."""
    assert flow.layer.has_budget
    own, turned = held(flow), flow.layer.energy.sum(axis=0)
    total = sum(own.values())
    return own | {
        "heat of viscosity": float(turned[VISCOUS]),
        "energy diffused": float(turned[DIFFUSIVE]),
        "work of walls": float(turned[BY_WALLS]),
        "work of surface tension": float(turned[BY_TENSION]),
        "work of shifting": float(turned[BY_SHIFTING]),
        "energy stopped at walls": float(turned[STOPPED]),
        "total energy": total,
        "energy balance": total + float(turned[LOST].sum() - turned[GIVEN].sum()),
    }

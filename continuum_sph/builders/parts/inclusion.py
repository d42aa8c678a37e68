"""The second fluid of a scene: what it is, where it starts, how it rises, how round it is and in how many pieces."""

import numpy as np
from numpy.typing import NDArray

from continuum_sph.builders.initial_pressure import lattice_pressure
from continuum_sph.scene.inclusion import InclusionSection
from continuum_sph.scene.sections import Scene
from continuum_sph.water.eos.law import Given
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.eos.register import laws
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.step import Flow
from porescale.common.core.types import Floats
from porescale.common.record.part import Part

SMOOTH = 2.6  # spacings, the kernel that draws an outline: with half of that each particle is a bump in it
TOUCH = 1.6  # spacings: particles nearer belong together; neighbours across a diagonal are at 1.41


class InclusionPart(Part):
    """Columns of the second fluid in series.csv."""

    def __init__(self, flow: Flow) -> None:
        self.flow = flow

    def row(self) -> dict[str, float]:
        """Columns of the second fluid in series.csv, see `inclusion_row`."""
        return inclusion_row(self.flow)


def inclusion_fluid(given: InclusionSection, water: Tait) -> Fluid:
    """The second fluid of a section, in water of a state."""
    said = Given(given.density, given.sound_speed, given.pressure, given.exponent, water.stiffness)
    law = laws()[given.law].of(said)
    return Fluid(law, given.viscosity, given.cohesion)


def fill_inclusion(scene: Scene, law: Law, x: Floats, rho: Floats, material: NDArray[np.int64]) -> None:
    """Turn water at ``x`` (n, 2) m in the discs of the second fluid into it; overwrites there ``rho`` and ``material``.

    Its pressure is that of the water in its place, or that of both the instant they are released
    (`initial_pressure`), which overwrites all of ``rho``; and of surface tension σ/R more.
    """
    assert scene.inclusion is not None
    states, numerics = [fluid.state for fluid in law.fluids], scene.numerics
    pressure, pull = states[0].pressure(rho), np.zeros(len(x))
    for disc in scene.inclusion.disc:
        inside = np.flatnonzero(np.hypot(x[:, 0] - disc.x, x[:, 1] - disc.y) < disc.radius)
        pull[inside] = scene.inclusion.surface_tension / disc.radius
        material[inside] = 1
    if scene.water.pressure == "released":
        heavy = np.array([state.density for state in states])[material[: len(x)]]
        pressure = lattice_pressure(x, heavy, numerics.spacing, scene.gravity, scene.inner, scene.tank.lid)
    for number, state in enumerate(states):
        own = material[: len(x)] == number
        rho[own] = state.density_at(pressure[own] + pull[own])


def inclusion_row(flow: Flow) -> dict[str, float]:
    """Columns of the series: centre and mean velocity by volume, circularity, pieces of four particles and more.

    bubble centre x (m) : centre of the second fluid, by volume
    bubble centre (m) : height of its centre
    bubble rise (m/s) : mean upward velocity, by volume
    bubble area (m2) : its volume per metre of depth
    bubble circularity () : perimeter of the circle of its area over its own; 1 for a circle
    bubble pieces () : pieces of four particles and more
    """
    layer, n = flow.layer, flow.layer.fluid
    own = layer.material[:n] == 1
    x, volume = layer.x[:n][own], layer.mass[:n][own] / layer.density[own]
    share = volume / volume.sum()
    return {
        "bubble centre x (m)": float(share @ x[:, 0]),
        "bubble centre (m)": float(share @ x[:, 1]),
        "bubble rise (m/s)": float(share @ layer.v[:n, 1][own]),
        "bubble area (m2)": float(volume.sum()),
        "bubble circularity ()": circularity(layer.x[:n], layer.material[:n], flow.law.spacing),
        "bubble pieces ()": float(pieces(x, flow.law.spacing)),
    }


def circularity(x: Floats, fluid: NDArray[np.int64], spacing: float) -> float:
    """Perimeter of the circle of equal area over that of the second fluid: 1 when it is one round piece.

    Its outline is where the ``fluid`` (n,), 0 or 1, of the particles at ``x`` (n, 2) m, averaged over a kernel of
    SMOOTH ``spacing`` (m), is one half; area and perimeter are both the outline's.  Particles strewn over exact shapes
    give the accuracy: a disc of ten spacings and more has 0.996 to 0.999; an ellipse whose ends are as blunt as four
    spacings is right to 0.5 %; sharper corners are cut off, which makes the shape too round.
    """
    from contourpy import contour_generator
    from scipy.spatial import cKDTree  # takes longer to import than a scene to be judged

    h = SMOOTH * spacing
    own = x[fluid == 1]
    low, high = own.min(axis=0) - 4.0 * h, own.max(axis=0) + 4.0 * h
    near = ((x > low - 2.0 * h) & (x < high + 2.0 * h)).all(axis=1)
    xs, ys = (np.arange(low[axis], high[axis], 0.5 * spacing) for axis in (0, 1))
    places = np.column_stack([axis.ravel() for axis in np.meshgrid(xs, ys)])
    pairs = cKDTree(places).sparse_distance_matrix(cKDTree(x[near]), 2.0 * h, output_type="ndarray")
    rest = 1.0 - 0.5 * pairs["v"] / h
    weight = rest**4 * (5.0 - 4.0 * rest)  # Wendland C2
    below = np.bincount(pairs["i"], weight, len(places))
    above = np.bincount(pairs["i"], weight * fluid[near][pairs["j"]], len(places))
    share = np.divide(above, below, out=np.zeros(len(places)), where=below > 0.0)
    perimeter = area = 0.0
    for line in contour_generator(xs, ys, share.reshape(len(ys), len(xs))).lines(0.5):
        at = np.asarray(line)
        steps = np.diff(at, axis=0)
        perimeter += float(np.hypot(steps[:, 0], steps[:, 1]).sum())
        area += 0.5 * float((at[:-1, 0] * steps[:, 1] - at[:-1, 1] * steps[:, 0]).sum())
    return float(2.0 * np.sqrt(np.pi * abs(area)) / perimeter) if perimeter > 0.0 else 0.0


def pieces(x: Floats, spacing: float) -> int:
    """Number of groups of four and more of the points ``x`` (n, 2) m that hang together within `TOUCH` spacings."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(x).query_pairs(TOUCH * spacing, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(x), len(x)))
    _, label = connected_components(links, directed=False)
    return int((np.bincount(label) >= 4).sum())

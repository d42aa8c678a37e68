"""Consolidation of a layer with all of its inertia: Biot's equations along one axis, by finite differences.  SI."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats


def differences(cells: int, height: float) -> tuple[Floats, Floats]:
    """(slopes at faces of values in ``cells``, zero beyond both ends; slopes in cells of values at faces), 1/m each."""
    step = height / cells
    slopes = (np.eye(cells + 1, cells) - np.eye(cells + 1, cells, -1)) / step
    inside = -slopes.T.copy()
    slopes[[0, -1]] *= 2.0  # from the middle of a cell to its face is half a step
    return slopes, inside


def excess_pressures(
    times: Sequence[float], start: Floats, height: float, *,
    modulus: float, permeability: float, porosity: float, stiffness: float, soil: float, water: float, gravity: float,
) -> list[Floats]:  # fmt: skip
    """Excess pressures (Pa) in the middles of cells at rising ``times`` (s) in a layer drained at base and surface.

    start : such pressures at time 0, Pa, borne by soil before, which stands on the base under a load at its surface;
    water and soil pass each other as Darcy's law has it and displace nothing together.
    modulus M, Pa;  permeability, m/s;  stiffness : K_w/n, Pa;  soil, water : kg of each in a cubic metre of both.

    ρ_s' v_s' = σ' - (1 - n) u' + D (v_w - v_s),  ρ_w' v_w' = -n u' - D (v_w - v_s),  D = n² ρ_w g/k,
    ∂σ/∂t = M v_s',  ∂u/∂t = -(K_w/n) {(1 - n) v_s' + n v_w'}:  linear, so its exponential is all that is needed.

    Source: Biot, J. Acoust. Soc. Am. 28 (1956) 168, without added mass; Zienkiewicz, Chang & Bettess, Géotechnique 30
    (1980) 385, in one dimension.
    """
    from scipy.linalg import expm  # takes longer to import than a scene to be judged

    cells, n = len(start), porosity
    faces = cells + 1
    slopes, inside = differences(cells, height)
    v_s, v_w = slice(0, faces), slice(faces, 2 * faces)
    sigma, u = slice(2 * faces, 2 * faces + cells), slice(2 * faces + cells, 2 * faces + 2 * cells)
    drag = n * water * gravity / permeability * np.eye(faces)
    rates: NDArray[np.float64] = np.zeros((2 * faces + 2 * cells, 2 * faces + 2 * cells))
    rates[v_s, sigma], rates[v_s, u] = slopes / soil, -(1.0 - n) * slopes / soil
    rates[v_s, v_s], rates[v_s, v_w] = -drag / soil, drag / soil
    rates[v_w, u] = -n * slopes / water
    rates[v_w, v_w], rates[v_w, v_s] = -drag / water, drag / water
    rates[sigma, v_s] = modulus * inside
    rates[u, v_s], rates[u, v_w] = -stiffness * (1.0 - n) * inside, -stiffness * n * inside
    rates[0] = 0.0  # the base holds the soil
    state = np.zeros(len(rates))
    flux = -permeability * n / (water * gravity) * (slopes @ start)
    state[v_s] = flux[0] - flux
    state[v_w] = state[v_s] + flux / n
    state[sigma], state[u] = start, start  # less the load, which is tension of as much
    found, now = [], 0.0
    for time in times:
        state = expm(rates * (time - now)) @ state
        now = time
        found.append(state[u].copy())
    return found

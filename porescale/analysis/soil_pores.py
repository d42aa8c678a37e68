"""The permeability of a specimen as it stands before its test, on two lattices: what the grid leaves open is measured;
and after it, at another porosity: how K follows that.

Flow along y through the whole periodic cell, discs with the radius used in the fluid, lambda times theirs, by the solid
operator for narrow gaps (permeability.py).  The error of the lattice falls at second order or faster, so that it is at
most a third of what half the cells change, but for the places of grains in their cells: 0.4 % of a hundred of them at
8 and 12 cells, lambda 0.8.  How K follows lambda is
measured on the coarser one, with discs larger by STEP: K ~ lambda^exponent; no number where these seal the pores.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from porescale.analysis.material import Known
from porescale.analysis.permeability import Measured, measure
from porescale.common.core.statistics import jackknife
from porescale.common.core.types import Floats
from porescale.coupling.limits import FOR_NARROW_GAPS, RECOMMENDED

ORDER = 2
STEP = 0.02
"""Share by which lambda is raised to see how K follows it."""


SHEARED, LOOSENED = "permeability after the test", "porosity after the test"
GROWTH = "growth of ln permeability with porosity"


def known_growth(rows: Sequence[Mapping[str, float]]) -> dict[str, Known]:
    """d ln K/dn from before the tests to after them, by least squares over the packings of ``rows`` (name and value),
    with the interval of the jackknife; empty where flow was not measured."""
    if not all(SHEARED in row for row in rows):
        return {}
    opened = np.array([row[LOOSENED] - row["porosity"] for row in rows])
    grown = np.log([row[SHEARED] / row["permeability"] for row in rows])

    def of(packings: list[int]) -> Floats:
        """The slope (1,) through the origin of some packings."""
        return np.array([np.sum(opened[packings] * grown[packings]) / np.sum(opened[packings] ** 2)])

    values = jackknife(of, len(rows))[:, 0]
    return {GROWTH: Known(tuple(values.tolist()))} if np.isfinite(values).all() else {}


def flow_numbers(position: Floats, radius: Floats, box: tuple[float, float], cells: int) -> dict[str, float]:
    """K (m²) and what belongs to it of discs at ``position`` (n, 2) m with the ``radius`` (n,) m used in the fluid.

    box : width and height of the periodic cell, m;  cells : per mean hydraulic diameter.  "lattice error" is relative.
    The excess is by how much of K a scene with free grains has more at half the cells, by the solid operator that it
    has by default.
    """
    fine, coarse = (_through(position, radius, box, part) for part in (cells, cells / 2.0))
    free = _through(position, radius, box, cells / 2.0, RECOMMENDED)
    wider = _through(position, (1.0 + STEP) * radius, box, (1.0 + STEP) * cells / 2.0)  # on the same lattice
    k = fine.permeability
    return {
        "permeability": k,
        "permeability over hydraulic diameter squared": fine.relative,
        "hydraulic solid fraction": fine.solid_fraction,
        "lattice error": abs(k - coarse.permeability) / ((2**ORDER - 1) * k),
        "exponent of lambda": exponent(coarse, wider),
        "excess with free grains at half the cells": free.permeability / k - 1.0,
        "cells": fine.cells,
        "steady": float(fine.steady and coarse.steady),
    }


def sheared_numbers(position: Floats, radius: Floats, box: tuple[float, float], cells: int) -> dict[str, float]:
    """K (m²) of a specimen after its test; the arguments: of `flow_numbers`."""
    return {SHEARED: _through(position, radius, box, cells).permeability}


def exponent(coarse: Measured, wider: Measured) -> float:
    """s of K ~ lambda^s from discs as they are and ``wider`` by STEP; nan where nothing steady flows past either."""
    ratio = wider.permeability / coarse.permeability if coarse.permeability > 0.0 else 0.0
    flows = ratio > 0.0 and coarse.steady and wider.steady
    return math.log(ratio) / math.log1p(STEP) if flows else math.nan


def _through(
    position: Floats, radius: Floats, box: tuple[float, float], cells: float, operator: str = FOR_NARROW_GAPS
) -> Measured:
    """Permeability on the lattice nearest to ``cells`` per diameter that holds the width whole, and the height to half
    a cell."""
    spacing = box[0] / round(box[0] * cells / (2.0 * float(radius.mean())))
    return measure(
        position, radius, (0.0, 0.0), box, spacing, direction="y", periodic=(True, True),
        solid_laws={"solid_operator": operator},
    )  # fmt: skip

"""The grains of the paper's column take little room beside the fluid."""

import numpy as np

from porescale.coupling.psm import SaturatedCells
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX
from tests.reference.memory import peak

SIDE = 600
PAPER_SIDE = 12_000
GIGABYTE = 1e9
ACROSS = 0.0015 / 0.12
"""Diameter of a grain over the side of the box, Saito et al.; 0.8 of it is what the fluid sees."""


def held(spacing):
    """Most bytes that grains hold while they are made, cover cells and step; ``spacing`` of their centres, diameters.

    The column, 3 by 7.2 cm at the right wall of 12 by 12 cm, in single precision.
    """
    pitch = spacing * ACROSS * SIDE
    x, y = np.meshgrid(np.arange(0.75 * SIDE, SIDE, pitch), np.arange(0, 0.6 * SIDE, pitch))
    centre = np.stack((x, y), axis=-1).reshape(-1, 2) + 0.5 * pitch
    radius = np.full(len(centre), 0.4 * ACROSS * SIDE)
    fluid = Fluid(SIDE, SIDE, 0.8, dtype=np.float32)
    motion = np.zeros_like(centre), np.zeros(len(centre))
    SaturatedCells(fluid, radius).advance(fluid, centre, *motion)  # compiled before it counts
    return peak(lambda: SaturatedCells(fluid, radius).advance(fluid, centre, *motion))


def test_the_papers_column_fits_into_eight_gigabytes_with_its_fluid():
    one_set = len(CX) * 4 * SIDE**2
    grains = held(1.0)
    # Nothing of theirs grows faster than the number of cells: loads of rows and scratch with the side, patches with
    # the area.  The box may take 1.3 sets of populations besides.
    assert (1.3 * one_set + grains) * (PAPER_SIDE / SIDE) ** 2 < 8 * GIGABYTE
    # Three fields of the whole box, kept for output only, would be a third of a set.
    assert grains < one_set / 3


def test_grains_cost_by_their_number():
    assert held(0.5) > 2 * held(1.0)

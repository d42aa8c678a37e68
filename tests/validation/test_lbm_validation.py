"""The fluid's validations hold, and their tolerances are tight enough to catch the error next door."""

from __future__ import annotations

import numpy as np
import pytest

from porescale.lbm import experiments as lab
from porescale.lbm.verify import HEIGHT, OTHER_MAGIC, VALIDATIONS, VISCOSITIES

EPS = np.finfo(float).eps


@pytest.mark.parametrize("validation", list(VALIDATIONS), ids=lambda validation: validation.name)
def test_the_validation_holds(validation):
    row = validation.run()
    assert row.passed, row


@pytest.mark.parametrize("viscosity", [0.01, 1 / 6, 1.0])
@pytest.mark.parametrize("height", [1, 2, 5])
def test_walls_sit_midway_at_magic_3_16(height, viscosity):
    # At magic 3/16 the parabola solves the discrete equations exactly; what is left is round-off, nine roundings a
    # step over H²/(pi² nu) steps of viscous memory, eps H²/nu, and over the halves' own memory, 3 tau steps.
    found, parabola = lab.poiseuille(height, viscosity)
    assert np.abs(found - parabola).max() < EPS * (height**2 / viscosity + 27 * (3 * viscosity + 0.5))


def test_another_magic_misplaces_the_wall():
    found, parabola = lab.poiseuille(HEIGHT, VISCOSITIES[1], OTHER_MAGIC)
    off = np.abs(found - parabola).max() * VISCOSITIES[1] / HEIGHT**2
    assert off > 1e10 * VALIDATIONS["lbm.poiseuille_walls_midway_at_magic_3_16"].tolerance


def test_the_slip_of_one_magic_is_not_that_of_another():
    found, parabola = lab.poiseuille(HEIGHT, VISCOSITIES[1], 1.001 * OTHER_MAGIC)
    lifted = (found - parabola) / ((16 / 3 - 1) / HEIGHT**2)
    assert np.abs(lifted - 1).max() > 10 * VALIDATIONS["lbm.poiseuille_slip_at_another_magic"].tolerance


def test_a_lid_that_moves_a_little_faster_is_told_apart():
    found, line = lab.couette(HEIGHT, VISCOSITIES[1], OTHER_MAGIC, speed=1e-3)
    faster = np.abs(found - (1 + 1e-9) * line).max() * VISCOSITIES[1] / HEIGHT**2
    assert faster > 10 * VALIDATIONS["lbm.couette"].tolerance


def test_a_lid_at_the_last_cells_centre_would_be_told_apart():
    # A full-way wall stands half a cell further in: the profile is y/(H - 1/2), off by 1/(2 H) at the lid.
    found, line = lab.couette(HEIGHT, VISCOSITIES[1], OTHER_MAGIC)
    assert np.abs(found - line * HEIGHT / (HEIGHT - 0.5)).max() > 0.4 / HEIGHT


def test_at_a_fixed_mach_number_vortices_do_not_converge_at_second_order():
    # Compressibility and the lattice's cubic Galilean defect are of order u², which no finer grid makes smaller when
    # the velocity in lattice units stays.
    errors = [lab.taylor_green(cells, speed=1.6 * cells / 16, drift=0.8 * cells / 16) for cells in (16, 32, 64)]
    assert abs(lab.order(errors) - 2) > 5 * VALIDATIONS["lbm.taylor_green_order"].tolerance

"""Beside each row on levels and wetting a twin that must fail, and the table that the dam is held to."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.seepage import Resistance, Supply, pores, reservoir
from continuum_sph.validation.seepage import dam, infiltration, wetting
from continuum_sph.validation.seepage.dam import DAM, STATIONS, SURFACE, Dam
from continuum_sph.validation.seepage.infiltration import DRAWN
from tests.reference.continuum.dam import surface
from tests.validation.tolerances import tolerance

PRINTED = DRAWN.porosity / (1.0 - DRAWN.porosity)
"""Factor of the drag n ρ_f g/k of eq. 46 per volume of water: n² ρ_f g/k of the whole, and 1/n of that."""


@pytest.fixture(autouse=True)
def fresh(monkeypatch):
    """No course of a dam is kept: those of twins are wrong on purpose."""
    monkeypatch.setattr(dam, "course", dam.course.__wrapped__)


@pytest.mark.parametrize("shape", sorted(SURFACE))
def test_the_surface_in_a_dam_solves_the_free_boundary_problem(shape):
    # 50 cells over H1: the surface falls on the line between nodes to 0.02 of a cell; and the table's half digit
    length, downstream = shape
    x, heights = surface(1.0, downstream, length, 50, 1500)
    np.testing.assert_allclose(
        np.interp(np.array(STATIONS) * length, x, heights), SURFACE[shape], atol=0.02 / 50 + 6e-4
    )


def test_the_discharge_of_a_dam_is_that_of_its_pressures():
    # ∫ (H1 - y) dy over the one side less that over the other: q L/k, whatever the surface between
    given = Dam(upstream=0.8, downstream=0.3, length=2.0, permeability=0.01)
    assert given.discharge == pytest.approx(0.01 / 2.0 * (0.5 * 0.8**2 - 0.5 * 0.3**2))


@pytest.mark.slow
def test_water_passes_a_dam_too_fast_under_the_printed_drag(monkeypatch):
    monkeypatch.setattr(Resistance, "factor", PRINTED)
    into, out, _ = dam.dam.__wrapped__(replace(DAM, rows=12), (0.5, 1.0))
    assert abs(0.5 * (into + out) - 1.0) > tolerance("continuum.dam")


@pytest.mark.slow
def test_a_short_dam_that_lets_much_through_lets_less_through_than_darcy_says():
    # Four times the permeability of the row: what inertia and viscosity take of the flow goes with it.
    into, out, _ = dam.dam.__wrapped__(Dam(length=0.5, permeability=4.0 * 0.5 * dam.CALM), (2.0, 6.0))
    assert 1.0 - 0.5 * (into + out) > tolerance("continuum.dam_50")


@pytest.mark.slow
def test_water_that_comes_in_sparse_presses_too_hard(monkeypatch):
    # Put no nearer at all it has 1.6 %, less than the row allows; put as much farther apart as it is sparse, 5.8 %.
    monkeypatch.setattr(reservoir, "CLOSER", -1)
    into, _, _ = dam.dam.__wrapped__(Dam(length=0.5, permeability=0.5 * dam.CALM), dam.CALM_SPAN)
    assert into - 1.0 > tolerance("continuum.dam_50")


@pytest.mark.slow
def test_water_enters_soil_too_fast_under_the_printed_drag(monkeypatch):
    monkeypatch.setattr(Resistance, "factor", PRINTED)
    (found,) = infiltration.fronts(replace(DRAWN, rows=20), (0.3,))
    assert abs(found - 1.0) > 3.0 * tolerance("continuum.imbibition")


@pytest.mark.slow
def test_under_twice_the_drag_the_wetting_line_lies_too_far_back(monkeypatch):
    monkeypatch.setattr(Resistance, "factor", 2.0)
    assert wetting.apart.__wrapped__(0.03) > 0.03 * tolerance("continuum.wetting_line_of_a_levee")


@pytest.mark.slow
def test_water_that_keeps_its_excess_of_volume_holds_the_front_back(monkeypatch):
    # Rows of water 1/n spacings apart, and kernels that end at 2.6 spacings: 0.4 % early where it takes the excess up,
    # 7 % late where it does not.
    monkeypatch.setattr(pores, "PACE", 0.0)
    (found,) = infiltration.fronts(replace(DRAWN, rows=20, ratio=1.3), (0.3,))
    assert abs(found - 1.0) > tolerance("continuum.imbibition")


@pytest.mark.slow
def test_a_reservoir_that_books_half_of_what_it_lets_in_loses_mass(monkeypatch):
    keep = Supply.keep

    def careless(supply, time):
        before = [pool.let_in for pool in supply.reservoirs]
        keep(supply, time)
        for pool, was in zip(supply.reservoirs, before, strict=True):
            pool.let_in = 0.5 * (was + pool.let_in)

    monkeypatch.setattr(Supply, "keep", careless)
    assert dam.unbooked(400) > 1e6 * tolerance("continuum.mass_between_levels")


@pytest.mark.slow
def test_what_reservoirs_let_in_and_out_goes_in_whole_particles(monkeypatch):
    # The twin of what has passed on.  12 rows: 12.6 particles pass in 3.5 s, and the last in or out is 8 %.
    monkeypatch.setattr(Supply, "passed", lambda _, pool: pool.let_in - pool.let_out)
    given = replace(DAM, rows=12, permeability=dam.CALM)
    assert dam.unlike(given, (3.5, 10.5)) > 4.0 * tolerance("continuum.in_and_out")

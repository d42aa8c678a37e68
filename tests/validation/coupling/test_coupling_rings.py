"""The validations of rings and rectangles hold, and would not with the error next door."""

import pytest

from porescale.validation.coupling import rings as verify_rings
from porescale.validation.coupling.rings import RADII, couette_error, piston_flux, torques
from tests.validation.tolerances import tolerance


def test_the_torque_falls_into_place_with_the_square_of_the_cells():
    # The error is that of a shift A/R of the radius, so second order: a quarter at twice the radii, to a quarter of it
    # for the places in a cell.
    coarse, fine = (torques(0.8, "disc", radii=(scale * RADII[0], scale * RADII[1]))[1] - 1 for scale in (0.75, 1.5))
    assert fine / coarse == pytest.approx(0.25, abs=0.06)


def test_the_operator_without_exact_walls_misses_the_torque():
    _, ring = torques(0.8, "disc", solid_operator="odd-SC1")
    assert abs(ring - 1) > tolerance("coupling.taylor_couette_torque")


def test_a_disc_a_tenth_of_a_cell_too_wide_misses_the_torque():
    # dT/T = 2 dR/R1 R2²/(R2² - R1²): a tenth of a cell in the disc's radius of 8 is 3.3 %.
    disc, ring = torques(0.8, "disc")
    assert max(abs(disc + 1), abs(ring - 1)) <= tolerance("coupling.taylor_couette_torque")
    _, ring = torques(0.8, "disc", radii=(RADII[0] + 0.1, RADII[1]))
    wide = RADII[0] + 0.1
    exact = [a**2 * RADII[1] ** 2 / (RADII[1] ** 2 - a**2) for a in (RADII[0], wide)]
    assert abs(ring * exact[1] / exact[0] - 1) > tolerance("coupling.taylor_couette_torque")


def test_a_rectangle_of_the_older_operator_does_not_slide_exactly():
    assert max(couette_error(6.25, 0.8, solid_operator="odd-SC1", weighting="B2")) > tolerance(
        "coupling.sliding_rectangle"
    )


def test_a_piston_whose_side_rests_pushes_out_less(monkeypatch):
    from porescale.coupling.coverage.bodies import Bodies

    place = Bodies.place

    def hold(self, patches):
        self.hold_sides()
        place(self, patches)

    monkeypatch.setattr(Bodies, "place", hold)
    assert abs(piston_flux()[0] - 1) > tolerance("coupling.piston")
    assert verify_rings.piston().error > tolerance("coupling.piston")

"""Validations of segments and bonds hold, and their twins fail."""

import numpy as np
import pytest

from porescale.dem.bodies.frames import rod_moments
from porescale.dem.discs import make_discs
from porescale.validation.dem import segments as lab
from porescale.validation.dem.momentum import momentum_drift


def test_a_polygon_is_not_its_outline_of_rods():  # the twin that must fail
    corners = np.array([(0.0, 0.0), (3.0, 0.0), (0.0, 6.0)])
    assert abs(rod_moments(corners, np.roll(corners, -1, axis=0), 1.0)[2] / 22.5 - 1.0) > 0.1


def test_energy_does_not_close_by_the_printed_rule():  # the twin that must fail
    assert lab.bouncing("disc", 200.0, "printed").max() > 1e-2
    assert lab.bouncing("disc", 200.0).max() < 1e-3


def test_energy_does_not_close_by_the_printed_rule_among_polygons_that_slip():  # the twin that must fail
    found = [
        lab.residuals(lab.mixed_cloud(0.0, rule, energy=True), 0.04, 100.0, gravity=0.0).max()
        for rule in ("outline", "each", "printed")
    ]
    assert max(found[:2]) < 1e-3 < 1e-2 < found[2]


def test_segments_counted_each_for_itself_close_too_and_are_twice_as_stiff_at_corners():
    assert lab.bouncing("polygon", 200.0, "each").max() < 1e-3


def test_momentum_of_a_body_alone_is_not_kept():  # the twin that must fail
    grains = lab.mixed_cloud()
    lab.hold(grains, 5)
    assert max(momentum_drift(grains, 3000)) > 1e-6


def test_a_chain_of_few_links_is_no_catenary():  # the twin that must fail
    at = lab.hanging_chain(8)
    curve = lab.catenary(at)
    assert np.abs(curve - at[:, 1]).max() > 2e-3 * -curve.min()


def test_a_bond_made_with_less_pressure_breaks_sooner():  # the twin that must fail
    strong, weak = (lab.bond_strength("discs", pressed, 2000) * pressed for pressed in (1e-3, 5e-4))
    assert weak == pytest.approx(0.5 * strong, rel=2e-3)


def test_a_rod_weighs_as_a_disc_of_its_area():
    rod = lab.rod((0.0, 0.0), 0.3).mass_properties()
    disc = make_discs([(0.0, 0.0)], 1.0, lab.DENSITY)
    area = 4.0 * lab.RADIUS * lab.THICKNESS
    assert rod.mass == pytest.approx(float(disc.mass[0]) * area / np.pi, rel=1e-14)

"""Scenes of polygons in water: convex ones, resolved, seen by fluid and grains; what cannot be is said."""

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.builders.checks.polygons_in_fluid import too_few_cells, widths
from porescale.builders.derive import derive
from porescale.common.core.errors import InputError
from tests.reference.scenes import column, grain, water

SQUARE = {"sides": 4, "diameter": 0.0014, "thickness": 2e-5, "at": [[0.004, 0.005]], "angle": [0.3]}
WATER = {"gate": None, "grains__packing": None, "grains__hydraulic_radius_ratio": 1, "domain__top": "wall"}


def wet(*polygons, **changes):
    return column(**WATER | {"polygon": list(polygons)} | changes)


def faults(*polygons, **changes):
    with pytest.raises(InputError) as caught:
        derive(wet(*polygons, **changes))
    return " ".join(f"{fault.key} {fault.problem} {fault.repair}" for fault in caught.value.faults)


def warned(*polygons, **changes):
    return " ".join(derive(wet(*polygons, **changes)).warnings)


def test_a_polygon_sinks_beside_a_grain_and_goes_on_bit_for_bit():
    # A held disc and a free grain besides: rows of discs come before those of corners.
    scene = wet(
        SQUARE, grains__grain=[grain(0.008, 0.005)], disc=[{"x": 0.002, "y": 0.002, "diameter": 0.001}],
        grains__hydraulic_radius_ratio=0.8,
    )  # fmt: skip
    one, other = build(scene), build(scene)
    one.advance(30)
    coupled = one.coupled
    np.testing.assert_allclose(coupled.hydraulic_radius, [0.0004, 0.0005, 0.0, 0.0, 0.0, 0.0], rtol=1e-12)
    assert coupled.polygons.velocity[0, 1] < 0.0 > coupled.grains.discs.velocity[0, 1]
    area, cell = 0.5 * 0.0014**2, 0.0002**2
    solid = one.snapshot().grids["fields"].cells["solid_fraction"]
    assert solid.sum() * cell == pytest.approx(area + np.pi * (0.0004**2 + 0.0005**2), rel=1e-5)
    assert len(one.snapshot().clouds["grains"].position) == 2
    assert len(one.snapshot().clouds["frames"].position) == 4
    other.restore(one.state())
    for simulation in (one, other):
        simulation.advance(10)
    np.testing.assert_array_equal(one.fluid.populations, other.fluid.populations)
    assert one.series() == other.series()


def test_the_load_of_a_held_disc_beside_polygons_is_its_own():
    held = {"x": 0.002, "y": 0.002, "diameter": 0.001, "velocity_x": {"amplitude": 0.01, "frequency": 50, "phase": 1.0}}
    model = build(wet(SQUARE, grains__grain=[grain(0.008, 0.005)], disc=[held], loads={"discs": [0]}))
    model.advance(5)
    row, force = model.tables()["loads"], model.coupled.fluid_force
    assert row["disc 0 force x (N/m)"] == force[1, 0] < 0.0  # grain, held disc, four corners: it is drawn to the right
    assert force[-1, 0] != force[1, 0]  # the twin: a corner's, the last row, is another
    discs = model.grains.discs
    assert discs.position[1, 0] == pytest.approx(0.002 + model.scene.disc[0].travelled(model.time)[0], rel=1e-14)


def test_a_polygon_that_is_told_stays():
    simulation = build(wet(SQUARE | {"held": True}, grains__grain=[grain(0.008, 0.005)]))
    simulation.advance(5)
    np.testing.assert_array_equal(simulation.coupled.polygons.velocity, 0.0)


def test_a_held_polygon_alone_is_an_obstacle():
    simulation = build(wet(SQUARE | {"held": True}, fluid__body_force=[10.0, 0.0]))
    simulation.advance(5)
    row = simulation.series()
    assert row["largest fluid speed (m/s)"] > 0.0
    assert not any("grain" in name for name in row)  # nothing moves of which that could be said


def test_what_is_no_convex_polygon_is_dry():
    rod = {"chain": [[0.006, 0.002], [0.007, 0.002]], "thickness": 1e-4, "width": 1e-4}
    assert "segment is for dry grains" in faults(SQUARE, segment=[rod])
    arrow = {"corners": [[0, 0], [0.002, 0], [0.0005, 0.0005], [0, 0.002]], "thickness": 2e-5, "at": [[0.004, 0.004]]}
    said = faults(arrow)
    assert "polygon[0]" in said
    assert "cut it into convex polygons" in said


def test_what_discs_alone_have_is_refused_of_polygons_with_the_reason():
    said = faults(SQUARE, lubrication={})
    assert "lubrication has no films between polygons: what the lattice lacks was measured" in said
    # The radius that the fluid sees is of discs; with discs it is theirs.
    beside = {"grains__hydraulic_radius_ratio": 0.8, "grains__grain": [grain(0.008, 0.005)]}
    said = faults(SQUARE, grains__hydraulic_radius_ratio=0.8)
    assert "grains.hydraulic_radius_ratio is of discs: the fluid sees a polygon's outline" in said
    assert "choose polygon.thickness" in said
    derive(wet(SQUARE, **beside))
    # A rim is softened by its radius: asked for, or by the operator's default.
    assert "fluid.rim softens discs alone" in faults(SQUARE, fluid__rim="soft")
    assert "fluid.rim is soft with 'central'" in faults(SQUARE, fluid__operator="central")
    derive(wet(SQUARE, fluid__operator="central", fluid__rim="sharp"))
    assert " is of the discs alone: the fluid sees polygons at their outline" in warned(SQUARE, **beside)
    # The twin: none of it is refused or said where there is no polygon.
    alone = derive(column(**WATER | beside | {"fluid__rim": "soft", "fluid__magic": 0.0417, "lubrication": {}}))
    assert not [line for line in alone.warnings if "alone" in line or "film" in line or "rim" in line]


def test_a_film_or_a_rim_that_a_body_has_not_is_said():
    grains = {"grains__grain": [grain(0.008, 0.005)], "lubrication": {}}
    block = {"rectangle": [{"lower": [0.009, 0.0], "upper": [0.0104, 0.004]}]}
    said = " ".join(derive(column(**WATER | grains | block)).warnings)
    assert "[lubrication] adds no film at [[rectangle]]" in said
    assert "adds no film at [gate]" in " ".join(derive(column(lubrication={})).warnings)
    ring = {"ring": {"x": 0.006, "y": 0.004, "diameter": 0.0064}, "disc": [{"x": 0.006, "y": 0.004, "diameter": 0.002}]}
    closed = {"domain__left": "wall", "domain__right": "wall", "domain__top": "slip", "fluid__body_force": None}
    said = " ".join(derive(water(**closed, **ring, lubrication={})).warnings)
    assert "adds no film at [ring] and domain.top (slip)" in said
    assert "is not used: rims of discs" in " ".join(derive(water(**block, fluid__rim="soft")).warnings)
    # The twins: without what asks for it nothing is said.
    assert "film" not in " ".join(derive(column(**WATER | {**grains, "lubrication": None} | block)).warnings)
    assert "rim" not in " ".join(derive(water(**block)).warnings)


def test_a_permeability_is_of_discs_alone():
    window = {"left": 0.002, "bottom": 0.002, "width": 0.008, "height": 0.005}
    bed = {"permeability": {"direction": "x", "window": window}}
    assert "permeability there is no bed of discs" in faults(SQUARE, **bed)
    beside = {"grains__grain": [grain(0.008, 0.005)]}
    assert "[[polygon]] are left out" in warned(SQUARE, **beside, **bed)
    block = {"rectangle": [{"lower": [0.009, 0.0], "upper": [0.0104, 0.004]}]}
    assert "[[rectangle]] are left out" in " ".join(derive(column(**WATER | beside | bed | block)).warnings)
    # The twins: a bed of discs, and bodies without the section.
    assert "left out" not in " ".join(derive(column(**WATER | beside | bed)).warnings)
    assert "left out" not in warned(SQUARE, **beside)


def test_films_that_are_uncertain_are_said():
    def said(**more):
        grains = {"grains__grain": [grain(0.008, 0.005)], "lubrication": {}}
        return " ".join(derive(column(**WATER | grains | more)).warnings)

    assert "with 'narrow-wall' the forces of films may be a third off" in said(fluid__solid_operator="narrow-wall")
    # The twins: without films, with the operator that they were measured with.
    assert "films" not in said(lubrication=None, fluid__solid_operator="narrow-wall")
    assert "films" not in said()


def test_a_plate_of_one_cell_is_warned_of():
    plate = {"corners": [[0, 0], [0.004, 0], [0.004, 0.0002], [0, 0.0002]], "thickness": 2e-5, "at": [[0.004, 0.004]]}
    assert any("polygon[0] is 1 cells across" in word for word in derive(wet(plate)).warnings)
    assert not any("cells across" in word for word in derive(wet(SQUARE)).warnings)


def test_a_polygon_lighter_than_is_known_to_hold_is_warned_of():
    said = derive(wet(SQUARE | {"density": 150.0})).warnings
    assert any("polygon[0] has a density ratio of 0.15" in word and "from 0.2 on" in word for word in said)
    assert not any("density ratio" in word for word in derive(wet(SQUARE | {"density": 150.0, "held": True})).warnings)
    assert not any("known to hold from" in word for word in derive(wet(SQUARE | {"density": 250.0})).warnings)


def test_no_polygon_goes_further_in_a_contact_step_than_its_thickness_bears():
    found = derive(wet(SQUARE))
    assert found.contact_step * found.speed <= 0.05 * 2e-5 < 2 * found.contact_step * found.speed


def test_the_width_of_a_polygon_is_the_least_between_parallels():
    frames = build(wet(SQUARE)).frames
    assert widths(frames) == pytest.approx([0.0014 / np.sqrt(2)], rel=1e-12)
    assert too_few_cells(frames, 0.0002) == ""


def test_polygons_alone_may_fall_in_a_small_periodic_box():
    scene = wet(SQUARE, domain__left="periodic", domain__right="periodic")
    assert build(scene).grains.discs.count == 4

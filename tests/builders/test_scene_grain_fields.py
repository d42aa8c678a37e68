"""Regions, coarse graining, forces and contacts of a scene: read where known, in files, absent when not asked."""

import math

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.common.core.errors import InputError
from porescale.common.record.drive import drive
from porescale.common.record.open_run import open_run
from porescale.common.schema.sections import scene_as_dict
from tests.reference.scenes import column, dry, grain, water

CORNER = {"name": "corner", "lower": [0.0, 0.0], "upper": [0.004, 0.002]}
ASKED = {
    "region": [CORNER, {"lower": [0.004, 0.0], "upper": [0.012, 0.008]}],
    "coarse_graining": {"spacing": 0.0005, "fields": ["density", "velocity", "strain_rate", "stress"]},
    "output__contacts": True, "output__forces": True,
}  # fmt: skip
PRESSED = [grain(0.0004995, 0.0004995), grain(0.001499, 0.0005), grain(0.006, 0.004)]
"""Two grains that overlap by 0.5 um, the first 0.5 um into both walls of the corner, and one that touches nothing."""

FORCE = 2e5 * 0.5e-6  # N/m


def pressed(**more):
    given = {"grains": {"density": 2500, "grain": PRESSED}, "gravity": [0.0, 0.0], **ASKED}
    return build(dry(**given | more))


def test_a_region_reads_what_its_grains_and_contacts_are():
    row = pressed().tables()["regions"]
    assert row["corner porosity ()"] == pytest.approx(1 - (2 * math.pi * 0.0005**2 - lost()) / 8e-6, rel=1e-12)
    # F = k d: 2e5 N/m times 0.5 um over branches of 0.4995 mm to the walls and 0.9995 mm between the grains, which lie
    # askew by 0.5 um: 1.25e-10 m further apart, 2.5e-4 of the overlap.
    assert row["corner stress xx (Pa)"] == pytest.approx(FORCE * (0.0004995 + 0.0009995) / 8e-6, rel=3e-4)
    assert row["corner stress yy (Pa)"] == pytest.approx(FORCE * 0.0004995 / 8e-6, rel=3e-4)
    assert row["corner contacts ()"] == 3
    assert row["corner share of rattlers ()"] == 0.5  # the second grain has one contact
    assert row["corner coordination number ()"] == 2.0  # its contact does not count for the first
    assert row["region 1 contacts ()"] == 0
    assert math.isnan(row["region 1 fabric anisotropy ()"])
    assert row["region 1 share of rattlers ()"] == 1.0


@pytest.mark.parametrize(("right", "up"), [(False, False), (True, False), (False, True), (True, True)])
def test_a_region_counts_contacts_with_the_walls_of_any_corner_of_the_box(right, up):
    def at(x, y):
        """A point (m) of the lower left corner, in the corner of this test."""
        return (0.012 - x if right else x, 0.008 - y if up else y)

    corners = np.sort([at(0.0, 0.0), at(0.004, 0.002)], axis=0)
    grains = [grain(*at(it["x"], it["y"]), it["diameter"]) for it in PRESSED]
    region = [{"name": "corner", "lower": corners[0].tolist(), "upper": corners[1].tolist()}]
    row = pressed(grains={"density": 2500, "grain": grains}, region=region).tables()["regions"]
    assert row["corner contacts ()"] == 3
    # Contacts of 0.5 um each: the direction between the grains is askew, as above, and places are known to 1e-18 m.
    assert row["corner mean normal force (N/m)"] == pytest.approx(FORCE, rel=3e-4)
    # Normals along x, x and y: the tensor is diag(2/3, 1/3), a = 2 (2/3 - 1/3), but for the skew of 5e-4.
    assert row["corner fabric anisotropy ()"] == pytest.approx(2 / 3, rel=1e-5)


def lost():
    """Area of two segments of height 0.5 um of a disc of radius 0.5 mm, beyond the walls; m²."""
    h, r = 0.0004995, 0.0005
    return 2 * (r * r * math.acos(h / r) - h * math.sqrt(r * r - h * h))


def test_forces_on_walls_and_held_discs():
    row = pressed(disc=[{"x": 0.006, "y": 0.0049995, "diameter": 0.001}]).tables()["forces"]
    assert row["left wall force x (N/m)"] == pytest.approx(-FORCE, rel=1e-9)
    assert row["left wall force y (N/m)"] == pytest.approx(0.0, abs=1e-12)
    assert row["bottom wall force y (N/m)"] == pytest.approx(-FORCE, rel=1e-9)
    # About the middle of the wall, 4 mm up: the arm is -3.5005 mm.
    assert row["left wall moment (N m/m)"] == pytest.approx(-FORCE * 0.0035005, rel=1e-9)
    assert row["right wall force x (N/m)"] == 0.0
    assert row["disc 0 force y (N/m)"] == pytest.approx(FORCE, rel=1e-9)


def test_a_held_disc_is_solid_but_has_no_mass():
    # All that moves is one grain: with a mass of the disc its 0.1 m/s would be a mean of two, and deviate from it.
    whole = {"name": "box", "lower": [0.0, 0.0], "upper": [0.012, 0.008]}
    moving = {**grain(0.003, 0.004), "velocity": [0.1, 0.0]}
    scene = dry(grains={"density": 2500, "grain": [moving]}, disc=[grain(0.008, 0.004, 0.002)], region=[whole],
                coarse_graining={"spacing": 0.0005, "fields": ["density", "solid_fraction"]})  # fmt: skip
    system = build(scene)
    row, fields = system.tables()["regions"], system.snapshot().grids["grain_fields"]
    assert row["box velocity x (m/s)"] == pytest.approx(0.1, rel=1e-12)
    assert row["box kinetic stress xx (Pa)"] == pytest.approx(0.0, abs=1e-12)
    area = math.pi * 0.0005**2
    assert row["box porosity ()"] == pytest.approx(1 - 5 * area / (0.012 * 0.008), rel=1e-12)
    # Single precision, some hundred cells.
    cell = math.prod(fields.spacing)
    assert float(fields.cells["density"].sum(dtype=float)) * cell == pytest.approx(2500 * area, rel=1e-6)
    assert float(fields.cells["solid_fraction"].sum(dtype=float)) * cell == pytest.approx(5 * area, rel=1e-6)


@pytest.mark.parametrize("body", ["grain", "clump"])
@pytest.mark.parametrize("rotation", [{"velocity": 0.0}, "free"])
def test_what_is_moved_in_all_components_is_none_of_the_grains(body, rotation):
    whole = {"name": "box", "lower": [0.0, 0.0], "upper": [0.012, 0.008]}
    moving, towed = {**grain(0.003, 0.004), "velocity": [0.1, 0.0]}, grain(0.008, 0.004)
    clump = [{"discs": [[-0.0003, 0.0, 0.0005], [0.0003, 0.0, 0.0005]], "at": [[0.008, 0.004]]}]
    control = {body: 1 if body == "grain" else 0, "x": {"velocity": -0.2}, "y": {"velocity": 0.0}, "rotation": rotation}
    system = build(dry(
        grains={"density": 2500, "grain": [moving, towed] if body == "grain" else [moving]}, region=[whole],
        clump=clump if body == "clump" else [], control=[control], gravity=[0.0, 0.0],
    ))  # fmt: skip
    system.advance(1)
    row, series = system.tables()["regions"], system.series()
    free = rotation == "free"  # the check that must fail: a component that is free makes it a grain
    assert (row["box velocity x (m/s)"] == pytest.approx(0.1, rel=1e-12)) != free
    assert (series["front (m)"] == pytest.approx(0.0035, rel=1e-2)) != free
    assert (series["largest grain speed (m/s)"] == pytest.approx(0.1, rel=1e-12)) != free
    assert (row["box kinetic stress xx (Pa)"] == pytest.approx(0.0, abs=1e-12)) != free
    assert row["box porosity ()"] < 1 - 1.9 * math.pi * 0.0005**2 / (0.012 * 0.008)  # solid it is


def test_tables_of_grains_in_fluid_carry_the_hydraulic_radius_ratio():
    control = [{"grain": 0, "x": {"velocity": 0.001}, "record": True}]
    for made, known in ((column, True), (dry, False)):
        scene = made(grains={"density": 2500, "hydraulic_radius_ratio": 0.8 if known else None, "grain": PRESSED},
                     gate=None, region=[CORNER], output__forces=True, control=control)  # fmt: skip
        tables = build(scene).tables()
        assert tables.keys() == {"regions", "forces", "control"}
        for row in tables.values():
            assert (list(row)[1] == "hydraulic radius ratio ()") == known
            assert row.get("hydraulic radius ratio ()") == (0.8 if known else None)


def test_tables_contacts_and_fields_of_a_run_are_files(tmp_path):
    scene = dry(**ASKED, time__end=0.01)
    drive(build(scene), tmp_path, 0.01, snapshot_interval=0.005, series_interval=0.001,
          card={"scene": scene_as_dict(scene)}, quiet=True)  # fmt: skip
    run = open_run(tmp_path)
    assert run.table("regions")["time (s)"].tolist() == run.series["time (s)"].tolist()
    assert len(run.table("forces")["bottom wall force y (N/m)"]) == len(run.series["time (s)"])
    last = run.snapshot(-1)
    fields, grains = last.grids["grain_fields"], last.clouds["grains"]
    mass = 2500 * math.pi * float(np.sum(grains.data["radius"] ** 2))
    # Single precision, some hundred cells.
    assert float(fields.cells["density"].sum(dtype=float)) * math.prod(fields.spacing) == pytest.approx(mass, rel=1e-6)
    assert {"stress_xx", "stress_yx", "stress_mean", "strain_rate_xy", "velocity"} <= fields.cells.keys()
    assert fields.units["stress_xy"] == "Pa"
    contacts = last.clouds["contacts"]
    assert len(contacts.position) > 10
    assert (contacts.data["overlap"] > 0).all()
    at, loaded = contacts.data["second"] >= 0, contacts.data["normal_force"] > 0
    centre = contacts.position[at] - grains.position[contacts.data["first"][at]]
    assert (np.hypot(*centre.T) < grains.data["radius"][contacts.data["first"][at]]).all()
    assert grains.data["contact_number"].sum() == (at[loaded].sum() + loaded.sum())


def test_a_run_that_measures_goes_the_same_way():
    plain, measured = build(dry()), build(dry(**ASKED))
    for _ in range(3):
        plain.advance(40)
        measured.advance(40)
        measured.tables()
        measured.snapshot()
    np.testing.assert_array_equal(plain.grains.discs.position, measured.grains.discs.position)
    assert plain.tables() == {}
    assert plain.snapshot().clouds.keys() == {"grains"}


@pytest.mark.parametrize(("given", "said"), [
    ({"region": [{"lower": [0.0, 0.0], "upper": [0.0, 0.002]}]}, r"region\[0\].upper.*right of and above"),
    ({"region": [{"lower": [0.0, 0.0], "upper": [0.02, 0.002]}]}, r"region\[0\].upper.*outside the box"),
    ({"coarse_graining": {"spacing": 0.001, "width": 0.0005}}, r"coarse_graining.width.*fall between"),
    ({"coarse_graining": {"spacing": 0.001, "fields": ["presure"]}}, r"coarse_graining.fields"),
])  # fmt: skip
def test_what_cannot_be_measured_is_refused(given, said):
    with pytest.raises(InputError, match=said):
        dry(**given)


def test_without_grains_nothing_of_them_is_measured():
    with pytest.raises(InputError, match=r"region.*no grains"):
        water(region=[CORNER])

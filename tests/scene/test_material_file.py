"""What grains say of their soil reaches a scene of the continuum below its own numbers, or clear words do."""

import math
from pathlib import Path

import pytest

from continuum_sph.builders.reports.soil_report import soil_report
from continuum_sph.scene import material_file
from continuum_sph.scene.material_file import DENSITY, VISCOSITY
from continuum_sph.scene.sections import Scene
from continuum_sph.scene.water import WaterSection
from porescale.analysis.doubts import doubts
from porescale.analysis.material import Known, known, tables
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import load, scene_as_dict, validate
from porescale.demseg.convert import toml

ROWS = [
    {"porosity": 0.18, "peak friction angle": 0.40, "peak dilatancy angle": 0.10, "critical friction angle": 0.30,
     "critical porosity": 0.20, "stiffness": 2e5, "Poisson's ratio": 0.3, "permeability": 3e-9, "cells": 12.0},
    {"porosity": 0.20, "peak friction angle": 0.44, "peak dilatancy angle": 0.14, "critical friction angle": 0.32,
     "critical porosity": 0.20, "stiffness": 3e5, "Poisson's ratio": 0.4, "permeability": 5e-9, "cells": 12.0},
]  # fmt: skip
BODY = "[[soil.body]]\noutline = [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]\n"
REST = (
    '[tank]\nwidth = 1\nheight = 1\n[numerics]\nspacing = 0.05\n[time]\nend = 0.1\n'
    "[output]\nsnapshot_interval = 0.1\nseries_interval = 0.1\n"
)  # fmt: skip


def material(folder: Path, rows: list[dict[str, float]] = ROWS, **more: object) -> Path:
    """A material file as `porescale homogenise` writes it; ``more`` replaces tables."""
    whole = {**tables(known(rows), 2500.0, 300.0, {"command": "here", "lambda": 0.8, "seeds": [1, 2]}), **more}
    path = folder / "material.toml"
    path.write_text(toml(whole), encoding="utf-8")
    return path


def scene(folder: Path, soil: str = "", water: str = "") -> Scene:
    file = folder / "scene.toml"
    file.write_text(f'{REST}{water}[soil]\nmaterial = "material.toml"\n{soil}{BODY}', encoding="utf-8")
    return load(file, Scene)


def test_mean_deviation_and_standard_error():
    it = Known((1.0, 2.0, 3.0, 6.0))  # mean 3, squares 4 + 1 + 0 + 9 over n - 1 = 3
    assert it.mean == 3.0
    assert it.deviation == pytest.approx(math.sqrt(14.0 / 3.0), rel=1e-15)
    assert it.error == pytest.approx(math.sqrt(14.0 / 12.0), rel=1e-15)


CRITICAL = {"critical dilatancy angle": 0.0, "independent critical values": 20.0}


def soil(*changes: dict[str, float]) -> list[dict[str, float]]:
    """Numbers of four packings that leave nothing to doubt, or what ``changes`` make of each."""
    four = [{**row, **CRITICAL, "critical friction angle": 0.30 + 0.005 * k} for k, row in enumerate([*ROWS, *ROWS])]
    return [row | change for row, change in zip(four, changes or [{}] * 4, strict=True)]


def test_nothing_is_doubted_of_four_packings_that_agree():
    assert doubts(soil(), known(soil())) == []


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (soil({"stiffness": math.nan}, {}, {}, {}), "stiffness is absent: 1 of 4 packings do not show it"),
        (soil()[:2], "2 packings give no interval"),
        (soil()[:3], "3 packings give a wide interval"),
        (soil(*[{"Poisson's ratio": -0.28}] * 4), "are not those of an elastic soil"),
        (soil(*[{"stiffness": -3189.0}] * 4), "are not those of an elastic soil"),
        (soil(*[{"critical dilatancy angle": -0.03 - 0.001 * k} for k in range(4)]), "volume still drifts"),
        (
            soil(*[{"critical dilatancy angle": 0.1 * (-1) ** k} for k in range(4)]),
            "whether volume still drifts is open",
        ),
        (soil(*[{"independent critical values": 2.0}] * 4), "2 independent values at most"),
        (soil(*[{"critical friction angle": 0.3 + 0.05 * k} for k in range(4)]), "too wide to order friction"),
        (soil(*[{"stiffness": 1e5 * 3.0**k} for k in range(4)]), "is hardly known"),
    ],
)
def test_what_is_doubtful_is_said(rows, said):
    lines = doubts(rows, known(rows))
    assert any(said in line for line in lines), lines


def test_what_is_no_elastic_soil_is_left_to_the_continuum_which_says_so(tmp_path):
    rows = soil(*[{"Poisson's ratio": -0.28}] * 4)
    material(tmp_path, rows, made={"doubts": doubts(rows, known(rows))})
    made = scene(tmp_path)
    assert made.soil.stiffness != pytest.approx(2.5e5)
    assert any("not those of an elastic soil" in line for line in soil_report(made).warnings)
    material(tmp_path, soil())  # the twin that must say nothing
    assert not any("elastic" in line for line in soil_report(scene(tmp_path)).warnings)


def test_lattice_and_lambda_stand_in_the_bar_of_the_permeability():
    rows = [{"permeability": 4e-9, "permeability over hydraulic diameter squared": 4e-3, "lattice error": 0.03,
             "exponent of lambda": -8.0}] * 4  # fmt: skip
    found = known(rows, 0.005)  # packings agree: 3 % of the lattice beside 8 · 0.5 %, or 10 · 0.5 % of K/d²
    assert found["permeability"].interval == pytest.approx(0.05 * 4e-9)
    assert found["permeability over hydraulic diameter squared"].interval == pytest.approx(math.hypot(3, 5) * 4e-5)
    assert found["permeability"].table()["systematic"] == pytest.approx(0.05 * 4e-9)
    assert known(rows)["permeability"].interval == pytest.approx(0.03 * 4e-9)  # lambda known exactly
    sealed = known([rows[0] | {"exponent of lambda": math.nan}, *rows], 0.005)  # the lattice is known without lambda
    assert sealed["permeability"].interval == pytest.approx(0.03 * 4e-9)


def test_a_number_that_one_packing_lacks_is_left_out():
    found = known([ROWS[0], {**ROWS[1], "stiffness": math.nan}])
    assert "stiffness" not in found
    assert "stiffness" not in tables(found, 2500.0, 300.0, {})["soil"]
    assert "porosity" in found


def test_a_scene_takes_over_every_number(tmp_path):
    material(tmp_path)
    soil = scene(tmp_path).soil
    assert soil.density == pytest.approx(0.81 * 2500.0, rel=1e-14)
    assert (soil.porosity, soil.stiffness, soil.reference) == pytest.approx((0.19, 2.5e5, 300.0), rel=1e-14)
    assert (soil.friction_angle, soil.dilatancy_angle, soil.poisson) == pytest.approx((0.31, 0.0, 0.35), rel=1e-14)
    assert soil.permeability == pytest.approx(4e-9 * DENSITY * GRAVITY / VISCOSITY, rel=1e-14)
    peak = scene(tmp_path, 'strength = "peak"\n').soil
    assert (peak.friction_angle, peak.dilatancy_angle) == pytest.approx((0.42, 0.12), rel=1e-14)


EXPONENTS = [{"exponent of stiffness": 0.12 + 0.02 * k} for k in range(4)]


def test_a_scene_takes_the_exponent_over_with_the_stiffness_that_it_belongs_to(tmp_path):
    material(tmp_path, soil(*EXPONENTS))
    assert doubts(soil(*EXPONENTS), known(soil(*EXPONENTS))) == []
    soils = [scene(tmp_path, text).soil for text in ("", 'stiffness = "1 MPa"\n', "exponent = 0.3\n")]
    assert [it.exponent for it in soils] == pytest.approx([0.15, 0.0, 0.3], abs=1e-14)
    assert [it.reference for it in soils] == pytest.approx([300.0] * 3, rel=1e-14)


@pytest.mark.parametrize("values", [(-0.1, 0.3, -0.2, 0.4), (1.2, 1.21, 1.2, 1.21), (-0.11, -0.1, -0.1, -0.11)])
def test_an_exponent_that_is_not_known_to_be_one_is_not_handed_over_which_is_said(values):
    rows = soil(*[{"exponent of stiffness": it} for it in values])
    assert "exponent" not in tables(known(rows), 2500.0, 300.0, {})["soil"]
    assert any("none is handed over" in line for line in doubts(rows, known(rows)))


def test_the_water_of_the_file_reader_is_that_of_a_scene_without_any():
    water = WaterSection()
    assert (water.density, water.viscosity) == (DENSITY, VISCOSITY)


def test_what_the_scene_says_wins(tmp_path):
    material(tmp_path)
    soil = scene(tmp_path, 'friction_angle = "25 degree"\npermeability = "1 cm/s"\n').soil
    assert soil.friction_angle == pytest.approx(math.radians(25.0))
    assert soil.permeability == pytest.approx(0.01)
    assert soil.porosity == pytest.approx(0.19)


def test_permeability_is_under_the_gravity_that_it_counts_under(tmp_path):
    """9.81 m/s²; with suction that of the scene, under which `soil.permeability` counts there."""
    material(tmp_path)
    at_rest = 4e-9 * DENSITY / VISCOSITY
    named = {"material": "material.toml"}

    def k(soil, **scene):
        return material_file.with_material({"soil": {**named, **soil}, **scene}, tmp_path)["soil"]["permeability"]

    assert k({}, gravity=98.1) == pytest.approx(at_rest * GRAVITY, rel=1e-14)
    assert k({"suction": {}}) == pytest.approx(at_rest * GRAVITY, rel=1e-14)
    assert k({"suction": {}}, gravity=98.1) == pytest.approx(at_rest * 98.1, rel=1e-14)
    assert k({"suction": {}}, gravity="much") == pytest.approx(at_rest * GRAVITY, rel=1e-14)  # the scene judges it


RATE = {"grain_diameter": 1.5e-3, "friction_angle": 0.6, "inertial_number": 0.3}


def test_only_a_scene_with_a_table_of_rates_takes_them_over_and_its_own_keys_win(tmp_path):
    material(tmp_path, rate=RATE)
    named = {"material": "material.toml"}
    with_material = material_file.with_material
    assert "rate" not in with_material({"soil": named}, tmp_path)["soil"]
    assert with_material({"soil": {**named, "rate": {}}}, tmp_path)["soil"]["rate"] == RATE
    own = {"friction_angle": "30 degree"}
    assert with_material({"soil": {**named, "rate": own}}, tmp_path)["soil"]["rate"] == {**RATE, **own}
    assert with_material({"soil": {**named, "rate": 3}}, tmp_path)["soil"]["rate"] == 3  # the section judges it
    material(tmp_path)  # a file without rates leaves the table as it is
    assert with_material({"soil": {**named, "rate": own}}, tmp_path)["soil"]["rate"] == own


def test_a_scene_with_an_empty_table_of_rates_has_the_law_of_the_file(tmp_path):
    material(tmp_path, rate=RATE)
    taken = scene(tmp_path, "[soil.rate]\n").soil.rate
    assert (taken.grain_diameter, taken.friction_angle, taken.inertial_number) == (1.5e-3, 0.6, 0.3)
    assert scene(tmp_path).soil.rate is None
    material(tmp_path)  # a file without rates: the section asks for its own keys
    with pytest.raises(InputError, match=r"soil\.rate\.friction_angle"):
        scene(tmp_path, "[soil.rate]\n")


def test_permeability_is_that_of_the_scenes_own_water(tmp_path):
    material(tmp_path)
    plain, thick = scene(tmp_path).soil, scene(tmp_path, water='[water]\nviscosity = "0.01 Pa s"\ndensity = 500\n').soil
    assert thick.permeability == pytest.approx(plain.permeability * 0.5 * VISCOSITY / 0.01, rel=1e-12)


def test_the_card_keeps_where_numbers_come_from(tmp_path):
    material(tmp_path)
    made = scene(tmp_path)
    card = scene_as_dict(made)
    assert "material" not in card["soil"]  # the numbers are there: the file may change or go
    origin = card["soil"]["origin"]
    assert origin["made"]["lambda"] == 0.8
    assert origin["intrinsic_permeability"] == pytest.approx(4e-9)
    mean, error = origin["measured"]["porosity"]
    assert mean == pytest.approx(0.19)
    assert error == pytest.approx(0.01)  # deviation 0.01 √2, over √2
    assert validate(Scene, card) == made
    said = soil_report(made).groups["measured on grains"]
    assert any(row.name == "porosity" and "no interval" in row.note for row in said)  # of two packings
    material(tmp_path, soil())
    said = soil_report(scene(tmp_path)).groups["measured on grains"]
    # 0.01 either side of 0.19, four times: 3.182 · 0.011547/2; angles are read in degrees
    assert any(row.name == "porosity" and "± 0.018 (95 %)" in row.note for row in said)
    assert any(row.name == "critical friction angle" and row.unit == "degrees" for row in said)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        ({"format": 2}, "newer version"),
        ({"format": "x"}, "is not that of a material file"),
        ({"soil": {"density": -1.0, "porosity": 0.2}}, "soil.density"),
        ({"soil": {"density": 2000.0}}, "soil.porosity"),
        ({"strength": {"critical": {"friction_angle": 0.3, "dilatancy_angle": 0.0}}}, "strength.peak"),
        ({"pores": {"permeability": 0.0}}, "pores.permeability"),
        ({"sole": {"density": 1.0}}, "sole"),
        ({"soil": {"density": 2e12, "porosity": 0.2}}, "soil.density"),  # beyond what the scene takes
        ({"strength": {name: {"friction_angle": 14.3, "dilatancy_angle": 0.0} for name in ("critical", "peak")}},
         'degrees are written as "14.3 deg"'),
        ({"rate": {**RATE, "friction_angle": 1.6}}, "rate.friction_angle"),
        ({"rate": {"grain_diameter": 1e-3, "friction_angle": 0.6}}, "rate.inertial_number"),
    ],
)  # fmt: skip
def test_a_wrong_file_is_refused_by_name(tmp_path, spoil, said):
    material(tmp_path, **spoil)
    with pytest.raises(InputError) as caught:
        scene(tmp_path)
    lines = [fault.line() for fault in caught.value.faults]
    assert all("material.toml" in line for line in lines)
    assert any(said in line for line in lines)


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(InputError, match="is no file"):
        scene(tmp_path)
    (tmp_path / "material.toml").mkdir()
    with pytest.raises(InputError, match="is no file"):
        scene(tmp_path)


def test_numbers_beyond_what_a_soil_can_be_are_refused_by_the_scene(tmp_path):
    material(
        tmp_path, strength={name: {"friction_angle": 0.2, "dilatancy_angle": 0.3} for name in ("critical", "peak")}
    )
    with pytest.raises(InputError, match=r"soil\.dilatancy_angle"):
        scene(tmp_path)


def test_the_share_of_grains_in_the_flow_goes_to_the_law_that_has_one(tmp_path):
    rows = [row | {"hydraulic solid fraction": 0.64 * (1.0 - row["porosity"])} for row in ROWS]
    material(tmp_path, rows)
    assert scene(tmp_path).soil.hydraulic_share == 1.0
    law = 'permeability_law = "kozeny-carman"\n'
    assert scene(tmp_path, law).soil.hydraulic_share == pytest.approx(0.64)
    assert scene(tmp_path, law + "hydraulic_share = 0.9\n").soil.hydraulic_share == 0.9
    with pytest.raises(InputError, match=r"soil\.hydraulic_share.*is of a law that the scene does not have"):
        scene(tmp_path, "hydraulic_share = 0.9\n")

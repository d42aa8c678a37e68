"""Scenes as files: quality levels, settings and units, and every case in the repository."""

import pytest

from porescale import Scene, load
from porescale.builders.derive import derive
from porescale.builders.report import report
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import LEVELS, scene_as_dict, validate
from tests.reference.folders import CASES
from tests.reference.scenes import COLUMN, column, table, write

SOUND = ["column_collapse", "settling_disc"]


@pytest.mark.parametrize("case", SOUND)
def test_finer_levels_have_finer_spacing_and_the_same_physics(case):
    scenes = [load(CASES / case, quality=level) for level in LEVELS]
    spacings = [scene.fluid.spacing for scene in scenes]
    assert spacings == sorted(spacings, reverse=True)
    assert len(set(spacings)) == 3
    for scene in scenes:
        assert (scene.domain, scene.time, scene.grains, scene.gate) == (
            scenes[0].domain, scenes[0].time, scenes[0].grains, scenes[0].gate)  # fmt: skip
        assert scene.fluid.viscosity == scenes[0].fluid.viscosity
        # Compressibility: expected Mach number below a tenth at every level, and no refusal.
        derived = derive(scene)
        assert derived.speed / derived.scales.sound_speed < 0.1
        # The one doubt of a coarse level is that a dense bed needs 15 cells per grain.
        assert [it for it in derived.warnings if "in a bed of solid fraction" not in it] == []
    # No doubt is left of the finest, but of the column's: the paper's table has 12 cells per hydraulic diameter.
    assert derived.warnings == () or case == "column_collapse"


def test_the_default_quality_of_the_column_is_draft():
    # 4 cells per diameter by default, 15 at fine (the consistent reading, 1200 squared).
    default, draft = load(CASES / "column_collapse"), load(CASES / "column_collapse", quality="draft")
    assert default == draft
    assert derive(default).cells == (320, 320)
    derived = derive(load(CASES / "column_collapse", quality="fine"))
    assert derived.cells == (1200, 1200)
    assert derived.scales.relaxation_time == pytest.approx(0.8, rel=1e-12)
    assert derived.scales.step == pytest.approx(1e-5, rel=1e-12)
    assert derived.diameters[1] / derived.scales.spacing == pytest.approx(15, rel=1e-12)


def test_the_column_is_the_papers():
    scene = load(CASES / "column_collapse")
    packing = scene.grains.packing
    assert (scene.domain.width, scene.domain.height) == (0.12, 0.12)
    assert (packing.left, packing.width, packing.height, packing.diameter) == (0.09, 0.03, 0.072, 0.0015)
    assert (scene.grains.density, scene.fluid.density, scene.fluid.viscosity) == (2500, 1000, 1e-4)
    assert scene.grains.hydraulic_radius_ratio == 0.8
    # About 1000 grains; Ar = (s - 1) g d^3/nu^2 = 1.5 * 9.81 * 1.5e-3^3/1e-8.
    rows = {row["name"]: row["value"] for group in report(scene).as_dict()["groups"].values() for row in group}
    assert abs(rows["number"] - 1000) < 50
    assert rows["Archimedes number"] == pytest.approx(4.966, rel=1e-3)
    assert rows["density ratio"] == 2.5
    assert rows["restitution of a pair"] == pytest.approx(0.97, abs=5e-4)


def test_settings_win_over_the_level_and_understand_units(tmp_path):
    levels = {"draft": {"fluid": {"step": 2e-5}}, "fine": {"time": {"end": 1.0}}}
    file = write(tmp_path / "scene.toml", table(quality_default="draft", quality=levels))
    assert load(file).fluid.step == 2e-5
    assert load(file, quality="fine").fluid.step == 4e-5
    assert load(file, quality="fine").time.end == 1.0
    assert load(file, settings=["fluid.step=1e-5"]).fluid.step == 1e-5
    assert load(file, settings=["fluid.spacing=0.2 mm", "gate.opens_at='3 ms'"]).gate.opens_at == 0.003
    assert load(file, settings=["grains.packing.seed=7"]).grains.packing.seed == 7
    moved = load(file, settings=["fluid.body_force=[1, 2]"])
    assert moved.fluid.body_force == (1.0, 2.0)


def test_a_scene_in_other_units_is_the_same_scene(tmp_path):
    other = table(
        domain__width="1.2 cm", domain__height="8 mm", time__end="24 ms", fluid__viscosity="20 mm^2/s",
        fluid__spacing="200 um", fluid__step="40 us", fluid__density="1 g/cm^3", grains__density="2.5 g/cm^3",
        contact__stiffness="0.2 kN/mm", gate__lift_speed="40 cm/s",
    )  # fmt: skip
    assert load(write(tmp_path / "scene.toml", other)) == column()


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("fluid.spacing=0.2 s", ("fluid.spacing", "m")),
        ("contact.friction=-0.1", ("contact.friction = -0.1", ">= 0")),
        ("grains.packing.size_spread=1.0", ("grains.packing.size_spread = 1.0", "<= 0.905")),
        ("grains.hydraulic_radius_ratio=1.1", ("grains.hydraulic_radius_ratio = 1.1", "<= 1")),
        ("domain.top=lid", ("domain.top", "wall")),
        ("grains.packing.sed=3", ("grains.packing.sed", "seed")),
        ("gate.speed=1", ("gate.speed", "lift_speed")),
        ("time.end=inf", ("time.end",)),
        ("fluid.viscosity=true", ("fluid.viscosity",)),
    ],
)
def test_a_wrong_setting_names_key_bound_and_the_nearest_key(tmp_path, setting, words):
    file = write(tmp_path / "scene.toml", COLUMN)
    with pytest.raises(InputError) as caught:
        load(file, settings=[setting])
    line = caught.value.faults[0].line()
    assert line.startswith("--set: ")
    assert all(word in line for word in words), line


def test_a_wrong_level_that_is_not_chosen_is_found_too(tmp_path):
    wrong = table(quality={"fine": {"fluid": {"step": -1.0}}})
    with pytest.raises(InputError, match=r"quality\.fine\.fluid\.step = -1\.0"):
        load(write(tmp_path / "scene.toml", wrong))


def test_the_full_scene_with_its_defaults_makes_the_same_scene():
    for scene in (column(), load(CASES / "settling_disc"), load(CASES / "column_collapse")):
        full = scene_as_dict(scene)
        assert validate(Scene, full) == scene
        assert full["gravity"] == [0.0, -9.81]
        assert full["output"]["checkpoint_seconds"] > 0

"""`check` warns of choices of method that were seen to change volume or pressure of water."""

import pytest

from continuum_sph.builders.report import report
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.water import setups as trials
from porescale.common.schema.sections import scene_as_dict, validate


def warnings(height, **numerics):
    scene = trials.column_scene(0.05, tank=(1.0, 1.0), column=(1.0, height), **numerics)
    return [text for text in report(scene).warnings if "splashes" in text]


@pytest.mark.parametrize(
    ("numerics", "said"),
    [
        ({"shifting": 2.0}, "swells"),
        ({"gradient": "corrected"}, "shrinks"),
        ({"gradient": "corrected", "shifting": 2.0, "tension": "cut"}, "loses half"),
    ],
)
def test_water_with_a_surface_that_changes_its_volume_is_warned_of(numerics, said):
    (text,) = warnings(0.5, **numerics)
    assert said in text
    assert not warnings(1.0, **numerics)  # it fills the tank


def test_gradients_of_water_in_ground_are_what_they_are_whatever_is_asked_for():
    soil = {"permeability": 1e-3, "held": True, "body": [{"outline": [[0, 0], [1, 0], [1, 0.3], [0, 0.3]]}]}
    for gradient, said in (("corrected", 1), ("plain", 0)):
        scene = trials.column_scene(0.05, tank=(1.0, 1.0), column=(1.0, 0.5), gradient=gradient)
        whole = validate(Scene, {**scene_as_dict(scene), "soil": soil})
        assert sum("numerics.gradient" in text for text in report(whole).warnings) == said  # two lines said so before
        assert not any("splashes" in text for text in report(whole).warnings)


@pytest.mark.parametrize("numerics", [{}, {"gradient": "corrected", "shifting": 2.0}])
def test_what_keeps_volume_best_is_not_warned_of(numerics):
    assert not warnings(0.5, **numerics)


def test_image_walls_are_warned_of_and_walls_that_carry_pressure_are_not():
    given = scene_as_dict(trials.column_scene(0.05, tank=(1.0, 1.0), column=(1.0, 0.5)))
    for kind, said in (("images", 1), ("pressure", 0)):
        whole = validate(Scene, given | {"tank": given["tank"] | {"wall_particles": kind}})
        assert sum("image walls" in text for text in report(whole).warnings) == said


@pytest.mark.parametrize(("pond", "said"), [(0.3, 1), (0.7, 0)])
def test_pores_full_to_far_above_the_open_water_are_warned_of(pond, said):
    bank = {"saturated": True, "held": True, "body": [{"outline": [[0, 0], [0.5, 0], [0.5, 1], [0, 1]]}]}
    given = scene_as_dict(trials.column_scene(0.05, tank=(1.0, 1.0), column=(0.5, pond)))
    given["water"] = {"column": [{"left": 0.5, "width": 0.5, "height": pond}]}
    found = report(validate(Scene, {**given, "soil": bank})).warnings
    assert sum("pores are full to 1 m" in text for text in found) == said


@pytest.mark.parametrize(("lid", "height", "said"), [(True, 1.0, 1), (True, 0.5, 0), (False, 1.0, 0)])
def test_probes_of_water_under_a_lid_that_it_fills_the_tank_to_are_warned_of(lid, height, said):
    given = scene_as_dict(trials.column_scene(0.05, tank=(1.0, 1.0), column=(1.0, height)))
    probed = given | {"tank": given["tank"] | {"lid": lid}, "probe": [{"x": 0.5, "y": 0.2}]}
    assert sum("a lid does not pull" in text for text in report(validate(Scene, probed)).warnings) == said
    assert not any("a lid does not pull" in text for text in report(validate(Scene, given)).warnings)  # no probe

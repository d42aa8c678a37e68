"""`check` warns of choices of method that were seen to change the volume of splashing water."""

import pytest

from continuum_sph.builders.report import report
from continuum_sph.validation.water import setups as trials


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


@pytest.mark.parametrize("numerics", [{}, {"gradient": "corrected", "shifting": 2.0}])
def test_what_keeps_volume_best_is_not_warned_of(numerics):
    assert not warnings(0.5, **numerics)

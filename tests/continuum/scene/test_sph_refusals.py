"""What a scene of soil and water is refused for: ground that holds nothing, strips that keep no level, names given
twice."""

import pytest

from continuum_sph.builders.report import report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate

BLOCK = [[0.3, 0], [0.6, 0], [0.6, 0.4], [0.3, 0.4]]
FLAT = [[0.7, 0], [0.9, 0], [0.9, 0.02], [0.7, 0.02]]  # lower than the middle of the lowest row
WATER = {"sound_speed": 30.0, "column": [{"width": 0.3, "height": 0.3}]}
SUCTION = {"alpha": 4.0, "n": 3.0, "saturation": 0.5}


def scene(*outlines, soil=None, **changes):
    """A block of soil in a tank of 1 m by 0.5 m, with particles of 0.05 m; water where ``changes`` have some."""
    table = {
        "tank": {"width": 1.0, "height": 0.5, "lid": False},
        "soil": {"body": [{"outline": it} for it in outlines or (BLOCK,)]} | (soil or {}),
        "numerics": {"spacing": 0.05},
        "time": {"end": 0.1},
        "output": {"snapshot_interval": 0.1, "series_interval": 0.1},
    }
    return validate(Scene, table | changes)


DRY, MOVING, HELD = {}, {"water": WATER}, {"water": WATER, "soil": {"held": True}}
MOIST = {"water": {"sound_speed": 30.0}, "soil": {"suction": SUCTION}}


@pytest.mark.parametrize("kind", [DRY, MOVING, HELD, MOIST], ids=["dry", "moving", "held", "moist"])
@pytest.mark.parametrize(("outlines", "number"), [((FLAT,), 0), ((BLOCK, FLAT), 1)])
def test_a_body_without_a_particle_is_refused_by_check_and_run(kind, outlines, number):
    for act in (report, Simulation):
        with pytest.raises(InputError, match=rf"soil\.body\[{number}\]\.outline .* holds no particle of soil"):
            act(scene(*outlines, **kind))
    report(scene(**kind))  # the check that fails: a body with particles passes


def test_every_empty_body_is_named_and_one_within_the_column_of_a_pile_is_empty():
    with pytest.raises(InputError) as caught:
        report(scene(FLAT, BLOCK, FLAT))
    assert [fault.key for fault in caught.value.faults] == ["soil.body[0].outline", "soil.body[2].outline"]
    beside = [[0.45, 0.1], [0.5, 0.1], [0.5, 0.4], [0.45, 0.4]]
    low = [[0, 0], [1, 0], [1, 0.1], [0, 0.1]]
    report(scene(low, beside))
    with pytest.raises(InputError, match=r"soil\.body\[1\]\.outline"):
        report(scene(low, beside, pile={"x": 0.475, "tip": 0.05}))

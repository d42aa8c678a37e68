"""Watched parts of the ground: their mean displacement, what is refused, and that none costs nothing."""

import numpy as np
import pytest

from continuum_sph.builders.parts.mixture import MixturePart
from continuum_sph.builders.parts.soil import SoilPart
from continuum_sph.builders.parts.watched import WatchedPart
from continuum_sph.builders.report import report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.tanks import tank_scene
from porescale.common.core.errors import InputError

UPPER = [[0.2, 0.2], [0.4, 0.2], [0.4, 0.4], [0.2, 0.4]]
BODY = {"outline": [[0, 0], [0.4, 0], [0.4, 0.4], [0, 0.4]]}


def scene(*watch, **changes):
    ground = {"stiffness": 1e6, "body": [BODY], "watch": list(watch)}
    return tank_scene(1.0, 0.6, 0.05, 0.2, every=0.1, lid=False, **{"soil": ground} | changes)


def test_a_watched_part_has_the_mean_displacement_of_what_was_in_its_outline():
    model = Simulation(scene({"name": "top", "outline": UPPER}, {"outline": BODY["outline"]}))
    model.advance(40)
    part = model.part(SoilPart)
    upper = (part.first[:, 0] > 0.2) & (part.first[:, 1] > 0.2)  # 4 by 4 of the 8 by 8
    moved, row = part.displacement(), model.series()
    assert upper.sum() == 16
    assert moved[upper].mean() > 1.01 * moved.mean() > 0.0  # the check that fails: another part has another mean
    assert row["top moved (m)"] == moved[upper].mean()
    assert row["part 1 moved (m)"] == moved.mean() == row["mean displacement (m)"]


@pytest.mark.parametrize(
    ("watch", "message"),
    [
        (
            [{"outline": [[0.6, 0.1], [0.7, 0.1], [0.7, 0.2]]}],
            r"soil\.watch\[0\]\.outline .* holds no particle",
        ),
        ([{"outline": [[0.1, 0.1], [0.2, 0.2]]}], r"outline = .*: has 2 entries where at least 3 belong"),
        ([{"outline": []}], r"soil\.watch\[0\]\.outline = \[\] m: has 0 entries where at least 3 belong"),
        ([{"outline": [[0.1, 0.1], [0.4, 0.2], [0.4, 0.1], [0.1, 0.2]]}], r"soil\.watch\[0\]\.outline: crosses itself"),
        (
            [{"outline": [[0.1, 0.1], [0.4, 0.1], [0.5, 0.1], [0.4, 0.1], [0.4, 0.2]]}],
            r"soil\.watch\[0\]\.outline = \(0\.5, 0\.1\) m: is the tip of a spike",
        ),
        ([{"outline": [[0.1, 0.1], [2, 0.2], [1, 1]]}], r"soil\.watch\[0\]\.outline .* lies outside of the tank"),
        ([{"name": "a", "outline": UPPER}] * 2, r"soil\.watch\[1\]\.name = 'a': is that of another part"),
    ],
)
def test_what_cannot_be_watched_is_refused_by_check_and_run(watch, message):
    for act in (report, Simulation):
        with pytest.raises(InputError, match=message):
            act(scene(*watch))


def test_a_scene_without_watched_parts_builds_none():
    model = Simulation(scene())
    assert not any(isinstance(part, WatchedPart) for part in model.parts)
    assert not any("moved" in name for name in model.series())


def test_parts_are_watched_in_water_too():
    model = Simulation(scene({"name": "top", "outline": UPPER}, water={"column": [{"width": 1.0, "height": 0.5}]}))
    assert any(isinstance(part, MixturePart) for part in model.parts)
    model.advance(3)
    found = model.series()["top moved (m)"]
    assert np.isfinite(found)
    assert found > 0.0

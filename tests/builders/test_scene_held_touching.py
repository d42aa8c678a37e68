"""Held discs alone touch their own images; refusals say by how much, and `check` refuses what the run refuses."""

import pytest

from porescale.builders.build import build
from porescale.builders.report import report
from porescale.common.core.errors import InputError
from porescale.scene.scene import Scene
from tests.reference.scenes import dry

PERIODIC = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")
WALLED = PERIODIC | {"bottom": "wall", "top": "wall"}


def disc(x, y, diameter, **more):
    return {"x": x, "y": y, "diameter": diameter, **more}


def driven(sides, *discs, **more):
    """A box of 8 mm of a driven liquid."""
    return Scene(
        domain={"width": 8e-3, "height": 8e-3} | sides, time={"end": 1.0}, gravity=(0.0, 0.0), disc=discs,
        output={"snapshot_interval": 1.0, "series_interval": 1.0},
        fluid={"density": 1000, "viscosity": 2.5e-5, "spacing": 5e-4, "relaxation_time": 0.8, "body_force": (1.0, 0.0)},
        **more,
    )  # fmt: skip


def refusals(scene):
    """What `check` and the run say."""
    said = []
    for read in (report, lambda given: build(given).advance(6)):
        try:
            read(scene)
        except InputError as error:
            said.append(str(error))
        else:
            said.append("")
    return said


@pytest.mark.parametrize(
    ("sides", "discs"),
    [
        (PERIODIC, [disc(4e-3, 4e-3, 8e-3)]),  # touches its images on all sides
        (PERIODIC, [disc(4.1e-3, 4.03e-3, 7.9e-3)]),
        (PERIODIC, [disc(4e-3, 4e-3, 7.9e-3, velocity=(0.01, 0.0))]),
        (PERIODIC, [disc(2e-3, 2e-3, 4e-3), disc(6e-3, 6e-3, 4e-3)]),
        (WALLED, [disc(4e-3, 4e-3, 8e-3)]),
        (WALLED, [disc(4e-3, 2e-3 - 3.9e-6, 4e-3)]),  # less than a thousandth of the diameter in the wall
        (PERIODIC, [disc(4e-3, 2e-3, 4e-3), disc(4e-3, 6e-3 - 3.9e-6, 4e-3)]),  # and as deep in another
    ],
)
def test_held_discs_may_touch(sides, discs):
    assert refusals(driven(sides, *discs)) == ["", ""]


@pytest.mark.parametrize(
    ("sides", "discs", "said"),
    [
        (PERIODIC, [disc(4e-3, 4e-3, 8.1e-3)], "disc[0].diameter = 0.0081 m: overlaps its own image by 0.0001 m"),
        (WALLED, [disc(4e-3, 3.9e-3, 8e-3)], "disc[0] = '(0.004, 0.0039)': reaches out of the box by 0.0001 m"),
        (WALLED, [disc(4e-3, 2e-3 - 4.1e-6, 4e-3)], "reaches out of the box by 4.1e-06 m"),
        (PERIODIC, [disc(4e-3, 2e-3, 4e-3), disc(4e-3, 6e-3 - 4.1e-6, 4e-3)], "disc[1]: overlaps disc 0 by 4.1e-06 m"),
        (PERIODIC, [disc(0.5e-3, 2e-3, 2e-3), disc(7.5e-3, 2e-3, 2e-3)], "disc[1]: overlaps disc 0 by 0.001 m"),
    ],
)
def test_what_overlaps_is_refused_by_how_much(sides, discs, said):
    check, run = refusals(driven(sides, *discs))
    assert said in check
    assert check == run


def test_films_between_held_discs_still_need_their_room():
    check, run = refusals(driven(PERIODIC, disc(4e-3, 4e-3, 7.9e-3), lubrication={}))
    assert "so short that" in check
    assert check == run


def test_a_periodic_box_may_hold_a_rectangle_alone():
    assert refusals(driven(PERIODIC, rectangle=[{"lower": (2e-3, 2e-3), "upper": (5e-3, 5e-3)}])) == ["", ""]


PACKED = {
    "left": 0.0,
    "width": 12e-3,
    "height": 4e-3,
    "diameter": 1e-3,
    "packing_fraction": 0.4,
    "settle": False,
    "seed": 1,
}


@pytest.mark.parametrize(
    "more",
    [
        {
            "polygon": [
                {"corners": [[0, 0], [3e-3, 0], [3e-3, 2e-3], [0, 2e-3]], "thickness": 1e-4, "at": [[2e-3, 1e-3]]}
            ]
        },
        {"disc": [disc(5e-3, 2e-3, 2e-3)]},
        {"grains__grain": [{"x": 5e-3, "y": 2e-3, "diameter": 2e-3}]},
    ],
    ids=["polygon", "disc", "grain"],
)
def test_a_packing_is_made_around_what_stands_in_it_where_there_is_room(more):
    assert refusals(dry(grains__packing=PACKED, **more)) == ["", ""]
    check, run = refusals(dry(grains__packing={**PACKED, "packing_fraction": 0.79}, **more))
    assert "do not fit beside what stands in it" in check, check
    assert check == run

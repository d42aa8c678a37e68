"""Grains that do not fit the rectangle of their packing are named by their sizes, by `check` as by the run."""

import pytest

from porescale import load
from porescale.builders.build import build
from porescale.builders.derive import derive
from tests.reference.folders import CASES
from tests.reference.scenes import dry, refusals, table

SIZES = ("diameter", "packing_fraction")
"""Keys that `sizes` stands for."""


def packed(**changes):
    """The small dry column in a box of half as much again, with changes of its packing, which settles."""
    kept = {name: value for name, value in table()["grains"]["packing"].items()
            if not (name in SIZES and "sizes" in changes)}  # fmt: skip
    return dry(domain__height=0.012, gate={"x": 0.008}, grains={"density": 2500, "packing": {**kept, **changes}})


@pytest.mark.parametrize(
    ("changes", "key", "room"),
    [
        ({"diameter": 2.0}, "diameter", "0.004"),
        ({"diameter": 0.0032, "size_spread": 0.5, "seed": 2}, "diameter", "0.004"),  # the largest that is drawn
        ({"diameter": 2.0, "settle": False, "packing_fraction": 0.6}, "diameter", "0.004"),
        ({"diameter": 0.0035, "height": 0.003, "settle": False, "packing_fraction": 0.6}, "diameter", "0.003"),
        ({"sizes": [[0.0041, 1], [0.0008, 4]]}, "sizes", "0.004"),
    ],
)
def test_a_grain_that_is_wider_than_its_packing_is_named(changes, key, room):
    (line,) = refusals(lambda: derive(packed(**changes)))
    assert line.partition(" = ")[0].partition(":")[0] == f"grains.packing.{key}"
    assert f"is wider than the {room} m across of where it is placed" in line


def test_a_size_that_might_be_drawn_and_is_not_is_not_refused():
    # The check that must fail: up to 0.0048 m might be drawn as above, in 0.004 m; with this seed the run places it.
    scene = packed(diameter=0.0032, size_spread=0.5, seed=1)
    assert derive(scene).grain_count == build(scene).grains.discs.count == 2


def test_head_room_that_a_large_grain_takes_is_said_of_its_diameter():
    # Of 0.012 m: grains of 3 mm need 0.0095 + 0.7 * 0.001 / 0.75 + 0.003 m, those of 0.9 mm in 0.0025 m less.
    (line,) = refusals(lambda: derive(packed(diameter=0.003, height=0.001, bottom=0.0095)))
    assert line.startswith("grains.packing.diameter = 0.003 m: is placed up to 0.01343 m before it settles")
    (line,) = refusals(lambda: derive(packed(diameter=0.0009, height=0.0025, bottom=0.0095)))
    assert line.startswith("grains.packing.height = 0.0025 m: is placed up to 0.01273 m before it settles")


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (["permeability.window.bottom='2.5 cm'", "permeability.window.height='4 mm'"], ["no grain stands in it"]),
        (["permeability.window.height='4 mm'"], ["hydraulic diameters long"]),
        (["permeability.window.height='5 mm'"], []),  # 4.2 of λ d
        (["permeability.direction='x'"], []),
    ],
)
def test_a_window_in_which_nothing_is_measured_is_warned_of(settings, said):
    warnings = derive(load(CASES / "permeameter", settings=settings)).warnings
    found = [it for it in warnings if it.startswith("permeability.window")]
    assert len(found) == len(said)
    assert all(part in it for part, it in zip(said, found, strict=True))

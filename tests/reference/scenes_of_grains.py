"""Small dry scenes of grains, what refuses them, and runs that are taken up again."""

from typing import Any

import numpy as np

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.derive import derive
from tests.reference.scenes import column, dry, grain, refusals


def loose(*grains: dict[str, Any], **changes: Any) -> Scene:
    """A dry box with grains placed by hand and nothing else."""
    return dry(**{"grains": {"density": 2500, "grain": list(grains)}, **changes})


BOX = {"width": 0.012, "height": 0.008}


def framed(**changes: Any) -> Scene:
    """A dry box with density, law and energy book, and nothing in it but what is told, such as polygons."""
    given = {"grains": {"density": 2500, **changes.pop("grains", {})}, "domain": BOX, "output__energy": True}
    return loose(**{**given, **changes})


def lines(**changes: Any) -> list[str]:
    """The refusals of a dry box with two grains, changed as in ``table``."""
    given = {"fluid": None, "gate": None, "grains": {"density": 2500, "grain": [grain(0.002, 0.002)]}}
    return refusals(lambda: derive(column(**{**given, **changes})))


def resumed(scene: Scene, before: int, after: int) -> tuple[Any, Any]:
    """A simulation after ``before + after`` steps, and one that took up its state in between."""
    whole, again = build(scene), build(scene)
    whole.advance(before)
    again.restore(whole.state())
    whole.advance(after)
    again.advance(after)
    return whole, again


def assert_same_bits(one: Any, other: Any) -> None:
    """Two simulations are in the same state and say the same."""
    for name in ("position", "angle", "velocity", "spin", "force", "torque"):
        np.testing.assert_array_equal(getattr(one.grains.discs, name), getattr(other.grains.discs, name), err_msg=name)
    assert one.series() == other.series()
    assert one.tables() == other.tables()

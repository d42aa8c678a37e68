"""Walls under a load hold it, or the check says at which speed they do."""

import math
import re

from porescale.builders.derive import derive
from porescale.scene.scene import Scene

RADIUS, STIFFNESS, LOAD, COUNT = 0.01, 1e3, 0.1, 10
MASS = 2500 * math.pi * RADIUS**2


def column(fastest: float, **lid: object) -> Scene:
    """Ten discs in a row under a lid, without weight."""
    given = {"kind": "wall", "force": LOAD, "fastest": fastest} | lid
    return Scene.model_validate({
        "gravity": [0, 0],
        "domain": {"width": 0.03, "height": 0.2, "left": "wall", "right": "wall", "bottom": "wall", "top": given},
        "time": {"end": 10.0},
        "output": {"snapshot_interval": 10.0, "series_interval": 0.1},
        "contact": {"stiffness": STIFFNESS, "restitution": 0.9, "friction": 0.0},
        "grains": {"density": 2500, "grain": [
            {"x": 0.015, "y": RADIUS * (2 * k + 1), "diameter": 2 * RADIUS} for k in range(COUNT)]},
    })  # fmt: skip


def warned(scene: Scene) -> list[str]:
    return [line for line in derive(scene).warnings if "hammer" in line]


def test_a_wall_that_hits_too_hard_for_its_load_is_warned_of():
    blow = 0.2 * math.sqrt(STIFFNESS * MASS)  # of a linear spring: V sqrt(k m)
    (line,) = warned(column(0.2))
    assert line.startswith("domain.top.fastest = 0.2 m/s")
    assert f"{blow:.3g} N/m, {blow / LOAD:.2g} times" in line
    repaired = float(re.search(r"([\d.e-]+) m/s holds it", line)[1])
    assert repaired <= 10 * LOAD / math.sqrt(STIFFNESS * MASS) < 1.2 * repaired  # two digits, rounded down
    assert warned(column(repaired)) == []
    # One grain finds room along the lid: a stress acts on all of its 3 cm.
    assert warned(column(0.2, force=None, stress=LOAD / 0.03)) == [line]
    # The check that must fail: six times the load.
    assert warned(column(0.2, force=6 * LOAD)) == []

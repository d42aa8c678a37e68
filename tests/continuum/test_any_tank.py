"""Tanks of water and soil with keys thrown together at random: what the check accepts runs, and goes on bit for bit."""

import copy
import warnings
from collections.abc import Callable
from random import Random
from typing import Any

import numpy as np
import pytest

from continuum_sph import InputError, PorescaleWarning, Scene, build, check

SPACING = 0.05
STEPS, TRIED = 12, 14
"""Steps before and after a state is taken; keys that are tried on a tank, of which the check leaves some."""
Table = dict[str, Any]


def tank(rng: Random) -> Table:
    """A tank of water, of dry soil, of soil full of water, or of soil with suction."""
    wide, ground = rng.randrange(16, 30) * SPACING, rng.randrange(4, 9) * SPACING
    foot = rng.choice([0.0, 6 * SPACING])
    outline = [[foot, 0], [wide, 0], [wide, ground], [foot + 4 * SPACING if foot else 0, ground]]
    soil = {"density": 1590, "porosity": 0.4, "stiffness": 2e6, "permeability": 1e-2, "body": [{"outline": outline}]}
    scene = {
        "tank": {"width": wide, "height": 1.0, "lid": False}, "numerics": {"spacing": SPACING}, "time": {"end": 0.5},
        "output": {"snapshot_interval": 0.25, "series_interval": 0.1},
    }  # fmt: skip
    column = {"water": {"column": [{"width": 0.3, "height": 0.4}]}}
    suction = {"alpha": 5.0, "n": 2.5, "water_table": 0.2}
    return scene | rng.choice([
        column, {"soil": soil}, {"soil": soil | {"saturated": True}}, {"soil": soil | {"saturated": True}} | column,
        {"soil": soil | {"suction": suction}},
    ])  # fmt: skip


def put(section: str, value: Any, *, more: bool = False) -> Callable[[Table], None]:
    """What sets keys of a section that is there, or adds one more of a list of sections."""

    def change(scene: Table) -> None:
        *above, last = section.split(".")
        inside = scene
        for part in above:
            inside = inside[part]
        if more:
            inside.setdefault(last, []).append(value)
        elif isinstance(inside.get(last), dict) and isinstance(value, dict):
            inside[last] |= value
        else:
            inside[last] = value

    return change


RIVER = [{"left": 0, "right": 6 * SPACING, "rise": [[0, 0.2], [0.02, 0.3]]}]
KEYS: tuple[Callable[[Table], None], ...] = (
    put("probe", {"x": 0.1, "y": 0.1, "width": 0.2, "height": 0.2}, more=True), put("level", {"x": 0.1}, more=True),
    put("face", [{"side": "left", "head": 0.6}]), put("reservoir", RIVER), put("pile", {"x": 0.4, "tip": SPACING}),
    put("air", {}), put("output.energy", True), put("numerics.gradient", "corrected"), put("numerics.shifting", 1.0),
    put("numerics.smoothing_ratio", 1.6), put("numerics.kernel", "cubic"), put("numerics.density_filter", 4),
    put("numerics.xsph", 0.3), put("numerics.smoothing_length", "evolved"), put("soil.held", True),
    put("soil.cohesion", 2e3), put("soil.dilatancy_angle", "5 degree"), put("soil.stress", "none"),
    put("soil.tension", 500.0), put("soil.exponent", 0.5), put("soil.numerics", {"gradient": "plain"}),
    put("soil.numerics", {"settle": 0.02}), put("soil.numerics", {"damping_of": "bounded"}),
    put("water", {"viscosity": 1.0}), put("tank.walls", "stick"), put("tank.lid", True), put("gravity", 98.0),
)  # fmt: skip


def taken(scene: Table) -> Scene | None:
    """The scene, None where it is refused."""
    try:
        made = Scene(**scene)
        check(made)
    except InputError:
        return None
    return made


@pytest.mark.parametrize("seed", range(40, 56))
def test_what_the_check_accepts_runs_and_goes_on_bit_for_bit(seed):
    """It found a filter of densities that made those of waiting particles nan (52)."""
    rng = Random(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PorescaleWarning)
        scene = tank(rng)
        made = taken(scene)
        assert made is not None
        for change in rng.sample(KEYS, TRIED):
            other = copy.deepcopy(scene)
            try:
                change(other)
            except KeyError:  # of a section that it has not
                continue
            if (found := taken(other)) is not None:
                scene, made = other, found
        one, two = build(made), build(made)
    one.advance(STEPS)
    two.restore(one.state())
    for model in (one, two):
        model.advance(STEPS)
        model.check()
    rows = [np.array(list(model.series().values()), float) for model in (one, two)]
    assert np.array_equal(rows[0], rows[1], equal_nan=True)

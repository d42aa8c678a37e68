"""Scenes thrown together at random: what the check accepts is built and, where nothing drives it, stays at rest."""

import warnings
from collections.abc import Callable
from random import Random
from typing import Any

import numpy as np
import pytest

from porescale import InputError, PorescaleWarning, Scene, build, check
from porescale.builders.scene import Scene as PorescaleScene

WIDTH, CELL = 0.04, 1e-3
COUNT, LEAST = 200, 30
"""Scenes thrown, and how many of them the check must accept for the test to mean anything (1 of 3 to 5 are)."""
STEPS = 20
STILL = 1e-9
"""m/s: pushed apart from an overlap of a millionth of a millimetre a disc of 2 mm would be faster after one step."""


def ring_of(rng: Random, x: float, y: float) -> dict[str, Any]:
    """A closed container."""
    radius, turn = rng.uniform(0.004, 0.01), np.linspace(0.0, 2.0 * np.pi, 21)
    chain = np.column_stack((x + radius * np.cos(turn), y + radius * np.sin(turn)))
    return {"chain": [*chain[:-1].tolist(), chain[0].tolist()], "thickness": 5e-4}


BODIES: dict[str, Callable[[Random, float, float], dict[str, Any]]] = {
    "grain": lambda rng, x, y: {"x": x, "y": y, "diameter": rng.uniform(0.002, 0.006)},
    "disc": lambda rng, x, y: {"x": x, "y": y, "diameter": rng.uniform(0.002, 0.01)},
    "clump": lambda rng, x, y: {
        "discs": [[-0.002, 0, 0.003], [0.002, 0, 0.003]], "at": [[x, y]], "angle": [rng.uniform(0.0, 3.0)],
    },
    "polygon": lambda rng, x, y: {
        "sides": rng.choice([3, 4, 5, 8]), "diameter": rng.uniform(0.004, 0.008), "thickness": 5e-4, "at": [[x, y]],
        "angle": [rng.uniform(0.0, 3.0)],
    },
    "segment": lambda rng, x, y: {
        "ends": [[-0.005, 0, 0.005, 0]], "thickness": 5e-4, "at": [[x, y]], "angle": [rng.uniform(0.0, 3.0)],
    },
    "container": lambda rng, x, y: ring_of(rng, x, y) if rng.random() < 0.5 else {
        "ends": [[x, y, rng.uniform(0, WIDTH), rng.uniform(0, WIDTH)]], "thickness": 5e-4,
    },
    "rectangle": lambda rng, x, y: {
        "lower": [x, y], "upper": [x + rng.uniform(0.002, 0.008), y + rng.uniform(0.002, 0.008)],
    },
    "wall": lambda rng, x, y: {"x": x, "y": y, "normal": [rng.uniform(-1, 1), rng.uniform(-1, 1)]},
    "gate": lambda rng, x, y: {"x": round(x / CELL) * CELL},
    "ring": lambda rng, x, y: {"x": x, "y": y, "diameter": rng.uniform(0.02, 0.045)},
    "packing": lambda rng, x, y: {
        "settle": False, "left": 0.5 * x, "bottom": 0.5 * y, "width": rng.uniform(0.01, 0.03), "height": 0.02,
        "diameter": 0.002, "packing_fraction": 0.5,
    },
}  # fmt: skip


def side(rng: Random) -> Any:
    """A kind of side for fluid."""
    return rng.choice(["wall", "slip", {"kind": "pressure"}, {"kind": "velocity", "velocity": [0.0, 0.0]}])


def box() -> dict[str, Any]:
    """A table of a box without bodies and gravity."""
    return {
        "gravity": [0, 0], "domain": {"width": WIDTH, "height": WIDTH}, "time": {"end": 1},
        "output": {"snapshot_interval": 1, "series_interval": 1}, "grains": {"density": 2000},
        "contact": {"stiffness": 1e5, "tangential_stiffness": 5e4, "restitution": 0.5, "friction": 0.3},
    }  # fmt: skip


def thrown(seed: int, wet: bool) -> dict[str, Any]:
    """A table of one to three bodies in a box of some sides, with fluid or without."""
    rng, scene = Random(seed), box()
    if wet:
        scene["fluid"] = {"viscosity": 1e-4, "spacing": CELL, "step": 1e-3}
        scene["grains"]["hydraulic_radius_ratio"] = 1.0
        scene["domain"] |= {name: side(rng) for name in ("left", "right", "bottom", "top")}
    if rng.random() < 0.3:
        scene["domain"] |= {"left": "periodic", "right": "periodic"}
    for _ in range(rng.choice([1, 2, 2, 3])):
        kind = rng.choice(list(BODIES))
        made = BODIES[kind](rng, rng.uniform(0.0, WIDTH), rng.uniform(0.0, WIDTH))
        where = scene["grains"] if kind in ("grain", "packing") else scene
        if kind in ("gate", "ring", "packing"):
            where[kind] = made
        else:
            where.setdefault(kind, []).append(made)
    return scene


def accepted(seed: int, wet: bool) -> PorescaleScene | None:
    """The scene, None where it is refused."""
    try:
        scene = Scene(**thrown(seed, wet))
        check(scene)
    except InputError:
        return None
    return scene


@pytest.mark.parametrize("wet", [False, True])
def test_what_the_check_accepts_is_built_and_stays_at_rest(wet):
    """It found a gate under an open side, which ended in a traceback."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PorescaleWarning)
        scenes = {seed: made for seed in range(COUNT) if (made := accepted(seed, wet)) is not None}
        assert len(scenes) >= LEAST
        for seed, scene in scenes.items():
            simulation = build(scene)
            if not wet:  # each law of fluid is compiled anew: built is enough
                simulation.advance(STEPS)
                assert simulation.series().get("largest grain speed (m/s)", 0.0) < STILL, seed


def test_what_overlaps_would_be_seen_to_move():  # the check that must fail
    two = [{"x": 0.02 + k * 0.00399, "y": 0.02, "diameter": 0.004} for k in range(2)]
    simulation = build(Scene(**box() | {"grains": {"density": 2000, "overlap": 0.1, "grain": two}}))
    simulation.advance(STEPS)
    assert simulation.series()["largest grain speed (m/s)"] > STILL

"""What no state of a model can hold is said before a model takes it up, by its place; what one can hold is not."""

import copy
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from porescale.common.record.check_state import other, senseless

NAN = float("nan")
STATE: dict[str, Any] = {
    "grains": {
        "discs": {"position": np.zeros((3, 2)), "spin": np.zeros(3)},
        "pairs": {"start": np.array([0, 2, 3, 3]), "partner": np.array([1, 2, 2], np.int32),
                  "carried": np.zeros((3, 1))},
        "segments": {"corner": np.array([[0, 2]]), "corner_memory": np.zeros((1, 1)), "near": np.array([[1, 4]]),
                     "near_memory": np.zeros((1, 1)), "listed": 1},
        "bonds": {"ends": np.array([[0, 1, 0], [2, 5, 1]]), "back": np.ones(2), "whole": np.ones(2, np.uint8),
                  "broken": np.full((2, 3), NAN)},
    },
    "flow": {"limited": [3, 0], "rule": 1, "limit": float("inf"), "time": 0.5, "lasted": np.array(3)},
}  # fmt: skip
"""Three discs, with a segment and bonds; and a flow."""
Change = Callable[[dict[str, Any]], object]


def put(place: str, index: Any, value: Any) -> Change:
    """Writes into an array."""

    def change(state: dict[str, Any]) -> None:
        *path, name = place.split(".")
        for key in path:
            state = state[key]
        state[name][index] = value

    return change


def to(place: str, made: Callable[[Any], Any]) -> Change:
    """Makes something else of what is there."""

    def change(state: dict[str, Any]) -> None:
        *path, name = place.split(".")
        for key in path:
            state = state[key]
        state[name] = made(state[name])

    return change


PAIRS = "grains.pairs."
SENSELESS: dict[str, tuple[Change, str]] = {
    "below zero": (put(f"{PAIRS}partner", 0, -1), "pairs.partner: -1 is none of 3"),
    "beyond": (put(f"{PAIRS}partner", 2, 3), "pairs.partner: 3 is none of 3"),
    "starts late": (put(f"{PAIRS}start", 0, 1), "pairs.start: does not rise"),
    "ends late": (put(f"{PAIRS}start", -1, 4), "pairs.start: does not rise"),
    "goes back": (put(f"{PAIRS}start", 1, 4), "pairs.start: does not rise"),
    "no start": (to(f"{PAIRS}start", lambda it: it[:0]), "pairs.start: 0 for 3 discs"),
    "of others": (to(f"{PAIRS}start", lambda it: np.append(it, 3)), "pairs.start: 5 for 3 discs"),
    "broken numbers": (to(f"{PAIRS}partner", lambda it: it + 0.5), "pairs.partner: no row of whole numbers"),
    "in a square": (to(f"{PAIRS}partner", lambda it: it[None]), "pairs.carried: (3,) rows for (1,)"),
    "a word": (to(f"{PAIRS}start", lambda it: "all"), "pairs.start: no row of whole numbers"),
    "springs missing": (to(f"{PAIRS}carried", lambda it: it[:2]), "pairs.carried: (2,) rows for (3,) of partner"),
    "corner": (put("grains.segments.corner", (0, 1), 3), "segments.corner: 3 is none of 3"),
    "corner below": (put("grains.segments.corner", (0, 0), -1), "segments.corner: -1 is none of 3"),
    "near": (put("grains.segments.near", (0, 0), 3), "segments.near: 3 is none of 3"),
    "near below": (put("grains.segments.near", (0, 1), -2), "segments.near: below zero"),
    "corners of three": (to("grains.segments.corner", lambda it: np.zeros((1, 3), int)), "no rows of 2 whole numbers"),
    "bond": (put("grains.bonds.ends", (0, 0), 9), "bonds.ends: 9 is none of 3"),
    "bond of discs": (put("grains.bonds.ends", (0, 1), 9), "bonds.ends: none of 3 discs"),
    "bond of neither": (put("grains.bonds.ends", (0, 2), 2), "bonds.ends: none of 3 discs"),
    "bonds without force": (to("grains.bonds.back", lambda it: it[:1]), "bonds.back: (1,) rows for (2,) of ends"),
    "no number": (put("grains.discs.position", (1, 1), NAN), "discs.position: no number in it"),
    "no time": (to("flow.time", lambda it: NAN), "flow.time: no number in it"),
    "no rule": (to("flow.rule", lambda it: 2), "flow.rule: 2 of 2"),
    "rule below": (to("flow.rule", lambda it: -1), "flow.rule: -1 of 2"),
}  # fmt: skip
OTHER: dict[str, tuple[Change, str]] = {
    "discs": (to("grains.discs.spin", lambda it: np.zeros(4)), "grains.discs.spin: (4,) in place of (3,)"),
    "one of them": (to("grains.discs.spin", lambda it: it[:1]), "grains.discs.spin: (1,) in place of (3,)"),
    "in space": (to("grains.discs.position", lambda it: np.zeros((3, 3))), "(3, 3) in place of (3, 2)"),
    "of two": (to(f"{PAIRS}carried", lambda it: np.zeros((3, 2))), "pairs.carried: (3, 2) in place of (3, 1)"),
    "bits": (to("grains.discs.spin", lambda it: it.astype(np.float32)), "float32 in place of float64"),
    "truths": (to("grains.discs.spin", lambda it: it > 0), "bool in place of float64"),
    "a list": (to("grains.discs.spin", lambda it: [0.0] * 3), "grains.discs.spin: list in place of an array"),
    "no table": (to("grains.discs", lambda it: 1), "grains.discs: int in place of a table"),
    "a word for a number": (to("flow.time", lambda it: "late"), "flow.time: str in place of a number"),
    "rules": (to("flow.limited", lambda it: [1]), "flow.limited: not 2 entries"),
    "a row for a number": (to("flow.lasted", lambda it: np.array([3])), "flow.lasted: (1,) in place of ()"),
}  # fmt: skip


@pytest.mark.parametrize("name", SENSELESS)
def test_what_no_state_holds_is_said_by_its_place(name):
    change, said = SENSELESS[name]
    state = copy.deepcopy(STATE)
    change(state)
    assert said in senseless(state)


@pytest.mark.parametrize("name", OTHER)
def test_what_another_model_holds_is_said_by_its_place(name):
    change, said = OTHER[name]
    state = copy.deepcopy(STATE)
    change(state)
    assert said in other(STATE, state)


LATER: dict[str, Change] = {
    "as it was": lambda state: None,
    "more neighbours": lambda state: state["grains"]["pairs"].update(
        start=np.array([0, 2, 4, 4]), partner=np.array([1, 2, 0, 2], np.int32), carried=np.ones((4, 1))
    ),
    "no bonds left": lambda state: state["grains"].pop("bonds"),
    "a bond broke": lambda state: put("grains.bonds.broken", 0, (1.0, 0.1, 0.2))(state),
    "more than there was": lambda state: state["flow"].update(power=np.zeros(3)),
    "a later time": lambda state: state["flow"].update(time=np.float64(0.75), rule=0),
}


@pytest.mark.parametrize("name", LATER)
def test_what_a_state_can_become_is_not_refused(name):  # the twin that must not fail
    state = copy.deepcopy(STATE)
    LATER[name](state)
    assert senseless(state) == ""
    assert other(STATE, state) == ""
    assert other(state, STATE) == ""

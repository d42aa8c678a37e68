"""A gate whose end fluid passes is refused by the check, where building its plate ended in a traceback."""

import pytest

from porescale.builders.derive import derive
from tests.reference.scenes import refusals, water

OPEN = {"kind": "pressure"}


def gated(x=0.004, **domain):
    """Water 12 by 8 mm, cells of 0.2 mm, and a gate at ``x`` (m)."""
    sides = {"left": "wall", "right": "wall"} | domain
    return water(gate={"x": x}, **{f"domain__{side}": kind for side, kind in sides.items()})


@pytest.mark.parametrize("side", ["bottom", "top"])
def test_a_gate_stands_on_and_under_what_turns_the_fluid_back(side):
    (line,) = refusals(lambda: derive(gated(**{side: OPEN})))
    assert line.startswith(f"domain.{side} = 'pressure': fluid passes where the gate ends")
    assert derive(gated(**{side: "slip"})).gate_column == 20


@pytest.mark.parametrize(("side", "x", "away"), [("left", 2e-4, 4e-4), ("right", 0.0118, 0.0116)])
def test_a_gate_stands_two_cells_from_a_side_that_fluid_passes(side, x, away):
    (line,) = refusals(lambda: derive(gated(x, **{side: OPEN})))
    assert line.startswith(f"domain.{side} = 'pressure': fluid passes where the gate ends")
    assert derive(gated(away, **{side: OPEN})).gate_column
    assert derive(gated(x)).gate_column

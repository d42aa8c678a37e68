"""Rectangles that leave a side: the gap behind them is refused or warned of; and densities that a run came to."""

from typing import Any

import numpy as np
import pytest

import porescale as ps
from porescale.builders.after_run import density_doubt
from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.scene.scene import Scene
from tests.reference.scenes import refusals, warned, water

PISTON: dict[str, Any] = {"lower": [0.0, 0.0], "upper": [0.002, 0.008], "velocity": [0.05, 0.0]}
"""From the left side, over the whole height of 8 mm; 1.2 mm further in 0.024 s."""
OUTLET: dict[str, Any] = {"kind": "pressure", "pressure": 0}


def channel(*sections: dict[str, Any], **changes: Any) -> Scene:
    """A box of 60 x 40 cells, 12 x 8 mm, with an outlet on the right."""
    given = {"domain__left": "wall", "domain__right": OUTLET, "domain__top": "wall", "fluid__body_force": None,
             "gravity": [0, 0], "rectangle": list(sections)}  # fmt: skip
    return water(**{**given, **changes})


def gaps(scene: Scene) -> list[str]:
    """The warnings of gaps."""
    return warned(scene, "the gap behind it")


@pytest.mark.parametrize(
    ("section", "changes", "first"),
    [
        ({}, {}, "lower.x <= -0.0012 m"),
        ({"lower": [0.0, -1.0], "upper": [0.002, 1.0]}, {}, "lower.x <= -0.0012 m"),
        ({"lower": [-0.0002, 0.0]}, {}, "lower.x <= -0.0012 m"),  # begins outside, but comes in
        ({"lower": [0.01, 0.0], "upper": [0.013, 0.008], "velocity": [-0.05, 0.0]},
         {"domain__left": OUTLET, "domain__right": "wall"}, "upper.x >= 0.0132 m"),
        ({"upper": [0.012, 0.002], "velocity": [0.0, 0.05]},
         {"domain__right": "wall", "domain__top": OUTLET}, "lower.y <= -0.0012 m"),
    ],
)  # fmt: skip
def test_a_rectangle_that_leaves_a_closed_side_is_refused(section, changes, first):
    (line,) = refusals(lambda: derive(channel({**PISTON, **section}, **changes)))
    assert line.startswith("rectangle[0]: moves away from the ")
    assert "which lets no fluid in: the gap behind it grows from 0 to 0.00" in line
    assert line.endswith(f"let it begin outside, with {first}")


@pytest.mark.parametrize(
    ("section", "changes"),
    [
        ({"lower": [-0.0012, 0.0]}, {}),  # the repair
        ({"stops_at": 0.0015}, {}),  # 0.075 mm: less than half of a cell of 0.2 mm
        ({"starts_at": 0.024}, {}),
        ({"upper": [0.002, 0.007]}, {}),  # fluid comes in past it
        ({"velocity": [-0.05, 0.0]}, {}),  # into the side
        ({}, {"domain__bottom": OUTLET, "domain__top": "wall", "rectangle": []}),
    ],
)
def test_what_opens_no_gap_is_not(section, changes):
    assert not gaps(channel(**{"rectangle": [{**PISTON, **section}], **changes}))


def test_a_piston_in_the_middle_thins_what_is_behind_it():
    # 6 mm before and 7.2 mm after: by a sixth, which is warned of; from 2 mm on by 3/8, which is refused.
    inside = {**PISTON, "lower": [0.006, 0.0], "upper": [0.008, 0.008]}
    (line,) = gaps(channel(inside))
    assert "the gap behind it grows from 0.006 to 0.0072 m, and the density in it falls by 0.17; " in line
    (line,) = refusals(lambda: derive(channel({**inside, "lower": [0.002, 0.0]})))
    assert "falls by 0.38" in line
    # Another rectangle fills the gap and goes along: nothing is said.
    follows = {**PISTON, "lower": [-0.0012, 0.0], "upper": [0.006, 0.008]}
    assert not gaps(channel(inside, follows))
    # The run agrees, as far as half a cell at each of the two edges: 2 % of it.
    model = build(channel({**inside, "ramp": 0.01}))
    model.run()
    excess, *_, solid = model.fields()
    behind = excess[:, :30][solid[:, :30] == 0.0].mean() / 1000
    gone = 0.05 * (0.024 - 0.005)
    assert behind == pytest.approx(-gone / (0.006 + gone), abs=0.02)


def test_a_density_far_from_that_at_rest_is_warned_of_at_the_end():
    series = {"time (s)": np.arange(3.0), "lowest relative density ()": np.array([1.0, 0.69, 0.9]),
              "highest relative density ()": np.array([1.0, 1.1, 1.29])}  # fmt: skip
    assert density_doubt(series).startswith("the density came to 0.69 of that at rest, at t = 1 s: further than 0.3")
    denser = {**series, "highest relative density ()": np.array([1.0, 1.1, 1.35])}
    assert density_doubt(denser).startswith("the density came to 1.35 of that at rest, at t = 2 s")
    assert density_doubt({**series, "lowest relative density ()": np.array([1.0, 0.71, 0.9])}) == ""
    assert density_doubt({"time (s)": np.arange(3.0)}) == ""


def test_a_run_warns_of_its_density(tmp_path, monkeypatch, recwarn):
    monkeypatch.setattr("porescale.builders.after_run.DENSITY", 1e-9)
    output = {"output__report": False, "time__end": 0.001}
    ps.run(channel({**PISTON, "lower": [-0.01, 0.0]}, **output), tmp_path / "run", progress=False)
    assert [str(it.message) for it in recwarn if "of that at rest" in str(it.message)]


def test_a_piston_before_a_shut_gate_is_warned_of():
    # 1.2 mm of a box of 12 mm: a tenth of all fluid, taken out beyond the gate as before it.
    box: dict[str, Any] = {"domain__right": "wall", "fluid__step": 1e-5}
    piston = PISTON | {"lower": [-0.004, 0.0]}
    (line,) = warned(channel(piston, **box, gate={"x": 0.008, "opens_at": 0.1}), "while the gate is shut")
    assert line.startswith("rectangle 0 comes in while")
    assert "beyond the gate falls by 0.1;" in line
    # The check that must fail: open from the start on, or with its mass left as it is.
    assert not warned(channel(piston, **box, gate={"x": 0.008, "opens_at": 0}), "while the gate is shut")
    left = channel(piston | {"make_good": False}, **box, gate={"x": 0.008, "opens_at": 0.1})
    assert not warned(left, "while the gate is shut")

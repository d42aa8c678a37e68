"""What scenes say of contacts, materials, energy, clumps, controls, walls and cells: in the grains, or refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from porescale.ground.check import InputError
from porescale.ground.constants import GRAVITY
from porescale.scene.build import build
from porescale.scene.derive import derive
from porescale.scene.sections import Scene
from porescale.workbench.sections import scene_as_dict, validate
from tests.reference.scenes import dry, grain, table

pytestmark = pytest.mark.usefixtures("one_thread")


def loose(*grains: dict[str, Any], **changes: Any) -> Scene:
    """A dry box with grains placed by hand and nothing else."""
    return dry(**{"grains": {"density": 2500, "grain": list(grains)}, **changes})


def lines(**changes: Any) -> list[str]:
    """The refusals of a dry box with two grains, changed as in ``table``."""
    given = {"fluid": None, "gate": None, "grains": {"density": 2500, "grain": [grain(0.002, 0.002)]}}
    with pytest.raises(InputError) as caught:
        derive(validate(Scene, table(**{**given, **changes})))
    return [fault.line() for fault in caught.value.faults]


def resumed(scene: Scene, before: int, after: int) -> tuple[Any, Any]:
    """A simulation after ``before + after`` steps, and one that took up its state in between."""
    whole, again = build(scene), build(scene)
    whole.advance(before)
    again.restore(whole.state())
    whole.advance(after)
    again.advance(after)
    return whole, again


def assert_same_bits(one: Any, other: Any) -> None:
    for name in ("position", "angle", "velocity", "spin", "force", "torque"):
        np.testing.assert_array_equal(getattr(one.grains.discs, name), getattr(other.grains.discs, name), err_msg=name)
    assert one.series() == other.series()
    assert one.tables() == other.tables()


def test_the_card_of_a_scene_makes_the_same_scene():
    scene = loose(grain(0.002, 0.002), output__energy=True)
    assert validate(Scene, scene_as_dict(scene)) == scene


# -- energy


def test_no_book_is_kept_unless_asked():
    simulation = build(loose(grain(0.002, 0.002)))
    assert simulation.grains.book is None
    assert "residual (J/m)" not in simulation.series()


def fallen(step: float) -> dict[str, float]:
    """The series after some bounces of a grain that falls by 1.5 mm, with a contact step in s."""
    simulation = build(loose(grain(0.002, 0.002), output__energy=True, contact__step=step))
    simulation.advance(round(0.05 / simulation.step_seconds))
    return simulation.series()


def test_the_energy_of_a_falling_grain_is_its_weight_times_its_height():
    weight = 2500 * math.pi * 0.0005**2 * GRAVITY
    first = build(loose(grain(0.002, 0.002), output__energy=True)).series()
    assert first["potential energy (J/m)"] == pytest.approx(weight * 0.002, rel=1e-12)
    row, coarse = fallen(5e-6), fallen(2e-5)
    assert list(row)[-1] == "residual (J/m)"
    assert row["lost in normal dashpots (J/m)"] > 0.1 * weight * 0.0015  # 1 - e^2 = 0.19 a bounce
    # The residual is of first order in the step: four times less at least, and 1e-3 of what was turned over (the bound
    # of the specification) with some 40 steps in a contact; 10 steps in a contact miss it.
    assert abs(row["residual (J/m)"]) < 1e-3 * row["turned over (J/m)"] < abs(coarse["residual (J/m)"])
    assert abs(row["residual (J/m)"]) < 0.25 * abs(coarse["residual (J/m)"])


def test_a_run_with_an_energy_book_is_taken_up_again_to_the_bit():
    assert_same_bits(*resumed(dry(output__energy=True), 150, 150))


def test_energy_needs_grains():
    (line,) = lines(grains=None, contact=None, disc=[grain(0.002, 0.002)], output__energy=True,
                    fluid={"viscosity": 2e-5, "spacing": 0.0002, "step": 4e-5})  # fmt: skip
    assert line.startswith("output.energy: there are no grains to measure")

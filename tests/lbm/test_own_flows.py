"""A user's body force and inflow: exact flows, nothing where they are absent, the same bits after a resume."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.common.compiled.jit import set_threads, threads
from porescale.common.core.errors import InputError
from tests.reference.flow_laws import flow_scene

EPS = float(np.finfo(float).eps)
NU, WIDTH = 1e-5, 0.01
WAVE = 2.0 * math.pi / WIDTH


def kolmogorov_error(folder: Path, cells: int) -> float:
    """Relative error of the amplitude a/(nu k²) of the steady flow under a sin(k y)."""
    simulation = build(flow_scene(folder, cells, fluid__body_force="laws.py:kolmogorov"))
    simulation.advance(round(12.0 / (NU * WAVE**2) / simulation.step_seconds))  # e^-12 of the start is left
    u = simulation.fields()[1][:, 0]
    y = (np.arange(cells) + 0.5) / cells * WIDTH
    return float(2.0 * np.mean(u * np.sin(WAVE * y)) / (1e-3 / (NU * WAVE**2)) - 1.0)


def test_kolmogorov_flow_has_its_amplitude_and_the_order_is_two(tmp_path: Path) -> None:
    # Second order in k h: at 8 and 16 cells (k h = 0.79, 0.39) errors in the ratio 4, but for terms of the fourth order
    # and e^-12 = 6e-6 of the start.
    coarse, fine = (kolmogorov_error(tmp_path, cells) for cells in (8, 16))
    assert abs(fine) < (WAVE * WIDTH / 16) ** 2 / 4
    assert math.log2(abs(coarse / fine)) == pytest.approx(2.0, abs=0.15)
    assert abs(fine - 0.05) > (WAVE * WIDTH / 16) ** 2 / 4 or abs(fine) < 0.05  # 5 % would be seen


HEAP = [
    {
        "x": 0.002 + 0.00201 * (k % 4), "y": 0.00101 + 0.00201 * (k // 4), "diameter": 0.002,
        "velocity": [0.01 * (1 - k % 3), -0.02],
    }
    for k in range(8)
]  # fmt: skip
"""Discs 10 micrometres apart, and from the floor, that come together within 1 ms."""
CHANNEL = {"domain__bottom": "wall", "domain__top": "wall"}


def swinging(y: Any, t: float, omega: float, force: float) -> Any:
    """Velocity of a channel whose fluid is accelerated by force cos(omega t) (Womersley 1955, plane)."""
    root = np.sqrt(1j * omega / NU)
    shape = 1.0 - np.cosh(root * (y - WIDTH / 2)) / np.cosh(root * WIDTH / 2)
    return (force / (1j * omega) * shape * np.exp(1j * omega * t)).real


def channel_error(folder: Path, cells: int, phase: float = 0.0) -> float:
    """Largest error of the oscillating channel over its largest speed, after sixteen periods."""
    omega = 8.0
    scene = flow_scene(folder, cells, omega=omega, fluid__body_force="laws.py:swinging", **CHANNEL)
    simulation = build(scene)
    simulation.advance(round(32.0 * math.pi / omega / simulation.step_seconds))
    y = (np.arange(cells) + 0.5) / cells * WIDTH
    exact = swinging(y, simulation.time + phase / omega, omega, 1e-3)
    return float(np.abs(simulation.fields()[1][:, 0] - exact).max() / np.abs(exact).max())


def test_a_channel_that_swings_is_womersleys(tmp_path: Path) -> None:
    # Second order, in cells over delta = sqrt(2 nu/omega) = 1.6 mm.  Of the start e^(-nu pi²/W² t) = 4e-6 is left.
    coarse, fine = channel_error(tmp_path, 16), channel_error(tmp_path, 32)
    assert fine < 0.4 * (WIDTH / 32 / math.sqrt(2 * NU / 8.0)) ** 2
    assert math.log2(coarse / fine) == pytest.approx(2.0, abs=0.2)  # the fourth order is (h/delta)² of it
    assert channel_error(tmp_path, 32, phase=0.1) > 2 * fine  # a tenth of a radian late


def test_a_uniform_function_is_the_uniform_force(tmp_path: Path) -> None:
    # The same operations on the same numbers, but for the rounding of the unit: EPS in the force, over 200 steps.
    disc = [{"x": 0.005, "y": 0.005, "diameter": 0.004}]
    force = (1e-3 * 1000.0, 0.25e-3 * 1000.0)
    both = [
        build(flow_scene(tmp_path, 32, fluid__body_force=given, disc=disc, **CHANNEL))
        for given in ("laws.py:uniform", force)
    ]
    for simulation in both:
        simulation.advance(200)
    one, other = (simulation.fields()[1] for simulation in both)
    assert np.abs(one - other).max() < 200 * 100 * EPS * np.abs(other).max()
    assert np.abs(1.001 * one - other).max() > 200 * 100 * EPS * np.abs(other).max()


def test_without_one_nothing_is_built(tmp_path: Path) -> None:
    simulation = build(flow_scene(tmp_path, fluid__body_force=(1.0, 0.0)))
    assert simulation.fluid
    assert simulation.fluid.force_field is None
    assert not [part for part in simulation.parts if type(part).__name__ in ("OwnForce", "OwnInflow")]
    own = build(flow_scene(tmp_path, fluid__body_force="laws.py:uniform"))
    assert [part for part in own.parts if type(part).__name__ == "OwnForce"]


OPEN = {"domain__bottom": "wall", "domain__top": "wall", "domain__right": "pressure"}


def test_an_inflow_that_is_a_parabola_is_the_built_in_one(tmp_path: Path) -> None:
    # The same velocities but for the rounding of the profile.
    sides = (
        {"kind": "velocity", "velocity": "laws.py:parabola"},
        {"kind": "velocity", "velocity": [1e-3, 0.0], "profile": "parabola"},
    )
    both = [build(flow_scene(tmp_path, domain__left=side, **OPEN)) for side in sides]
    for simulation in both:
        simulation.advance(200)
    one, other = (simulation.fields()[1] for simulation in both)
    assert np.abs(one - other).max() < 1e4 * EPS * np.abs(other).max()
    assert np.abs(1.001 * one - other).max() > 1e4 * EPS * np.abs(other).max()


def test_an_inflow_lets_in_what_its_integral_says(tmp_path: Path) -> None:
    # In the middle of a step the velocity of a wave integrates to (omega dt)²/24 of the amplitude, and the mass of the
    # box is what came in: a closed box gains density by the inflow over its width.
    scene = flow_scene(
        tmp_path, force=1e-5, omega=50.0, domain__left={"kind": "velocity", "velocity": "laws.py:pulse"},
        domain__right="wall", domain__bottom="wall", domain__top="wall",
    )  # fmt: skip
    simulation = build(scene)
    assert simulation.fluid
    steps = 40
    simulation.advance(steps)
    t, dt = simulation.time, simulation.step_seconds
    gained = simulation.fluid.mass_excess() / 16 * WIDTH / 16  # m² over the height
    exact = 1e-5 * (t - math.sin(50.0 * t) / 50.0)
    bound = (50.0 * dt) ** 2 / 24 * 1e-5 / 50.0 + 1e-12
    late = 1e-5 * (t + dt / 2 - math.sin(50.0 * (t + dt / 2)) / 50.0)
    assert gained == pytest.approx(exact, abs=bound)
    assert gained != pytest.approx(late, abs=bound)  # half a step later


@pytest.mark.parametrize("what", ["force", "inflow"])
def test_a_resumed_run_is_the_uninterrupted_one(tmp_path: Path, what: str) -> None:
    changes: dict[str, Any] = {"fluid__body_force": "laws.py:swinging", **CHANNEL}
    if what == "inflow":
        changes = {"domain__left": {"kind": "velocity", "velocity": "laws.py:pulse"}, **OPEN}
    whole, first, second = (build(flow_scene(tmp_path, omega=300.0, **changes)) for _ in range(3))
    whole.advance(31)
    first.advance(17)
    second.restore(first.state())
    second.advance(14)
    assert np.array_equal(whole.fluid.populations, second.fluid.populations)  # type: ignore[union-attr]
    first.advance(13)
    assert not np.array_equal(whole.fluid.populations, first.fluid.populations)  # type: ignore[union-attr]


def test_speeds_and_numbers_that_are_none_are_refused_before_a_run(tmp_path: Path) -> None:
    left = {"kind": "velocity", "velocity": "laws.py:parabola"}
    fast = flow_scene(tmp_path, force=0.02, domain__left=left, **OPEN)
    with pytest.raises(InputError, match=r"fluid\.step = .*: a speed of 0\.0299 m/s is to be expected, Mach"):
        derive(fast)
    left = {"kind": "velocity", "velocity": "laws.py:unset"}
    with pytest.raises(InputError, match=r"domain\.left\.velocity = 'laws\.py:unset': is \(nan, 0\) m/s at"):
        derive(flow_scene(tmp_path, domain__left=left, **OPEN))
    with pytest.raises(InputError, match="made for @inflow, here @body_force is needed"):
        flow_scene(tmp_path, fluid__body_force="laws.py:pulse")


@pytest.mark.slow
def test_one_and_two_threads_give_the_same_bits_with_a_contact_law_and_a_force(tmp_path: Path) -> None:
    # Discs that stick to each other and to the floor, in fluid that a force of every cell stirs.
    def final(count: int, adhesion: float = 0.02) -> list[Any]:
        scene = flow_scene(
            tmp_path, 32, fluid__body_force="laws.py:whirl", force=0.05, **CHANNEL,
            contact={"law": "laws.py:sticky", "release": "overlap", "stiffness": 1e4, "adhesion": adhesion},
            grains={"density": 2500, "hydraulic_radius_ratio": 0.8, "grain": HEAP},
        )  # fmt: skip
        set_threads(count)
        simulation = build(scene)
        simulation.advance(60)
        assert simulation.fluid
        assert simulation.grains
        discs = simulation.grains.discs
        inside = simulation.fluid.populations[:, 1:-1, 1:-1]
        return [it.copy() for it in (inside, discs.position, discs.velocity, discs.spin)]

    before = threads()
    try:
        one, two, stickier = final(1), final(2), final(2, 0.02001)
    finally:
        set_threads(before)
    for a, b in zip(one, two, strict=True):
        np.testing.assert_array_equal(a, b)
    assert not any(np.array_equal(a, b) for a, b in zip(one[:3], stickier[:3], strict=True))  # the law is asked

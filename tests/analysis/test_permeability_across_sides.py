"""A window beside a periodic side has the discs that reach into it from across that side."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from porescale.analysis.bed_permeability import measure_window
from porescale.scene.scene import Scene
from tests.reference.scenes import warned, water

WIDTH, RADIUS = 0.008, 0.001
WINDOW = {"left": 0.0, "bottom": 0.0, "width": 0.004, "height": 0.008}


def beside(*x: float, window: dict[str, float] = WINDOW) -> Scene:
    """A box of 8 x 8 mm, periodic both ways, with a held disc at each ``x`` (m)."""
    held = [{"x": at, "y": 0.004, "diameter": 2 * RADIUS} for at in x]
    sides: dict[str, Any] = {"domain__bottom": "periodic", "domain__top": "periodic"}
    return water(disc=held, domain__width=WIDTH, **sides, permeability={"window": window, "direction": "y"})


def share(*x: float) -> float:
    """The solid fraction of the window with discs at ``x`` (m)."""
    at = np.array([(it, 0.004) for it in x])
    grains: Any = SimpleNamespace(position=at, data={"hydraulic_radius": np.full(len(at), RADIUS)})
    return measure_window(beside(*x), grains).solid_fraction


def test_a_disc_stands_in_a_window_wherever_its_centre_is_counted():
    # Half of a disc on the side is in the window, at either end of the box, but for what one ulp of its place moves.
    half = np.pi * RADIUS**2 / 2 / (WINDOW["width"] * WINDOW["height"])
    assert share(0.002, 0.0) == pytest.approx(3 * half, rel=1e-6)
    assert share(0.002, np.nextafter(WIDTH, 0.0)) == pytest.approx(3 * half, rel=1e-6)
    assert share(0.002) == pytest.approx(2 * half, rel=1e-6)  # the check that must fail


def test_a_disc_across_a_side_stands_in_its_window_for_check():
    whole = WINDOW | {"width": WIDTH}
    assert not warned(beside(WIDTH, window=whole), "no grain stands in it")
    assert not warned(beside(0.0075), "no grain stands in it")
    assert warned(beside(0.006), "no grain stands in it")  # the check that must fail: it ends at 5 and 7 mm

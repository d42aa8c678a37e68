"""Keys of numerics that change nothing in a scene with soil are said, and change nothing."""

import numpy as np
import pytest

from continuum_sph.builders.report import report
from continuum_sph.builders.reports.effect_report import IN_THE_OPEN, OF_WATER
from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.tanks import tank_scene

OTHER = {
    "artificial_viscosity": 0.05, "artificial_viscosity_2": 1.0, "softening": 1.0, "density_diffusion": 0.05,
    "diffusion_of": "plain", "noise_floor": 0.5, "density_filter": 2, "gradient": "corrected", "shifting": 1.0,
    "smoothing_length": "evolved", "xsph": 0.3,
}  # fmt: skip
STEPS = 40  # in which the water comes to move by more than what shifting leaves alone


def scene(kind, **numerics):
    """A bank of soil, "dry", with "suction" or "wet", beside water, and with ``numerics``."""
    corners = [[0.5, 0], [1, 0], [1, 0.3], [0.5, 0.3]]
    soil = {"stiffness": 1e6, "permeability": 1e-2, "body": [{"outline": corners}], "saturated": kind == "wet"}
    if kind == "suction":
        soil["suction"] = {"alpha": 10.0, "n": 3.0, "water_table": 0.1}
    water = {"sound_speed": 30.0, "column": [{"width": 0.25, "height": 0.4}] if kind == "wet" else []}
    return tank_scene(1.0, 0.6, 0.05, numerics=numerics, soil=soil, water=water)


def told(kind, **numerics):
    """Keys that its report says to have no effect."""
    lines = [it for it in report(scene(kind, **numerics)).warnings if "has no effect" in it]
    return [it.split(" = ")[0].removeprefix("numerics.") for it in lines]


def end(kind, **numerics):
    """Places of the soil and of the water after some steps."""
    model = Simulation(scene(kind, **numerics))
    for _ in range(STEPS):
        model.flow.advance()
    return {name: it.position for name, it in model.snapshot().clouds.items()}


@pytest.mark.parametrize("kind", ["dry", "suction", "wet"])
def test_what_has_no_effect_is_said_and_nothing_else(kind):
    given = end(kind)
    for key, value in OTHER.items():
        other = end(kind, **{key: value})
        same = all(np.array_equal(given[name], other[name]) for name in given)
        assert told(kind, **{key: value}) == ([key] if same else []), key
        assert same == (key in (IN_THE_OPEN if kind == "wet" else OF_WATER)), key


def test_nothing_is_said_of_defaults():
    assert set(OTHER) == set(OF_WATER)
    assert told("wet", gradient="plain") == told("dry", artificial_viscosity=0.02) == []

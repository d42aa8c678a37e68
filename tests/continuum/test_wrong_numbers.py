"""Wrong numbers from Python below the scenes of the continuum: each is refused by name."""

import math

import numpy as np
import pytest

from continuum_sph.soil import Material, Soil
from continuum_sph.unsaturated import VanGenuchten
from continuum_sph.water import Layer, Smoothing, Tait
from continuum_sph.water.eos.adiabatic import AdiabaticGas
from porescale.common.core.errors import InputError

SAND = {"stiffness": 1e6, "density": 2000.0}
LOAM = {"alpha": 1.0, "n": 2.0, "residual": 0.1, "weight": 9810.0, "stiffness": 1e8}


@pytest.mark.parametrize(
    ("key", "value", "allowed"),
    [
        ("stiffness", -1.0, "> 0"),
        ("stiffness", math.nan, "> 0"),
        ("density", 0.0, "> 0"),
        ("poisson", 0.5, "> -1 and < 0.5"),
        ("poisson", 2.0, "> -1 and < 0.5"),
        ("poisson", -1.0, "> -1 and < 0.5"),
        ("porosity", 2.0, ">= 0 and < 1"),
        ("porosity", 1.0, ">= 0 and < 1"),
        ("sin_friction", 2.0, ">= 0 and <= 1"),
        ("sin_dilatancy", -2.0, ">= -1 and <= 1"),
        ("cohesion_intercept", -1.0, ">= 0"),
        ("tension", -1.0, ">= 0"),
        ("reference", 0.0, "> 0"),
        ("least", -1.0, ">= 0"),
        ("exponent", math.inf, ""),
        ("modulus", "plain", "plane strain or printed"),
    ],
)
def test_a_material_has_numbers_that_a_material_can_have(key, value, allowed):
    with pytest.raises(InputError) as caught:
        Material(**{**SAND, key: value})
    (fault,) = caught.value.faults
    assert (fault.key, fault.allowed) == (f"material.{key}", allowed)


@pytest.mark.parametrize(("key", "value"), [("alpha", -1.0), ("n", 0.5), ("n", 1.0), ("residual", 1.5),
                                            ("residual", 1.0), ("weight", 0.0), ("stiffness", math.nan)])  # fmt: skip
def test_a_retention_has_numbers_that_a_soil_can_have(key, value):
    with pytest.raises(InputError, match=f"^retention.{key} = "):
        VanGenuchten(**{**LOAM, key: value})


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Smoothing("wendland", -1.0), "smoothing.length = -1.0 m: is out of range"),
        (lambda: Smoothing("gauss", 1.0), "smoothing.name = 'gauss': is unknown .allowed: cubic or wendland"),
        (lambda: Tait(-1.0, 1.0, 1.0), "(?s)liquid.density = -1.0 kg/m.3.*liquid.exponent = 1.0"),
        (lambda: Tait(1000.0, 0.0), "liquid.sound_speed"),
        (lambda: AdiabaticGas(1.2, -1e5), "gas.base"),
    ],
)
def test_water_has_numbers_that_water_can_have(make, said):
    with pytest.raises(InputError, match=said):
        make()


def layer(**changes):
    """Two particles of fluid and one of a wall."""
    given = {"fluid": 2, "x": np.zeros((3, 2)), "v": np.zeros((3, 2)), "mass": np.ones(3), "density": np.ones(2)}
    return Layer(**{**given, **changes})


def soil(**changes):
    """Two particles of soil and one of a wall."""
    given = {"soil": 2, "x": np.zeros((3, 2)), "v": np.zeros((3, 2)), "mass": np.ones(3), "density": np.ones(2)}
    return Soil(**{**given, "stress": np.zeros((3, 4)), **changes})


@pytest.mark.parametrize("kind", [layer, soil])
@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("x", np.zeros((3, 3))),
        ("x", np.zeros((3, 2), np.int64)),
        ("x", [[0.0, 0.0]] * 3),
        ("v", np.zeros((2, 2))),
        ("mass", np.ones(2)),
        ("mass", 1.0),
        ("density", np.ones(3)),
        ("material", np.zeros(2, np.int64)),
        ("material", np.zeros(3)),
    ],
)
def test_arrays_of_particles_have_their_shapes(kind, key, value):
    kind()
    with pytest.raises(InputError, match=rf"^(layer|soil)\.{key}.*allowed: shape .*(float64|int64)"):
        kind(**{key: value})


def test_a_layer_has_no_more_fluid_than_particles():
    for wrong in (4, -1, 2.0):
        with pytest.raises(InputError, match=r"^layer.fluid = "):
            layer(fluid=wrong, density=np.ones(2))
        with pytest.raises(InputError, match=r"^soil.soil = "):
            soil(soil=wrong, density=np.ones(2))


def test_what_physics_allows_passes():
    Material(**SAND, poisson=-0.9, porosity=0.0, sin_friction=0.0, sin_dilatancy=-0.1, least=0.0)
    Material(**SAND, poisson=0.499, sin_friction=1.0, exponent=0.0)
    Tait(0.1, 1e-3, 1.4)
    assert np.all(np.isfinite(VanGenuchten(**{**LOAM, "residual": 0.0, "n": 1.1}).numbers))

"""What damps and levels soil follows from gravity, height and stiffness: alike at any size, stiffness and spacing."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from continuum_sph.builders.parts.soil import soil_law
from continuum_sph.soil import Material
from continuum_sph.soil.steadying import MOST, WEIGHTLESS, steadied
from continuum_sph.validation.tanks import level_ground, tank_scene

SAND = Material(1e6, 1600.0)
EPS = 2.0**-52
ROUNDED = 16 * EPS  # of a dozen products, quotients and roots
OWN = ("damping", "damping_viscosity", "stress_diffusion", "restless_diffusion")
"""Keys of soil.numerics by which a scene would have a law of its own."""


def viscosity(material, gravity, height, length):
    """α c h over H √(g H)."""
    sound = math.sqrt(material.column_modulus / material.density)
    return steadied(material, gravity, height, length)[0] * sound * length / (height * math.sqrt(gravity * height))


def levelling(material, gravity, height, length):
    """χ ρ g H/E."""
    return steadied(material, gravity, height, length)[1] * material.density * gravity * height / material.stiffness


@pytest.mark.parametrize("number", [viscosity, levelling])
@pytest.mark.parametrize(
    "other",
    [
        (replace(SAND, stiffness=2e6), 9.8, 1.0, 0.1),  # stiffer
        (SAND, 9.8, 1.0, 0.05),  # finer
        (SAND, 6.0, 1.0, 0.1),  # lighter
        (replace(SAND, stiffness=1e7), 9.8, 10.0, 1.0),  # ten times as large, and as stiff
    ],
)
def test_soil_is_steadied_alike_at_any_stiffness_spacing_gravity_and_size(number, other):
    assert number(*other) == pytest.approx(number(SAND, 9.8, 1.0, 0.1), rel=ROUNDED)


def test_a_constant_alpha_is_not_alike_at_another_spacing():  # the twin that must fail
    sound = math.sqrt(SAND.column_modulus / SAND.density)
    one, other = (0.2 * sound * length for length in (0.1, 0.05))
    assert abs(other / one - 1.0) > 0.4


def test_soil_that_stiffens_is_steadied_by_its_stiffness_under_its_weight():
    stiffening = replace(SAND, exponent=0.5)
    pressure = 0.5 * SAND.density * 9.8 * (1.0 + SAND.rest)
    same = replace(SAND, stiffness=stiffening.stiffness_at(pressure))
    found = steadied(stiffening, 9.8, 1.0, 0.1)
    assert found == pytest.approx(steadied(same, 9.8, 1.0, 0.1), rel=ROUNDED)
    assert found[1] < 0.5 * steadied(SAND, 9.8, 1.0, 0.1)[1]


def test_diffusion_does_not_go_beyond_what_a_step_follows():
    assert steadied(replace(SAND, stiffness=1e9), 9.8, 1.0, 0.1)[1] == MOST


def test_soil_without_weight_has_constants():
    assert steadied(SAND, 0.0, 1.0, 0.1) == WEIGHTLESS


def scene(numerics):
    """A scene of ground of 0.3 m in a tank that is higher."""
    return tank_scene(1.0, 0.5, 0.02, lid=False, soil={"body": [level_ground(0.4, 0.3)], "numerics": numerics})


def test_a_scene_that_says_nothing_has_the_law_and_one_that_does_has_its_own():
    plain = soil_law(scene({}))
    wanted = steadied(plain.materials[0], scene({}).gravity, 0.3, plain.smoothing.length)
    assert (plain.damping, plain.diffusion) == wanted
    given = soil_law(scene({"damping": 1.5, "stress_diffusion": 0.0}))
    assert (given.damping, given.diffusion) == (1.5, 0.0)
    assert soil_law(scene({"damping_of": "approach"})).damping == WEIGHTLESS[0]


def own_laws(folder):
    """Scenes below ``folder`` that set damping or diffusion of soil themselves."""
    found = []
    for file in sorted(folder.rglob("*.toml")):
        soil = tomllib.loads(file.read_text(encoding="utf-8")).get("soil")
        numerics = soil.get("numerics", {}) if isinstance(soil, dict) else {}
        found += [f"{file.parent.name}: {key}" for key in OWN if key in numerics]
    return found


def test_no_case_has_damping_or_diffusion_of_its_own():
    assert own_laws(Path(__file__).parents[3] / "cases") == []


def test_a_case_with_damping_of_its_own_is_found(tmp_path):  # the twin that must fail
    (tmp_path / "scene.toml").write_text("[soil.numerics]\ndamping = 4\n", encoding="utf-8")
    assert own_laws(tmp_path) == [f"{tmp_path.name}: damping"]

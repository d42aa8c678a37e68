"""A body that names no material: said where the first of several is taken, or a density that was given is not."""

import pytest

from porescale.builders.build import build
from tests.reference.scenes import column, dry, grain, warned

SAND, STEEL = {"name": "sand", "density": 2650}, {"name": "steel", "density": 7800}
HANDS = {"gate": None, "grains__packing": None, "grains__density": 2500}


def said(*materials, make=dry, **changes):
    """The warnings about materials."""
    scene = make(**HANDS | {"material": list(materials)} | changes)
    return scene, warned(scene, "material")


def grains(*names):
    given = [grain(0.002 * (k + 1), 0.002, **({"material": name} if name else {})) for k, name in enumerate(names)]
    return {"grains__grain": given}


def test_a_grain_without_a_material_among_several_is_named_with_what_it_gets():
    scene, (line,) = said(SAND, STEEL, **grains("steel", "", "sand"))
    assert line.startswith(
        "no material is named by grains.grain[1]: the first is taken, 'sand', of 2650 kg/m^3 instead"
    )
    assert "grains.density = 2500" in line
    # What is said is what is done: the disc's mass is that of the first material.
    discs = build(scene).grains.discs
    assert discs.mass / discs.mass[1] == pytest.approx([7800 / 2650, 1.0, 1.0], rel=1e-12)


def test_many_are_counted_and_other_bodies_are_looked_at_too():
    pair = {"discs": [[-0.0003, 0, 0.0005], [0.0003, 0, 0.0005]], "at": [[0.009, 0.006]]}
    _, (line,) = said(SAND, STEEL, clump=[pair], **grains("", "", ""))
    assert "by grains.grain[0], grains.grain[1], grains.grain[2] and 1 more: the first" in line
    _, (line,) = said({"name": "sand"}, STEEL, grains__packing={"diameter": 0.001}, gate=None, make=packed)
    assert line == "no material is named by grains.packing: the first is taken, 'sand'; name it with material"


def packed(**changes):
    """The dry column with its packing, of which some keys are changed."""
    changes = {key: value for key, value in changes.items() if key != "grains__packing"}
    return dry(**changes)


def test_one_material_needs_no_name_but_its_density_is_said_where_it_is_another():
    assert said({"name": "sand"}, **grains("", ""))[1] == []
    assert said({"name": "sand", "density": 2500}, **grains("", ""))[1] == []
    _, (line,) = said(SAND, **grains("", ""))
    assert "of 2650 kg/m^3 instead of grains.density = 2500" in line


def test_a_density_that_no_material_leaves_to_the_grains_is_said():
    _, (line,) = said(SAND, STEEL, **grains("steel", "sand"))
    assert line.startswith("grains.density = 2500 kg/m^3 has no effect on masses")
    # The twins: one material takes it, or it is one of them; and nothing is said where there are no materials.
    assert said({"name": "sand"}, STEEL, **grains("steel", "sand"))[1] == []
    assert said({"name": "sand", "density": 2500}, STEEL, **grains("steel", "sand"))[1] == []
    assert said(**grains("", ""))[1] == []
    assert not warned(column(), "material")

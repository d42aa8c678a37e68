"""Checks and reports of grains whose material has a density of its own use that one, not grains.density."""

import math

import numpy as np
import pytest

from porescale import build
from porescale.builders.checks.regime import expected_speed
from porescale.builders.derive import derive
from porescale.builders.report import report
from porescale.common.core.errors import InputError
from tests.reference.scenes import column, dry, grain, warned, water

LIGHT, HEAVY = 1500.0, 7800.0
IN_FLUID = {"hydraulic_radius_ratio": 0.8}


def of(density, make=column, **changes):
    """A scene whose packing has a ``density`` by its material, where grains.density is another."""
    return make(material=[{"name": "own", "density": density}], grains__packing__material="own", **changes)


def plain(density, make=column, **changes):
    """The same by grains.density alone."""
    return make(grains__density=density, **changes)


@pytest.mark.parametrize("density", [LIGHT, HEAVY])
@pytest.mark.parametrize("make", [column, dry])
def test_what_is_derived_of_a_material_is_what_is_derived_of_grains_of_its_density(make, density):
    one, other = of(density, make), plain(density, make)
    found = [derive(it) for it in (one, other)]
    assert found[0].speed == found[1].speed
    assert found[0].density_variation == found[1].density_variation
    assert found[0].contact_step == pytest.approx(found[1].contact_step, rel=1e-12)
    said = [[line for line in it.warnings if "grains.density" not in line] for it in found]
    assert said[0] == said[1]
    if make is column:  # the check that must fail
        assert found[0].density_variation != derive(plain(2500.0, make)).density_variation


def test_a_report_has_the_restitution_and_the_density_ratio_of_the_material():
    own, same, other = (str(report(it)) for it in (of(LIGHT), plain(LIGHT), plain(2500.0)))
    for word in ("restitution of a pair", "restitution at a wall", "contact time of a pair", "density ratio",
                 "Archimedes number", "Stokes number"):  # fmt: skip
        lines = [next(line for line in text.splitlines() if word in line) for text in (own, same, other)]
        assert lines[0] == lines[1], word
        assert "restitution" in word or lines[0] != lines[2], word


def test_a_material_that_floats_does_not_settle_whatever_grains_density_says():
    with pytest.raises(InputError, match=r"material\[0\].density = 900.*do not sink"):
        derive(of(900.0))
    derive(of(LIGHT, grains__density=900.0))


def test_a_compressed_packing_has_the_mass_of_its_material():
    keys = {"grains__packing__compress": True, "grains__packing__packing_fraction": 0.5}
    box = {"left": 0.0, "bottom": 0.0, "width": 0.012, "height": 0.008}
    keys |= {f"grains__packing__{name}": value for name, value in box.items()}
    scene = of(LIGHT, dry, **keys)
    discs = build(scene).grains.discs
    assert discs.mass == pytest.approx(LIGHT * np.pi * discs.radius**2, rel=1e-12)


def test_the_weight_that_the_fluid_must_bear_is_that_of_each_grain():
    def balance(**changes):
        scene = water(
            fluid__body_force=[0.0, 0.0], domain__bottom="periodic", domain__top="periodic", domain__left="periodic",
            domain__right="periodic", contact={"stiffness": 2e5, "restitution": 0.9}, **changes,
        )  # fmt: skip
        (line,) = warned(scene, "nothing holds the fluid along y")
        return line.split("fluid.body_force = ")[1].split("]")[0]

    grains = [grain(0.003, 0.004, material="light"), grain(0.008, 0.004, material="heavy")]
    materials = [{"name": "light", "density": LIGHT}, {"name": "heavy", "density": HEAVY}]
    mixed = balance(grains={**IN_FLUID, "density": 2500, "grain": grains}, material=materials)
    alone = [grain(0.003, 0.004), grain(0.008, 0.004)]
    assert mixed == balance(grains={**IN_FLUID, "density": (LIGHT + HEAVY) / 2, "grain": alone})
    assert mixed != balance(grains={**IN_FLUID, "density": 2500, "grain": alone})


def test_the_largest_speed_is_that_of_the_heaviest_grain():
    placed = [grain(0.003, 0.004, material="light"), grain(0.008, 0.004, material="heavy")]
    grains = {**IN_FLUID, "grain": placed, "density": 2500}
    materials = [{"name": "light", "density": LIGHT}, {"name": "heavy", "density": HEAVY}]
    scene = column(grains=grains, material=materials, gate=None)
    alone = column(grains={**IN_FLUID, "grain": [grain(0.003, 0.004)], "density": HEAVY}, gate=None)

    def speed(it):
        found = derive(it)
        return expected_speed(it, found.scales, found.diameters)

    assert speed(scene) == speed(alone)
    assert math.isfinite(speed(scene))

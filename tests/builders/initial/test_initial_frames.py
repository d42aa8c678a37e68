"""Bodies of segments among materials: the step that they ask for does not depend on which they name."""

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.builders.derive import derive
from tests.reference.scenes import grain
from tests.reference.scenes_of_grains import framed

SQUARE = {"corners": [[0, 0], [1e-3, 0], [1e-3, 1e-3], [0, 1e-3]], "thickness": 5e-5, "at": [[4e-3, 2e-3]]}
ROD = {"ends": [[2e-3, 3e-3, 3e-3, 3e-3]], "thickness": 1e-4}
MATERIALS = [{"name": "sand"}, {"name": "clay"}]


@pytest.mark.parametrize("sections", [{"polygon": [SQUARE]}, {"segment": [ROD]}], ids=["polygon", "segment"])
def test_a_free_body_may_be_of_the_second_material(sections):
    ((kind, (section,)),) = sections.items()
    scenes = [framed(**{kind: [section | {"material": it["name"]}]}, material=MATERIALS) for it in MATERIALS]
    steps = {derive(it).contact_step for it in scenes}
    assert len(steps) == 1  # both materials are alike but for their names
    assert [set(build(it).grains.material.tolist()) for it in scenes] == [{0}, {1}]


def test_a_drum_is_hollow_and_turns_as_a_ring():
    """A container whose chain closes had the mass of a solid polygon: 50 times that of its walls here."""
    radius, thickness, moment, sides = 2e-3, 1e-5, 1e-3, 90
    turn = 2.0 * np.pi * np.arange(sides + 1) / sides
    chain = 4e-3 + radius * np.column_stack((np.cos(turn), np.sin(turn)))
    chain[-1] = chain[0]
    drum = {
        "chain": chain.tolist(), "thickness": thickness, "pivot": [4e-3, 4e-3], "rotation": {"force": moment},
        "name": "drum", "record": True,
    }  # fmt: skip
    simulation = build(framed(container=[drum], grains={"grain": [grain(4e-3, 4e-3)]}, gravity=[0, 0]))
    side = 2.0 * radius * np.sin(np.pi / sides)
    width = 2.0 * thickness
    mass = 2500 * sides * side * width
    # Rods about their middles, which are the polygon's inner radius from the pivot
    apart = radius * np.cos(np.pi / sides)
    inertia = mass * (apart**2 + (side**2 + width**2) / 12.0)
    table = simulation.grains.steering.clumps
    # Sums of 90 rods, and of 50 kicks of M dt/I from rest: a rounding each
    eps = float(np.finfo(float).eps)
    assert table.mass[0] == pytest.approx(mass, rel=90 * eps)
    simulation.advance(50)
    assert table.spin[0] == pytest.approx(moment * simulation.time / inertia, rel=(90 + 2 * 50) * eps)

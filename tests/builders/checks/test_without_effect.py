"""Keys that change nothing are said before a run, and their twins that change something are not."""

import numpy as np
import pytest

from porescale.builders.derive import derive
from tests.reference.scenes import column, dry, grain, water

WATER_ALONE = {"grains": None, "contact": None, "coarse_graining": None}
GRAIN = {"gate": None, "grains__packing": None, "grains__density": 2500, "grains__grain": [grain(0.002, 0.002)]}
BLOCK = {"lower": [0.002, 0.0], "upper": [0.003, 0.002]}


def said(scene):
    """The warnings about keys without effect."""
    return [line for line in derive(scene).warnings if "has no effect" in line]


@pytest.mark.parametrize(
    ("make", "nothing", "line", "something"),
    [
        (column, WATER_ALONE | {"gate__friction": 0.3}, "gate.friction = 0.3", {"gate__friction": 0.3}),
        (
            column, WATER_ALONE | {"gate": None, "rectangle": [BLOCK | {"friction": 0.3}]},
            "rectangle[0].friction = 0.3", WATER_ALONE | {"gate": None, "rectangle": [BLOCK]},
        ),
        (
            column, WATER_ALONE | {"gate": None, "rectangle": [BLOCK | {"ramp": 0.01}]},
            "rectangle[0].ramp = 0.01 s",
            WATER_ALONE | {"gate": None, "rectangle": [BLOCK | {"ramp": 0.01, "velocity": [0.001, 0]}]},
        ),
        (
            dry, GRAIN | {"grains__hydraulic_radius_ratio": 0.8}, "grains.hydraulic_radius_ratio = 0.8",
            GRAIN | {"grains__hydraulic_radius_ratio": None},
        ),
        (
            dry, GRAIN | {"control": [{"grain": 0}]}, "control[0]", GRAIN | {"control": [{"grain": 0, "record": True}]},
        ),
        (
            dry, GRAIN | {"control": [{"grain": 0, "y": "free"}]}, "control[0]",
            GRAIN | {"control": [{"grain": 0, "y": {"force": 1e-3}}]},
        ),
    ],
)  # fmt: skip
def test_a_key_that_changes_nothing_is_said(make, nothing, line, something):
    (found,) = said(make(**nothing))
    assert found.startswith(f"{line} has no effect")
    assert said(make(**something)) == []


def test_probes_and_sections_in_solids_are_said():
    held = {"x": 0.004, "y": 0.004, "diameter": 0.002}
    inside = {"probe": [{"x": 0.004, "y": 0.0045}], "flux": [{"start": [0.0035, 0.004], "end": [0.0045, 0.004]}]}
    across = {"probe": [{"x": 0.004, "y": 0.006}], "flux": [{"start": [0.004, 0.0], "end": [0.004, 0.008]}]}
    found = [line for line in derive(water(disc=[held], **inside)).warnings if "where no fluid is" in line]
    assert [line.split(" lies")[0] for line in found] == ["probe[0]", "flux[0]"]
    rim = {"probe": [{"x": 0.004 + 0.001 * np.cos(a), "y": 0.004 + 0.001 * np.sin(a)} for a in np.arange(7.0)]}
    for scene in (
        water(disc=[held], **across),
        water(disc=[held], **rim),
        water(disc=[held | {"velocity": [0.001, 0.0]}], **inside),
    ):
        assert not any("where no fluid is" in line for line in derive(scene).warnings)
    block = {"lower": [0.003, 0.003], "upper": [0.005, 0.005]}
    found = [line for line in derive(water(rectangle=[block], **inside)).warnings if "where no fluid is" in line]
    assert len(found) == 2

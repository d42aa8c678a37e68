"""Bodies of segments among materials: the step that they ask for does not depend on which they name."""

import pytest

from porescale.builders.build import build
from porescale.builders.derive import derive
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

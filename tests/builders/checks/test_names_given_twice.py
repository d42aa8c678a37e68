"""Names of bodies and walls that one table would have twice, or could not have, and what a scene says twice."""

import pytest

from tests.reference.scenes_of_grains import lines

FLOOR = {"x": 0, "y": 0, "normal": [0, 1]}
TRAY = {"chain": [[0.001, 0.001], [0.009, 0.001]], "thickness": 1e-4, "name": "c"}
SAND_ON_ICE = [{"materials": names, "friction": 0.1} for names in (["sand", "ice"], ["ice", "sand"])]


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"control": [{"grain": 0, "name": "c"}], "container": [TRAY]}, "control[0].name = 'c': is taken"),
        ({"control": [{"grain": 0, "name": "a\nb"}]}, "control[0].name = 'a\\nb': has control characters"),
        ({"container": [TRAY, TRAY]}, "container[1].name = 'c': is that of another container"),
        ({"wall": [{**FLOOR, "name": "w"}, {**FLOOR, "name": "w"}]}, "wall[1].name = 'w': is that of another wall"),
        ({"wall": [{**FLOOR, "name": " "}]}, "wall[0].name = ' ': is blank"),
        ({"material": [{"name": "sand"}, {"name": "ice"}], "contact__pair": SAND_ON_ICE},
         "contact.pair[1].materials = 'ice, sand': is the pair of contact.pair[0], too"),
    ],
)  # fmt: skip
def test_names_and_pairs_are_given_once(changes, line):
    assert lines(**changes)[0].startswith(line), lines(**changes)

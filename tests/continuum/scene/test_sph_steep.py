"""Steep faces of cohesive ground: without tension they come off in slabs that topple, and `check` says so."""

import numpy as np
import pytest

from continuum_sph.builders.report import report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.tanks import tank_scene

DENSITY, HIGH, TOE, BACK = 1600.0, 1.0, 0.3, 1.2  # kg/m³; of the face, of the ground before it and behind it, m
WEIGHT = DENSITY * 9.81 * HIGH


def cut(run=0.0, water=None, **soil):
    """Ground with a face of a ``run``, m, and ten rows over its toe; cohesion is that of its weight unless given."""
    wide = BACK + run + 0.6
    corners = [[0, 0], [wide, 0], [wide, TOE], [BACK + run, TOE], [BACK, TOE + HIGH], [0, TOE + HIGH]]
    own = {"density": DENSITY, "stiffness": 200 * WEIGHT, "friction_angle": 0.0, "cohesion": WEIGHT,
           "body": [{"outline": corners}], "numerics": {"settle": 1.0}}  # fmt: skip
    return tank_scene(wide, 1.6, 0.1, 2.0, every=1.0, lid=False, soil=own | soil, **({"water": water} if water else {}))


def moved(given):
    """Largest displacement, m, at the end: braked for a second, free for another."""
    model = Simulation(given)
    start = model.positions.copy()
    while model.time < given.time.end:
        model.advance(20)
    return float(np.hypot(*(model.positions - start).T).max())


def test_a_face_without_tension_topples_however_large_its_cohesion_is():
    """An upright slab that nothing holds leans by what grows as exp(√(3g/2H) t), 46 times in a second; none of it is
    shear.  So three times the cohesion, which without friction has no other part in it, changes nothing."""
    weak, strong = moved(cut()), moved(cut(cohesion=3.0 * WEIGHT))
    assert weak > 0.1 * HIGH
    assert strong == pytest.approx(weak, rel=0.02)  # a fiftieth of what it leans: strains where it stands
    # the check that fails: a tenth of the cohesion as tension holds the slabs together
    assert moved(cut(tension=0.1 * WEIGHT)) < 0.02 * HIGH


def told(given):
    return [it for it in report(given).warnings if "topple" in it]


def test_check_warns_of_a_steep_face_without_tension():
    (line,) = told(cut())
    assert line.startswith("a face of 90 degrees, 1 m high")
    assert line.endswith("give soil.tension a value")
    (wet,) = told(cut(water={"sound_speed": 60.0}, saturated=True))
    assert wet == line
    (line,) = told(cut(friction_angle="30 degree", run=0.2))
    assert "a face of 78.7 degrees" in line
    assert "up to 2.719e+04 Pa (c cot φ)" in line


@pytest.mark.parametrize(
    "given",
    [
        cut(tension=1e3),
        cut(cohesion=0.0, friction_angle="30 degree"),  # sand: falls by its friction
        cut(elastic=True),
        cut(water={"sound_speed": 60.0}, saturated=True, held=True),
        cut(run=0.3),  # 73 degrees
        cut(body=[{"outline": [[0, 0], [1.8, 0], [1.8, 1], [0, 1]]}]),  # from side to side of the tank
        cut(body=[{"outline": [[0, 0], [1, 0], [1, 1], [0, 1]]}, {"outline": [[1, 0], [1.8, 0], [1.8, 1], [1, 1]]}]),
        cut(body=[{"outline": [[0, 0], [1.8, 0], [1.8, 1], [1, 1], [1, 1.3], [0, 1.3]]}]),  # a step of three rows
    ],
    ids=["tension", "sand", "elastic", "held", "73 degrees", "level", "two pieces", "a small step"],
)
def test_check_is_silent_on_other_ground(given):
    assert not told(given)

"""A settled packing and grains placed by hand go together: what rested goes on resting; and a packing on a slope."""

import re
import tomllib
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from porescale import load
from porescale.builders.build import build
from porescale.builders.report import report
from porescale.common.core.errors import InputError
from porescale.dem.measures.energy import elastic
from porescale.dem.measures.survey import max_overlap
from tests.reference.scenes import dry, grain

BED = {"left": 0.008, "width": 0.004, "height": 0.0055, "diameter": 0.0008, "packing_fraction": 0.7}
GATE = {"x": 0.008, "opens_at": 0.01, "lift_speed": 0.4}
STEPS = 200


def bed(*grains):
    """A dry, settled bed behind its gate, with grains placed by hand."""
    placed = {"grain": list(grains)} if grains else {}
    return build(dry(grains={"density": 2500, "packing": BED, **placed}, gate=GATE))


def moved(simulation, count):
    """How far the first ``count`` grains have come in STEPS steps, (count, 2) m."""
    start = simulation.grains.discs.position[:count].copy()
    simulation.advance(STEPS)
    return simulation.grains.discs.position[:count] - start


def test_a_bed_rests_as_it_would_alone_when_a_grain_falls_far_from_it():
    alone, joined = bed(), bed(grain(0.003, 0.005))
    count = alone.grains.discs.count
    assert joined.grains.discs.count == count + 1
    assert sum(elastic(joined.grains)) == pytest.approx(sum(elastic(alone.grains)), rel=1e-12)
    # The same contacts in the same order: the bed's path has the same bits.
    np.testing.assert_array_equal(moved(joined, count), moved(alone, count))
    assert joined.grains.discs.position[count, 1] < 0.005


def test_a_bed_that_forgets_its_springs_moves():
    # The twin that must fail: friction held part of the weight.
    alone, forgetful = bed(), bed(grain(0.003, 0.005))
    forgetful.grains.pairs.carried[:] = 0.0
    forgetful.grains.wall_spring[:] = 0.0
    count = alone.grains.discs.count
    assert np.abs(moved(forgetful, count)).max() > 10 * np.abs(moved(alone, count)).max()


def test_a_grain_beside_the_rectangle_that_a_bed_settles_into_is_named():
    beside = {**BED, "width": 0.0035}  # 0.5 mm of it left to the wall
    placed = [grain(0.003, 0.005), grain(0.01175, 0.002, 0.0004)]
    scene = dry(grains={"density": 2500, "packing": beside, "grain": placed}, gate=GATE)
    with pytest.raises(InputError) as caught:
        build(scene)
    (fault,) = caught.value.faults
    assert fault.line().startswith("grains.grain[1]: overlaps a grain of the packing by ")


def test_a_bed_comes_to_rest_on_grains_that_are_pressed_into_the_floor():
    # By 0.4 % of a diameter, as the packing.csv of a run has them: four times what settling leaves between its own.
    # No stiffness takes out what stands meanwhile, so it must not be raised for it, or the bed never comes to rest.
    row = [grain(0.0085 + 0.001 * k, 0.000496) for k in range(4)]
    upper = {**BED, "bottom": 0.001, "height": 0.003}
    model = build(dry(grains={"density": 2500, "packing": upper, "grain": row, "overlap": 0.01}, gate=GATE))
    count = model.grains.discs.count - len(row)
    assert count > 10
    assert 0.5 * max_overlap(model.grains).share == pytest.approx(0.004, rel=1e-6)
    assert 0.5 * max_overlap(model.grains, count).share < 0.002


def test_the_template_with_its_grain_uncommented_is_checked_and_built(tmp_path: Path):
    text = files("porescale.cli").joinpath("template.toml").read_text()
    block = text[text.index("# [[grains.grain]]") : text.index("[contact]")]
    whole = text.replace(block, re.sub(r"^# ", "", block, flags=re.MULTILINE))
    assert len(tomllib.loads(whole)["grains"]["grain"]) == 1
    path = tmp_path / "scene.toml"
    path.write_text(whole)
    scene = load(path)
    report(scene)
    simulation = build(scene)
    assert simulation.grains.discs.radius[-1] == 0.00075
    start = simulation.grains.discs.position.copy()
    simulation.advance(20)
    # The gate is shut; at rest is a kinetic energy of 1e-8 m g d per grain, with g' = 0.6 g in water: at most
    # sqrt(2e-8 N g' d) in one of N = 150 grains, 1.3e-4 m/s, for 20 steps of 4e-5 s.
    assert np.abs(simulation.grains.discs.position - start)[:-1].max() < 1.3e-4 * 20 * 4e-5


def test_a_packing_settles_under_what_of_gravity_points_down_and_is_let_go_under_all_of_it():
    endless = {"domain__left": "periodic", "domain__right": "periodic", "grains__packing__settle": True}
    endless |= {"grains__packing__left": 0.0, "grains__packing__width": 0.012}
    level, tilted = (build(dry(**endless, gravity=given)) for given in ([0.0, -9.0], [6.0, -9.0]))
    np.testing.assert_array_equal(tilted.motion()[0], level.motion()[0])
    along = []
    for it in (level, tilted):
        it.advance(round(0.01 / it.step_seconds))
        along.append(abs(it.masses @ it.motion()[1][:, 0] / it.masses.sum()))
    # contact friction of 0.5 takes 4.5 of 6 m/s² on the flat floor at most; the twin, level, stays
    assert along[1] > (6.0 - 4.5) * 0.01 > 10.0 * along[0]

"""A model that is too small for two threads has one, unless a number is asked for."""

from types import SimpleNamespace

import pytest

import continuum_sph as cs
from continuum_sph.builders.simulation import ALONE
from continuum_sph.validation.water.setups import column_scene
from porescale.common.cli.options import suit_threads, use_threads
from porescale.common.compiled.jit import threads


@pytest.fixture(autouse=True)
def as_before():
    """Threads as they were, afterwards."""
    before = threads()
    yield
    use_threads(before)


@pytest.mark.parametrize(("count", "model", "left"), [
    (None, SimpleNamespace(small=True), 1), (None, SimpleNamespace(small=False), 2), (None, object(), 2),
    (2, SimpleNamespace(small=True), 2),
])  # fmt: skip
def test_one_thread_is_taken_only_for_what_is_small_and_where_none_are_asked_for(count, model, left):
    use_threads(2)
    suit_threads(count, model)
    assert threads() == left


def test_a_scene_of_few_particles_is_small_and_one_of_many_is_not():
    for spacing, small in ((0.05, True), (0.02, False)):  # 20 by 10, 50 by 25
        scene = column_scene(spacing, tank=(1.0, 1.0), column=(1.0, 0.5))
        model = cs.build(scene)
        assert (len(model.motion()[0]) < ALONE) == model.small == small

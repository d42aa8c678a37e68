"""What the second process builds: a scene that comes to the kernels of a step at once."""

from pathlib import Path

import numpy as np
import pytest

from porescale import load
from porescale.builders.build import system_of

CASE = Path(__file__).parents[2] / "cases" / "column_collapse"


def test_discs_stand_apart_in_rows_and_no_pair_is_looked_for():
    scene = load(CASE)
    grains = system_of(scene, hasty=True).grains
    packing, (x, y), radius = scene.grains.packing, grains.discs.position.T, grains.discs.radius
    assert radius == pytest.approx(np.full(len(radius), 0.5 * packing.diameter * (1 + packing.size_spread)))
    assert packing.left <= (x - radius).min()
    assert (x + radius).max() <= packing.left + packing.width
    assert (y + radius).max() <= packing.bottom + packing.height
    assert len(np.unique(x)) * len(np.unique(y)) == len(x) > 500
    assert np.diff(np.unique(x)).min() > 2 * radius[0]
    assert grains.pairs.builds == 0


def test_a_run_looks_for_pairs_at_once():  # the twin, with the settled packing left out
    scene = load(CASE, settings=["grains.packing.settle=false", "grains.packing.packing_fraction=0.5"])
    assert system_of(scene).grains.pairs.builds == 1
    assert system_of(scene, hasty=True).grains.pairs.builds == 0

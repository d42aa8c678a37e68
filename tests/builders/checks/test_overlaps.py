"""How far grains placed by hand overlap, and what takes it."""

import pytest

from porescale.builders.build import build
from porescale.common.core.errors import InputError
from tests.reference.scenes import dry, grain


def test_what_a_small_overlap_takes_is_said_and_suffices():
    near = [grain(0.003, 0.004), grain(0.0039501, 0.004)]  # 1 mm across
    grains = {"density": 2500, "grain": near}
    with pytest.raises(InputError, match=r"by 4.99e-05 m; move one of them, or raise grains.overlap to 0.05$"):
        build(dry(grains=grains))
    assert build(dry(grains=grains | {"overlap": 0.05})).grains.discs.count == 2

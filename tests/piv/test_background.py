"""A background that tracers stay in holds them, too: that is said, and nothing is where they have gone far enough."""

import warnings
from typing import Literal

import numpy as np
import pytest

from porescale.common.core.errors import PorescaleWarning
from porescale.piv import measure

SHAPE = 96, 128
WIDTH = 0.7
"""Standard deviation of a tracer's image, px: 2.8 px wide."""


def film(count: int, u: float) -> list[np.ndarray]:
    """Pictures of tracers that all move by ``u`` px to the right from one to the next."""
    rng = np.random.default_rng(1)
    x, y = rng.uniform(-40, SHAPE[1] + 5, 1200), rng.uniform(-5, SHAPE[0] + 5, 1200)
    rows, columns = (np.arange(it) for it in SHAPE)
    made = []
    for k in range(count):
        along = np.exp(-0.5 * ((columns[:, None] - x - k * u) / WIDTH) ** 2)
        across = np.exp(-0.5 * ((rows[:, None] - y) / WIDTH) ** 2)
        made.append(np.clip(np.rint(20 + 150 * across @ along.T), 0, 255).astype(np.uint8))
    return made


@pytest.mark.parametrize("kind", ["mean", "least"])
@pytest.mark.parametrize(("count", "u"), [(2, 1.3), (2, 0.3), (3, 0.3)])
def test_a_background_that_holds_the_tracers_is_said_to(kind: Literal["mean", "least"], count: int, u: float) -> None:
    with pytest.warns(
        PorescaleWarning, match=rf"over the {count} pictures of which background {kind} is taken"
    ) as said:
        found = measure(film(count, u), background=kind, average=True)
    assert len(said) == 1  # nothing of narrow, faint tracers, which is what is left of them
    assert abs(float(np.nanmean(found.u)) / u - 1) > 0.2


@pytest.mark.parametrize(("kind", "count"), [("mean", 12), ("least", 12), ("none", 2)])
def test_a_background_of_a_way_of_many_widths_holds_none(kind: Literal["mean", "least", "none"], count: int) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = measure(film(count, 1.3), background=kind, average=True)
    # 14 px of way, or none to take off: a twelfth of a tracer is left in the background of the mean, beyond its reach.
    assert float(np.nanmean(found.u)) == pytest.approx(1.3, abs=0.01)

"""Three layers between two faces: one after the other, with the heads in them, and side by side."""

from itertools import accumulate

import numpy as np
import pytest

from continuum_sph.builders.parts.pore_water import pore_law
from continuum_sph.builders.parts.soil import soil_particles
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.water.smoothing import kernel_value
from porescale.common.schema.sections import validate

K, FALL, THICK = 1e-3, 0.2, 0.2  # m/s; of the head, m; of a layer, m
PARTS = (1.0, 0.1, 0.3)
"""Of K, of the layers from the high head on, or from the floor."""
SETTLED = 0.4
"""s, after which flow is steady: what is left of the start falls slowest in the tight layer, as exp(-π² D t/d²), where
D = k c²/g = 0.1 m²/s and d is THICK; of 25 in a second there are 10."""


def layered(sides, rows, wide, *, across):
    """Layers of so many rows from one of two ``sides`` to the other, ``wide`` m; ``across`` : the flow crosses them."""
    deep, upright = THICK * len(PARTS), (sides[0] == "floor") == across
    bodies = []
    for k, part in enumerate(PARTS):
        one, other = THICK * k, THICK * (k + 1)
        corners = [[0, one], [wide, one], [wide, other], [0, other]]
        outline = corners if upright else [corner[::-1] for corner in corners]
        bodies.append({"outline": outline, "permeability": part * K})
    table = {
        "tank": {"width": wide, "height": deep} if upright else {"width": deep, "height": wide},
        "water": {"sound_speed": 100.0},
        "soil": {"held": True, "saturated": True, "permeability": K, "body": bodies},
        "face": [
            {"name": "high", "side": sides[0], "head": 2.0 + FALL},
            {"name": "low", "side": sides[1], "head": 2.0},
        ],
        "numerics": {"spacing": THICK / rows},
        "time": {"end": 1.0},
        "output": {"snapshot_interval": 1.0, "series_interval": 1.0},
    }
    return validate(Scene, table)


def steady(given, seconds):
    """What flows in and out, m²/s, then, and the water's places (n, 2) m and heads (n,) m."""
    model = Simulation(given)
    while model.time < seconds:
        model.advance(50)
    model.check()
    row, cloud = model.series(), model.snapshot().clouds["particles"]
    water = cloud.data["layer"] == 0
    return (row["high flow in (m2/s)"], -row["low flow in (m2/s)"]), cloud.position[water], cloud.data["head"][water]


def in_series(parts):
    """Darcy's velocity through layers one after the other, m/s."""
    return FALL / sum(THICK / (part * K) for part in parts)


@pytest.mark.parametrize("sides", [("left", "right"), ("floor", "lid")])
def test_flow_across_three_layers_and_the_heads_in_them_are_those_of_their_resistances_in_series(sides):
    """q = Δh / Σ d/k.  Each face is known to a twentieth of a spacing: as if all of the fall were in one layer, two of
    them are 1.25 % of its eight rows.  So are the heads in the middle half of each layer."""
    rows, wide, within = 8, 0.2, 2 / 20 / 8
    flows, x, head = steady(layered(sides, rows, wide, across=True), SETTLED)
    q = in_series(PARTS)
    assert flows == pytest.approx((q * wide, q * wide), rel=within)
    falls = [q * THICK / (part * K) for part in PARTS]
    ends = [2.0 + FALL - gone for gone in accumulate(falls, initial=0.0)]
    z = x[:, 1 if sides[0] == "floor" else 0]
    for k, fall in enumerate(falls):
        inside = np.abs(z / THICK - k - 0.5) < 0.25
        exact = ends[k] - fall * (z[inside] / THICK - k)
        assert float((head[inside] - exact).mean()) == pytest.approx(0.0, abs=within * FALL)
    # the checks that fail: a tight layer with 5 % more permeability, and layers in another order
    assert flows[0] != pytest.approx(in_series((1.0, 0.105, 0.3)) * wide, rel=within)
    tight = np.abs(z / THICK - 1.5) < 0.25
    assert float(head[tight].mean()) != pytest.approx(ends[0] - 0.5 * falls[1], abs=within * FALL)


def seen(given, rows):
    """k over K that the water in each row meets: the mean of what its partners resist, by the kernel."""
    law, spacing = pore_law(given, soil_particles(given)[0]).smoothing, given.numerics.spacing
    reach, h, count = np.arange(-5, 6), law.length / spacing, rows * len(PARTS)
    weight = np.array([sum(kernel_value(law.kind, np.hypot(i, j) / h, h) for i in reach) for j in reach])
    apart = np.subtract.outer(np.arange(count), np.arange(count))
    share = np.where(np.abs(apart) <= 5, weight[np.clip(apart + 5, 0, 10)], 0.0)
    return share.sum(axis=1) / (share / np.repeat(PARTS, rows)).sum(axis=1)


@pytest.mark.parametrize("sides", [("left", "right"), ("floor", "lid")])
def test_flow_along_three_layers_is_the_sum_but_for_a_row_at_each_boundary(sides):
    """q = Σ k d Δh/L, less what the more permeable layer loses at each boundary, as both hold back the water there.

    Faces as of one layer, 1.25 % of 8 rows with 1.4 of K in all.  What rows at a boundary lose besides is 0.06 each, as
    measured of two pieces (test_sph_layers): of two rows at each of two boundaries, times the more permeable layer."""
    rows, long = 8, 0.4
    given = layered(sides, rows, long, across=False)
    one = K * FALL / long * THICK / rows  # of a row of the most permeable layer
    due = float(seen(given, rows).sum())
    besides = 2 * 0.06 * (1.0 + 0.3)
    flows, _, _ = steady(given, SETTLED)
    within = 0.0125 * rows * sum(PARTS) + besides
    assert [flow / one for flow in flows] == pytest.approx([due - besides] * 2, abs=within)
    # the check that fails: the sum of the layers, which it is but for these rows, 0.7 and 0.1 of them
    assert rows * sum(PARTS) - due == pytest.approx(0.8, abs=0.1)
    assert flows[0] / one != pytest.approx(rows * sum(PARTS), abs=within)

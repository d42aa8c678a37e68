"""Water laid in several rectangles, on each other or on full ground, starts at rest under all that stands on it."""

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.soil.stress import YY
from continuum_sph.validation.tanks import tank_scene
from porescale.common.core.errors import InputError

WIDE, GROUND, LEVEL, SPACING = 0.6, 0.5, 0.9, 0.05  # m
SOIL = {"density": 1500.0, "porosity": 0.4, "body": [{"outline": [[0, 0], [WIDE, 0], [WIDE, GROUND], [0, GROUND]]}]}
ROUND_OFF = 1e-13
"""Heights are sums of two numbers in one scene and of four in another: some eps, times γ - 1 = 6 in the density."""


def simulation(columns, **more):
    """Water in ``columns``, (bottom, top) each."""
    column = [{"width": WIDE, "bottom": low, "height": high - low} for low, high in columns]
    given = {"water": {"sound_speed": 60.0, "column": column}}
    return Simulation(tank_scene(WIDE, 1.2, SPACING, every=0.1, lid=False, **given | more))


def densities(made):
    """Of the particles of water, kg/m³, by height and place."""
    layer = getattr(made.flow, "water", made.flow).layer
    x = np.round(layer.x[: layer.fluid], 9)
    return layer.density[: layer.fluid][np.lexsort((x[:, 0], x[:, 1]))]


def upright(made):
    """Upright effective stress of the soil at the start, Pa, (n,)."""
    soil = made.flow.ground.soil
    return soil.stress[: soil.soil, YY]


@pytest.mark.parametrize(
    "columns", [[(0.0, 0.5), (0.5, 0.9)], [(0.5, 0.9), (0.0, 0.5)], [(0.0, 0.3), (0.6, 0.9), (0.3, 0.6)]]
)
def test_columns_on_each_other_weigh_as_one(columns):
    one = densities(simulation([(0.0, LEVEL)]))
    assert densities(simulation(columns)) == pytest.approx(one, rel=ROUND_OFF)
    # the check that must fail: what hangs over a gap of a row weighs nothing on what is below
    apart = densities(simulation([(0.0, 0.45), (0.5, 0.9)]))
    assert apart.max() < one.max() - 0.4 * (one.max() - 1000.0)


def test_a_column_on_a_part_of_another_weighs_there_alone():
    table = [{"width": WIDE, "height": 0.4}, {"left": 0.3, "width": 0.3, "bottom": 0.4, "height": 0.4}]
    made = simulation([], water={"column": table, "sound_speed": 60.0})
    layer = getattr(made.flow, "water", made.flow).layer
    x, rho = layer.x[: layer.fluid], layer.density[: layer.fluid]
    low = np.abs(x[:, 1] - 0.5 * SPACING) < 1e-6
    p = made.flow.law.state.pressure(rho)
    top = np.where(x[low, 0] > 0.3, 0.8, 0.4)
    # of the depth, with the compression of the water below it, ρ g d/(2 ρ c²) = 0.1 % at 60 m/s
    assert p[low] == pytest.approx(9810.0 * (top - x[low, 1]), rel=2e-3)


@pytest.mark.parametrize(
    ("saturated", "columns"),
    [(True, [(0.5, 0.9)]), (True, [(0.0, 0.3), (0.5, 0.9)]), (False, [(0.0, 0.5), (0.5, 0.9)])],
)
def test_pores_bear_the_water_over_the_ground_and_lift_its_grains(saturated, columns):
    whole = simulation([(0.0, LEVEL)], soil=SOIL)
    made = simulation(columns, soil=SOIL | {"saturated": saturated})
    assert densities(made) == pytest.approx(densities(whole), rel=ROUND_OFF)
    assert upright(made) == pytest.approx(upright(whole), rel=1e-12)  # some sums of heights
    assert upright(whole).max() < 0.7 * SOIL["density"] * 9.81 * GROUND  # so it is less buoyancy
    # the check that must fail: the same ground under no open water
    bare = simulation([], soil=SOIL | {"saturated": True})
    assert densities(bare).max() < densities(whole).max() - 0.4 * (densities(whole).max() - 1000.0)


@pytest.mark.parametrize("water", [False, True])
def test_ground_over_a_gap_weighs_nothing_on_the_ground_below(water):
    """A block that is to fall: what it falls on had the stress, and the pore pressure, of ground up to its top."""

    def ground(gap, block=0.3):
        pieces = [(0.0, 0.3), (0.3 + gap, 0.3 + gap + block)] if block else [(0.0, 0.3)]
        outlines = [[[0, low], [WIDE, low], [WIDE, high], [0, high]] for low, high in pieces]
        made = simulation([], soil=SOIL | {"body": [{"outline": it} for it in outlines], "saturated": water})
        soil = made.flow.ground.soil if water else made.flow.soil
        low = soil.x[: soil.soil, 1] < 0.3
        found = [soil.stress[: soil.soil, YY][low]]
        if water:
            layer = made.flow.water.layer
            found.append(layer.density[: layer.fluid][layer.x[: layer.fluid, 1] < 0.3] - 1000.0)
        return np.concatenate(found)

    alone = ground(0.0, block=0.0)
    assert ground(0.2) == pytest.approx(alone, rel=1e-12)  # round-off of the same heights
    # the check that must fail: without the gap it bears as much again, and more
    assert (ground(0.0) > 1.9 * alone).all()


@pytest.mark.parametrize("full", [{"saturated": True}, {"water_table": GROUND}])
def test_water_without_pressure_has_none_in_pores(full):
    """Pores were at rest under the water over them, which had no pressure."""
    column = [{"width": WIDE, "bottom": GROUND, "height": LEVEL - GROUND}]

    def starting(pressure):
        water = {"sound_speed": 60.0, "column": column, "pressure": pressure}
        return densities(simulation([], soil=SOIL | full, water=water))

    assert (starting("none") == 1000.0).all()
    assert (starting("hydrostatic") > 1000.0).all()  # the check that must fail


def pushed(columns, width=1.2, **more):
    """Speeds of water whose right face is pushed, (n, 3): place, and speed to the right; columns: left, bottom, width,
    height (m) of each."""
    named = [dict(zip(("left", "bottom", "width", "height"), it, strict=True)) for it in columns]
    water = {"sound_speed": 60.0, "push": "face", "column": named}
    flow = Simulation(tank_scene(width, 1.2, SPACING, lid=False, water=water, **more)).flow
    layer = getattr(flow, "water", flow).layer
    rows = np.column_stack((layer.x, layer.v[:, 0]))[: layer.fluid].round(9)
    return rows[np.lexsort((rows[:, 0], rows[:, 1]))]


@pytest.mark.parametrize(
    "pieces",
    [
        [(0.0, 0.0, 0.3, 0.8), (0.3, 0.0, 0.3, 0.8)],
        [(0.3, 0.0, 0.3, 0.8), (0.0, 0.0, 0.3, 0.8)],
        [(0.0, 0.0, 0.6, 0.4), (0.0, 0.4, 0.6, 0.4)],
    ],
)
def test_a_face_is_pushed_as_one_whatever_its_water_is_laid_in(pieces):
    """Each piece had a right face of its own, also amid the water, and a height of its own."""
    assert np.array_equal(pushed(pieces), pushed([(0.0, 0.0, 0.6, 0.8)]))
    assert pushed([(0.0, 0.0, 0.6, 0.8)])[:, 2].max() == pytest.approx(np.sqrt(2.0 * 9.81 * 0.775))


def test_a_face_is_pushed_where_it_is_in_the_open():
    beside = pushed([(0.0, 0.0, 0.6, 0.8), (0.6, 0.0, 0.2, 0.3)])
    assert set(beside[beside[:, 2] > 0.0, 0]) == {0.575, 0.775}
    assert not beside[(beside[:, 0] == 0.575) & (beside[:, 1] < 0.3), 2].any()


@pytest.mark.parametrize("more", [{"width": 0.6}, {"soil": {"body": [{"outline": [[0.6, 0], [1.2, 0], [0.6, 0.8]]}]}}])
def test_a_face_before_a_side_or_ground_is_not_pushed_into_it(more):
    if "soil" in more:  # a slope, which the upper part of the face looks over
        rows = pushed([(0.0, 0.0, 0.6, 1.0)], **more)
        assert rows[rows[:, 2] > 0.0, 1].min() > 0.7
        more = {"soil": {"body": [{"outline": [[0.6, 0], [1.2, 0], [1.2, 1.0], [0.6, 1.0]]}]}}
    with pytest.raises(InputError, match=r"water\.push = 'face': needs a right face of water in the open"):
        pushed([(0.0, 0.0, 0.6, 1.0)], **more)

"""Streaming in place is streaming between two arrays: every side, both parities, plates; reading changes nothing."""

import itertools

import numpy as np
import pytest

from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from tests.lbm.beside_twin import ROUND_OFF, go, same, start
from tests.reference.lbm import lbm as twin

EPS = np.finfo(float).eps
LIDS = [("wall", "wall"), ("slip", "slip"), ("wall", "slip"), ("slip", "wall"), ("periodic", "periodic")]


def pair(sides: dict[str, tuple[str, float]], *, nx=7, ny=6, tau=0.7, magic=3 / 16, force=(2e-4, -1e-4), seed=1):
    """A fluid and its twin with the same random flow (speeds up to 0.05, density within 1 %)."""
    given = {name: kind for name, (kind, _) in sides.items()}
    speeds = {f"{name}_speed": speed for name, (_, speed) in sides.items()}
    fluid = Fluid(nx, ny, tau, magic=magic, force=force, sides=Sides(**given, **speeds))
    other = twin.Lattice(nx, ny, tau, magic, force, sides)
    return start(fluid, other, seed)


def box(left, right, bottom, top, speed=0.0):
    """Sides of the four kinds; walls move at ``speed``, each a little differently."""
    kinds = {"left": left, "right": right, "bottom": bottom, "top": top}
    return {name: (kind, (k + 1) * speed if kind == "wall" else 0.0) for k, (name, kind) in enumerate(kinds.items())}


@pytest.mark.parametrize(("columns", "rows"), list(itertools.product(LIDS, LIDS)))
def test_in_place_streaming_is_streaming_between_two_arrays(columns, rows):
    go(*pair(box(*columns, *rows, speed=0.01)), steps=9)


@pytest.mark.parametrize("wrong", ["tau", "magic", "force"])
def test_another_collision_is_told_apart(wrong):
    other_values = {"tau": 0.701, "magic": 0.19, "force": (2e-4, -1.01e-4)}
    fluid, _ = pair(box("wall", "wall", "slip", "slip"))
    _, other = pair(box("wall", "wall", "slip", "slip"), **{wrong: other_values[wrong]})
    for _ in range(2):
        fluid.advance()
        other.step()
    with pytest.raises(AssertionError):
        same(fluid, other, 2)


@pytest.mark.parametrize(("nx", "ny"), [(1, 5), (5, 1), (2, 2), (1, 1)])
def test_boxes_one_cell_wide_stream_alike(nx, ny):
    for columns, rows in itertools.product((LIDS[0], LIDS[4]), (LIDS[0], LIDS[4])):
        go(*pair(box(*columns, *rows, speed=0.01), nx=nx, ny=ny))


@pytest.mark.parametrize("rows", LIDS[:4])
@pytest.mark.parametrize("columns", [LIDS[0], LIDS[4]])
def test_a_plate_turns_back_the_links_it_cuts(rows, columns):
    fluid, other = pair(box(*columns, *rows, speed=0.01))
    plate = fluid.add_plate(3)
    other.plate = 3
    for step in range(1, 24):
        if step == 3:  # it starts to rise before an odd-numbered (even) step; both streamings of a pair see one height
            plate.speed = other.plate_speed = 0.1
        fluid.advance()
        other.step()
        same(fluid, other, step)
        if step % 2 == 0:
            plate.lower_edge += 2 * plate.speed
            other.plate_edge = plate.lower_edge
        if step == 20:
            fluid.plates.remove(plate)
            other.plate = None


def test_a_plate_at_another_height_is_told_apart():
    fluid, other = pair(box("wall", "wall", "wall", "wall"))
    fluid.add_plate(3).lower_edge = 1.0
    other.plate = 3
    for _ in range(2):
        fluid.advance()
        other.step()
    with pytest.raises(AssertionError):
        same(fluid, other, 2)


def excess(fluid):
    """Density excess of every cell; sums of it show leaks of round-off size."""
    return fluid.fields()[0] - 1.0


@pytest.mark.parametrize("rows", [("wall", "wall"), ("slip", "slip"), ("wall", "slip")])
def test_a_plate_keeps_the_water_on_either_side(rows):
    fluid, _ = pair(box("wall", "wall", *rows), nx=12, ny=10)
    fluid.add_plate(5)
    left = excess(fluid)[:, :5].sum()
    right = excess(fluid)[:, 5:].sum()
    steps = 200
    for _ in range(steps):
        fluid.advance()
    # Each cell rounds its nine populations (size 0.01, shifted) and 1 + d (size 1) once a step: 2 eps a cell and step,
    # of random sign; summed at worst.
    bound = 2 * EPS * steps * 60
    assert abs(excess(fluid)[:, :5].sum() - left) < bound
    assert abs(excess(fluid)[:, 5:].sum() - right) < bound


def test_a_raised_plate_lets_water_through():
    fluid, _ = pair(box("wall", "wall", "wall", "wall"), nx=12, ny=10)
    fluid.add_plate(5).lower_edge = 2.0
    left = excess(fluid)[:, :5].sum()
    for _ in range(20):
        fluid.advance()
    assert abs(excess(fluid)[:, :5].sum() - left) > 1e-6


def test_a_moving_plate_drags_water_along_and_makes_none():
    fluid = Fluid(16, 40, 0.8, sides=Sides(top="slip"))
    plate = fluid.add_plate(8)
    plate.speed = 0.01
    for _ in range(100):
        fluid.advance()
        plate.lower_edge += plate.speed
    _, _, uy = fluid.fields()
    assert uy[20, 7] > 1e-3
    assert uy[20, 8] == pytest.approx(uy[20, 7], rel=1e-9)  # alike on both faces: the box is symmetric, round-off apart
    # 640 cells, 100 steps, populations of size 0.01: 640 * 100 * 9 * 0.01 eps at worst
    assert abs(fluid.mass_excess()) < 640 * 100 * 9 * 0.01 * EPS


@pytest.mark.parametrize("steps", [4, 5])
def test_reading_leaves_the_bits_as_they_were(steps):
    def state(read: bool):
        fluid, _ = pair(box("wall", "wall", "wall", "slip", speed=0.01))
        fluid.add_plate(3)
        for _ in range(steps):
            fluid.advance()
        if read:
            fluid.fields()
            fluid.momentum()
            fluid.mass_excess()
            with fluid.readable():
                pass
        at_once = fluid.populations[:, 1:-1, 1:-1].copy()
        for _ in range(3):
            fluid.advance()
        return at_once, fluid.populations.copy()

    for undisturbed, read in zip(state(False), state(True), strict=True):
        np.testing.assert_array_equal(undisturbed, read)


def test_the_moments_of_an_odd_step_need_their_halo():  # the twin of readable()
    from porescale.lbm.moments import moment_fields

    fluid, _ = pair(box("wall", "wall", "wall", "wall"))
    fluid.advance()
    with fluid.readable():
        right = moment_fields(fluid.padded, fluid.nx, 1)[0].copy()
    fluid.populations[:, 0] = fluid.populations[:, -1] = 0.1
    assert np.abs(moment_fields(fluid.padded, fluid.nx, 1)[0] - right).max() > 1e-3


@pytest.mark.parametrize("steps", [6, 7])
def test_a_restored_fluid_goes_on_bit_for_bit(steps):
    def made():
        fluid, _ = pair(box("wall", "wall", "wall", "slip", speed=0.01))
        plate = fluid.add_plate(3)
        plate.speed = 0.05
        return fluid, plate

    def go(fluid, plate, count):
        for _ in range(count):
            fluid.advance()
            plate.lower_edge += plate.speed

    fluid, plate = made()
    go(fluid, plate, steps)
    kept = {key: np.copy(value) if key == "populations" else value for key, value in fluid.state().items()}
    go(fluid, plate, 5)
    again, again_plate = made()
    again.restore(kept)
    go(again, again_plate, 5)
    np.testing.assert_array_equal(fluid.populations, again.populations)
    assert (again.step, again_plate.lower_edge) == (fluid.step, plate.lower_edge)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_everything_stays_in_the_dtype_of_the_populations(dtype):
    fluid = Fluid(8, 6, 0.7, force=(1e-4, 0.0), dtype=dtype)
    for _ in range(4):
        fluid.advance()
    assert fluid.populations.dtype == dtype
    assert all(values.dtype == dtype for values in fluid.fields())


def test_a_relaxation_time_of_one_half_or_less_is_refused():
    with pytest.raises(ValueError, match="relaxation time"):
        Fluid(4, 4, 0.5)


@pytest.mark.parametrize("column", [0, 7])
def test_a_plate_stands_between_two_columns(column):
    with pytest.raises(ValueError, match="column"):
        Fluid(7, 6, 0.7).add_plate(column)


def test_a_plate_needs_a_floor_and_a_lid():
    with pytest.raises(ValueError, match="periodic"):
        Fluid(7, 6, 0.7, sides=Sides(bottom="periodic", top="periodic")).add_plate(3)


def test_sides_are_periodic_together():
    with pytest.raises(ValueError, match="together"):
        Sides(left="periodic")


def test_a_step_of_plain_python_is_the_compiled_one(monkeypatch):
    # Rows of 4 cells; the same operations but for fused multiply-adds: 60 eps a step, as above.
    from porescale.lbm import fluid as room
    from porescale.lbm import moments, stream
    from porescale.lbm.boundary import links as rim
    from porescale.lbm.collision import law, trt

    def made():
        fluid, _ = pair(box("wall", "slip", "wall", "wall", speed=0.01), nx=4, ny=3)
        fluid.add_plate(2).speed = 0.01
        return fluid

    compiled = made()
    for _ in range(2):
        compiled.advance()
    for module, name in (
        (stream, "collide_row"), (stream, "even_slots"), (stream, "odd_slots"), (stream, "slots"),
        (law, "collide_cells"), (law, "cut"), (law, "moments"), (moments, "moments"),
        (law, "shear_rate"), (law, "collide"), (law, "half_force"), (trt, "relax_halves"),
        (trt, "relax_by"), (trt, "symmetric_equilibrium"), (trt, "symmetric_gain"), (trt, "magic_rate"),
        (rim, "pass_on"), (rim, "pass_one"),
        (room, "exchange"), (moments, "_moment_row"),
    ):  # fmt: skip
        monkeypatch.setattr(module, name, getattr(module, name).py_func)
    plain = made()
    for _ in range(2):
        plain.advance(stream.sweep.py_func)
    np.testing.assert_allclose(plain.populations, compiled.populations, rtol=0, atol=2 * ROUND_OFF)
    d, jx, jy = np.zeros((3, 3, 4))
    moments._moments_even.py_func(plain.padded, d, jx, jy)
    for ours, theirs in zip((1 + d, jx, jy), moments.moment_fields(compiled.padded, compiled.nx, 0), strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=2 * ROUND_OFF)

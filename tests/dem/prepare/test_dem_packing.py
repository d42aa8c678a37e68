"""Packings reach the prescribed pressure or density, rest there, and come back from files as they were."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.neighbors.grading import graded_radii
from porescale.common.neighbors.placement import part
from porescale.dem.contact.linear import Linear
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.fabric import rattlers
from porescale.dem.measures.region import Region
from porescale.dem.measures.stress import contact_stress
from porescale.dem.prepare.compaction import (
    BALANCE,
    NEAR,
    Compactor,
    kept,
    mean_stress,
    out_of_balance,
    read_circles,
    read_packing,
    write_packing,
)

LAW = Linear.from_restitution(0.5, 1e-3, 1e6, 2.5e5, 20.0, 0.5)
SIZE = (0.012, 0.012)


def sizes(count=150):
    return 0.5e-3 * (1.0 + 0.3 * (2.0 * (np.arange(count) + 0.5) / count - 1.0))


def pressed(friction, periodic=True):
    return Compactor((0.0, 0.0), SIZE, LAW, (periodic, periodic), friction, seed=2).to_pressure(sizes(), 1000.0)


def test_pressure_is_reached_at_rest_and_friction_makes_it_loose():
    dense, loose = pressed(0.0), pressed(0.5)
    for made in (dense, loose):
        assert made.pressure == pytest.approx(1000.0, rel=NEAR)
        assert out_of_balance(made.grains) < BALANCE
        # It goes on resting: at a mean net force of 3e-3 of contact forces springs of 1e6 N/m give by 3e-9 m and less.
        before = made.grains.discs.position.copy()
        made.grains.step(made.grains.stable_step(), count=400)
        bearing = ~rattlers(contacts(made.grains), len(before))
        assert np.abs(made.grains.discs.position - before)[bearing].max() < 1e-3 * 1e-3
    # Random close packing in the plane is at 0.84; friction of 0.5 holds from 0.77 to 0.81 (150 discs: +- 0.01).
    assert 0.825 < dense.fraction < 0.855
    assert 0.76 < loose.fraction < 0.82
    assert dense.fraction - loose.fraction > 0.02
    stress = contact_stress(Region((0.0, 0.0), SIZE), contacts(dense.grains), SIZE)
    assert abs(stress[0, 0] / stress[1, 1] - 1.0) < 0.25  # isotropic but for the chance of 150 discs


def test_a_packing_from_disk_has_the_bits_it_was_made_with(tmp_path, monkeypatch):
    press = Compactor((0.0, 0.0), SIZE, LAW, friction=0.5, seed=2)
    made = kept(press, sizes(), 1000.0, tmp_path)
    monkeypatch.setattr(Compactor, "to_pressure", None)  # it must not be pressed again
    found = kept(press, sizes(), 1000.0, tmp_path)
    assert found[1:] == made[1:]
    for grains in (made.grains, found.grains):
        grains.step(1e-6, count=20)
    np.testing.assert_array_equal(found.grains.discs.position, made.grains.discs.position)
    np.testing.assert_array_equal(found.grains.discs.mass, made.grains.discs.mass)
    with pytest.raises(TypeError):
        kept(press, sizes(), 1001.0, tmp_path)  # the twin: another pressure is another packing


def test_walls_hold_a_packing_too():
    made = pressed(0.0, periodic=False)
    walls = dict(zip(made.grains.wall_names, made.grains.wall_force, strict=True))
    # Two numbers for the pressure on a wall, one by force over length, one by contacts over the area.
    on_walls = np.mean(
        [abs(walls[name][axis]) for name, axis in (("left", 0), ("right", 0), ("top", 1), ("bottom", 1))]
    )
    assert on_walls / SIZE[0] == pytest.approx(made.pressure, rel=5 * BALANCE)


def test_a_size_gives_its_fraction_and_too_much_of_it_is_refused():
    press = Compactor((0.0, 0.0), SIZE, LAW, seed=2)
    area = np.pi * np.sum(sizes() ** 2)
    small = sizes() * np.sqrt(0.78 * SIZE[0] * SIZE[1] / area)
    made = press.to_size(small)
    np.testing.assert_allclose(made.grains.discs.radius, small, rtol=1e-12)  # hundreds of factors, each rounded
    assert made.fraction == pytest.approx(0.78, rel=1e-11)
    assert mean_stress(made.grains) < 1.0  # looser than jamming: nothing presses
    with pytest.raises(InputError, match=r"packing_fraction.*pressed into each other"):
        press.to_size(sizes() * np.sqrt(0.95 * SIZE[0] * SIZE[1] / area))
    with pytest.raises(InputError, match=r"pressure.*raise contact.stiffness"):
        press.to_pressure(small, 1e5)


def test_sizes_of_one_to_ten_are_packed():
    radius = graded_radii(((0.2e-3, 0.0), (2e-3, 100.0)), 0.8 * SIZE[0] * SIZE[1])
    made = Compactor((0.0, 0.0), SIZE, LAW, seed=1).to_pressure(radius, 1000.0)
    assert radius.max() / radius.min() > 7.0
    assert made.fraction > 0.85  # small discs fill the pores of large ones: denser than equal sizes
    np.testing.assert_allclose(made.grains.discs.radius / radius, made.scale, rtol=1e-12)


@pytest.mark.parametrize("suffix", [".csv", ".h5"])
def test_a_packing_comes_back_from_its_file(tmp_path, suffix):
    rng = np.random.default_rng(0)
    position, radius = rng.uniform(0, 1, (20, 2)), rng.uniform(1e-3, 2e-3, 20)
    write_packing(tmp_path / f"bed{suffix}", position, radius)
    again = read_packing(tmp_path / f"bed{suffix}")
    np.testing.assert_array_equal(again[0], position)
    np.testing.assert_array_equal(again[1], radius)


def test_circles_of_a_picture_count_downwards(tmp_path):
    path = tmp_path / "circles.csv"
    path.write_text("id,x (mm),y (mm),diameter (mm)\n1,10,5,2\n2,12.5,9,2\n")
    at, radius = read_circles(path, "mm", "down", 0.01, origin=(0.1, 0.0))
    np.testing.assert_allclose(at, [(0.11, 0.005), (0.1125, 0.001)], rtol=1e-14)
    np.testing.assert_allclose(radius, 1e-3, rtol=1e-14)
    np.testing.assert_allclose(read_circles(path, "mm", "down")[0][:, 1], [0.005, 0.001], rtol=1e-12)  # lowest at y = 0


@pytest.mark.parametrize(("text", "unit", "said"), [
    ("x,y\n1,2\n", "mm", r"no column radius.*x, y and diameter or radius"),
    ("x,y,diameter\n1,2,3\n1,two,3\n", "mm", r"line 3 is '1,two,3'"),
    ("x,y,diameter\n1,2,-3\n", "mm", r"circle 0.*radius > 0"),
    ("x (cm),y (cm),diameter (cm)\n1,2,3\n", "mm", r"unit.*says otherwise"),
    ("x;y;diameter\n1;2;3\n", "mm", r"no column x, y, radius.*part columns by commas"),
    ("x,y,radius,diameter\n1,2,1.5,3\n1,2,2,5\n", "mm", r"line 3 has radius 2 and diameter 5; leave one of"),
    ("x,y,diameter\n", "mm", r"holds no circle"),
    ("x,y,diameter\n1,2,3\n", "inch", r"unit.*not known"),
])  # fmt: skip
def test_what_is_no_list_of_circles_is_refused(tmp_path, text, unit, said):
    path = tmp_path / "circles.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=said):
        read_circles(path, unit)


def test_files_that_are_none_are_refused(tmp_path):
    (tmp_path / "a.h5").write_text("no")
    for name, said in (("a.h5", "no packing"), ("a.txt", r"\.csv or \.h5"), ("b.csv", "cannot be read")):
        with pytest.raises(InputError, match=said):
            read_packing(tmp_path / name)


def test_measured_circles_are_slid_apart_and_stay_close():
    rng = np.random.default_rng(5)
    grid = np.stack(np.meshgrid(np.arange(8), np.arange(6)), axis=-1).reshape(-1, 2) * 1.05e-3
    radius = np.full(len(grid), 0.5e-3)
    measured = grid + rng.normal(0.0, 4e-5, grid.shape)
    moved = part(measured, radius)
    near = np.hypot(*(moved[:, None] - moved[None]).transpose(2, 0, 1)) + np.eye(len(grid))
    assert near.min() >= 1e-3 * (1 - 1e-12)
    first = np.hypot(*(measured[:, None] - measured[None]).transpose(2, 0, 1)) + np.eye(len(grid))
    assert first.min() < 0.97e-3  # they did overlap
    assert np.hypot(*(moved - measured).T).max() < 2e-4

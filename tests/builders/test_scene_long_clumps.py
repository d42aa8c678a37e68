"""Long clumps, and such as fall into pieces with their hydraulic radii, are bodies: in `check` and in the run."""

import numpy as np
import pytest

import porescale as ps
from porescale.common.core.errors import InputError
from porescale.coupling.displaced import displaced
from porescale.dem.bodies import clumps
from porescale.dem.bodies.union import outline

R = 1e-3  # m
# A row of twelve, and one of six whose two last discs stand 1.7 R apart: three pieces from a ratio of 0.85 on.
ROW = tuple((R * k, 0.0, R) for k in range(12))
LOOSE = (*((0.8 * R * k, 0.0, R) for k in range(6)), (5.7 * R, 0.0, R), (7.4 * R, 0.0, R))


def scene(discs, ratio=None, *, angle=0.0, body_force=(0.0, 0.0), **changes):
    """One disc and a long clump, alone or in a liquid, with ``ratio`` of their radii."""
    wet = {"hydraulic_radius_ratio": ratio} if ratio else {}
    if ratio:
        changes["fluid"] = {"viscosity": 1e-4, "spacing": 0.5 * R, "step": 1e-4, "body_force": body_force}
    return ps.Scene(
        domain={"width": 20 * R, "height": 20 * R}, gravity=(0.0, 0.0), time={"end": 0.01},
        output={"snapshot_interval": 0.01, "series_interval": 0.01},
        grains={"density": 2500} | wet, contact={"stiffness": 1e3, "restitution": 0.5},
        clump=[{"discs": [[0, 0, R]], "at": [[5 * R, 18 * R]]},
               {"discs": discs, "at": [[4 * R, 5 * R]], "angle": [angle], "velocity": [0.1, 0.2], "spin": 30.0}],
        **changes,
    )  # fmt: skip


def sums(discs, own):
    """Mass, centre, moment of inertia about it, momentum and energy of rows of discs, from their shares."""
    mass, x, v = discs.mass[own], discs.position[own], discs.velocity[own]
    centre = mass @ x / mass.sum()
    turning = float(mass @ np.sum((x - centre) ** 2, axis=1) + discs.inertia[own].sum())
    energy = 0.5 * float(mass @ np.sum(v**2, axis=1) + discs.inertia[own] @ discs.spin[own] ** 2)
    return float(mass.sum()), centre, turning, mass @ v, energy


@pytest.mark.parametrize("discs", [ROW, LOOSE], ids=["row", "loose"])
@pytest.mark.parametrize("angle", [0.0, 1.1])
def test_sums_over_the_members_of_a_long_clump_are_those_of_the_body(discs, angle, monkeypatch):
    """Shares centre the members within 1e-13 of half the length, 5.5 R, which is 1e-12 of the inertia; the rest is a
    rounding for each of twelve."""
    given = scene(discs, angle=angle)
    ps.check(given)
    grains = ps.build(given).grains
    body, own = grains.steering.clumps, grains.steering.clumps.discs_of(1)
    at = np.array(discs)
    union = outline(at[:, :2], at[:, 2])
    mass, centre, turning, momentum, energy = sums(grains.discs, own)
    assert (grains.discs.mass[own] > 0.0).all()
    assert (grains.discs.inertia[own] > 0.0).all()
    assert mass == pytest.approx(2500 * union.area, rel=1e-12)
    assert centre == pytest.approx(body.position[1], rel=1e-12)
    assert turning == pytest.approx(2500 * union.second_moment, rel=1e-11)
    assert momentum == pytest.approx(mass * np.array([0.1, 0.2]), rel=1e-11)
    assert energy == pytest.approx(0.5 * mass * 0.05 + 0.5 * turning * 30.0**2, rel=1e-11)
    monkeypatch.setattr(clumps, "DRAWN", ())  # the check that fails: shares by the outline alone
    with pytest.raises(InputError, match=r"clump\[.\]\.inertia"):
        ps.check(given)


@pytest.mark.parametrize("ratio", [0.5, 0.6, 0.8, 0.9, 1.0])
@pytest.mark.parametrize("discs", [ROW, LOOSE], ids=["row", "loose"])
def test_long_clumps_displace_fluid_in_pieces_too(discs, ratio):
    for body_force in ((0.0, 0.0), (0.1, 0.0)):
        given = scene(discs, ratio, angle=0.4, body_force=body_force)
        ps.check(given)
        model = ps.build(given)
        model.advance(1)
    grains, at = model.grains, np.array(discs)
    own = grains.steering.clumps.discs_of(1)
    inside = displaced(grains, ratio * grains.discs.radius, 1000.0)
    union = outline(at[:, :2], ratio * at[:, 2])
    offset = grains.discs.position[own] - grains.steering.clumps.position[1]
    assert (inside.inertia[own] > 0.0).all()
    assert inside.mass[own].sum() == pytest.approx(1000.0 * union.area, rel=1e-12)
    # about the centre of the body, which is not that of the fluid where pieces overlap by less: parallel axes
    away = (inside.mass[own] @ offset) / inside.mass[own].sum()
    second = float(inside.mass[own] @ np.sum((offset - away) ** 2, axis=1) + inside.inertia[own].sum())
    assert second == pytest.approx(1000.0 * union.second_moment, rel=1e-11)


def test_clumps_that_were_bodies_before_have_the_same_shares():
    """Bit for bit: nothing is drawn in where the outline's own shares leave a moment."""
    at, radius = np.array([[0.0, 0.0], [1.2, 0.0], [2.4, 0.3]]), np.array([1.0, 0.9, 0.8])
    union = outline(at, radius)
    weight = radius * union.exposed
    own = clumps.shares(weight, at - union.centroid, 1.0)
    second = union.second_moment / union.area
    assert clumps.drawn_in(own, weight, at - union.centroid, radius, second) is own


def test_check_refuses_what_has_no_shares_with_the_line_of_the_run(monkeypatch):
    """Without shares that are drawn in, as an example: this row is a body, and at 0.7 of its radii none."""
    row = (*((R * k, 0.0, R) for k in range(4)), (4.7 * R, 0.0, R))
    ps.check(scene(row, 0.7))
    monkeypatch.setattr(clumps, "DRAWN", ())
    line = "clump[1]: cannot displace fluid; make it of other discs, or raise grains.hydraulic_radius_ratio"
    for read in (ps.check, ps.build):
        with pytest.raises(InputError) as caught:
            read(scene(row, 0.7))
        assert str(caught.value) == line
    ps.check(scene(row, 1.0))


def across(shift):
    """Positions (3, 2) m of a grain and a clump of two discs that it hits in a box without sides, all moved by x, y m.

    The clump reaches over a side, disc and all, once it is moved far enough.
    """
    side = 20 * R
    at = [(x + shift) % side for x in (5.3 * R, 6.6 * R, 13.3 * R, 7.3 * R)]
    sides = dict.fromkeys(("left", "right", "bottom", "top"), "periodic")
    made = ps.build(ps.Scene(
        domain={"width": side, "height": side, **sides}, gravity=(0.0, 0.0), time={"end": 0.05},
        output={"snapshot_interval": 0.05, "series_interval": 0.05}, contact={"stiffness": 1e4, "restitution": 0.5},
        grains={"density": 2500, "grain": [{"x": at[2], "y": at[3], "diameter": 2.6 * R, "velocity": [-0.2, 0.02]}]},
        clump=[{"discs": [[-1.3 * R, 0, 1.6 * R], [1.3 * R, 0, 1.6 * R]], "at": [at[:2]], "angle": [0.3],
                "velocity": [0.05, 0.01], "spin": 5.0}],
    ))  # fmt: skip
    made.run()
    return made.positions, at


def test_a_clump_may_lie_across_a_periodic_side():
    side, (still, _) = 20 * R, across(0.0)
    for shift in (13.6 * R, 14.5 * R):  # its middle lies within the box, that of one disc beyond
        moved, at = across(shift)
        assert max(at[:2]) + 1.3 * R * np.cos(0.3) > side
        apart = (moved - still - shift + 0.5 * side) % side - 0.5 * side
        # Each of some 50 steps rounds places to eps of the side, and the impact multiplies that by ten or so.
        assert np.abs(apart).max() < 1e3 * np.finfo(float).eps * side
    with pytest.raises(InputError, match=r"clump\[0\] = '.*': reaches out of the box by 0.0001 m"):
        ps.check(ps.Scene(
            domain={"width": side, "height": side, "left": "periodic", "right": "periodic"}, time={"end": 0.05},
            output={"snapshot_interval": 0.05, "series_interval": 0.05}, grains={"density": 2500},
            contact={"stiffness": 1e4, "restitution": 0.5},
            clump=[{"discs": [[-R, 0, R], [R, 0, R]], "at": [[side + 0.1 * R, 5 * R]]}],
        ))  # fmt: skip

"""A contact law of a user: equal to a built-in one where it says the same, refused where it is no law."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import elastic
from porescale.dem.timestep import packing_limit
from tests.reference.own_laws import contact_named, write_laws

EPS = np.finfo(float).eps
MASS, RADIUS = 7.9e-3, 1e-3


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with laws.py."""
    return write_laws(tmp_path_factory.mktemp("own")).parent


def heap(law: ContactLaw, steps: int = 3000, dt: float = 2e-6, **more: Any) -> Grains:
    """Twelve discs that fall on a floor beside a wall, sliding and rolling."""
    rng = np.random.default_rng(3)
    x = np.array([(1.1e-3 + 2.05e-3 * (k % 4), 1.05e-3 + 2.05e-3 * (k // 4)) for k in range(12)])
    discs = make_discs(x + 2e-5 * rng.random(x.shape), RADIUS * (0.9 + 0.1 * rng.random(12)), 2500.0)
    grains = Grains(discs, law, Box((0.0, 0.0), (9e-3, 9e-3), "solid", "solid", "solid", "open"), **more)
    grains.discs.velocity[:] = 0.05 * rng.standard_normal((12, 2))
    grains.discs.velocity[:, 1] -= 0.1
    weight = np.column_stack([np.zeros(12), -9.81 * grains.discs.mass])
    grains.step(dt, weight, count=steps)
    return grains


def rubbing(folder: Path) -> tuple[ContactLaw, Linear]:
    """A linear law of a user in the frame of the built-in one, with friction and rolling resistance, and that one."""
    theirs = Linear(1e5, 0.5, 2e4, 0.1, 0.4, "force", 0.1, 1e4, 0.05)
    own = contact_named(folder, "linear", stiffness=1e5, damping=0.5)
    return replace(own, frame=replace(theirs, stiffness=1.0, damping=0.0)), theirs


def test_a_linear_law_of_a_user_is_the_built_in_one_to_the_bit(folder: Path) -> None:
    # The same operations in the same order: spring plus dashpot, the rest is the linear law's own.
    own, theirs = rubbing(folder)
    one, other = heap(own), heap(theirs)
    assert np.array_equal(one.discs.position, other.discs.position)
    assert np.array_equal(one.discs.spin, other.discs.spin)
    stiffer = heap(replace(own, numbers=(1e5 * (1 + 4 * EPS), 0.5)))  # must fail: two more units in the last place
    assert not np.array_equal(stiffer.discs.position, other.discs.position)


def test_hertz_of_a_user_without_friction_is_the_built_in_one_to_the_bit(folder: Path) -> None:
    # The same operations in the same order here, too; the built-in one adds a dashpot of 0 to it.
    theirs = heap(Hertz(2e7), 1500)
    one = heap(contact_named(folder, "hertz", modulus=2e7), 1500)
    assert np.array_equal(one.discs.position, theirs.discs.position)
    assert not one.discs.spin.any()
    other = heap(contact_named(folder, "hertz", modulus=2e7 * (1 + 4 * EPS)), 1500)  # must fail, as above
    assert not np.array_equal(other.discs.position, theirs.discs.position)


def test_restitution_and_contact_time_are_those_of_the_linear_law(folder: Path) -> None:
    # Integrated to 10 digits a step; some hundred steps.
    own = contact_named(folder, "linear", stiffness=1e5, damping=2.0)
    theirs = Linear(1e5, 2.0)
    for release in ("force", "overlap"):
        law = replace(own, frame=replace(own.frame, release=release))
        exact = replace(theirs, release=release)
        assert law.restitution(MASS, RADIUS) == pytest.approx(exact.restitution(MASS), rel=1e-8)
        assert law.shortest_contact(MASS, RADIUS) == pytest.approx(exact.contact_time(MASS), rel=1e-8)
        assert law.restitution(MASS, RADIUS) != pytest.approx(
            replace(exact, damping=2.0001).restitution(MASS), rel=1e-8
        )


def test_the_stable_step_is_that_of_the_built_in_law(folder: Path) -> None:
    # Tangents are differences over 1e-4 of the overlap: of a line to round-off over that, 1e-11; of Hertz's to 1e-8/24.
    own = contact_named(folder, "linear", stiffness=1e5, damping=2.0)
    assert packing_limit(own, MASS, RADIUS) == pytest.approx(packing_limit(Linear(1e5, 2.0), MASS), rel=1e-10)
    hertz, theirs = contact_named(folder, "hertz", modulus=2e7), Hertz(2e7)
    assert packing_limit(hertz, MASS, RADIUS) == pytest.approx(packing_limit(theirs, MASS, RADIUS), rel=1e-8)
    deeper = replace(hertz, deepest=0.021)
    assert packing_limit(deeper, MASS, RADIUS) != pytest.approx(packing_limit(theirs, MASS, RADIUS), rel=1e-8)
    lasts, theirs_lasts = hertz.shortest_contact(MASS, RADIUS), theirs.shortest_contact(MASS, RADIUS)
    assert lasts == pytest.approx(theirs_lasts, rel=1e-3)  # of the work, summed over 96 trapezia


@pytest.mark.parametrize("name", ["linear", "hertz"])
def test_its_elastic_energy_is_the_work_of_its_force(folder: Path, name: str) -> None:
    # Gauss's rule is exact for both: round-off of a dozen terms.
    own: ContactLaw
    exact: ContactLaw
    own, exact = rubbing(folder) if name == "linear" else (contact_named(folder, name, modulus=2e7), Hertz(2e7))
    one = elastic(heap(own, 400))[0]
    other = elastic(heap(exact, 400))[0]
    assert other > 0.0
    assert one == pytest.approx(other, rel=1e-8)
    assert one != pytest.approx(elastic(heap(exact, 401))[0], rel=1e-8)


@pytest.mark.parametrize(
    ("name", "numbers", "said"),
    [
        ("unset", {}, "the force is nan at an overlap of 2e-11 m"),
        ("log", {}, "the force is inf at an overlap of 2e-11 m"),
        ("hard", {}, "pushes with 5 N/m at an overlap of 2e-11 m: its stiffness there is not finite"),
        ("nothing", {}, "the force is 0 at every overlap"),
        ("giving", {}, "a collision gains energy"),
        ("sticky", {"stiffness": 1e5, "adhesion": 0.5}, "pulls with 0.5 N/m at an overlap of 2e-11 m"),
        ("sticky", {"stiffness": 1e5, "adhesion": 5.0}, "pulls with 5 N/m"),
    ],
)
def test_what_is_no_contact_law_is_refused_with_its_value(
    folder: Path, name: str, numbers: dict[str, float], said: str
) -> None:
    assert said in contact_named(folder, name, **numbers).problem(MASS, RADIUS)


def test_what_is_one_is_not(folder: Path) -> None:
    assert contact_named(folder, "linear", stiffness=1e5, damping=0.5).problem(MASS, RADIUS) == ""
    assert contact_named(folder, "hertz", modulus=2e7).problem(MASS, RADIUS) == ""
    sticky = contact_named(folder, "sticky", "overlap", stiffness=1e5, adhesion=0.5)
    assert sticky.problem(MASS, RADIUS) == ""  # with a rule that lets contacts attract
    held = sticky.collision(MASS, RADIUS, 1e-3)
    assert held.restitution == pytest.approx(1.0, rel=1e-8)  # the work of adhesion is got back while the overlap lasts


def test_discs_that_do_not_part_have_no_finite_damping_ratio(folder: Path) -> None:
    sticky = contact_named(folder, "sticky", "overlap", stiffness=1e5, adhesion=0.5)
    assert sticky.ratio_of_damping(MASS, RADIUS) == pytest.approx(0.0, abs=1e-8)
    caught = replace(contact_named(folder, "linear", "overlap", stiffness=1e5, damping=1e4))  # creeps back for ever
    assert caught.restitution(MASS, RADIUS) == 0.0
    assert caught.ratio_of_damping(MASS, RADIUS) == math.inf


def test_between_unlike_materials_stiffnesses_are_in_series(folder: Path) -> None:
    one = contact_named(folder, "linear", stiffness=1e5, damping=1.0)
    other = replace(one, numbers=(3e5, 3.0))
    assert one.mixed(other).numbers == (1.5e5, 2.0)
    assert one.mixed(one).numbers == one.numbers

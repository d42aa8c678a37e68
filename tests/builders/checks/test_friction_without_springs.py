"""Friction needs a spring or a dashpot along the contact, of whatever surface or pair it is: refused without one."""

from typing import Any

import pytest

from porescale.builders.derive import derive
from tests.reference.scenes import dry, grain, refusals

ONE: dict[str, Any] = {"density": 2500, "grain": [grain(0.006, 0.006)]}
SMOOTH: dict[str, Any] = {"stiffness": 1e5, "restitution": 0.5}
SPRING: dict[str, Any] = {"tangential_stiffness": 5e4}
NEEDED = "tangential_stiffness: is needed where there is friction"
SURFACES: dict[str, Any] = {
    "wall": [{"x": 0.0, "y": 0.0005, "normal": [0.0, 1.0]}],
    "rectangle": [{"lower": [0.0, 0.0], "upper": [0.004, 0.002]}],
    "gate": {"x": 0.008},
}


def surface(name: str, friction: float) -> dict[str, Any]:
    """A section of a surface with friction."""
    given = SURFACES[name]
    return {name: [given[0] | {"friction": friction}] if isinstance(given, list) else given | {"friction": friction}}


@pytest.mark.parametrize("name", list(SURFACES))
def test_friction_of_a_surface_without_a_spring_along_contacts_is_refused(name: str) -> None:
    def made(contact: dict[str, Any], friction: float) -> Any:
        """What is derived from a scene whose surface has this friction."""
        return derive(dry(grains=ONE, contact=contact, **surface(name, friction)))

    (line,) = refusals(lambda: made(SMOOTH, 0.5))
    assert line.startswith(f"contact.{NEEDED}")
    # The checks that must fail: with a spring, or without friction, there is nothing to say.
    assert made({**SMOOTH, **SPRING}, 0.5)
    assert made(SMOOTH, 0.0)


@pytest.mark.parametrize(
    ("own", "line"),
    [
        ({"friction": 0.4}, f"contact.pair[0].{NEEDED}"),
        ({"friction": 0.4, **SPRING}, ""),
        ({"friction": 0.4, "tangential_damping": 1.0}, ""),
        ({"rolling_friction": 0.1}, "contact.pair[0].rolling_stiffness: is needed where there is rolling_friction"),
        ({"rolling_friction": 0.1, "rolling_stiffness": 1e4}, ""),
        ({"restitution": 0.2}, ""),
    ],
)
def test_friction_of_a_pair_of_materials_needs_one_in_both_or_of_its_own(own: dict[str, Any], line: str) -> None:
    given = [{"name": "glass"}, {"name": "rubber", **SPRING}]
    contact = {**SMOOTH, "pair": [{"materials": ["glass", "rubber"], **own}]}
    scene = {"grains": ONE, "contact": contact, "material": given}
    if line:
        assert [it[: len(line)] for it in refusals(lambda: derive(dry(**scene)))] == [line]
    else:
        assert derive(dry(**scene)).law

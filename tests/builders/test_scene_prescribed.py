"""Where prescribed motions lead: into a side or each other is refused before the run, which would stop there."""

from typing import Any

import pytest

from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.common.core.errors import Unstable
from porescale.scene.scene import Scene
from tests.reference.scenes import dry, grain, refusals, water

R = 0.001
"""Radius, m, of what moves in a box of 12 x 8 mm."""
INTO, MEET = "goes more than 0.3 of its radius into the", "run into each other after"
STILL: dict[str, Any] = {"rotation": {"velocity": 0}}
ONE: dict[str, Any] = {"density": 2500, "grain": [grain(0.006, 0.004, 2 * R)]}


def disc(x: float, y: float, velocity: tuple[float, float] = (0.0, 0.0), **more: Any) -> dict[str, Any]:
    """A held disc."""
    return {"x": x, "y": y, "diameter": 2 * R, "velocity": velocity, **more}


def held(*discs: dict[str, Any], **changes: Any) -> Scene:
    """Held discs in a closed box of water, for 0.1 s."""
    walls = {f"domain__{name}": "wall" for name in ("left", "right", "bottom", "top")}
    given = {**walls, "fluid__body_force": None, "gravity": [0, 0], "time__end": 0.1}
    return water(**{**given, "disc": list(discs), **changes})


def controlled(**components: Any) -> Scene:
    """One dry grain in the middle of the box, controlled, without gravity, for 0.1 s."""
    return dry(grains=ONE, gravity=[0, 0], time__end=0.1, control=[{"grain": 0, **STILL, **components}])


def said(scene: Scene) -> list[str]:
    """The lines of the refusal."""
    return refusals(lambda: derive(scene))


@pytest.mark.parametrize(
    ("scene", "line"),
    [
        # Touch after 4 mm and 3 mm, and 0.3 mm on: 0.043 and 0.033 s; places of looks are R/20 apart.
        (held(disc(0.002, 0.004, (0.1, 0)), disc(0.008, 0.004)), f"disc[0]: and disc 1 {MEET} 0.043"),
        (held(disc(0.008, 0.004), disc(0.002, 0.004, (0.1, 0))), f"disc[0]: and disc 1 {MEET} 0.043"),
        (held(disc(0.004, 0.004, (-0.1, 0))), f"disc[0]: {INTO} left side after 0.03"),
        (held(disc(0.006, 0.004, velocity_y=[[0, 0.1], [1, 0.1]])), f"disc[0]: {INTO} top side after 0.033"),
        (controlled(x={"velocity": 0.1}), f"control[0]: {INTO} right side after 0.053"),
        (controlled(y={"displacement": [[0, 0.001], [0.05, -0.005]]}), f"control[0]: {INTO} bottom side after 0.02"),
    ],
)  # fmt: skip
def test_what_is_moved_into_something_is_refused_with_one_line(scene, line):
    (only,) = said(scene)
    assert only.startswith(line)
    assert "; end " in only


def test_a_controlled_grain_and_a_disc_run_into_each_other():
    walk = [{"grain": 0, **STILL, "x": {"velocity": 0.1}, "y": {"velocity": 0}}]
    (only,) = said(dry(grains=ONE, gravity=[0, 0], time__end=0.03, control=walk, disc=[disc(0.009, 0.004)]))
    assert only.startswith("disc[0]: and grain 0 run into each other after 0.013")
    # Pushed instead, it is stopped by the contact.
    pushed = [{"grain": 0, **STILL, "x": {"force": 0.1}, "y": {"velocity": 0}}]
    derive(dry(grains=ONE, gravity=[0, 0], time__end=0.03, control=pushed, disc=[disc(0.009, 0.004)]))


@pytest.mark.parametrize(
    "scene",
    [
        held(disc(0.002, 0.004, (0.1, 0)), disc(0.008, 0.004), time__end=0.042),  # 0.2 of a radius: pressed, no more
        held(disc(0.002, 0.002, (0.08, 0)), disc(0.008, 0.0041)),  # passes by
        held(disc(0.002, 0.004, (0.06, 0)), disc(0.0045, 0.004, (0.06, 0))),  # in line
        held(disc(0.006, 0.004, velocity_x={"amplitude": 0.1, "frequency": 10.0})),  # swings by 3.2 mm, and back
        held(disc(0.006, 0.004, (0.5, 0)), domain__left="periodic", domain__right="periodic"),
        held(disc(0.006, 0.004), disc(0.004, 0.002)),
        controlled(x={"velocity": 0.05}),
        controlled(x={"displacement": 0.5}),  # changes alone count
    ],
)
def test_what_keeps_clear_is_accepted(scene):
    derive(scene)


def test_discs_meet_through_a_periodic_side():
    sides = {"domain__left": "periodic", "domain__right": "periodic", "time__end": 0.04}
    (only,) = said(held(disc(0.010, 0.004, (0.1, 0)), disc(0.002, 0.004), **sides))
    assert only.startswith("disc[0]: and disc 1 run into each other after 0.023")


def test_a_wall_that_moves_is_not_looked_at():
    # It goes with the grain.
    walls = {"domain__right": {"kind": "wall", "velocity": [0.1, 0]}, "domain__left": {"kind": "wall"}}
    moved = [{"grain": 0, **STILL, "x": {"velocity": 0.1}, "y": {"velocity": 0}}]
    derive(dry(grains=ONE, gravity=[0, 0], time__end=0.06, control=moved, **walls))


PAIR = {"discs": [[-0.001, 0, R], [0.001, 0, R]], "at": [[0.006, 0.004]]}
"""Two discs that touch, 4 mm long."""
SQUARE = {"corners": [[-1e-3, -1e-3], [1e-3, -1e-3], [1e-3, 1e-3], [-1e-3, 1e-3]], "thickness": 1e-4,
          "at": [[0.006, 0.004]]}  # fmt: skip
CLUMP, STANDS = {"clump": [PAIR]}, {"velocity": 0}
FAR = {"density": 2500, "grain": [grain(0.0015, 0.0015, R)]}


def moved(kind: str, sections: dict[str, Any], **changes: Any) -> Scene:
    """A dry box for 0.1 s in which the first body of a kind is controlled, and what else there is."""
    components = {name: changes.pop(name) for name in ("x", "y", "rotation") if name in changes}
    control = [{kind: 0, "x": STANDS, "y": STANDS, **STILL, **components}] if kind else []
    return dry(**{"grains": FAR, "gravity": [0, 0], "time__end": 0.1, "control": control, **sections, **changes})


def wall(x: float, normal: float, **more: Any) -> dict[str, Any]:
    """An upright wall."""
    return {"wall": [{"x": x, "y": 0.004, "normal": [normal, 0], **more}]}


# Along x the pair's tip has 4 mm to the right side and the square's, 1.1 mm wide, 4.9; at 0.1 m/s.
INTO_SOMETHING = {
    "clump along a side": (
        moved("clump", CLUMP, x={"velocity": 0.1}),
        f"{INTO.replace('its', 'a disc' + chr(39) + 's')} right side",
        0.043,
    ),
    "clump that turns": (
        moved("clump", CLUMP, y={"velocity": 0.05}, rotation={"velocity": 31.4}),
        "bottom|top side",
        0.0,
    ),
    "clump into a disc": (
        moved("clump", CLUMP, x={"velocity": 0.1}, disc=[disc(0.0105, 0.004)]),
        "run into each other after",
        0.018,
    ),
    "polygon along a side": (
        moved("polygon", {"polygon": [SQUARE]}, x={"velocity": 0.1}),
        "goes more than 0.8 of its thickness into the right side",
        0.0498,
    ),
    "polygon into a wall": (
        moved("polygon", {"polygon": [SQUARE]}, x={"velocity": 0.1}, **wall(0.009, -1)),
        "goes more than 0.8 of its thickness into wall 0",
        0.0198,
    ),
    "disc into a wall": (
        moved("", {"disc": [disc(0.006, 0.004, (0.1, 0))]}, **wall(0.009, -1)),
        "goes more than 0.3 of its radius into wall 0",
        0.023,
    ),
    "wall into a disc": (
        moved("", {"disc": [disc(0.006, 0.004)]}, **wall(0.009, -1, velocity_x=-0.1)),
        "goes more than 0.3 of its radius into wall 0",
        0.023,
    ),
    "wall that turns into a disc": (
        moved("", {"disc": [disc(0.006, 0.0055)]}, **wall(0.009, -1, turning=10)),
        "into wall 0",
        0.0,
    ),
}


@pytest.mark.parametrize("name", INTO_SOMETHING)
def test_clumps_polygons_and_walls_that_are_moved_into_something_are_refused(monkeypatch, name):
    scene, words, after = INTO_SOMETHING[name]
    (only,) = said(scene)
    assert any(it in only for it in words.split("|")), only
    said_at = float(only.partition(" after ")[2].split(" ")[0])
    # Looks are a twentieth of the smallest radius apart, 0.5 ms and less; printed with three digits.
    assert after == 0.0 or said_at == pytest.approx(after, abs=0.0006)
    # And there the run stops, not before; it looks whether all is well every so many steps.
    monkeypatch.setattr("porescale.builders.derive.check_motions", lambda scene, frames, faults: None)
    model = build(scene)
    with pytest.raises(Unstable) as found:
        model.run()
    assert 0.995 * said_at - 0.0005 <= found.value.time <= 0.1


@pytest.mark.parametrize(
    "scene",
    [
        moved("clump", CLUMP, x={"velocity": 0.1}, time__end=0.04),
        moved("clump", CLUMP, x={"velocity": 0.1}, rotation="free", time__end=0.045),  # it may turn aside
        moved("clump", CLUMP, rotation={"velocity": 31.4}),  # turns where it is
        moved("clump", CLUMP, x={"force": 0.1}),
        moved("polygon", {"polygon": [SQUARE]}, x={"velocity": 0.1}, time__end=0.049),
        moved("", {"disc": [disc(0.006, 0.004)]}, **wall(0.009, -1, velocity_x=0.02)),  # goes away
        moved("", {"disc": [disc(0.006, 0.004)]}, **wall(0.009, -1, force=1.0, fastest=0.1)),  # gives way
        moved("", {"disc": [disc(0.006, 0.004)]}, **wall(0.009, -1, velocity_x=-0.1), time__end=0.022),
    ],
)
def test_clumps_polygons_and_walls_that_keep_clear_are_accepted(scene):
    derive(scene)


def test_the_run_stops_where_check_says(monkeypatch):
    monkeypatch.setattr("porescale.builders.derive.check_motions", lambda scene, frames, faults: None)
    model = build(held(disc(0.002, 0.004, (0.1, 0)), disc(0.008, 0.004)))
    with pytest.raises(
        Unstable, match=r"overlap with held disc 1 .* at held disc 0; its motion is prescribed"
    ) as found:
        model.run()
    assert found.value.time > 0.043

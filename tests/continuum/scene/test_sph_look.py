"""[look] of a continuum: what no snapshot of a scene holds is refused, with what can be shown."""

import subprocess
import sys

import pytest

from continuum_sph import Scene, build
from continuum_sph.look import look_of_scene
from continuum_sph.scene.look import shown_arrays
from porescale.common.core.errors import InputError
from porescale.common.pictures.figure import require_same_box

BLOCK = {"body": [{"outline": [[0, 0], [0.5, 0], [0.5, 0.4], [0, 0.4]]}]}
FACES = [{"side": "left", "head": 1.2}, {"side": "right", "head": 1.0}]
POOL = {"left": 0.0, "right": 0.5, "bottom": 0.4, "level": 0.5}
COLUMN = {"width": 0.5, "height": 0.4}
SUCTION = {"alpha": 4.0, "n": 2.0, "saturation": 0.5}
KINDS = {
    "water": {"water": {"column": [COLUMN]}},
    "two fluids": {
        "water": {"column": [COLUMN]},
        "inclusion": {"density": 500.0, "disc": [{"x": 0.25, "y": 0.2, "radius": 0.15}]},
    },
    "dry": {"soil": BLOCK},
    "suction": {"soil": BLOCK | {"suction": SUCTION}, "water": {"sound_speed": 30.0}},
    "suction beside a level": {
        "soil": BLOCK | {"suction": SUCTION}, "water": {"sound_speed": 30.0}, "tank": {"width": 0.6, "height": 0.6},
        "reservoir": [{"left": 0.5, "right": 0.6, "level": 0.2}],
    },
    "full pores": {"soil": BLOCK | {"saturated": True}},
    "water table": {"soil": BLOCK | {"water_table": 0.2}},
    "moving": {"soil": BLOCK, "reservoir": [POOL]},
    "held": {"soil": BLOCK | {"held": True}, "reservoir": [POOL]},
    "faces": {"soil": BLOCK | {"held": True, "saturated": True}, "face": FACES, "tank": {"width": 0.5, "height": 0.4}},
    "air": {"soil": BLOCK | {"held": True}, "reservoir": [POOL], "air": {}},
    "no weight": {
        "soil": BLOCK | {"held": True, "saturated": True}, "water": {"sound_speed": 10.0}, "gravity": 0.0,
    },
}  # fmt: skip
"""A scene of each kind of particles."""


def table(kind, **look):
    return {
        "tank": {"width": 0.5, "height": 0.6},
        "numerics": {"spacing": 0.05},
        "time": {"end": 0.1},
        "output": {"snapshot_interval": 0.1, "series_interval": 0.1},
    } | KINDS[kind] | ({"look": look} if look else {})  # fmt: skip


def refused(kind, **look):
    """Lines of the error."""
    with pytest.raises(InputError) as caught:
        Scene(**table(kind, **look))
    return str(caught.value).splitlines()


@pytest.mark.parametrize("kind", KINDS)
def test_all_that_snapshots_hold_can_be_shown_and_nothing_else(kind):
    model = build(Scene(**table(kind)))
    held = model.snapshot().clouds["particles"].data
    assert set(shown_arrays(model.scene)) == set(held)
    for name in held:
        Scene(**table(kind, colour=name))
    allowed = ", ".join(shown_arrays(model.scene))
    for key in ("colour", "field"):
        line = f"look.{key} = 'vorticity': is not recorded (allowed: {allowed}); choose one of these"
        assert refused(kind, **{key: "vorticity"}) == [line]


def test_other_boxes_are_named_by_their_tanks():
    looks = [look_of_scene(Scene(**table("water", **more)).to_dict(), "") for more in ({}, {"view": [0, 0.2, 0, 0.2]})]
    require_same_box([(None, it) for it in looks])
    wider = look_of_scene(Scene(**table("water") | {"tank": {"width": 1.0, "height": 0.6}}).to_dict(), "")
    with pytest.raises(InputError, match=r"against = '1 m x 0.6 m': is another box than 0.5 m x 0.6 m"):
        require_same_box([(None, looks[0]), (None, wider)])


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_shown_without_a_look_is_held_too(kind):
    scene = Scene(**table(kind))
    assert look_of_scene(scene.to_dict(), "").colour in shown_arrays(scene)


def test_a_disc_of_three_spacings_is_resolved_where_the_product_is_rounded_up():
    """3 * 0.05 is 0.15 and a rounding more."""
    assert 3 * 0.05 > 0.15
    Scene(**table("two fluids"))
    small = KINDS["two fluids"]["inclusion"] | {"disc": [{"x": 0.25, "y": 0.2, "radius": 0.1499}]}
    with pytest.raises(InputError, match="fewer than 6 particles across"):  # the check that fails
        Scene(**table("two fluids") | {"inclusion": small})


def test_arrays_of_another_kind_of_scene_are_refused():
    for kind, name in (("water", "porosity"), ("dry", "pressure"), ("moving", "stress_xx"), ("air", "head"),
                       ("suction", "layer"), ("full pores", "displacement"), ("water", "fluid")):  # fmt: skip
        assert "is not recorded" in refused(kind, colour=name)[0]


def test_two_keys_for_one_thing_are_refused():
    assert "look.field = 'pressure': is of the particles" in refused("water", field="pressure", colour="density")[0]
    both = refused("water", limits=[0.0, 1.0], colour_limits=[0.0, 2.0])
    assert both == ["look.limits = (0.0, 1.0): is of the particles, as look.colour_limits is: there are no cells; "
                    "take out one of them"]  # fmt: skip
    Scene(**table("water", field="pressure", limits=[0.0, 1.0]))  # the checks that fail: one of each is enough
    Scene(**table("water", colour="pressure", colour_limits=[0.0, 1.0]))


@pytest.mark.parametrize("kind", KINDS)
def test_limits_of_kinds_are_refused(kind):
    """Where colours are kinds, as water and soil, there is no range."""
    if look_of_scene(Scene(**table(kind)).to_dict(), "").kinds:
        for key in ("limits", "colour_limits"):
            line = refused(kind, **{key: [0.0, 1.0]})[0]
            assert line.startswith(f"look.{key} = (0.0, 1.0): has no quantity")
            assert line.endswith("add look.colour")
    else:
        Scene(**table(kind, limits=[0.0, 1.0]))
    Scene(**table(kind, limits=[0.0, 1.0], colour="velocity"))


@pytest.mark.parametrize("view", [[-0.02, 0.3, 0.0, 0.3], [0.0, 0.52, 0.0, 0.3], [0.0, 0.3, 0.0, 0.62]])
def test_a_view_beyond_the_tank_is_refused(view):
    """A picture of all of it has a margin of 0.02 times the width, 1 cm; these reach 1 cm farther."""
    assert "look.view" in refused("water", view=view)[0]
    Scene(**table("water", view=[-0.01, 0.51, -0.01, 0.61]))  # the check that fails


def test_check_and_run_refuse_it_in_one_line(tmp_path):
    (tmp_path / "scene.toml").write_text(
        'tank = {width = 0.5, height = 0.6}\nnumerics = {spacing = 0.05}\ntime = {end = 0.1}\n'
        "output = {snapshot_interval = 0.1, series_interval = 0.1}\nlook = {colour = 'spin'}\n"
        "[[water.column]]\nwidth = 0.5\nheight = 0.4\n"
    )  # fmt: skip
    for words in (["check", "scene.toml"], ["run", "scene.toml", "--out", "out"]):
        done = subprocess.run([sys.executable, "-m", "continuum_sph", *words], cwd=tmp_path, capture_output=True,
                              text=True, timeout=120)  # fmt: skip
        assert done.returncode == 2
        assert "look.colour = 'spin': is not recorded (allowed: velocity, pressure, density)" in done.stderr
        assert len(done.stderr.splitlines()) == 1
    assert not (tmp_path / "out").exists()

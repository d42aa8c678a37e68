"""Hooks, forces and measures of the user's own, in both packages: what they do, and when they are refused."""

from pathlib import Path

import numpy as np
import pytest

import continuum_sph
import porescale
from porescale.builders.parts.user_forces import UserForces
from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.core.errors import Unstable
from porescale.common.record.read_card import read_card
from tests.common.api.small import build, package_of, scene_of
from tests.fingerprints.digest import fingerprint
from tests.reference.same_run import differences
from tests.reference.scenes import COLUMN, dry, grain, refusals, table, water, write

pytestmark = [
    pytest.mark.usefixtures("without_pictures"),
    pytest.mark.filterwarnings("ignore::porescale.common.core.errors.PorescaleWarning"),
]

KINDS = ("coupled", "dry", "tank", "soil", "levee")
STRENGTH = 0.3


def pushed(scene, strength=STRENGTH, end=None):
    """A simulation whose particles are pushed to the left by a force that changes in time and place."""
    sim = build(scene)
    weight = 9.81 * sim.masses

    def push(time, positions, velocities, out):
        out[:, 0] = -strength * weight[: len(out)] * (1.0 + np.sin(2e3 * time)) * (1.0 + positions[:, 1])

    sim.force(push)

    @sim.every(seconds=0.2 * (end or scene.time.end))
    def middle(sim):
        return {"x (m)": sim.positions[:, 0].mean(), "y (m)": sim.positions[:, 1].mean()}

    return sim


@pytest.mark.parametrize("kind", KINDS)
def test_a_force_of_zero_changes_no_bit(kind):
    plain, hooked, moved = (build(scene_of(kind)) for _ in range(3))

    @hooked.force
    def nothing(time, positions, velocities, out):
        pass

    @moved.force
    def little(time, positions, velocities, out):
        out[0, 0] = 1e-3

    for sim in (plain, hooked, moved):
        sim.run(steps=30)
    assert fingerprint(plain.state()) == fingerprint(hooked.state())
    assert fingerprint(plain.state()) != fingerprint(moved.state())  # it can tell


def test_without_hooks_nothing_is_built():
    for kind in KINDS:
        sim = build(scene_of(kind))
        parts = list(sim.parts)
        assert not sim.hooks
        assert not sim.records
        assert not any("UserForces" in type(part).__name__ for part in parts)

        @sim.every(steps=10)
        def seen(sim):
            return {"a": 1.0}

        assert sim.parts == parts  # measures are no part of a step
        before = getattr(sim, "_before", None)
        assert before is None or len(before) == len(build(scene_of(kind))._before)
    sim = build(scene_of("dry"))
    assert sim._between == []
    assert sim.stepper.takes_many
    sim.force(lambda_less)
    assert isinstance(sim.parts[-1], UserForces)
    assert len(sim._between) == 1


def lambda_less(time, positions, velocities, out):
    """A force that is none."""


def test_a_force_is_newtons_in_a_dry_scene():
    grains = {"grain": [grain(0.003, 0.006), grain(0.008, 0.006)], "density": 2500}
    sim = porescale.build(dry(grains=grains, time__end=0.01))
    mass = sim.masses

    @sim.force
    def wind(time, positions, velocities, out):
        out[1, 0] = 2.0 * mass[1]

    sim.run(until=0.01)
    # Leap-frog is exact for a constant force but for the half step of the first velocity.
    assert sim.velocities[1, 0] == pytest.approx(2.0 * 0.01, rel=2.0 * sim.step_seconds / 0.01)
    assert sim.velocities[1, 1] == pytest.approx(-9.81 * 0.01, rel=2.0 * sim.step_seconds / 0.01)
    assert sim.velocities[0, 0] == 0.0


@pytest.mark.parametrize("kind", ["tank", "soil", "levee"])
def test_a_force_moves_the_middle_of_mass(kind):
    """The first step, in which walls are hardly reached by what the force starts: change of momentum is F t."""
    plain, hooked = build(scene_of(kind)), build(scene_of(kind))
    mass = hooked.masses

    @hooked.force
    def up(time, positions, velocities, out):
        out[:, 1] = 20.0 * mass

    for sim in (plain, hooked):
        sim.run(steps=1)
    gained = mass @ (hooked.velocities - plain.velocities)
    # Walls and sound carry 0, 3 and 6 % of it away within a step of a quarter of h/c, twice as much in two.
    assert gained[1] == pytest.approx(20.0 * mass.sum() * hooked.time, rel=0.1)
    assert abs(gained[0]) < 0.01 * gained[1]


def test_grains_that_are_held_stay_and_bodies_of_segments_have_none():
    still = {"x": 0.003, "y": 0.004, "diameter": 0.001}
    bar = {"corners": [[0.006, 0.004], [0.008, 0.004], [0.008, 0.005]], "thickness": 0.0002, "density": 2500}
    sim = porescale.build(dry(grains={"density": 2500}, disc=[still], polygon=[bar]))
    assert len(sim.positions) == 1

    @sim.force
    def strong(time, positions, velocities, out):
        out[:] = 1e3

    sim.run(steps=20)
    assert sim.positions.tolist() == [[0.003, 0.004]]
    x = sim.grains.discs.position[1:, 0]
    assert x.tolist() == [0.006, 0.008, 0.008]  # the polygon falls straight down
    only = porescale.build(dry(grains={"density": 2500}, polygon=[bar]))
    assert "this scene has no discs that it could act on" in refused_force(only, strong)


def test_hooks_that_are_none_are_refused():
    sim = build(scene_of("dry"))
    assert "does not take what it is given; def two(time, positions, velocities, out)" in refused_force(sim, two)
    assert "is not the name of a function" in refusals(lambda: sim.force(lambda t, x, v, out: None))[0]
    assert "needs an interval" in refusals(lambda: sim.every())[0]
    assert "has two intervals" in refusals(lambda: sim.every(1.0, steps=1))[0]
    assert "must be positive" in refusals(lambda: sim.every(-1.0))[0]
    assert "is no number of steps" in refusals(lambda: sim.every(steps=0))[0]

    def series(sim):
        return {}

    assert "would write series.csv" in refusals(lambda: sim.every(1.0)(series))[0]
    sim.force(lambda_less)

    def measure(sim):
        return {}

    measure.__name__ = "lambda_less"
    assert "is the name of another hook (force)" in refusals(lambda: sim.every(1.0)(measure))[0]
    fluid = porescale.build(water())
    assert "this scene has no discs" in refused_force(fluid, lambda_less)


def two(time, positions):
    """Takes too little."""


def refused_force(sim, function):
    return refusals(lambda: sim.force(function))[0]


def test_a_force_cannot_change_what_it_is_shown():
    sim = build(scene_of("dry"))

    @sim.force
    def wrong(time, positions, velocities, out):
        positions[0] = 0.0

    with pytest.raises(ValueError, match="read-only") as caught:
        sim.run(steps=3)
    assert "raised by the hook wrong (force) at step 0, t = 0 s" in caught.value.__notes__[0]

    @sim.force
    def wrong(time, positions, velocities, out):  # noqa: F811  (takes the other's place)
        return out + 1.0

    assert "returns something; write the force into out" in refusals(lambda: sim.run(steps=1))[0]


@pytest.mark.parametrize("kind", ["dry", "coupled", "tank"])
def test_a_force_that_is_no_number_is_named(kind):
    sim = build(scene_of(kind))

    @sim.force
    def bad(time, positions, velocities, out):
        out[2, 1] = np.nan

    with pytest.raises(Unstable, match="force bad = nan N/m at row 2; the hook bad wrote it"):
        sim.run(steps=200)


def test_rows_come_at_their_times_however_a_run_is_cut():
    whole, pieces = pushed(scene_of("dry")), pushed(scene_of("dry"))
    end = whole.scene.time.end
    whole.run()
    for share in (0.1, 0.33, 0.6, 1.0):
        pieces.run(until=share * end)
    assert list(whole.records) == ["middle"]
    assert list(whole.records["middle"]) == ["time (s)", "x (m)", "y (m)"]
    rows = whole.records["middle"]["time (s)"]
    assert rows == pytest.approx(np.arange(6) * 0.2 * end, abs=0.51 * whole.step_seconds)
    for name, values in whole.records["middle"].items():
        assert (values == pieces.records["middle"][name]).all()

    calls = []

    @pieces.every(steps=7)
    def counted(sim):
        calls.append(sim.step)

    first = pieces.step
    pieces.run(steps=20)
    events = [step for step in range(first + 1, first + 21) if step % 7 == 0]
    assert calls == [*events, *([first + 20] if (first + 20) % 7 else [])]


def test_what_is_measured_is_numbers_in_the_same_columns():
    sim = build(scene_of("dry"))

    @sim.every(steps=1)
    def other(sim):
        return {f"{sim.step}": 1.0}

    assert "gave other columns than before: 0, 1" in refusals(lambda: sim.run(steps=2))[0]

    @sim.every(steps=1)
    def other(sim):  # noqa: F811
        return {"x": sim.positions} if sim.step else {"x": 10**400}

    assert "column 'x' is no number" in refusals(lambda: sim.run(steps=2))[0]

    @sim.every(steps=1)
    def other(sim):  # noqa: F811
        sim.advance(1)

    assert "did steps of the simulation" in refusals(lambda: sim.run(steps=2))[0]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("threads", [1, 2])
def test_a_resumed_run_with_hooks_is_the_uninterrupted_one(kind, threads, tmp_path):
    scene, package = scene_of(kind, **({"time__end": 0.02} if kind == "levee" else {})), package_of(kind)
    first = scene.model_copy(update={"time": scene.time.model_copy(update={"end": 0.47 * scene.time.end})})
    package.set_threads(min(threads, 2))
    try:
        package.run(pushed(first, end=scene.time.end), tmp_path / "pieces", progress=False)
        package.run(pushed(scene), tmp_path / "pieces", resume=True, progress=False)
        whole = package.run(pushed(scene), tmp_path / "whole", progress=False)
    finally:
        package.set_threads(1)
    assert (tmp_path / "whole" / "middle.csv").read_text().startswith("time (s),x (m),y (m)\n0.0,")
    assert len((tmp_path / "whole" / "middle.csv").read_text().splitlines()) == 7
    assert not differences(tmp_path / "pieces", whole.folder)
    other = package.run(pushed(scene, strength=0.31), tmp_path / "other", progress=False)
    assert differences(other.folder, whole.folder)  # it can tell


def test_a_card_names_its_hooks_and_other_ones_are_refused(tmp_path):
    scene = write(tmp_path / "scene.toml", table(COLUMN, fluid=None, gate=None, grains__packing__settle=False,
                                                 grains__hydraulic_radius_ratio=None, time__end=0.001))  # fmt: skip
    load = porescale.load
    out = tmp_path / "run"
    porescale.run(pushed(load(scene)), out, progress=False)
    hooks = read_card(out)["hooks"]
    assert list(hooks) == ["push", "middle"]
    assert hooks["push"]["kind"] == "force"
    assert hooks["push"]["source"].startswith("def push(time, positions, velocities, out):\n    out[:, 0] = -strength")
    assert hooks["push"]["interval"] is None
    assert hooks["middle"]["interval"] == "0.0002 s"
    assert hooks["middle"]["source"].startswith("def middle(sim):")

    def resumed(sim):
        return refusals(lambda: porescale.run(sim, out, resume=True, progress=False))

    before = (out / "card.json").read_bytes()
    assert resumed(pushed(load(scene), strength=0.2)) == [
        "hook push: a value or function that it uses is not the one with which the run was begun; "
        "take it from card.json, or start another run"
    ]
    missing = resumed(load(scene))
    assert missing == [f"hook {name}: the run was begun with this hook; resume it from Python with the hook"
                       for name in ("push", "middle")]  # fmt: skip
    extra = pushed(load(scene))
    extra.force(lambda_less)
    assert resumed(extra) == [
        "hook lambda_less: the run was begun without this hook; leave it out, or start another run"
    ]
    changed = pushed(load(scene))

    @changed.force
    def push(time, positions, velocities, out):
        out[:, 0] = 1e-9

    assert resumed(changed)[0].startswith("hook push: its source is not that with which the run was begun")
    assert main(commands(), ["run", str(scene), "--out", str(out), "--resume", "--quiet"]) == 2
    assert (out / "card.json").read_bytes() == before
    assert resumed_fine(load(scene), out)


def resumed_fine(scene, out):
    return porescale.run(pushed(scene), out, resume=True, progress=False)


def test_another_interval_is_no_other_hook(tmp_path):
    scene = scene_of("tank")
    first = scene.model_copy(update={"time": scene.time.model_copy(update={"end": 0.5 * scene.time.end})})

    def measured(scene, seconds):
        sim = continuum_sph.build(scene)

        @sim.every(seconds=seconds)
        def top(sim):
            return {"y (m)": sim.positions[:, 1].max()}

        return sim

    continuum_sph.run(measured(first, 0.005), tmp_path / "run", progress=False)
    run = continuum_sph.run(measured(scene, 0.002), tmp_path / "run", resume=True, progress=False)
    assert run.card["hooks"]["top"]["interval"] == "0.002 s"


@pytest.mark.parametrize("kind", ["dry", "tank"])
def test_a_hook_that_raises_leaves_a_run_that_goes_on(kind, tmp_path):
    scene, package = scene_of(kind, output__checkpoint_seconds=1e-3), package_of(kind)
    broken = str(tmp_path / "broken")  # the same hook finds another world
    end = scene.time.end

    def with_pump():
        sim = package.build(scene)

        @sim.force
        def pump(time, positions, velocities, out):
            if time > 0.5 * end and Path(broken).exists():
                raise ValueError("the pump broke")
            out[:, 0] = 1e-3

        @sim.every(seconds=0.1 * end)
        def middle(sim):
            return {"x (m)": sim.positions[:, 0].mean()}

        return sim

    Path(broken).touch()
    with pytest.raises(ValueError, match="the pump broke") as caught:
        package.run(with_pump(), tmp_path / "run", progress=False)
    assert "raised by the hook pump (force) at step" in caught.value.__notes__[0]
    assert "last good state: " in caught.value.__notes__[1]
    card = read_card(tmp_path / "run")
    assert card["outcome"] == "failed"
    assert "the pump broke; raised by the hook pump (force) at step" in card["problem"]
    Path(broken).unlink()
    run = package.run(with_pump(), tmp_path / "run", resume=True, progress=False)
    assert run.card["outcome"] == "finished"
    assert run.card["resumed"]
    assert not differences(package.run(with_pump(), tmp_path / "whole", progress=False).folder, run.folder)


def test_a_measure_that_raises_is_named(tmp_path):
    sim = build(scene_of("dry"))

    @sim.every(steps=5)
    def late(sim):
        if sim.step == 10:
            raise RuntimeError("no more paper")

    with pytest.raises(RuntimeError, match="no more paper") as caught:
        porescale.run(sim, tmp_path / "run", progress=False)
    assert "raised by the hook late (every) at step 10" in caught.value.__notes__[0]

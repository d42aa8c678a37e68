"""What a collapse is measured by: front, run-out, surface, energies, against what can be counted by hand."""

import itertools
import json
import math
from types import SimpleNamespace

import numpy as np
import pytest

from porescale import program
from porescale.builders import cost
from porescale.builders.build import build
from porescale.builders.checks.regime import terminal_speed
from porescale.builders.derive import derive
from porescale.builders.parts.flow_fields import fluid_row
from porescale.common.compiled import turns as turns_module
from porescale.common.compiled.turns import Turns
from porescale.lbm.scales import Scales
from porescale.output.surface import surface
from tests.reference.scenes import column, dry, grain, water


def hand(*grains):
    return build(dry(grains={"density": 2500, "grain": list(grains)}, gravity=[0.0, 0.0]))


def test_the_front_is_the_foremost_edge_on_the_side_where_there_is_room():
    left = hand(grain(0.002, 0.004), grain(0.005, 0.004, 0.002))
    assert left.series()["front (m)"] == 0.005 + 0.001
    right = hand(grain(0.010, 0.004), grain(0.007, 0.004, 0.002))
    assert right.series()["front (m)"] == 0.007 - 0.001


@pytest.mark.parametrize(("x", "speed"), [(0.004, 0.1), (0.008, -0.1)])
def test_run_out_is_how_far_the_front_has_come(x, speed):
    simulation = hand(grain(x, 0.004, velocity=[speed, 0.0]))
    assert simulation.series()["run-out (m)"] == 0.0
    steps = 20
    simulation.advance(steps)
    # Free flight; the rounding of `steps` additions to a position of centimetres.
    assert simulation.series()["run-out (m)"] == pytest.approx(0.1 * simulation.time, rel=1e-12)
    other = hand(grain(x, 0.004, velocity=[-speed, 0.0]))  # the twin: away from the free side it is negative
    other.advance(steps)
    assert other.series()["run-out (m)"] < 0


def test_a_row_counts_energy_mass_and_height():
    simulation = hand(grain(0.002, 0.004, velocity=[3.0, 4.0]), grain(0.009, 0.002, 0.002))
    row = simulation.series()
    mass = 2500 * math.pi / 4 * 0.001**2
    # Density times area, and a square and a half: a handful of roundings.
    assert row["kinetic energy of grains (J/m)"] == pytest.approx(0.5 * mass * 25, rel=1e-14)
    assert row["largest grain speed (m/s)"] == 5.0
    assert row["highest grain (m)"] == 0.004 + 0.0005
    assert row["centre of mass x (m)"] == pytest.approx((0.002 + 4 * 0.009) / 5, rel=1e-14)
    assert row["largest overlap over diameter ()"] == 0.0


def test_the_overlap_is_over_the_diameter():
    # Two equal discs whose centres are 0.9995 diameters apart overlap by 0.0005 of it.
    row = hand(grain(0.004, 0.004), grain(0.0049995, 0.004)).series()
    assert row["largest overlap over diameter ()"] == pytest.approx(0.0005, rel=1e-9)  # 1e-16/5e-7 lost in x1 - x2
    assert row["coordination number ()"] == 1.0


def dense_surface(position, radius, edges, samples=20001):
    """The slow twin: the highest disc over many points of every bin."""
    height = []
    for low, high in itertools.pairwise(edges):
        x = np.linspace(low, high, samples)[:, None]
        under = np.maximum(radius**2 - (x - position[:, 0]) ** 2, 0.0)
        top = np.where(np.abs(x - position[:, 0]) <= radius, position[:, 1] + np.sqrt(under), 0.0)
        height.append(float(top.max()))
    return np.array(height)


def test_the_surface_is_that_of_the_discs():
    random = np.random.default_rng(3)
    position, radius = random.uniform(0.1, 0.9, (40, 2)), random.uniform(0.02, 0.06, 40)
    edges = np.linspace(0.0, 1.0, 12)
    found = surface(position, radius, edges)
    # The twin misses a top within a bin by less than spacing^2/(8 r) = (1/11/2e4)^2/0.16, and where a disc only
    # reaches in its edge is as steep as sqrt(2 r dx): 1e-3 at a spacing of 4.5e-6.
    assert found == pytest.approx(dense_surface(position, radius, edges), abs=1e-3)
    assert surface(position[:0], radius[:0], edges).tolist() == [0.0] * 11
    assert found.max() == pytest.approx((position[:, 1] + radius).max(), rel=1e-15)


def test_the_fluid_row_weighs_what_is_not_solid():
    ux, uy, excess, solid = (np.zeros((2, 3)) for _ in range(4))
    ux[0, 0], uy[1, 2], solid[1, 2], excess[0, 0] = 3.0, 4.0, 0.75, 10.0
    scales = Scales(0.1, 0.01, 0.8)
    row = fluid_row(excess, ux, uy, solid, scales)
    assert row["kinetic energy of fluid (J/m)"] == pytest.approx(0.5 * (1010 * 9 + 1000 * 16 / 4) * 0.01, rel=1e-14)
    assert row["largest fluid speed (m/s)"] == 4.0
    assert row["Mach number ()"] == pytest.approx(4.0 / (10 / math.sqrt(3)), rel=1e-14)
    assert row["highest relative density ()"] == 1.01


def test_the_pressure_on_record_is_hydrostatic_at_rest():
    simulation = build(water(fluid__body_force=[0.0, 0.0]))
    simulation.advance(4)
    pressure = simulation.snapshot().grids["fields"].cells["pressure"]
    depth = (40 - 0.5 - np.arange(40)) * 0.0002
    # Stored in single precision: 6e-8 of 80 Pa.
    assert pressure == pytest.approx(np.repeat(1000 * 9.81 * depth[:, None], 60, axis=1), rel=1e-6)


@pytest.mark.parametrize("reynolds", [1e-3, 1e-2])
def test_slow_discs_fall_as_lamb_says(reynolds):
    # Lamb 1911: drag per length 4 pi mu U/(1/2 - 0.5772 - ln(Re/8)); what else is in the estimate, 1.2 rho d U^2/2,
    # is 1.2 Re/(8 pi/...) of it: 1.5e-4 of the drag at Re 1e-3, 1e-3 at 1e-2, times what the logarithm gives back.
    d, nu = 0.001, 1e-3
    speed = reynolds * nu / d
    log = 0.5 - 0.5772 - math.log(reynolds / 8)
    driving = 4 * math.pi * nu * speed / log / (math.pi / 4 * d**2)
    assert terminal_speed(d, driving, nu) == pytest.approx(speed, rel=1.2 * reynolds * log / (4 * math.pi))


def test_the_estimate_of_the_settling_disc_is_an_estimate_from_above():
    # 5.55 cm/s in a box four times as wide as the disc is wide of the unbounded estimate, on the safe side.
    assert 0.0555 < terminal_speed(0.0025, 0.25 * 9.81, 1e-5) < 2 * 0.0555


def test_memory_is_what_the_arrays_take():
    simulation = build(column(grains__packing__settle=False))
    taken = simulation.fluid.populations.nbytes
    assert taken == 9 * 8 * 62 * 42
    assert taken < cost.memory(derive(column())) < 3 * taken


def test_the_cost_learns_from_a_run(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    derived = derive(column())
    guess, measured = cost.expected_seconds(derived, 1000)
    assert not measured
    cost.remember(derived, 0.0)  # a run that took no step teaches nothing
    assert cost.expected_seconds(derived, 1000) == (guess, False)
    cost.remember(derived, 500.0)
    seconds, measured = cost.expected_seconds(derived, 1000)
    assert measured
    assert seconds == pytest.approx(2.0, rel=1e-12)
    (tmp_path / "porescale" / "rate.json").write_text("nonsense")
    assert cost.expected_seconds(derived, 1000) == (guess, False)


def test_one_kind_of_scene_learns_nothing_from_another_and_one_slow_run_has_no_say(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    wet, single = derive(column()), derive(column(fluid__precision="float32"))
    for rate in (500.0, 5.0, 500.0):  # a run of three shared the machine
        cost.remember(wet, rate)
    assert cost.expected_seconds(wet, 1000)[0] == pytest.approx(2.0, rel=1e-12)
    for other in (derive(dry()), single, derive(column(fluid__spacing=0.00002, fluid__step=4e-6))):
        assert not cost.expected_seconds(other, 1000)[1]


def test_single_precision_takes_half_of_the_populations(monkeypatch):
    double, single = (cost.memory(derive(column(fluid__precision=it))) for it in ("float64", "float32"))
    assert double - single == 4 * (9 * 64 * 42 + 3 * 60 * 40)  # padded rows; three of the solid in a cell


def test_a_small_run_does_not_make_the_machine_look_slow(tmp_path, monkeypatch):
    # On the machine where the rates were measured the small column did 15 900 steps/s.  What a large scene is then
    # expected to take changes by less than a factor of two; reckoned by cells and grains alone it would be three.
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    large, small = derive(column(fluid__spacing=0.00002, fluid__step=4e-6)), derive(column())
    before, _ = cost.expected_seconds(large, 1000)
    cost.remember(small, 15900.0)
    assert 0.5 < cost.expected_seconds(large, 1000)[0] / before < 2


def test_a_rate_that_cannot_be_noted_fails_no_run(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    derived = derive(column())
    cost.remember(derived, 500.0)
    assert not cost.expected_seconds(derived, 1000)[1]


def test_check_expects_the_whole_command(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(cost, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(cost, "TURNS", turns := Turns())
    derived, snapshots = derive(column()), 11
    guess = cost.expected(derived, 1000, snapshots)
    assert (guess.compiling, guess.measured) == (cost.KERNELS, False)
    turns.kept, turns.seconds = ["cover-1", "sweep-2", "sweep-2"], 30.0
    for name in turns.kept:
        (tmp_path / f"{name}.nbc").touch()
    taken = {cost.BUILDING: 4.0, cost.RECORDING: 5.0, cost.FINISHING: 6.0}
    for rate in (500.0, 500.0, 5.0):  # the last one shared the machine
        cost.remember(derived, rate)
        cost.remember_run(derived, snapshots, taken if rate > 5.0 else dict.fromkeys(taken, 1e3))
    known = cost.expected(derived, 1000, snapshots)
    assert known.measured
    # Two seconds of steps, what the parts took, and the start; all kernels are kept.
    assert known.total == pytest.approx(cost.START + 2.0 + 4.0 + 5.0 + 6.0, rel=1e-12)
    # Half of the kernels are gone, as after an edit.
    (tmp_path / "sweep-2.nbc").unlink()
    assert cost.expected(derived, 1000, snapshots).compiling == pytest.approx(15.0)
    # The check that must fail: three times the snapshots, so more of what each takes, but not three times that.
    more = cost.expected(derived, 1000, 3 * snapshots)
    assert known.finishing < more.finishing < 3 * known.finishing
    assert more.building == known.building


def test_few_kernels_that_changed_do_not_stand_for_all(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(cost, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(cost, "TURNS", turns := Turns())
    derived, taken = derive(column()), {cost.BUILDING: 1.0, cost.RECORDING: 1.0, cost.FINISHING: 1.0}
    for kept, seconds in ((["a", "b", "c"], 30.0), (["b"], 9.0), ([], 0.0)):
        turns.kept, turns.seconds = kept, seconds
        cost.remember_run(derived, 11, taken)
    assert cost.expected(derived, 1000, 11).compiling == pytest.approx(30.0)  # none of the three is on disk


@pytest.mark.parametrize("compiles", [True, False])
def test_a_second_run_in_a_process_notes_what_it_compiled_itself(tmp_path, monkeypatch, compiles):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(cost, "cache_folder", lambda: tmp_path)
    mine = Turns(kept=["a", "b"], seconds=30.0)  # those of a first run
    for module in (cost, turns_module):
        monkeypatch.setattr(module, "TURNS", mine)
    done = SimpleNamespace(steps_per_second=1.0, recording=1.0, finishing=1.0)

    def driven(*_, **more):
        if compiles:
            mine.kept.append("c")
            mine.seconds += 7.0
        return done

    monkeypatch.setattr("porescale.common.api.run_scene.drive_scene", driven)
    scene = dry(grains={"density": 2500, "grain": [grain(0.004, 0.004)]})
    model = program.build(scene)
    program.drive(model, tmp_path / "run", scene, card={}, resume=False, quiet=True)
    known = cost._besides()[cost._kind(model.derived)]
    assert known.get("kernels") == (["c"] if compiles else None)
    assert known.get(cost.COMPILING) == ([7.0] if compiles else None)


def test_a_spoiled_note_of_a_run_is_a_guess(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    derived = derive(column())
    guess = cost.expected(derived, 1000, 11)
    kind = cost._kind(derived)
    for table in ([], {kind: 3}, {kind: {"building": ["x"], "compiling": [-1.0], "kernels": 5}}):
        file = tmp_path / "porescale" / "rate.json"
        file.parent.mkdir(exist_ok=True)
        file.write_text(json.dumps({"slowness": {}, "besides": table}))
        assert cost.expected(derived, 1000, 11) == guess

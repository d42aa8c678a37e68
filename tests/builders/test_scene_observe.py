"""What a collapse is measured by: front, run-out, surface, energies, against what can be counted by hand."""

import itertools
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
from porescale.common.duration.expected import BUILDING, FINISHING, RECORDING, STEPS, expected
from porescale.common.duration.quiet import Moment
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
    assert taken < cost.memory(column(), derive(column())) < 3 * taken


def test_scenes_cost_alike_whose_kind_is_the_same():
    kind = kind_of(column())
    assert kind == kind_of(column(grains__packing__seed=2, time__end=0.5))
    others = dry(), column(fluid__precision="float32"), column(fluid__spacing=0.00002, fluid__step=4e-6)
    assert len({kind, *map(kind_of, others)}) == 4


def kind_of(scene):
    return cost.work(scene, derive(scene)).kind


def test_single_precision_takes_half_of_the_populations(monkeypatch):
    double, single = (
        cost.memory(it, derive(it)) for it in (column(fluid__precision=name) for name in ("float64", "float32"))
    )
    assert double - single == 4 * (9 * 64 * 42 + 3 * 60 * 40)  # padded rows; three of the solid in a cell


def test_a_small_run_does_not_make_the_machine_look_slow():
    # On a machine where plain fluid does 150e6 cells/s the small column did 15 900 steps/s.  Nominal rates give the
    # same within a factor of two; were all of a step calls, as in this small one, a large one would be far off.
    small, large = (derive(it) for it in (column(), column(fluid__spacing=0.00002, fluid__step=4e-6)))
    assert 0.5 < 15900.0 * cost.step_seconds(small) < 2.0
    assert cost.step_seconds(large) > 10.0 * cost.step_seconds(small)


def test_a_step_takes_less_on_more_threads_and_its_calls_do_not():
    """Of a step, all but its calls is shared; half of the bytes take half of the time."""
    large = derive(column(fluid__spacing=0.00002, fluid__step=4e-6))
    one, two = (cost.step_seconds(large, threads) - cost.COUPLED_CALLS for threads in (1, 2))
    assert one == pytest.approx(2.0 * two, rel=1e-12)
    single = derive(column(fluid__spacing=0.00002, fluid__step=4e-6, fluid__precision="float32"))
    nx, ny = large.cells
    saved = cost.step_seconds(large) - cost.step_seconds(single)
    assert saved == pytest.approx(0.5 * nx * ny / cost.COUPLED_CELLS_PER_SECOND, rel=1e-9)


def test_rows_take_their_time_when_a_run_records():
    few, many = (column(time__end=1.0, output__series_interval=it) for it in (0.1, 0.01))
    few, many = (cost.work(it, derive(it)).seconds[RECORDING] for it in (few, many))
    assert many - few == pytest.approx(90 * cost.ROW, rel=1e-9)  # 101 and 11 rows


def test_what_is_no_step_grows_with_snapshots_but_not_as_fast():
    few, many = (column(time__end=1.0, output__snapshot_interval=it) for it in (0.1, 0.1 / 3.0))
    few, many = (cost.work(it, derive(it)).seconds for it in (few, many))
    assert few[FINISHING] < many[FINISHING] < 3.0 * few[FINISHING]
    assert many[BUILDING] == few[BUILDING]
    assert many[STEPS] == few[STEPS]


@pytest.mark.parametrize("resumed", [False, True])
def test_a_whole_run_is_remembered_and_one_that_was_resumed_is_not(tmp_path, monkeypatch, resumed):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    scene = dry(grains={"density": 2500, "grain": [grain(0.004, 0.004)]})
    model = program.build(scene)
    model.building = Moment(0.0, 1.0, 0.0), Moment(5.0, 6.0, 0.0)
    took = {STEPS: 1.0, RECORDING: 1.0, FINISHING: 1.0}
    monkeypatch.setattr("porescale.common.record.drive.drive", lambda *_, **__: SimpleNamespace(phases=took))
    program.drive(model, tmp_path / "run", scene, card={}, resume=resumed, quiet=True)
    told = expected(cost.work(scene, model.derived))
    assert told.measured is not resumed
    if not resumed:
        took[BUILDING] = 5.0
        assert {phase: told.seconds[phase] for phase in took} == pytest.approx(took, rel=1e-12)


def test_numbers_of_coarse_grained_fields_at_a_point_are_those_in_a_snapshot():
    every = {"spacing": 5e-4, "fields": list(cost.COLUMNS)}
    for section in ({"spacing": 5e-4}, every):
        scene = column(grains__packing__settle=False, coarse_graining=section)
        cells = build(scene).snapshot().grids["grain_fields"].cells
        points = next(iter(cells.values())).shape[:2]
        assert cost.columns(scene) == sum(value.size for value in cells.values()) / (points[0] * points[1])

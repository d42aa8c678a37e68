"""The model of a tank: restored bit for bit, the same at any number of threads, honest about what it cannot do."""

import numpy as np
import pytest

from continuum_sph.builders.report import report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.water import setups as trials
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.leapfrog import Pressing, pressurise
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import RATIO
from continuum_sph.water.state import RHO, VOLUME
from porescale.common.compiled.jit import set_threads
from porescale.common.core.errors import InputError, Unstable
from porescale.common.record.checkpoint import read_checkpoint, write_checkpoint
from porescale.common.record.model import Model
from porescale.common.schema.sections import validate
from tests.reference.continuum.uncompiled import WATER, uncompile
from tests.reference.memory import growth


def scene(**numerics):
    return trials.column_scene(0.1, tank=(2.0, 1.5), column=(0.5, 1.0), pressure="released", **numerics)


def bits(model):
    layer = model.flow.layer
    return [layer.x.tobytes(), layer.v.tobytes(), layer.density.tobytes(), layer.length.tobytes(), model.time]


def test_is_a_model():
    model = Simulation(scene())
    assert isinstance(model, Model)
    assert model.variable_step
    row, shot = model.series(), model.snapshot()
    assert row["mass (kg/m)"] == pytest.approx(500.0, rel=0.01)  # 0.5 m² of water, compressed by less than 1 %
    assert len(shot.clouds["particles"].position) == 50


PAPER = {"kernel": "cubic", "smoothing_ratio": 1.2, "smoothing_length": "evolved", "density_filter": 30, "xsph": 0.3}
MODERN = {"gradient": "corrected", "shifting": 1.0, "diffusion_of": "linear", "xsph": 0.2}


@pytest.mark.parametrize("numerics", [{}, PAPER, MODERN])
def test_restored_model_goes_on_bit_for_bit(tmp_path, numerics):
    straight = Simulation(scene(**numerics))
    straight.advance(150)
    write_checkpoint(tmp_path / "c.h5", straight.state())
    straight.advance(250)
    resumed = Simulation(scene(**numerics))
    resumed.restore(read_checkpoint(tmp_path / "c.h5"))
    resumed.advance(250)
    assert bits(straight) == bits(resumed)
    assert straight.flow.pairs.builds > 2  # the list was rebuilt on the way


def test_looking_changes_nothing():
    quiet, watched = Simulation(scene()), Simulation(scene())
    quiet.advance(60)
    for _ in range(60):
        watched.advance(1)
        watched.check(), watched.series(), watched.snapshot(), watched.state()
    assert bits(quiet) == bits(watched)


def test_one_thread_and_many_give_the_same_bits():
    found = []
    for count in (1, 2):
        set_threads(count)
        model = Simulation(scene())
        model.advance(120)
        found.append(bits(model))
    assert found[0] == found[1]


def crowd():
    """1250 particles of water: the smallest array, one number each, is 10 kB."""
    table = trials.column_scene(0.02, tank=(2.0, 1.5), column=(0.5, 1.0), pressure="released")
    return Simulation(table).flow


def test_no_array_is_allocated_in_a_step_between_rebuilds():
    flow = crowd()
    builds = flow.pairs.builds
    # What Python itself needs for its calls stays below 4 kB.
    assert growth(flow.advance, steps=10) < 4096
    assert flow.pairs.builds == builds  # a rebuild may make room for more pairs


def test_an_array_in_a_step_would_be_noticed():  # the twin that must fail
    flow = crowd()

    def step_and_copy():
        flow.advance()
        flow.layer.density.copy()

    assert growth(step_and_copy, steps=10) > 8192


def test_water_faster_than_sound_is_unstable_and_named():
    model = Simulation(scene())
    model.check()
    model.flow.layer.v[7, 0] = 2.0 * model.flow.law.state.sound_speed
    with pytest.raises(Unstable, match="particle 7"):
        model.check()
    model.flow.layer.v[7, 0] = np.nan
    with pytest.raises(Unstable, match="particle 7"):
        model.check()
    with pytest.raises(Unstable, match="position"):
        model.advance(5)


def test_the_limiting_rule_is_recorded():
    model = Simulation(scene())
    model.advance(10)
    assert model.flow.limited == [10, 0, 0, 0]
    thick = Simulation(trials.column_scene(0.1, tank=(1, 1), column=(0.5, 0.5), viscosity=3e5))
    thick.advance(2)
    assert thick.flow.limited == [0, 0, 2, 0]
    h, law = thick.flow.law.smoothing.length, thick.flow.law
    assert thick.step_seconds == pytest.approx(0.125 * h * h * 1000.0 / 3e5)
    assert law.limits(1e9, 1.0)[1] == pytest.approx(0.25 * (h / 1e9) ** 0.5)


def test_soft_water_is_refused_and_springy_water_warned_of():
    table = scene().model_dump()
    assert not report(scene()).warnings

    def with_sound(speed):
        return type(scene()).model_validate({**table, "water": {**table["water"], "sound_speed": speed}})

    assert "Mach" in report(with_sound(30.0)).warnings[0]
    with pytest.raises(InputError, match=r"water\.sound_speed"):
        report(with_sound(5.0))


@pytest.mark.parametrize(
    ("column", "tank", "pressure", "named"),
    [
        ((3.0, 1.0), (2.0, 1.5), "hydrostatic", "beyond the tank"),
        ((0.5, 2.0), (2.0, 1.5), "hydrostatic", "beyond the tank"),
        ((0.2, 1.0), (2.0, 1.5), "hydrostatic", "fewer than 4 particles"),
    ],
)
def test_water_that_does_not_fit_is_refused(column, tank, pressure, named):
    with pytest.raises(InputError, match=named):
        trials.column_scene(0.1, tank=tank, column=column, pressure=pressure)


@pytest.mark.parametrize(
    ("column", "tank", "named"),
    [
        ((0.5, 1.0), (2.04, 1.5), r"tank\.width.*20\.4 spacings.*; 2 m would be$"),
        ((0.5, 1.0), (2.0, 1.46), r"tank\.height.*14\.6 spacings"),
        ((0.54, 1.0), (2.0, 1.5), r"water\.column\[0\]\.width.*5\.4 spacings"),
    ],
)
def test_lengths_that_are_not_whole_spacings_are_refused_with_the_nearest_that_are(column, tank, named):
    with pytest.raises(InputError, match=named):
        trials.column_scene(0.1, tank=tank, column=column)


def test_a_column_of_just_four_spacings_is_taken_whatever_rounds():
    height = 0.7 - 0.5  # 0.2 less 4e-17: it was refused for a spacing that had to be <= 0.05 m, with 0.05 m
    assert height < 4.0 * 0.05
    assert trials.column_scene(0.05, tank=(1.0, 1.0), column=(0.5, height)).water.column[0].height == height
    with pytest.raises(InputError, match="fewer than 4 particles across"):
        trials.column_scene(0.05, tank=(1.0, 1.0), column=(0.5, 0.15))


def test_walls_and_stops_stand_at_the_same_place_when_a_width_is_whole_but_for_round_off():
    # 0.9e-6 of a length is within what counts as whole: walls and stops go to the whole number together.
    flow = Simulation(trials.column_scene(0.1, tank=(2.0 * (1 + 0.9e-6), 1.5), column=(0.5, 1.0))).flow
    walls = flow.layer.x[flow.layer.fluid :]
    first = walls[(walls[:, 0] > 1.9) & (walls[:, 1] > 0.0) & (walls[:, 1] < 1.5), 0].min()
    assert first - 0.5 * 0.1 == pytest.approx(flow.upper[0], rel=1e-14)
    assert flow.upper[0] == pytest.approx(2.0, rel=1e-14)


EXTREMES = {
    "gravity": (0.0, 1e-300, 1e-6, 1e6, 1e300),
    "water.density": (1e-300, 1e-2, 1e5, 1e300),
    "water.viscosity": (0.0, 1e-300, 1e9, 1e300),
    "water.sound_speed": (1e-300, 1e-3, 1e6, 1e300),
    "water.exponent": (1.5, 20.0, 1e300),
    "tank.width": (1e-300, 1e-6, 1e5, 1e300),
    "numerics.spacing": (1e-300, 1e-6, 1e3, 1e300),
    "numerics.courant": (1e-300, 1e-3),
    "numerics.softening": (1e-300, 1e-6),
    "time.end": (1e-300, 1e-9, 1e9, 1e300),
}


@pytest.mark.parametrize(("key", "value"), [(key, value) for key, values in EXTREMES.items() for value in values])
def test_extreme_numbers_are_reported_or_refused_in_one_line(key, value):
    table = scene().model_dump()
    home = table
    *path, name = key.split(".")
    for part in path:
        home = home[part]
    home[name] = value
    faults, numbers = [], []
    try:
        made = report(validate(type(scene()), table))
        numbers = [row.value for rows in made.groups.values() for row in rows if isinstance(row.value, float)]
    except InputError as error:
        faults = error.faults
    assert faults or numbers
    assert all("\n" not in fault.line() for fault in faults)
    assert not np.isnan(numbers).any()  # a step that nothing limits is infinite


def test_walls_surround_the_tank_and_leave_it_empty():
    walls = tank_walls(1.0, 0.5, 0.1, 3, lid=True)
    assert len(walls) == 16 * 11 - 10 * 5
    inside = (walls > 0.0).all(axis=1) & (walls[:, 0] < 1.0) & (walls[:, 1] < 0.5)
    assert not inside.any()
    assert len(tank_walls(1.0, 0.5, 0.1, 3, sides=False)) == 30  # a floor alone


def test_a_particle_that_reaches_a_wall_is_stopped_there():
    model = Simulation(scene())
    model.flow.layer.x[0] = [0.01, 0.5]
    model.flow.layer.v[0] = [-100.0, 0.0]
    model.flow.layer.acceleration[0] = 0.0
    before = model.flow.stopped
    model.advance(1)
    assert model.flow.stopped > before
    assert model.flow.layer.x[0, 0] == 0.0


def test_pass_over_pairs_as_plain_python(monkeypatch):
    # Compiled kernels do not check bounds; plain Python does.  prange is range there.
    def made():
        table = trials.column_scene(0.1, tank=(0.5, 0.5), column=(0.4, 0.4), **MODERN).model_dump()
        return Simulation(validate(type(scene()), table))

    compiled, plain = made(), made()
    uncompile(monkeypatch, *WATER)
    plain.advance(2)
    monkeypatch.undo()
    compiled.advance(2)
    for name in ("x", "v", "density"):
        # the same sums; compiled code may contract or reorder nothing, so only libm's last digit differs
        np.testing.assert_allclose(
            getattr(plain.flow.layer, name), getattr(compiled.flow.layer, name), rtol=1e-11, atol=1e-13
        )


def test_a_density_extrapolated_below_zero_stops_at_the_least():
    # 800 kg/m³ and a rate that has doubled to -7e6 kg/(m³ s): three times that in a step of 5e-5 s lies below zero.
    fluid = Fluid(Tait(1000.0, 44.0))
    rho = np.array([1000.0, 800.0 - 3.0 * 7e6 * 5e-5])
    pressure, record, places = np.zeros(2), np.zeros((2, 8)), np.zeros((2, 2))
    to = Pressing(
        number=0, viscosity=0.0, material=None, properties=None, lengths=None, mass=np.full(2, 0.1),
        length=np.full(2, 0.013), pressure=pressure, record=record, cut=False,
    )  # fmt: skip
    fastest = pressurise.py_func(places, places, rho, to, fluid.state.numbers)
    assert record[1, RHO] == 800.0
    assert record[1, VOLUME] == 0.1 / 800.0
    assert pressure[1] == pytest.approx(float(fluid.state.pressure(np.array(800.0))), rel=1e-14)
    assert fastest == pytest.approx((44.0 / 0.013) ** 2, rel=1e-14)
    assert 0.1 / rho[1] < 0.0  # the twin that must fail: a volume of less than nothing


def test_a_flow_without_a_next_step_names_particle_and_rule():
    flow = Simulation(scene()).flow
    flow.layer.acceleration[7] = np.inf, 0.0
    with pytest.raises(Unstable, match=r"next step = 0 s at particle 7 at .* limited by acceleration; .* inf m/s²"):
        flow.finish(0.0)
    flow.layer.acceleration[7] = 0.0
    flow.finish(0.0)
    flow.sound_rate = np.inf
    flow.layer.density[5] = 1e6
    with pytest.raises(Unstable, match=r"particle 5 .* limited by sound; .* 1e\+06 kg/m³"):
        flow.finish(0.0)


def test_a_flow_whose_step_falls_to_nothing_is_unstable():
    # Acceleration allows 0.25 √(h/|a|), sound 0.25 h/c: with |a| = c²/h as much, with 1e8 times that a ten thousandth.
    flow = Simulation(scene()).flow
    alike = flow.law.quickest**2 / flow.law.smoothing.length
    flow.layer.acceleration[7] = 0.9e8 * alike, 0.0
    flow.finish(0.0)
    flow.layer.acceleration[7] = 1.1e8 * alike, 0.0
    with pytest.raises(Unstable, match="limited by acceleration"):
        flow.finish(0.0)


def test_rows_that_no_disk_holds_are_refused() -> None:
    table = scene().model_dump(mode="json", by_alias=True, exclude_none=True)
    table["time"]["end"], table["output"]["snapshot_interval"] = 1e6, 1e-9
    with pytest.raises(InputError, match=r"output\.snapshot_interval = 1e-09 s: makes \S+ snapshots, about \S+ GiB"):
        report(validate(type(scene()), table))


def test_a_scene_that_names_no_smoothing_length_has_that_of_the_validations():
    assert scene().numerics.smoothing_ratio == RATIO

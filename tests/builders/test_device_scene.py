"""Scenes on a GPU, in numba's simulator: refused in one line, the same bits, resumed on the other device."""

import copy
import subprocess
import sys
import warnings
from importlib import import_module

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.builders.cost import seconds_on_gpu, work
from porescale.builders.derive import derive
from porescale.builders.report import bytes_on_gpu, report
from porescale.builders.scene import Scene
from porescale.common.compiled import cuda
from porescale.common.core.errors import InputError, Unstable
from porescale.common.duration.expected import STEPS, expected, remember
from porescale.common.duration.quiet import moment
from porescale.lbm.device.fluid import bytes_needed

FLUID = {"spacing": 1e-3, "relaxation_time": 0.7, "viscosity": 1e-5, "body_force": [0.01, 0]}
SCENE = {
    "domain": {"width": 0.007, "height": 0.006},
    "time": {"end": 0.02},
    "output": {"snapshot_interval": 0.01, "series_interval": 0.01},
    "fluid": FLUID,
}
ON_GPU = {**SCENE, "run": {"device": "gpu"}}
BLOCK = [{"lower": [0.002, 0.002], "upper": [0.004, 0.004]}]
GRAINS = {
    "domain": {"width": 0.024, "height": 0.014, "left": "periodic", "right": "periodic"},
    "time": {"end": 0.02},
    "output": {"snapshot_interval": 0.01, "series_interval": 0.01},
    "fluid": {**FLUID, "viscosity": 4e-4, "density": 1000},
    "grains": {
        "density": 2500,
        "hydraulic_radius_ratio": 0.9,
        "grain": [
            {"x": 0.0095, "y": 0.005, "diameter": 0.005, "velocity": [0.02, 0], "spin": 3},
            {"x": 0.014601, "y": 0.006, "diameter": 0.0054},
            {"x": 0.0235, "y": 0.0105, "diameter": 0.005, "velocity": [0, -0.02]},
        ],
    },
    "disc": [{"x": 0.0185, "y": 0.0025, "diameter": 0.004}],
    "contact": {"stiffness": 1e5, "tangential_stiffness": 2.5e4, "restitution": 0.6, "friction": 0.4},
}
GRAINS_ON_GPU = {**GRAINS, "run": {"device": "gpu"}}


def test_a_scene_without_the_key_imports_nothing_of_cuda():
    code = f"""
import sys
from porescale.builders.build import build
from porescale.builders.report import report
from porescale.builders.scene import Scene
scene = Scene(**{GRAINS!r})
report(scene)
build(scene).stepper.advance()
cuda = ("numba.cuda", "porescale.lbm.device", "porescale.coupling.device", "porescale.common.compiled.cuda")
assert not [it for it in sys.modules if it.startswith(cuda)]
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


@pytest.mark.parametrize("change", [{"rectangle": BLOCK}, {"fluid": None}])
def test_what_a_gpu_lacks_is_refused_in_one_line(change):
    table = {name: value for name, value in {**ON_GPU, **change}.items() if value is not None}
    with pytest.raises(InputError) as refused:
        Scene(**table)
    assert [it for it in str(refused.value).splitlines() if "run.device" in it and 'take "cpu"' in it]


def test_without_a_gpu_a_run_is_refused_in_one_line(monkeypatch):
    monkeypatch.setattr(cuda, "simulated", lambda: False)
    monkeypatch.setattr(cuda, "cuda", lambda: type("Machine", (), {"is_available": staticmethod(lambda: False)}))
    with pytest.raises(InputError, match="there is no GPU here") as refused:
        build(Scene(**ON_GPU))
    assert len(str(refused.value).splitlines()) == 1
    assert refused.value.code == 2


def test_without_a_gpu_a_scene_is_refused_before_its_grains_are_packed(monkeypatch):
    monkeypatch.setattr("porescale.builders.build.grains_of", lambda *_, **__: pytest.fail("grains were packed"))
    with pytest.raises(pytest.fail.Exception):
        build(Scene(**GRAINS_ON_GPU))
    monkeypatch.setattr(cuda, "simulated", lambda: False)
    monkeypatch.setattr(cuda, "cuda", lambda: type("Machine", (), {"is_available": staticmethod(lambda: False)}))
    with pytest.raises(InputError, match="there is no GPU here"):
        build(Scene(**GRAINS_ON_GPU))


def test_memory_that_does_not_suffice_is_one_line(monkeypatch):
    def full(_):
        raise RuntimeError("Call to cuMemAlloc results in CUDA_ERROR_OUT_OF_MEMORY")

    monkeypatch.setattr(cuda, "cuda", lambda: type("Machine", (), {"to_device": staticmethod(full)}))
    with pytest.raises(InputError, match=r"does not hold 1\.00 GiB more"):
        cuda.to_device(np.broadcast_to(np.zeros(1), (2**27,)))


def test_a_scene_steps_on_the_device_to_the_same_bits():
    cpu, gpu = build(Scene(**SCENE)), build(Scene(**ON_GPU))
    for simulation in (cpu, gpu):
        for _ in range(2):
            simulation.stepper.advance()
    found = gpu.stepper.fields()
    for ours, theirs in zip(found, cpu.stepper.fields(), strict=True):
        assert np.array_equal(ours, theirs)
    assert np.abs(found[1]).max() > 0
    assert type(gpu.fluid) is not type(cpu.fluid)


class Maker:
    """A device that says how fast its memory is: 1 GHz, 512 bits, two transfers a clock."""

    MEMORY_CLOCK_RATE, GLOBAL_MEMORY_BUS_WIDTH = 10**6, 512
    compute_capability, name = (9, 0), "Maker"


def test_check_says_what_the_gpu_needs_and_that_its_gain_is_unknown(monkeypatch):
    monkeypatch.setattr(cuda, "makers_bandwidth", lambda: None)
    # Other tests have left runs to learn from.
    monkeypatch.setattr("porescale.common.duration.expected._runs", list)
    said = str(report(Scene(**ON_GPU)))
    assert "memory of the GPU" in said
    assert "time on the CPU" in said
    assert "unknown" in said
    assert "gain of the GPU" not in said
    assert "GPU" not in str(report(Scene(**SCENE)))


def test_check_estimates_the_time_from_the_makers_figures(monkeypatch):
    monkeypatch.setattr("porescale.common.duration.expected._runs", list)
    monkeypatch.setattr(cuda.cuda(), "get_current_device", Maker, raising=False)
    assert cuda.makers_bandwidth() == 2 * 1e9 * 512 / 8
    derived = derive(Scene(**ON_GPU))
    # 42 cells, nine float64 read and written, 1000 steps, 128 GB/s.
    seconds = seconds_on_gpu(derived, 1000, cuda.makers_bandwidth())
    assert seconds == pytest.approx(42 * 2 * 9 * 8 * 1000 / 128e9, rel=1e-14)
    assert seconds != pytest.approx(seconds_on_gpu(derive(single()), 1000, 128e9), rel=0.4)  # half of it
    said = str(report(Scene(**ON_GPU)))
    assert "an estimate from the maker's figures, 128 GB/s" in said
    assert "not measured" in said
    assert "at most" in said


def single():
    """The scene in single precision."""
    return Scene(**{**ON_GPU, "fluid": {**FLUID, "precision": "float32"}})


def test_what_a_gpu_did_is_remembered_apart_from_the_cpu(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    scene, derived = Scene(**ON_GPU), derive(Scene(**ON_GPU))
    on_cpu, on_gpu = work(scene, derived), work(scene, derived, cuda.describe()[0])
    guess = expected(on_cpu)
    remember(on_gpu, {STEPS: 3.0 * on_gpu.seconds[STEPS]}, moment())
    assert expected(on_cpu) == guess
    assert expected(on_gpu).seconds[STEPS] == pytest.approx(3.0 * on_gpu.seconds[STEPS], rel=1e-12)
    assert "by the last runs of such scenes on it" in str(report(scene))
    assert not expected(work(scene, derived, "another GPU")).measured


@pytest.mark.parametrize("fits", [0, 3, 7])
def test_memory_that_does_not_suffice_fails_the_build(fits, monkeypatch):
    """Whichever array it is that does not fit, the build says so, before there is a run."""
    machine, left = cuda.cuda(), [fits]
    send = machine.to_device

    def sent(array):
        left[0] -= 1
        if left[0] < 0:
            raise RuntimeError("Call to cuMemAlloc results in CUDA_ERROR_OUT_OF_MEMORY")
        return send(array)

    monkeypatch.setattr(machine, "to_device", sent)
    with pytest.raises(InputError, match="does not hold") as refused:
        build(Scene(**ON_GPU))
    assert len(str(refused.value).splitlines()) == 1


@pytest.mark.parametrize("scene", [ON_GPU, GRAINS_ON_GPU], ids=["fluid", "grains"])
def test_a_run_that_was_built_asks_for_no_more_memory(scene, monkeypatch):
    """The check that must fail for an array that is made at the first step, row, snapshot or state."""
    simulation = build(Scene(**scene))
    monkeypatch.setattr(cuda.cuda(), "to_device", lambda _: pytest.fail("asked for more memory"))
    state = simulation.state()
    simulation.check()
    simulation.series()
    simulation.snapshot()
    simulation.advance(1)
    simulation.series()
    simulation.restore(state)
    simulation.advance(1)


def test_a_diverging_fluid_is_found_without_its_populations(monkeypatch):
    """The same cell, quantity and cause as on the CPU."""
    said = []
    for table in (SCENE, ON_GPU):
        simulation = build(Scene(**table))
        simulation.check()
        simulation.fluid.set_flow(*simulation.fluid.fields()[1:], 1 + 0.6 * np.eye(6, 7))
        monkeypatch.setattr(type(simulation.fluid), "state", lambda _: pytest.fail("populations were read"))
        with pytest.raises(Unstable, match=r"relative density change = 0\.6 .*cell \(0, 0\)") as error:
            simulation.check()
        said.append(str(error.value))
    assert said[0] == said[1]


def test_a_block_of_steps_ends_when_the_device_has_done_it(monkeypatch):
    calls, simulation = [], build(Scene(**ON_GPU))
    monkeypatch.setattr(simulation.stepper, "advance", lambda: calls.append("step"))
    monkeypatch.setattr("porescale.lbm.device.fluid.synchronize", lambda: calls.append("wait"))
    simulation.advance(2)
    assert calls == ["step", "step", "wait"]
    calls.clear()
    simulation = build(Scene(**SCENE))
    monkeypatch.setattr(simulation.stepper, "advance", lambda: calls.append("step"))
    simulation.advance(2)
    assert calls == ["step", "step"]  # the check that must fail: a fluid on the CPU waits for nothing


@pytest.mark.parametrize("name", cuda.STREAM_PER_THREAD)
def test_a_stream_0_for_each_thread_is_refused_in_one_line(name, monkeypatch):
    monkeypatch.setenv(name, "0")
    cuda.require_device()
    monkeypatch.setenv(name, "1")
    with pytest.raises(InputError, match=f"{name} is set") as refused:
        cuda.require_device()
    assert len(str(refused.value).splitlines()) == 1


def test_pinned_memory_that_does_not_suffice_is_one_line(monkeypatch):
    def full(*_):
        raise RuntimeError("Call to cuMemHostAlloc results in CUDA_ERROR_OUT_OF_MEMORY")

    monkeypatch.setattr(cuda, "cuda", lambda: type("Machine", (), {"pinned_array": staticmethod(full)}))
    with pytest.raises(InputError, match=r"the host has no pinned memory for 1\.00 GiB more"):
        cuda.pinned_array(2**27, np.float64)


def test_small_grids_are_not_warned_of():
    """The words are those of numba's warning; others of its kind still come."""
    numba = import_module("numba.core.errors").NumbaPerformanceWarning
    cuda.cuda.cache_clear()
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        cuda.cuda()
        for words in (
            "Grid size 3 will likely result in GPU under-utilization due to low occupancy.",
            "Host array used",
        ):
            warnings.warn(numba(words), stacklevel=1)
    assert [str(it.message).count("Host array used") for it in seen] == [1]


POLYGONS_ON_GPU = {
    **{name: it for name, it in GRAINS_ON_GPU.items() if name != "disc"},
    "grains": {"density": 2500, "hydraulic_radius_ratio": 1.0},
    "polygon": [
        {"corners": [[-0.003, -0.0025], [0.003, -0.0025], [0, 0.0025]], "thickness": 5e-4, "at": [[0.008, 0.007]]}
    ],
}
SOFT_ON_GPU = {**GRAINS_ON_GPU, "fluid": {**GRAINS["fluid"], "rim": "soft"}}
LARGE_HELD_ON_GPU = {
    **GRAINS_ON_GPU,
    "grains": {**GRAINS["grains"], "grain": GRAINS["grains"]["grain"][:1]},
    "disc": [{"x": 0.0185, "y": 0.007, "diameter": 0.01}],
}


@pytest.mark.parametrize("table", [ON_GPU, GRAINS_ON_GPU, SOFT_ON_GPU, POLYGONS_ON_GPU, LARGE_HELD_ON_GPU])
def test_check_counts_no_less_memory_than_a_build_takes(table, monkeypatch):
    """Every array that is made there; patches are counted a block too wide, and grains as wide as the widest."""
    machine, taken = cuda.cuda(), []
    for name in ("to_device", "device_array"):
        monkeypatch.setattr(machine, name, counted(getattr(machine, name), taken))
    scene = Scene(**table)
    build(scene)
    need = bytes_on_gpu(scene, derive(scene))
    assert sum(taken) <= need < 2 * sum(taken)
    assert sum(taken) > bytes_needed(*derive(scene).cells, 8) or table is ON_GPU  # the check that must fail


def counted(make, taken):
    """``make``, with the bytes of what it makes noted in ``taken``."""

    def made(*arguments):
        found = make(*arguments)
        taken.append(found.nbytes)
        return found

    return made


def memory_row(scene):
    """MiB of the GPU in the report of a scene."""
    return float(str(report(Scene(**scene))).split("memory of the GPU")[1].split()[0])


def test_check_counts_what_discs_need_on_the_gpu():
    """At least what loads are made of in every cell."""
    without = {name: it for name, it in GRAINS_ON_GPU.items() if name not in ("grains", "disc", "contact")}
    assert memory_row(GRAINS_ON_GPU) > memory_row(without) + 3 * 8 * 24 * 14 / 2**20


def flat(state):
    """Arrays and numbers of a state, by their place in it."""
    if isinstance(state, dict):
        return {f"{key}/{name}": it for key, value in state.items() for name, it in flat(value).items()}
    return {"": np.array(state)}


def same(one, other):
    """Names of what differs between two states."""
    one, other = flat(one), flat(other)
    assert list(one) == list(other)
    return [name for name in one if not np.array_equal(one[name], other[name])]


def stepped(scene, steps):
    """A simulation after so many steps."""
    made = build(Scene(**scene))
    for _ in range(steps):
        made.stepper.advance()
    return made


def test_grains_in_water_move_to_the_same_bits():
    """Free, held and touching, one across a periodic side; and what is read of them."""
    cpu, gpu = stepped(GRAINS, 3), stepped(GRAINS_ON_GPU, 3)
    assert same(gpu.stepper.state(), cpu.stepper.state()) == []
    assert np.abs(cpu.stepper.coupled.contact_load()[:2, 0]).min() > 0
    for ours, theirs in zip(gpu.stepper.fields(), cpu.stepper.fields(), strict=True):
        assert np.array_equal(ours, theirs)
    gpu.stepper.check()
    assert gpu.stepper.coupled.momentum() == pytest.approx(cpu.stepper.coupled.momentum(), rel=0, abs=0)


def test_grains_in_other_water_move_elsewhere():
    """The check that must fail."""
    other = {**GRAINS_ON_GPU, "fluid": {**GRAINS["fluid"], "relaxation_time": 0.71}}
    assert same(stepped(other, 1).stepper.state(), stepped(GRAINS, 1).stepper.state())


@pytest.mark.parametrize(("first", "then"), [(GRAINS, GRAINS_ON_GPU), (GRAINS_ON_GPU, GRAINS)])
def test_grains_go_on_on_the_other_device_from_an_odd_step(first, then):
    begun, other = stepped(first, 1), stepped(then, 0)
    other.stepper.restore(copy.deepcopy(begun.stepper.state()))
    for _ in range(2):
        other.stepper.advance()
    assert same(other.stepper.state(), stepped(GRAINS, 3).stepper.state()) == []

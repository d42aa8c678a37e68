"""Scenes on a GPU, in numba's simulator: refused in one line, the same bits, resumed on the other device."""

import subprocess
import sys

import numpy as np
import pytest

from porescale.builders.build import build
from porescale.builders.report import report
from porescale.builders.scene import Scene
from porescale.common.compiled import cuda
from porescale.common.core.errors import InputError

FLUID = {"spacing": 1e-3, "relaxation_time": 0.7, "viscosity": 1e-5, "body_force": [0.01, 0]}
SCENE = {
    "domain": {"width": 0.007, "height": 0.006},
    "time": {"end": 0.02},
    "output": {"snapshot_interval": 0.01, "series_interval": 0.01},
    "fluid": FLUID,
}
ON_GPU = {**SCENE, "run": {"device": "gpu"}}
DISC = [{"x": 0.003, "y": 0.003, "diameter": 0.002}]


def test_a_scene_without_the_key_imports_nothing_of_cuda():
    code = f"""
import sys
from porescale.builders.build import build
from porescale.builders.report import report
from porescale.builders.scene import Scene
scene = Scene(**{SCENE!r})
report(scene)
build(scene).fluid.advance()
cuda = ("numba.cuda", "porescale.lbm.device", "porescale.common.compiled.cuda")
assert not [it for it in sys.modules if it.startswith(cuda)]
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


@pytest.mark.parametrize("change", [{"disc": DISC}, {"fluid": None}])
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


def test_check_says_what_the_gpu_needs():
    assert "memory of the GPU" in str(report(Scene(**ON_GPU)))

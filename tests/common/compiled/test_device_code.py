"""What numba would be given to compile for a GPU, found on any machine.

The simulator cannot show it: in it functions on numbers stand for themselves, so that none is looked up.
"""

import math
from types import FunctionType, SimpleNamespace

import numpy as np
import pytest
from numba import cuda as device

from porescale.common.compiled import cuda, simd
from porescale.common.compiled.jit import Kernel
from porescale.coupling.device import cover, loads, sweeps
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.lbm.device import kernels, readings
from porescale.lbm.fluid import Fluid

MODULES = kernels, readings, cover, loads, sweeps
KERNELS = [
    it
    for module in MODULES
    for it in vars(module).values()
    if isinstance(it, FunctionType) and it.__module__ == module.__name__ and "grid" in it.__code__.co_names
]
CACHED = cuda.device_function, cuda._numpy, cuda._numbered, cuda._device_fma


@pytest.fixture
def _on_a_device(monkeypatch):
    """numba's compiler for a GPU takes every function as it is."""
    monkeypatch.setattr(cuda, "simulated", lambda: False)
    monkeypatch.setattr(cuda, "cuda", SimpleNamespace)
    monkeypatch.setattr(cuda, "jit", lambda function, **_: function)
    for it in CACHED:
        it.cache_clear()
    yield
    for it in CACHED:
        it.cache_clear()


def reached(function, found):
    """The function and all that it calls by a global name, in ``found``."""
    if isinstance(function, FunctionType) and function not in found:
        found.add(function)
        for name in cuda._globals_of(function):
            value = function.__globals__.get(name)
            assert not isinstance(value, Kernel), f"{function.__name__} would call {name} of the CPU"
            if str(getattr(value, "__module__", "")).startswith("porescale"):
                reached(value, found)


@pytest.mark.usefixtures("_on_a_device")
@pytest.mark.parametrize("real", [np.float32, np.float64])
@pytest.mark.parametrize("operator", SOLID_OPERATORS)
def test_nothing_of_the_cpu_is_left_in_what_a_device_runs(operator, real):
    fluid = Fluid(8, 8, 0.7, dtype=real)
    cells = SaturatedCells(fluid, [2.0], solid_operator=operator)
    laws = tuple(type(it) for it in (fluid.law_of_sweep, *cells._laws[::-1]))
    assert {kernels.sweep_cells, cover.mark_discs, loads.load_rows, sweeps.sweep_tiles} <= set(KERNELS)
    for kernel in KERNELS:
        found = set()
        reached(cuda._for_device(kernel, laws, real), found)
        assert not [it for it in found if it.__module__ == simd.__name__]


@pytest.mark.usefixtures("_on_a_device")
def test_functions_on_vectors_become_those_on_numbers():
    """An attribute may be called as a global is: the root of numbers, ``np.sqrt``, was taken for that of vectors."""
    root = cuda._meaning(simd.sqrt, object, np.float64)
    assert root(2.0) == math.sqrt(2.0)
    assert cuda._globals_of(root) == {"np"}
    assert cuda._meaning(simd.maximum, object, np.float64)(1.0, 2.0) == 2.0


def test_products_are_not_fused_at_the_link(monkeypatch):
    """The function comes with its options: numba-cuda 0.30 forgets one of them where it decorates."""
    given = []
    monkeypatch.setattr(cuda, "cuda", lambda: SimpleNamespace(jit=lambda *a, **options: given.append((a, options))))
    monkeypatch.setattr(cuda, "simulated", lambda: False)
    cuda.jit(math.sqrt, device=True)
    assert given == [((math.sqrt,), {"device": True, "lto": False})]
    monkeypatch.setattr(cuda, "simulated", lambda: True)  # whose ``jit`` has no such option
    cuda.jit(math.sqrt)
    assert given[1] == ((math.sqrt,), {})


def test_a_barrier_is_refused_by_a_simulator_that_takes_threads_in_turn():
    if cuda.simulated():
        found = np.zeros(4)
        numbered = cuda.jit(_numbered)
        numbered[2, 2](found, False)
        assert found.tolist() == [1, 2, 3, 4]
        with pytest.raises(NotImplementedError, match="barrier"):
            numbered[2, 2](found, True)


def _numbered(found, wait):
    i = device.grid(1)
    found[i] = i + 1
    if wait:
        device.syncthreads()

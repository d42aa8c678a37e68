"""Kernels compiled for a graphics device from the functions that the CPU compiles: numba-cuda, or its simulator.

A function of one cell or of one link is written once.  ``device_function`` copies it with all that it calls: a kernel
becomes a device function, a law function the body for the law in use, constants those of the precision in use.  What
differs between the machines is only which thread takes which entry.

numba's CUDA target is imported by the first call here, never by a run on the CPU.  With ``NUMBA_ENABLE_CUDASIM=1`` in
the environment it is numba's simulator: every thread of every block in plain Python, on any machine.
"""

import dis
import math
import os
import warnings
from collections.abc import Callable
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numpy as np

from porescale.common.compiled import simd
from porescale.common.compiled.jit import Kernel, body_for, unchecked_view
from porescale.common.core.errors import Fault, InputError

LEAST_CAPABILITY = (6, 0)
"""Oldest devices: the first with float64 atomics and pre-emption, and the oldest that current drivers serve."""
WARP = 32
"""Threads that go together."""

SIMULATOR = "numba's simulator"

SMALL_GRID = r"(?s).*Grid size \d+ will likely result in GPU under-utilization"
"""How numba warns of a launch below 128 blocks, whatever colours go before: rows of bodies and links are few.  Of any
category, since numba-cuda and numba have each its own."""
STREAM_PER_THREAD = "NUMBA_CUDA_PER_THREAD_DEFAULT_STREAM", "CUDA_PYTHON_CUDA_PER_THREAD_DEFAULT_STREAM"
"""Variables by which the stream 0 no longer waits for others, nor they for it: see ``launch``."""


@cache
def cuda() -> Any:
    """numba's CUDA module, that no longer warns of small grids, and fuses no product with a sum."""
    found = import_module("numba.cuda")
    warnings.filterwarnings("ignore", SMALL_GRID)
    if not simulated():
        nvvm: Any = import_module("numba.cuda.cudadrv.nvvm")
        nvvm.compile_ir = partial(nvvm.compile_ir, fma=False)
    return found


def jit(function: Any, **options: Any) -> Any:
    """The function compiled by numba's ``cuda.jit``: its code rounds after every operation, as the CPU's does, but for
    ``fma``.

    Without optimisation at the link, which would fuse products with sums once more.  Given with its function, since
    numba-cuda 0.30 forgets the option where it decorates.
    """
    return cuda().jit(function, **options, **({} if simulated() else {"lto": False}))


def simulated() -> bool:
    """Whether the simulator stands for a device."""
    return bool(vars(import_module("numba.core.config")).get("ENABLE_CUDASIM"))


def require_device() -> None:
    """InputError, in one line, unless there is a device that can be used, or the simulator, and its stream 0 is one of
    all threads."""
    for name in STREAM_PER_THREAD:
        if os.environ.get(name, "0") not in ("", "0"):
            problem = f"{name} is set: work on the device would not wait for what it needs"
            raise InputError(Fault("device", "gpu", problem, repair="unset it"))
    if simulated():
        return
    try:
        found = cuda().is_available()
    except Exception as error:  # whatever a driver that is half installed raises
        raise InputError(Fault("device", "gpu", f"no GPU can be used: {error}")) from None
    if not found:
        raise InputError(
            Fault("device", "gpu", "there is no GPU here, or no driver of one", repair='take "cpu"'),
        )
    capability = tuple(cuda().get_current_device().compute_capability)
    if capability < LEAST_CAPABILITY:
        raise InputError(Fault("device", "gpu", f"compute capability {capability}", allowed=f">= {LEAST_CAPABILITY}"))


def describe() -> tuple[str, int]:
    """Name of the device, or why there is none, and its memory in bytes, 0 where it is not known."""
    try:
        require_device()
    except InputError as error:
        return str(error), 0
    if simulated():
        return SIMULATOR, 0
    name: Any = cuda().get_current_device().name
    return name.decode() if isinstance(name, bytes) else str(name), int(cuda().current_context().get_memory_info()[1])


def driver() -> str:
    """Version of CUDA that the driver of the device has, and of the driver where the system says it; "" without one."""
    if simulated():
        return ""
    cuda_version = ".".join(str(it) for it in import_module("numba.cuda.cudadrv.driver").get_version())
    own = Path("/sys/module/nvidia/version")
    return f"CUDA {cuda_version}" + (f", driver {own.read_text().strip()}" if own.exists() else "")


def makers_bandwidth() -> float | None:
    """Bytes per second of the device's memory by its attributes, clock times width of the bus times two transfers a
    clock; None where it does not say."""
    try:
        device = cuda().get_current_device()
        found = 2e3 * float(device.MEMORY_CLOCK_RATE) * float(device.GLOBAL_MEMORY_BUS_WIDTH) / 8  # kHz, bits
    except Exception:  # whatever a driver, or the simulator, raises for an attribute that it does not have
        return None
    return found if found > 0 else None


def synchronize() -> None:
    """Wait until the device has done all that it was given."""
    cuda().synchronize()


def to_device(array: Any) -> Any:
    """A copy of the array on the device; InputError where its memory does not suffice."""
    return _within_memory(lambda: cuda().to_device(np.ascontiguousarray(array)), array.nbytes)


def empty_on_device(shape: Any, dtype: Any) -> Any:
    """An array on the device, of any values; InputError where its memory does not suffice."""
    size = int(np.prod(shape)) * np.dtype(dtype).itemsize
    return _within_memory(lambda: cuda().device_array(shape, dtype), size)


def _within_memory(make: Callable[[], Any], size: int, lacking: str = "its memory does not hold") -> Any:
    """What ``make`` makes of ``size`` bytes; InputError, with what is ``lacking``, where memory does not suffice."""
    try:
        return make()
    except Exception as error:  # the driver's own type, which the simulator does not have
        if "OUT_OF_MEMORY" not in str(error):
            raise
        raise InputError(Fault("device", "gpu", f"{lacking} {size / 2**30:.2f} GiB more")) from None


Laws = type | tuple[type, ...]
"""The law, or laws, of a kernel: of each law function the body is taken for the first of them that has one."""


def _device_kernel(function: FunctionType, law: Laws, real: type) -> Any:
    """Compile a function of arrays and numbers whose threads take their entry by ``grid``: see ``launch``.

    law : of the law functions that it calls;  real : np.float32 or np.float64, of ``precision_constants``.
    """
    return jit(_for_device(function, law, real))


device_kernel: Any = cache(_device_kernel)
"""The same, once for each function, law and precision."""


@cache
def device_function(function: FunctionType, law: Laws, real: type) -> Any:
    """The device function of a function in plain Python, for a law, or several, and a precision."""
    return jit(_for_device(function, law, real), device=True)


def launch(compiled: Any, count: int, block: int, *arguments: Any, stream: Any = 0) -> None:
    """Run a kernel of ``device_kernel`` with ``count`` threads or more, at most ``block`` of them in a block.

    Work of the stream 0 waits for that of others which was asked for before it, and that of others for its own.
    """
    if count > 0:
        block = min(block, -(-count // WARP) * WARP)
        compiled[-(-count // block), block, stream](*arguments)


def new_stream() -> Any:
    """A stream of work on the device, beside others but the stream 0."""
    return cuda().stream()


def pinned_array(shape: Any, dtype: Any) -> Any:
    """Zeros in memory of the host that the device reads and writes while the host goes on; InputError where the host
    has no more of it."""
    size = int(np.prod(shape)) * np.dtype(dtype).itemsize
    made = _within_memory(lambda: cuda().pinned_array(shape, dtype), size, "the host has no pinned memory for")
    made[...] = 0
    return made


def grid() -> int:
    """Number of the thread of a kernel of ``device_kernel``, from 0."""
    raise TypeError("this has a meaning in device kernels only")


def _for_device(function: FunctionType, law: Laws, real: type) -> FunctionType:
    """A copy of the function in whose names everything compiled for the CPU is compiled for the device."""
    names = dict(function.__globals__)
    for name in _globals_of(function):
        if name in names:
            names[name] = _meaning(names[name], law, real)
    made = FunctionType(function.__code__, names, function.__name__, function.__defaults__, function.__closure__)
    made.__doc__, made.__module__ = function.__doc__, function.__module__
    return made


def _globals_of(function: FunctionType) -> set[str]:
    """Global names that a function reads; not attributes, of which one may be called as a global is (``np.sqrt``)."""
    return {it.argval for it in dis.get_instructions(function) if it.opname == "LOAD_GLOBAL"}


def _meaning(value: Any, law: Laws, real: type) -> Any:
    """What the value of a global name becomes on the device."""
    if value is np and not simulated():
        return _numpy()
    if value is grid:
        return _numbered()
    if value is unchecked_view:  # its plain form; inlined, since no device function may return a slice
        return jit(value, device=True, inline="always")
    if value is simd.fma and not simulated():
        return _device_fma()
    if getattr(value, "__module__", "") == simd.__name__ and not simulated():  # of numbers: a thread has no lanes
        return device_function(import_module(simd.CODE).SCALAR[value], law, real)
    if isinstance(value, Kernel):
        return device_function(value.py_func, law, real)
    meaning = getattr(value, "meaning", None)
    if not isinstance(meaning, dict):
        return value
    bits = 8 * np.dtype(real).itemsize
    if set(meaning) == {32, 64}:
        return device_function(_constant(meaning[bits]), law, real)
    laws = law if isinstance(law, tuple) else (law,)
    body = next((found for it in laws if (found := body_for(meaning, it)) is not None), None)
    if body is None:
        raise TypeError(f"{value.__name__} has no body for {' or '.join(it.__name__ for it in laws)}")
    return device_function(body.py_func, law, real)


@cache
def _constant(known: Any) -> Callable[[Any], Any]:
    """A function of one number that returns ``known``."""
    return lambda number: known


@cache
def _numpy() -> ModuleType:
    """What device functions use of numpy, in the precision of the argument: numba-cuda does not know numpy's own."""
    made: Any = ModuleType("numpy_on_device")
    made.sqrt, made.float64 = math.sqrt, np.float64
    return made  # type: ignore[no-any-return]


@cache
def _numbered() -> Any:
    """Device function that gives the number of the thread."""
    return jit(FunctionType(_thread.__code__, {"cuda": cuda()}, "thread"), device=True)


@cache
def _device_fma() -> Any:
    """Device function for ``fma``."""
    return jit(FunctionType(_fused.__code__, {"cuda": cuda()}, "fused"), device=True)


def _fused(a: Any, b: Any, c: Any) -> Any:
    """a b + c, rounded once."""
    return cuda.fma(a, b, c)  # type: ignore[attr-defined]  # the module, where it is compiled


def _thread() -> Any:
    """Number of the thread: of its block times threads in a block, and of it in the block."""
    return cuda.grid(1)  # type: ignore[attr-defined]  # the module, where it is compiled

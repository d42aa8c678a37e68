"""Every kernel of a GPU compiled for one, on any machine: what each holds, as a table.

    python -m tests.reference.lbm.compile_for_device [--operator exact-wall …] [--capability 9 0]

Needs numba-cuda and the compiler of CUDA (``pip install 'numba-cuda[cu13]' nvidia-cuda-nvcc``), no device and no
driver: a step is done with arrays of the host, and what would be launched is compiled for the types of its arguments.
Registers and spills come from ptxas where there is one.  Not in the simulator, which compiles nothing.
"""

import argparse
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace

import numpy as np

import porescale.common.compiled.cuda as compiled
from porescale.coupling.solid.choose import SOLID_OPERATORS

OPERATIONS = re.compile(r"\b(?:add|sub|mul|fma|div|sqrt|rcp|min|max|neg|setp)[.\w]*\.f64\b")
USED = re.compile(r"(\d+) bytes stack frame, (\d+) bytes spill stores.*?Used (\d+) registers", re.DOTALL)


class OnHost(np.ndarray):
    """An array of the host in place of one of a device."""

    def copy_to_host(self, to, stream=0):
        """Nothing is computed."""

    def copy_to_device(self, of, stream=0):
        """Nor is it here."""


class Compiled:
    """A kernel that is compiled where it would be launched."""

    def __init__(self, function, found, capability):
        self.function, self.found, self.capability = function, found, capability

    def __getitem__(self, configuration):
        return self

    def __call__(self, *arguments):
        numba, cuda = import_module("numba"), compiled.cuda()
        types = tuple(numba.typeof(_plain(it)) for it in arguments)
        if (self.function, types) not in self.found:
            code, _ = cuda.compile_ptx(self.function, types, cc=self.capability)
            self.found[self.function, types] = code


def _plain(value):
    """The value with arrays that numba knows."""
    if isinstance(value, np.ndarray):
        return np.asarray(value)
    if isinstance(value, tuple):
        return type(value)(*map(_plain, value)) if hasattr(value, "_fields") else tuple(map(_plain, value))
    return value


@contextmanager
def compiling(found, capability) -> Iterator[None]:
    """Within this, what would be launched is compiled instead: code into ``found``, by function and types."""
    cuda, dispatcher = compiled.cuda(), import_module("numba.cuda.dispatcher")
    jit, device = cuda.jit, vars(dispatcher)["get_current_device"]
    on_host = {
        "jit": lambda it, **more: jit(it, **more) if "device" in more else Compiled(it, found, capability),
        "to_device": lambda array: array.copy().view(OnHost),
        "device_array": lambda shape, dtype: np.zeros(shape, dtype).view(OnHost),
        "pinned_array": lambda shape, dtype: np.zeros(shape, dtype),
        "stream": lambda: SimpleNamespace(synchronize=lambda: None),
        "is_available": lambda: True,
        "get_current_device": lambda: SimpleNamespace(compute_capability=capability),
    }
    kept = {name: getattr(cuda, name) for name in on_host}
    for name, it in on_host.items():
        setattr(cuda, name, it)
    vars(dispatcher)["get_current_device"] = on_host["get_current_device"]
    try:
        yield
    finally:
        for name, it in kept.items():
            setattr(cuda, name, it)
        vars(dispatcher)["get_current_device"] = device


def step(operator, dtype, *, soft):
    """A step of every kind: both kinds of side, a plate, discs that overlap, a body force."""
    from porescale.coupling.device.cells import DeviceSaturatedCells
    from porescale.lbm.boundary.sides import Sides
    from porescale.lbm.device.fluid import DeviceFluid

    sides = Sides(left="velocity", right="pressure", bottom="slip", top="wall", left_velocity=(0.01, 0.0))
    fluid = DeviceFluid(40, 20, 0.7, force=(1e-5, 0.0), dtype=dtype, sides=sides)
    fluid.add_plate(30)
    fluid.advance()
    fluid.advance()
    cells = DeviceSaturatedCells(fluid, [3.0, 3.0], solid_operator=operator, soft_rim=soft)
    cells.pairs = np.array([[0, 1]])
    cells.advance(fluid, np.array([[10.0, 10.0], [14.0, 10.0]]), np.zeros((2, 2)), np.zeros(2))


def assembler():
    """Path of ptxas, or None."""
    try:
        own = [Path(it) / "cu13/bin/ptxas" for it in import_module("nvidia").__path__]
    except ImportError:
        own = []
    return next((str(it) for it in own if it.exists()), shutil.which("ptxas"))


def used(code, capability):
    """Bytes of stack and of spills, and registers, as ptxas says; dashes where there is none that takes the code."""
    tool = assembler()
    if tool is None:
        return "-", "-", "-"
    with TemporaryDirectory() as folder:
        source = Path(folder) / "kernel.ptx"
        source.write_text(code, encoding="utf-8")
        target = f"-arch=sm_{capability[0]}{capability[1]}"
        done = subprocess.run(
            [tool, "-v", target, str(source), "-o", os.devnull],
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
    known = USED.search(done.stderr)
    return known.groups() if known else ("-", "-", "-")


def main():
    """Print the table."""
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--operator", nargs="+", choices=list(SOLID_OPERATORS), default=list(SOLID_OPERATORS))
    asked.add_argument("--capability", nargs=2, type=int, default=(9, 0))
    given = asked.parse_args()
    capability, shown = tuple(given.capability), set()
    print(f"{'kernel':18} {'of':18} {'numbers':8} {'float64':>7} {'stack':>6} {'spills':>6} {'registers':>9}")
    for operator in given.operator:
        for soft in (False, True) if SOLID_OPERATORS[operator].soft_law else (False,):
            for dtype in (np.float32, np.float64):
                found = {}
                compiled.device_function.cache_clear()
                compiled.device_kernel.cache_clear()
                with compiling(found, capability):
                    step(operator, dtype, soft=soft)
                for (function, _), code in found.items():
                    row = function.__name__, dtype.__name__, len(OPERATIONS.findall(code)), *used(code, capability)
                    if row not in shown:
                        shown.add(row)
                        kind = f"{operator}, soft" if soft else operator
                        name, numbers, double, stack, spills, registers = row
                        print(
                            f"{name:18} {kind:18} {numbers:8} {double:7} {stack:>6} {spills:>6} {registers:>9}",
                            flush=True,
                        )


if __name__ == "__main__":
    main()

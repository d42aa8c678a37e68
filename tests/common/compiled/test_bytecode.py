"""The bytecode of kernels is read as Python's own `dis` reads it: versions of Python write it differently.

kernel_key.py reads it itself, ten times as fast, for it does so at the start of every run.
"""

import dis
from functools import cache
from importlib import import_module
from pkgutil import walk_packages
from types import CodeType

import continuum_sph
import porescale
from porescale.common.compiled import kernel_key
from porescale.common.compiled.jit import Kernel


@cache
def all_kernels() -> dict[str, Kernel]:
    """Every kernel of both packages by its place."""
    found = {}
    for package in (porescale, continuum_sph):
        for module in walk_packages(package.__path__, f"{package.__name__}."):
            if not module.name.endswith("__main__"):
                kernels = vars(import_module(module.name)).values()
                found |= {f"{it.__module__}.{it.__name__}": it for it in kernels if isinstance(it, Kernel)}
    return found


def read_by_dis(code: CodeType) -> tuple[set[str], set[int]]:
    """Global names and places of constants that a function's instructions take, those of functions in it apart."""
    names, constants = set(), set()
    for it in dis.get_instructions(code):
        if it.opname.startswith("LOAD_") and "GLOBAL" in it.opname:
            names.add(it.argval)
        elif it.opcode in dis.hasconst:
            constants.add(it.arg)
    return names, constants


def read_here(code: CodeType, operation=None) -> tuple[set[str], set[int]]:
    """The same as kernel_key.py reads them."""
    names, constants = set(), set()
    for it, argument in kernel_key._instructions(code):
        if it == (kernel_key._GLOBAL if operation is None else operation):
            names.add(code.co_names[argument >> 1])
        elif it in kernel_key._HAS_CONSTANT:
            constants.add(argument)
    return names, constants


def codes(code: CodeType) -> list[CodeType]:
    """A function's code and those within it."""
    return [code, *(each for inner in code.co_consts if isinstance(inner, CodeType) for each in codes(inner))]


def test_kernels_are_read_as_dis_reads_them():
    kernels = all_kernels()
    assert len(kernels) > 400
    for name, made in kernels.items():
        for code in codes(made.py_func.__code__):
            assert read_here(code) == read_by_dis(code), name


def test_a_version_with_another_instruction_would_be_noticed():
    code = all_kernels()["porescale.dem.motion.leapfrog.kick_drift"].py_func.__code__
    assert read_here(code, operation=dis.opmap["STORE_FAST"]) != read_by_dis(code)


def far(x):
    """A function with more than 255 names and constants, whose arguments take more than one byte."""


exec(  # as no one writes it
    "def far(x):\n '''Text.'''\n" + "".join(f" x += name_{k} + {k}.5 + {k * 1000}\n" for k in range(300)) + " return x"
)


def test_arguments_of_several_bytes_are_read():
    names, constants = read_here(far.__code__)
    assert (names, constants) == read_by_dis(far.__code__)
    assert len(names) == 300
    assert len(constants) >= 300


def test_only_the_docstring_is_left_out_of_a_key():
    # What no instruction takes is left out only where it is a text: all of these are docstrings.
    for name, made in all_kernels().items():
        for code in codes(made.py_func.__code__):
            taken = read_by_dis(code)[1]
            left = [k for k, it in enumerate(code.co_consts) if k not in taken and isinstance(it, str)]
            assert left in ([], [0]), name

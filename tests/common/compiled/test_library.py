"""Machine code is made for kernels that Python calls, and for these only; what kernels call does what it did."""

import os
import sys

import numpy as np
import pytest

from porescale.common.compiled.jit import compiler, inline, kernel, parallel_kernel, prange
from tests.reference.waiting import done


@inline
def halved(x):
    """Half of x; fails where that is not whole."""
    if x % 2:
        raise ValueError("odd")
    return x // 2


@kernel
def total_of_halves(values):
    """Sum of half of each."""
    total = 0
    for i in range(values.shape[0]):
        total += halved(values[i])
    return total


@parallel_kernel
def halve(values, half):
    """Overwrites ``half``."""
    for i in prange(values.shape[0]):
        half[i] = halved(values[i])


@kernel
def twice(values, half):
    """Calls a loop over threads, and another kernel."""
    halve(values, half)
    return 2 * total_of_halves(values)


def emitted(dispatcher) -> list[bool]:
    """Of each library of a dispatcher, whether it has machine code."""
    return [it.library._emitted for it in dispatcher.overloads.values()]


EVEN = np.array([2, 4, 6])


def test_what_kernels_call_has_no_machine_code_of_its_own_unless_python_calls_it(tmp_path):
    """In a process that finds nothing on disk; the last one would fail were it never made."""
    code = (
        "from tests.common.compiled import test_library as it\n"
        "print(it.total_of_halves(it.EVEN), it.emitted(it.halved.inner), it.emitted(it.total_of_halves.compiled))\n"
        "print(it.halved(6), it.emitted(it.halved.inner), it.emitted(it.halved.compiled))"
    )
    said = done([sys.executable, "-c", code], env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}).stdout
    assert said.splitlines() == ["6 [False] [True]", "3 [False] [True]"]


def test_what_is_merged_is_optimised_in_its_caller_and_what_need_not_be_by_itself_too(tmp_path):
    """An inline function, and a kernel that another calls: the check on one fails on the other."""
    code = (
        "from tests.common.compiled import test_library as it\n"
        "it.twice(it.EVEN, it.EVEN.copy())\n"
        "made = [it.halved.inner, it.total_of_halves.inner, it.halve.inner, it.twice.compiled]\n"
        "print([[lib.library._optimised for lib in one.overloads.values()] for one in made])"
    )
    said = done([sys.executable, "-c", code], env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}).stdout
    assert said.splitlines() == ["[[False], [True], [True], [True]]"]


def test_options_are_equal_and_hashed_as_numba_has_it():
    """Set to the default is equal to not set; another value is not: the check that must fail."""
    from numba.core.compiler import Flags

    compiler()
    plain, same, other = Flags(), Flags(), Flags()
    same.forceinline = Flags().forceinline
    other.forceinline = not Flags().forceinline
    assert (plain == same, plain == other, plain == other.copy(), other == other.copy()) == (True, False, False, True)
    assert plain != "options"
    for options in (plain, same, other):
        assert hash(options) == hash(tuple(sorted(options.values())))


def test_loops_over_threads_may_be_called_from_kernels():
    half = np.zeros(3, int)
    assert twice(EVEN, half) == 12
    assert half.tolist() == [1, 2, 3]


def test_errors_of_what_kernels_call_reach_python():
    with pytest.raises(ValueError, match="odd"):
        total_of_halves(np.array([2, 3]))


def test_kernels_from_disk_are_the_same_and_their_errors_too(tmp_path):
    code = (
        "import numpy as np\nfrom tests.common.compiled import test_library as it\n"
        "half = np.zeros(3, int)\nprint(it.twice(it.EVEN, half), half, it.halved(6))\n"
        "made = [it.twice, it.halved]\nprint([sum(one.compiled.stats.cache_misses.values()) for one in made])\n"
        "try:\n    it.total_of_halves(np.array([3]))\nexcept ValueError as error:\n    print(error)"
    )
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    said = [done([sys.executable, "-c", code], env=environment).stdout for _ in range(2)]
    first, second = (it.splitlines() for it in said)
    assert first == ["12 [1 2 3] 3", "[1, 1]", "odd"]
    assert second == ["12 [1 2 3] 3", "[0, 0]", "odd"]
    assert not list(tmp_path.glob("*.lock"))


def test_a_full_disk_fails_no_kernel(monkeypatch):
    def full(*_):
        raise OSError(28, "no space left on device")

    monkeypatch.setattr(compiler()._Files, "_save_data", full)

    def thrice(x):
        """Three times x."""
        return 3 * x

    assert kernel(thrice)(2) == 6

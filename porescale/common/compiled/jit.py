"""How functions become kernels: compiled by numba when they are first called, and not before.

numba takes longer to import than a wrong scene takes to be found wrong, so what is defined here waits for it: a
`Kernel` until it is called, and the other functions (`law_function`, `unchecked_view` …) until the first kernel is.
compiling.py does the work then, and simd_code.py for simd.py.

Kernels are compiled once and kept on disk.  numba stamps a cached kernel with its own file only, so an edited contact
law would survive inside a cached pair loop; kernels are therefore kept under a hash of all that is compiled into them,
see kernel_key.py.  An edit compiles anew the kernels that contain what was edited, and no others.
"""

import os
import sys
from collections.abc import Callable, Mapping
from functools import cached_property, update_wrapper
from importlib import import_module
from pathlib import Path
from threading import RLock
from typing import Any, TypeVar, cast

import numpy as np

from porescale.common.compiled.cache import cache_root, hash_of, keep_only_used
from porescale.common.core.errors import Fault, InputError

PACKAGES = ("porescale", "continuum_sph")


def source_hash() -> str:
    """Hash (12 hex digits) of every Python source of both packages."""
    root = Path(__file__).resolve().parents[3]
    return hash_of(root / package for package in PACKAGES)


def cache_folder_name() -> str:
    """Name of the folder for compiled kernels where none is given: one for this version of Python."""
    return f"kernels-py{sys.version_info.major}{sys.version_info.minor}"


def cache_folder() -> Path:
    """Folder for compiled kernels: ``$NUMBA_CACHE_DIR`` if set, else one in the cache's own place."""
    given = os.environ.get("NUMBA_CACHE_DIR")
    if given:
        return Path(given)
    return cache_root() / cache_folder_name()


GIVEN = bool(os.environ.get("NUMBA_CACHE_DIR"))
"""Whether the folder was named by the user, or by the process that started this one: nothing is removed from it."""
if not GIVEN:
    KERNELS = cache_folder()
    os.environ["NUMBA_CACHE_DIR"] = str(KERNELS)
    keep_only_used(KERNELS, "kernels-*")

F = TypeVar("F", bound=Callable[..., Any])

_WAITING: list[Callable[[Any], object]] = []
_LOCK = RLock()
_compiler: Any = None


def when_compiling(teach: Callable[[Any], object]) -> None:
    """Call ``teach`` with compiling.py before any kernel is compiled: at once if one may have been already."""
    with _LOCK:
        _WAITING.append(teach)
        if _compiler is not None:
            compiler()


def compiler() -> Any:
    """compiling.py, once all that waited for it is registered; numba is imported by the first call."""
    global _compiler
    with _LOCK:
        if _compiler is None:
            _compiler = import_module(f"{__package__}.compiling")
        while _WAITING:
            _WAITING.pop(0)(_compiler)
    return _compiler


class Kernel:
    """A function that is compiled when it is first called; also from within other kernels.

    py_func : the function in plain Python;  options : numba's for it;  compiled : what numba makes of it, whose
    attributes it has as well;  inner : the same for calls from other kernels.
    """

    def __init__(self, function: Callable[..., Any], options: dict[str, Any]) -> None:
        update_wrapper(self, function)
        self.py_func, self.options = function, options

    @cached_property
    def compiled(self) -> Any:
        """numba's dispatcher of the function, for calls from Python."""
        return compiler().dispatcher(self.py_func, self.options)

    @cached_property
    def inner(self) -> Any:
        """numba's dispatcher of the function, for calls from kernels."""
        return compiler().dispatcher(self.py_func, self.options, inner=True)

    @property
    def _numba_type_(self) -> Any:
        """Type of this as a name in a kernel."""
        return self.inner._numba_type_

    def __call__(self, *arguments: Any) -> Any:
        """Compile it for the types of these arguments, if that is still to be done, and run it."""
        return self.compiled(*arguments)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # special names are looked up by tools that inspect objects
            raise AttributeError(name)
        return getattr(self.compiled, name)

    def __reduce__(self) -> str:
        return cast(str, vars(self)["__qualname__"])  # copied and pickled by name, as functions are


def _decorator(**options: Any) -> Callable[[F], F]:
    """A decorator that makes a kernel with these options of numba's."""
    return lambda function: cast(Any, Kernel(function, options))


def kernel(function: F) -> F:
    """Compile a serial kernel over arrays and numbers."""
    return _decorator()(function)


def parallel_kernel(function: F) -> F:
    """Compile a kernel whose ``prange`` loops run over threads; it must give the same bits at any count."""
    return _decorator(parallel=True)(function)


def inline(function: F) -> F:
    """Compile a small function that LLVM merges into the kernels that call it."""
    return _decorator(forceinline=True)(function)


def disjoint(function: F) -> F:
    """As ``inline``, for a loop over arrays of which no two share memory; not checked.

    A compiler that is not told so compares every pair of them before each loop that it takes several entries at a time:
    a hundred comparisons where a row of grains is collided, as long as the row itself takes where it is short.
    """
    return _decorator(forceinline=True, noalias=True)(function)


def law_function(signature: F) -> Any:
    """Make an inline kernel whose body depends on the type of its last argument, the law: a NamedTuple of numbers.

    A sweep that takes a law and passes it on is compiled once for each law in use, and kept on disk, which it is not
    for functions as arguments.  ``signature`` lends name and docstring; ``@name.of(Law, ...)`` adds a body, for laws
    derived from ``Law``, too, that have none of their own.  A law must be flat: loops over threads take no tuples
    within tuples.
    """
    bodies: dict[type, Any] = {}

    def chosen(*arguments: Any) -> Any:
        """The body for the type of the last argument, on these arguments."""
        return body_for(bodies, type(arguments[-1]))(*arguments)

    def plain(*arguments: Any) -> Any:
        """The function for the given law in plain Python."""
        return body_for(bodies, type(arguments[-1])).py_func(*arguments)

    def of(*laws: type) -> Callable[[F], F]:
        """Take the decorated function as body for ``laws``; returns it compiled."""

        def add(body: F) -> F:
            """Compile ``body`` unless it is a kernel, and keep it for the laws."""
            compiled = body if hasattr(body, "py_func") else inline(body)
            bodies.update(dict.fromkeys(laws, compiled))
            return compiled

        return add

    vars(chosen).update(__name__=signature.__name__, __doc__=signature.__doc__, of=of, py_func=plain, meaning=bodies)
    when_compiling(lambda machine: machine.choose_law_function(chosen, bodies))
    return chosen


def body_for(bodies: Mapping[type, Any], law: type) -> Any:
    """The body for a type of law, or for the nearest type that it is derived from; None where there is none."""
    return next((bodies[it] for it in law.__mro__ if it in bodies), None)


def precision_constants(build: Callable[[type], Any]) -> Any:
    """Make an inline kernel of one number that returns ``build(np.float32)`` or ``build(np.float64)`` as constants.

    A float64 literal promotes a float32 kernel; what this returns for a number of the kernel's own precision does not.
    """
    constants = {32: build(np.float32), 64: build(np.float64)}

    def chosen(number: Any) -> Any:
        """The constants of the precision of ``number``."""
        return constants[8 * np.dtype(type(number)).itemsize]

    vars(chosen).update(__name__=build.__name__, __doc__=build.__doc__, meaning=constants)
    when_compiling(lambda machine: machine.choose_precision(chosen, constants))
    return chosen


def unchecked_view(array: Any, first: Any, count: Any) -> Any:
    """``count`` entries of a one-dimensional array from ``first`` on; for loops that take many short parts.

    In kernels a view that owns nothing: a slice made the usual way counts references and is cut to the array, which
    costs more than a part of a dozen entries.  Not checked: that the part lies in the array.
    """
    return array[first : first + count]


def prefetch(array: Any, at: Any) -> None:
    """Request that the entry ``at`` of a contiguous array, counted as if it were flat, be brought to the nearest cache.

    For entries that a loop reaches in an order that no hardware predicts.  Does nothing else, nor in plain Python.
    """


prange: Any = range
"""``range`` over iterations that threads share, in a `parallel_kernel`; plain `range` elsewhere."""


def thread() -> int:
    """Number, below ``most_threads()``, of the thread that runs an iteration of a prange loop: for scratch, not
    results.
    """
    return 0


def set_threads(count: int | None) -> int:
    """Use ``count`` threads (None: all cores) in parallel kernels; returns it.  InputError unless there are as many."""
    limit = most_threads()
    chosen = limit if count is None else count
    if not hasattr(chosen, "__index__") or not 1 <= chosen <= limit:
        raise InputError(Fault("--threads", count, "is out of range", allowed=f"1 to {limit}"))
    compiler().numba.set_num_threads(chosen)
    return chosen


def most_threads() -> int:
    """Most threads that parallel kernels can be given."""
    return int(vars(compiler().numba.config)["NUMBA_NUM_THREADS"])


def threads() -> int:
    """Number of threads that parallel kernels use now."""
    return int(compiler().numba.get_num_threads())

"""Machine code is made for kernels that Python calls; what they call is merged into them, and has none of its own.

numba makes every function that a kernel calls ready to be called by itself: machine code, and two functions more that
translate its arguments from Python and from C.  All three are thrown away, since the function is compiled once more as
a part of its caller.  They take a third of the time of compiling.  Here a function that a kernel calls stays what LLVM
merges into the caller: `INNER` are the options for it, and `Library` makes machine code when an address is asked for.
The machine code of kernels is the same: in every byte of eight of nine that were compared, 2 % longer in the ninth.

numba also optimises every function before it is merged, and then once more as a part of its caller.  What is merged in
any case (`inline` functions, bodies of laws, and the two functions in which numba wraps a loop over threads) is
optimised in its caller only: a fifth less to compile.  A row of a lattice, and the body of a loop over threads, are
still optimised by themselves; merged as they are, they came out with a fifteenth more instructions in the inner loop
of plain fluid.

For each call that numba types, it compares the options of functions, all 22 of them, 90 000 times for the scene of
`porescale new`: 4 % of compiling.  Here those that were set are compared first.

`use` installs it for numba's target of the processor.  It takes parts of numba that are not public.
"""

from typing import Any

from numba.core import codegen, targetconfig
from numba.core.environment import lookup_environment
from numba.core.registry import cpu_target
from numba.parfors import parfor_lowering

OUTER: dict[str, Any] = {"no_cfunc_wrapper": True}
"""Options of a kernel that Python calls: nothing calls it from C."""
INNER: dict[str, Any] = {"no_cfunc_wrapper": True, "no_cpython_wrapper": True}
"""Options of a function that kernels call."""
_ENVIRONMENT = "_ZN08NumbaEnv"
"""How names of environments begin: what a function needs of Python, such as the text of its errors."""


class Library(codegen.JITCodeLibrary):
    """Code of a function, in LLVM's form until the address of a function in it is asked for."""

    _emitted = False
    _optimised = False

    def _optimize_final_module(self) -> None:
        """Optimise a function that kernels call and that need not be merged into them; others wait for `_emit`."""
        flags = targetconfig.ConfigStack.top_or_none()
        if flags is not None and flags.no_cpython_wrapper and not flags.forceinline:
            self._optimised = True
            super()._optimize_final_module()

    def _finalize_final_module(self) -> None:
        """Ready to be merged into others; machine code only where it comes from disk."""
        if self._object_caching_enabled and self._compiled_object:
            self._optimised = True
            self._emit()
        else:
            self._finalize_dynamic_globals()
            self._verify_declare_only_symbols()
            self._finalized = True

    def _emit(self) -> None:
        """Make the machine code, and give each function that was merged into it its environment."""
        self._emitted = True
        if not self._optimised:
            self._optimised = True
            super()._optimize_final_module()
        super()._finalize_final_module()
        for it in self._final_module.global_variables:
            environment = lookup_environment(it.name) if it.name.startswith(_ENVIRONMENT) else None
            if environment is not None:
                self.codegen.set_env(it.name, environment)

    def get_pointer_to_function(self, name: str) -> int:
        """Address of a function; 0 where this library does not define it."""
        self._ensure_finalized()
        if not self._emitted and any(it.name == name for it in self.get_defined_functions()):
            self._emit()
        return int(super().get_pointer_to_function(name)) if self._emitted else 0

    def serialize_using_object_code(self) -> tuple[Any, ...]:
        """What is kept on disk: machine code if there is any, else LLVM's form."""
        self._ensure_finalized()
        kept: tuple[Any, ...] = (
            super().serialize_using_object_code() if self._emitted else self.serialize_using_bitcode()
        )
        return kept


class Codegen(codegen.JITCPUCodegen):
    """Makes such libraries."""

    _library_class = Library

    def set_env(self, env_name: str, env: Any) -> None:
        """Give a function its environment, if there is machine code that has a place for it."""
        if self._engine.is_symbol_defined(env_name):
            super().set_env(env_name, env)


_HASHES: dict[type, int] = {}
_equal_by_all = targetconfig.TargetConfig.__eq__


def _hash_of_options(options: Any) -> int:
    """numba's hash of options, which is that of their names, hence one for each class."""
    kind = type(options)
    if kind not in _HASHES:
        _HASHES[kind] = hash(tuple(sorted(kind.options)))
    return _HASHES[kind]


def _equal_options(one: Any, other: Any) -> Any:
    """Whether all options are the same; compares those that were not set only where the others differ."""
    if type(one) is type(other) and one._values == other._values:
        return True
    return _equal_by_all(one, other)


_body_of_loop = parfor_lowering._create_gufunc_for_parfor_body


def _merged_body(lowerer: Any, parfor: Any, typemap: Any, typing: Any, target: Any, flags: Any, *more: Any) -> Any:
    """numba's function for the body of a loop over threads, which the kernel alone calls."""
    for name in INNER:
        setattr(flags, name, True)
    return _body_of_loop(lowerer, parfor, typemap, typing, target, flags, *more)


def use() -> None:
    """Let all that this process compiles from now on be `Library`."""
    cpu_target.target_context.codegen().__class__ = Codegen
    parfor_lowering._create_gufunc_for_parfor_body = _merged_body
    options: Any = targetconfig.TargetConfig
    options.__hash__, options.__eq__ = _hash_of_options, _equal_options

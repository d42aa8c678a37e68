"""What numba does over and over while it compiles, and whose outcome is the same each time or is thrown away.

Four fifths of the time of compiling are numba's own Python.  `use` takes out of it, without a change to what is
compiled:

* The type of ``a + b`` for two numbers is looked for among all that ``+`` means for lists, sets, texts and arrays, and
  a text is written about each that does not fit.  Here a number's operator is looked for once (`_typed`).
* What numba makes of a function that it brings itself, such as ``max``, gets a function more, which translates
  arguments from C.  Nothing calls it.
* Each call of LLVM, each pass and each function starts and ends an event, which timers add up.  Without a listener no
  event is made, and there are no timers.
* The variables of a statement are looked for by asking of each part what class it is of, in a way that is slow for
  abstract classes; and dictionaries of texts and numbers are copied as if anything could be in them.
* scipy.linalg is imported by each process that loads a kernel, to see whether it could be.

It takes parts of numba that are not public.
"""

import copy
from contextlib import nullcontext
from importlib import import_module
from types import FunctionType, SimpleNamespace
from typing import Any

from numba.core import event, ir, lowering, types
from numba.core.types.functions import BaseFunction
from numba.core.typing import templates
from numba.np import linalg
from numba.parfors import array_analysis

_NUMBERS = frozenset(
    (types.Integer, types.Float, types.Boolean, types.Complex, types.IntegerLiteral, types.BooleanLiteral)
)
_KNOWN: dict[int, tuple[Any, dict[Any, Any]]] = {}
"""Signatures of functions, with these: not in them, for they may be written to disk."""
_typed_by_all = BaseFunction.get_call_type


def _typed(function: Any, context: Any, arguments: Any, keywords: Any) -> Any:
    """Signature of a function of numba's for these types; of numbers from memory, where it is an operation as such.

    A body in Python (`overload`) is not remembered: it depends on the options that it is compiled with.
    """
    if keywords or not all(type(it) in _NUMBERS for it in arguments):
        return _typed_by_all(function, context, arguments, keywords)
    _, known = _KNOWN.setdefault(id(function), (function, {}))
    key = (context, arguments)
    signature: Any = known.get(key)
    if signature is not None:
        function._impl_keys[signature.args] = function.typing_key
        return signature
    signature = _typed_by_all(function, context, arguments, keywords)
    if function._impl_keys[signature.args] is function.typing_key:
        known[key] = signature
    return signature


_BROUGHT: set[FunctionType] = set()
"""Functions that stand in for what Python calls otherwise; only kernels call them."""
_decorator_of = templates._OverloadFunctionTemplate._get_jit_decorator


def _jit_of_brought(template: Any) -> Any:
    """numba's decorator for such a body, which notes it."""
    decorator = _decorator_of(template)

    def prepared(**options: Any) -> Any:
        """The decorator with its options."""
        made = decorator(**options)

        def take(body: Any) -> Any:
            """The dispatcher of ``body``."""
            if options.get("no_cpython_wrapper"):
                _BROUGHT.add(body)
            return made(body)

        return take

    return prepared


_from_c = lowering.BaseLower.create_cfunc_wrapper


def _for_c(lower: Any) -> None:
    """The function that translates arguments from C, where C may call it."""
    if lower.func_ir.func_id.func not in _BROUGHT:
        _from_c(lower)


_start, _end = event.start_event, event.end_event


def _started(kind: str, data: Any = None) -> None:
    """An event begins, if anything listens."""
    if event._registered.get(kind):
        _start(kind, data)


def _ended(kind: str, data: Any = None, exc_details: Any = None) -> None:
    """An event ends, if anything listens."""
    if event._registered.get(kind):
        _end(kind, data, exc_details)


_variables_by_all = ir.Inst._rec_list_vars


def _variables(statement: Any, value: Any) -> list[Any]:
    """Variables in ``value``, a part of a statement, in the order in which they stand there."""
    found: list[Any] = []
    _gather(value, found)
    return found


_KINDS: dict[type, int] = {}
"""What a class is to `_gather`: 0 a variable, 1 a part with its own, 2 a sequence, 3 a dictionary, 4 nothing."""


def _gather(value: Any, found: list[Any]) -> None:
    """Adds the variables in ``value`` to those ``found``."""
    kind = _KINDS.get(type(value))
    if kind is None:
        classes: tuple[Any, ...] = (ir.Var, ir.Inst, (list, tuple), dict, object)
        kind = _KINDS[type(value)] = next(k for k, it in enumerate(classes) if isinstance(value, it))
    if kind == 0:
        found.append(value)
    elif kind == 1:
        found.extend(value.list_vars())
    elif kind == 2:
        for part in value:
            _gather(part, found)
    elif kind == 3:
        for part in value.values():
            _gather(part, found)


_PLAIN = (str, int, type(None))


def _copied(value: Any, memo: Any = None) -> Any:
    """A deep copy; of a dictionary of texts and numbers, or of lists of these, in one go."""
    if type(value) is dict and all(type(it) in _PLAIN for it in value):
        if all(type(it) in _PLAIN for it in value.values()):
            return dict(value)
        lists = list(value.values())
        plain = all(type(it) is list and all(type(part) in _PLAIN for part in it) for it in lists)
        if plain and len({id(it) for it in lists}) == len(lists):
            return {key: list(it) for key, it in value.items()}
    return copy.deepcopy(value, memo)


def _import_without_blas() -> None:
    """Import numba's sums over arrays, which imports scipy.linalg to see that it is there: a dependency of ours.

    A kernel that calls it would import it then.
    """
    checked = linalg.ensure_blas
    linalg.ensure_blas = lambda: None
    try:
        import_module("numba.np.arraymath")
    finally:
        linalg.ensure_blas = checked


def use() -> None:
    """Let this process compile so from now on."""
    _import_without_blas()
    vars_of: Any = {
        BaseFunction: {"get_call_type": _typed},
        templates._OverloadFunctionTemplate: {"_get_jit_decorator": _jit_of_brought},
        lowering.BaseLower: {"create_cfunc_wrapper": _for_c},
        ir.Inst: {"_rec_list_vars": _variables},
        event: {"start_event": _started, "end_event": _ended, "install_timer": lambda *_: nullcontext()},
        array_analysis: {"copy": SimpleNamespace(copy=copy.copy, deepcopy=_copied)},
    }
    for owner, parts in vars_of.items():
        for name, part in parts.items():
            setattr(owner, name, part)

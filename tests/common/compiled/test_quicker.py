"""Compiling leaves out what changes nothing of what is compiled."""

import copy
import operator

import numba
import numpy as np
import pytest
from numba.core import event, ir, lowering, types
from numba.core.registry import cpu_target
from numba.core.types.functions import BaseFunction
from numba.core.typing import templates

from porescale.common.compiled import quicker
from porescale.common.compiled.jit import compiler, kernel

compiler()


def summed(values, factor):
    """Whole and half numbers, a function of Python's and a loop: all that is typed from memory."""
    total = 0.0
    for i in range(values.shape[0]):
        total += max(values[i] * factor, 2 * i - 1) ** 2 if i % 3 else -values[i] / (1 + i)
    return total


def as_numba(monkeypatch):
    """Undoes `quicker.use`."""
    monkeypatch.setattr(BaseFunction, "get_call_type", quicker._typed_by_all)
    monkeypatch.setattr(templates._OverloadFunctionTemplate, "_get_jit_decorator", quicker._decorator_of)
    monkeypatch.setattr(lowering.BaseLower, "create_cfunc_wrapper", quicker._from_c)
    monkeypatch.setattr(ir.Inst, "_rec_list_vars", quicker._variables_by_all)
    monkeypatch.setattr(event, "start_event", quicker._start)
    monkeypatch.setattr(event, "end_event", quicker._end)


def machine_code():
    """Instructions of ``summed``, compiled anew, without names and what is kept beside them."""
    made = numba.njit(summed, no_cfunc_wrapper=True, error_model="numpy")
    made(np.ones(3), 0.5)
    (text,) = made.inspect_asm().values()
    return [line for line in text.splitlines() if line.startswith("\t") and not line.startswith("\t.")
            and "_Z" not in line and "$" not in line]  # fmt: skip


def test_machine_code_is_numbas_own(monkeypatch):
    quick = machine_code()
    as_numba(monkeypatch)
    slow = machine_code()
    assert quick == slow
    assert sum("mul" in line or "div" in line for line in quick) > 2


def test_an_operation_on_numbers_is_looked_for_once(monkeypatch):
    context = cpu_target.typing_context
    add, largest = (context.resolve_value_type(it) for it in (operator.add, max))
    numbers, pairs = (types.float64, types.float64), (types.UniTuple(types.float64, 2),) * 2
    first = add.get_call_type(context, numbers, {})
    asked, by_all = [], quicker._typed_by_all
    monkeypatch.setattr(quicker, "_typed_by_all", lambda *given: asked.append(given[2]) or by_all(*given))
    assert add.get_call_type(context, numbers, {}) is first
    assert asked == []
    for function, given in ((add, pairs), (largest, numbers), (largest, numbers)):  # no numbers; a body in Python
        function.get_call_type(context, given, {})
    assert asked[0] == pairs
    assert asked.count(numbers) >= 2


PARTS = [
    {"a": 1, "b": None}, {1: ["a", "b"], 2: ["c"]}, {"a": {1}}, {1: [[2]], 3: []}, {(1, 2): 3}, ["a"], {},
]  # fmt: skip


@pytest.mark.parametrize("value", PARTS, ids=str)
def test_copies_are_deep(value):
    made = quicker._copied(value)
    assert made == value
    assert made is not value
    for old, new in zip(value.values(), made.values(), strict=True) if isinstance(value, dict) else ():
        assert old is not new or isinstance(old, int | None)


def test_copies_share_what_was_shared():
    both = ["a"]
    made = quicker._copied({1: both, 2: both})
    assert made[1] is made[2]
    assert made[1] is not both
    assert quicker._copied(made) == copy.deepcopy(made)


def test_variables_are_found_in_numbas_order():
    place = ir.unknown_loc
    a, b, c = (ir.Var(None, name, place) for name in "abc")
    call = ir.Expr.call(a, (b, (c, 1)), {"k": c}, place)
    for it in (ir.Assign(call, b, place), call, ir.Return(c, place), ir.Assign(ir.Const(1, place), a, place)):
        own = [part.name for part in quicker._variables_by_all(it, vars(it))]
        assert [part.name for part in quicker._variables(it, vars(it))] == own
    assert [part.name for part in call.list_vars()] == ["a", "b", "c", "c"]


class Heard(event.Listener):
    """What was compiled."""

    def __init__(self):
        self.names = []

    def on_start(self, event):
        self.names.append(event.data["dispatcher"].py_func.__name__)

    def on_end(self, event):
        pass


@kernel
def one_more(x):
    """One more."""
    return x + 1


def test_who_listens_hears_what_is_compiled():
    heard = Heard()
    with event.install_listener("numba:compile", heard):
        assert numba.njit(one_more.py_func)(2) == 3
    assert heard.names == ["one_more"]

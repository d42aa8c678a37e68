"""What the functions of simd.py are in kernels: the machine's own vectors of LANES float64, and their operators."""

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.cgutils import alloca_once, for_range, for_range_slice, get_or_insert_function
from numba.core.imputils import lower_builtin, lower_cast
from numba.core.typeconv.castgraph import Conversion
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, models, overload, register_model

from porescale.common.compiled.simd import (
    LANES,
    WORDS,
    choose,
    fma,
    load,
    mask_tail,
    maximum,
    minimum,
    ramp,
    reduce_add,
    rint,
    sqrt,
    store,
    store_sorted,
    zeros,
)

NUMBER, COUNT, SHORT = ir.DoubleType(), ir.IntType(64), ir.IntType(32)
VECTOR, TWO = ir.VectorType(NUMBER, LANES), ir.VectorType(NUMBER, 2)
INLINED: Any = {"error_model": "numpy", "nogil": True, "forceinline": True}


class Lanes(types.Type):
    """Type of a vector in kernels; a number becomes one by standing in every lane."""

    def __init__(self) -> None:
        super().__init__(name=f"lanes{LANES}")

    def can_convert_from(self, _: Any, other: Any) -> Any:
        """Numbers may stand for vectors."""
        return Conversion.safe if isinstance(other, types.Float | types.Integer) else None


class _Model(models.PrimitiveModel):
    """A vector is passed on and kept as the machine's own."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, VECTOR)


lanes = Lanes()
register_model(Lanes)(_Model)


def _shuffled(builder: Any, a: Any, b: Any, places: list[int]) -> Any:
    """Entries of ``a`` and, counted on, of ``b`` at ``places``."""
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(SHORT, len(places)), places))


def _everywhere(builder: Any, value: Any) -> Any:
    """A vector with ``value`` in all lanes."""
    none = ir.Constant(ir.VectorType(value.type, LANES), ir.Undefined)
    return _shuffled(builder, builder.insert_element(none, value, SHORT(0)), none, [0] * LANES)


@lower_cast(types.Float, Lanes)
@lower_cast(types.Integer, Lanes)
def _spread(context: Any, builder: Any, kind: Any, _: Any, value: Any) -> Any:
    """A number as a vector."""
    return _everywhere(builder, context.cast(builder, value, kind, types.float64))


def _operator(keys: tuple[Callable[..., Any], ...], code: Callable[..., Any], operands: int = 2) -> None:
    """Let ``keys`` (a + b, a += b) take vectors, or vectors and numbers, by ``code`` (builder, values)."""
    for operation in keys:

        class Template(AbstractTemplate):
            """The operator on vectors, as numba sees it."""

            key: Any = operation

            def generic(self, arguments: Any, _: Any) -> Any:
                """Signature where a vector is among the arguments; None leaves them to others."""
                if len(arguments) == operands and lanes in arguments:
                    return signature(lanes, *[lanes] * operands)
                return None

        infer_global(operation)(Template)
        lower_builtin(operation, *[Lanes] * operands)(lambda context, builder, _, values: code(builder, *values))


_operator((operator.add, operator.iadd), lambda builder, a, b: builder.fadd(a, b))
_operator((operator.sub, operator.isub), lambda builder, a, b: builder.fsub(a, b))
_operator((operator.mul, operator.imul), lambda builder, a, b: builder.fmul(a, b))
_operator((operator.truediv, operator.itruediv), lambda builder, a, b: builder.fdiv(a, b))
_operator((operator.neg,), lambda builder, a: builder.fneg(a), 1)


SCALAR: dict[Any, Callable[..., Any]] = {}
"""What the functions are where no argument is a vector."""


def _function(plain: Any, code: Callable[..., Any], scalar: Any) -> None:
    """Let ``plain`` mean ``code`` (builder, values) in kernels where an argument is a vector, else ``scalar``."""
    count = plain.__code__.co_argcount

    def made(*_: Any) -> Any:
        """Signature and code for vectors alone."""
        return lanes(*[lanes] * count), lambda context, builder, _, values: code(builder, *values)

    one: Any = intrinsic(lambda typing, a: made())
    two: Any = intrinsic(lambda typing, a, b: made())
    three: Any = intrinsic(lambda typing, a, b, c: made())
    four: Any = intrinsic(lambda typing, a, b, c, d: made())

    def choose_one(a: Any) -> Any:
        """The function of one argument, by its type."""
        return (lambda a: one(a)) if a == lanes else scalar

    def choose_two(a: Any, b: Any) -> Any:
        """The function of two arguments, by their types."""
        return (lambda a, b: two(a, b)) if lanes in (a, b) else scalar

    def choose_three(a: Any, b: Any, c: Any) -> Any:
        """The function of three arguments, by their types."""
        return (lambda a, b, c: three(a, b, c)) if lanes in (a, b, c) else scalar

    def choose_four(a: Any, b: Any, c: Any, d: Any) -> Any:
        """The function of four arguments, by their types."""
        return (lambda a, b, c, d: four(a, b, c, d)) if lanes in (a, b, c, d) else scalar

    chosen: Any = {1: choose_one, 2: choose_two, 3: choose_three, 4: choose_four}
    overload(plain, strict=False, jit_options=INLINED)(chosen[count])
    SCALAR[plain] = scalar


def _by_machine(name: str) -> Callable[..., Any]:
    """Code of LLVM's function of vectors of that name."""

    def code(builder: Any, *values: Any) -> Any:
        """A call of it."""
        kind = ir.FunctionType(VECTOR, [VECTOR] * len(values))
        return builder.call(get_or_insert_function(builder.module, kind, f"llvm.{name}.v{LANES}f64"), values)

    return code


def _chosen(sign: str) -> Callable[..., Any]:
    """Code of a where ``a sign b``, else b."""
    return lambda builder, a, b: builder.select(builder.fcmp_ordered(sign, a, b), a, b)


_function(sqrt, _by_machine("sqrt"), lambda a: np.sqrt(a))
_function(rint, _by_machine("rint"), lambda a: np.rint(a))
_function(maximum, _chosen(">"), lambda a, b: a if a > b else b)
_function(minimum, _chosen("<"), lambda a, b: a if a < b else b)
_fused: Any = intrinsic(lambda typing, a, b, c: (a(a, a, a), lambda context, builder, _, values: builder.fma(*values)))
_function(fma, _by_machine("fma"), lambda a, b, c: _fused(a, b, c))
_function(
    choose,
    lambda builder, a, b, larger, other: builder.select(builder.fcmp_ordered(">", a, b), larger, other),
    lambda a, b, larger, other: larger if a > b else other,
)


def _zero(typing: Any) -> Any:
    """Signature and code of ``zeros`` in kernels."""
    return lanes(), lambda context, builder, _, values: ir.Constant(VECTOR, [0.0] * LANES)


def _steps(typing: Any) -> Any:
    """Signature and code of ``ramp`` in kernels."""
    return lanes(), lambda context, builder, _, values: ir.Constant(VECTOR, [float(k) for k in range(LANES)])


def _sum(typing: Any, a: Any) -> Any:
    """Signature and code of ``reduce_add`` in kernels."""

    def code(context: Any, builder: Any, _: Any, values: Any) -> Any:
        """Halves of the vector added until one number is left."""
        left, size = values[0], LANES
        while size > 1:
            size //= 2
            none = ir.Constant(left.type, ir.Undefined)
            parts = (list(range(size)), list(range(size, 2 * size)))
            left = builder.fadd(*(_shuffled(builder, left, none, part) for part in parts))
        return builder.extract_element(left, SHORT(0))

    return types.float64(lanes), code


def _put_line(typing: Any, line: Any, first: Any, end: Any, values: Any) -> Any:
    """Signature and code of ``store`` in kernels."""

    def code(context: Any, builder: Any, _: Any, taken: Any) -> Any:
        """One store where all lanes lie before the end, else those that do, one by one."""
        data = context.make_array(line)(context, builder, taken[0]).data
        at, values = builder.gep(data, [taken[1]]), taken[3]
        if line.dtype == types.float32:
            values = builder.fptrunc(values, ir.VectorType(ir.FloatType(), LANES))
        whole = builder.icmp_signed("<=", builder.add(taken[1], COUNT(LANES)), taken[2])
        with builder.if_else(whole) as (vector, single):
            with vector:
                builder.store(values, builder.bitcast(at, values.type.as_pointer()), align=line.dtype.bitwidth // 8)
            with single:
                for lane in range(LANES - 1):
                    inside = builder.icmp_signed("<", builder.add(taken[1], COUNT(lane)), taken[2])
                    with builder.if_then(inside):
                        one = builder.extract_element(values, SHORT(lane))
                        builder.store(one, builder.gep(at, [COUNT(lane)]))
        return context.get_dummy_value()

    return types.none(line, types.int64, types.int64, lanes), code


def _put_ascending(typing: Any, line: Any, count: Any, target: Any, first: Any) -> Any:
    """``store_sorted`` in kernels: WORDS entries at a time are compared with all."""
    vector, none = ir.VectorType(SHORT, WORDS), COUNT(0)

    def code(context: Any, builder: Any, _: Any, values: Any) -> Any:
        """The place of each entry is how many are less."""
        source, there = (context.make_array(line)(context, builder, values[at]).data for at in (0, 2))
        target, number = builder.gep(there, [values[3]]), values[1]
        less = alloca_once(builder, vector)
        with for_range_slice(builder, none, number, COUNT(WORDS), COUNT) as (block, _):
            own = builder.load(builder.bitcast(builder.gep(source, [block]), vector.as_pointer()), align=4)
            builder.store(ir.Constant(vector, [0] * WORDS), less)
            with for_range(builder, number, intp=COUNT) as loop:
                one = builder.load(builder.gep(source, [loop.index]))
                blank = ir.Constant(vector, ir.Undefined)
                every = _shuffled(builder, builder.insert_element(blank, one, SHORT(0)), blank, [0] * WORDS)
                beyond = builder.sext(builder.icmp_signed(">", own, every), vector)
                builder.store(builder.sub(builder.load(less), beyond), less)
            places = builder.bitcast(less, SHORT.as_pointer())
            rest = builder.sub(number, block)
            some = builder.select(builder.icmp_signed("<", rest, COUNT(WORDS)), rest, COUNT(WORDS))
            with for_range(builder, some, intp=COUNT) as loop:
                place = builder.sext(builder.load(builder.gep(places, [loop.index])), COUNT)
                one = builder.load(builder.gep(source, [builder.add(block, loop.index)]))
                builder.store(one, builder.gep(target, [place]))
        return context.get_dummy_value()

    return types.none(line, types.int64, target, types.int64), code


def _kept(builder: Any, values: Any, first: Any, end: Any) -> Any:
    """Instructions of ``mask_tail`` on loaded values."""
    places = ir.Constant(ir.VectorType(COUNT, LANES), list(range(LANES)))
    inside = builder.icmp_signed("<", places, _everywhere(builder, builder.sub(end, first)))
    return builder.select(inside, values, ir.Constant(VECTOR, [0.0] * LANES))


def _keep(typing: Any, a: Any, first: Any, end: Any) -> Any:
    """Signature and code of ``mask_tail`` in kernels."""
    return lanes(lanes, types.int64, types.int64), lambda context, builder, _, values: _kept(builder, *values)


def _take_line(typing: Any, line: Any, first: Any, end: Any) -> Any:
    """Signature and code of ``load`` in kernels."""

    def code(context: Any, builder: Any, _: Any, values: Any) -> Any:
        """A load, of which lanes beyond the end are zero."""
        data = context.make_array(line)(context, builder, values[0]).data
        at = builder.bitcast(builder.gep(data, [values[1]]), VECTOR.as_pointer())
        return _kept(builder, builder.load(at, align=8), values[1], values[2])

    return lanes(line, types.int64, types.int64), code


def _joined(builder: Any, parts: list[Any]) -> Any:
    """Vectors end to end."""
    while len(parts) > 1:
        places = list(range(2 * parts[0].type.count))
        parts = [_shuffled(builder, parts[k], parts[k + 1], places) for k in range(0, len(parts), 2)]
    return parts[0]


_nothing: Any = intrinsic(_zero)
_ramp: Any = intrinsic(_steps)
_total: Any = intrinsic(_sum)
_line: Any = intrinsic(_take_line)
_keeping: Any = intrinsic(_keep)
_put: Any = intrinsic(_put_line)
_ascending: Any = intrinsic(_put_ascending)


@overload(zeros, strict=False, jit_options=INLINED)
def _choose_nothing() -> Any:
    return lambda: _nothing()


@overload(ramp, strict=False, jit_options=INLINED)
def _choose_ramp() -> Any:
    return lambda: _ramp()


@overload(reduce_add, strict=False, jit_options=INLINED)
def _choose_total(a: Any) -> Any:
    return lambda a: _total(a)


@overload(load, strict=False, jit_options=INLINED)
def _choose_line(line: Any, first: Any, end: Any) -> Any:
    return lambda line, first, end: _line(line, first, end)


@overload(mask_tail, strict=False, jit_options=INLINED)
def _choose_kept(a: Any, first: Any, end: Any) -> Any:
    return lambda a, first, end: _keeping(a, first, end)


@overload(store, strict=False, jit_options=INLINED)
def _choose_put(line: Any, first: Any, end: Any, values: Any) -> Any:
    return lambda line, first, end, values: _put(line, first, end, values)


@overload(store_sorted, strict=False, jit_options=INLINED)
def _choose_ascending(line: Any, count: Any, target: Any, first: Any) -> Any:
    return lambda line, count, target, first: _ascending(line, count, target, first)


def _numbers(builder: Any, listed: Any, first: Any, end: Any, other: Any, before: Any) -> list[Any]:
    """LANES entries of the list from ``first`` on, less ``before``, and ``other`` from ``end`` on.

    All but the last ones of a row are present without a test of each.
    """

    def known(at: Any) -> Any:
        """The number listed at a place, counted from ``before``."""
        return builder.sub(builder.sext(builder.load(builder.gep(listed, [at])), COUNT), before)

    places = [builder.add(first, COUNT(lane)) for lane in range(LANES)]
    with builder.if_else(builder.icmp_signed("<", places[-1], end), likely=True) as (whole, part):
        with whole:
            found = [known(at) for at in places]
            in_whole = builder.block
        with part:
            within = [builder.icmp_signed("<", at, end) for at in places[:-1]]
            some = [
                builder.select(inside, known(builder.select(inside, at, first)), other)
                for inside, at in zip(within, places[:-1], strict=True)
            ]
            some.append(other)
            in_part = builder.block
    numbers = []
    for here, there in zip(found, some, strict=True):
        number = builder.phi(COUNT)
        number.add_incoming(here, in_whole)
        number.add_incoming(there, in_part)
        numbers.append(number)
    return numbers


def teach_rows(take: Callable[..., Any], columns: int) -> None:
    """Let ``take``, made by ``row_gatherer`` for so many columns, mean vectors in kernels."""

    def vectors(typing: Any, record: Any, row: Any, first: Any, end: Any, other: Any, column: Any, before: Any) -> Any:
        """Rows come two columns at a time and are put side by side in registers."""
        found = types.UniTuple(lanes, columns)

        def code(context: Any, builder: Any, _: Any, values: Any) -> Any:
            """A vector for each column; lanes beyond the end take the row ``other``."""
            table = context.make_array(record)(context, builder, values[0])
            width = builder.extract_value(table.shape, 1)
            listed = context.make_array(row)(context, builder, values[1]).data
            numbers = _numbers(builder, listed, values[2], values[3], values[4], values[6])
            rows = [builder.gep(table.data, [builder.add(builder.mul(at, width), values[5])]) for at in numbers]
            side_by_side = []
            for pair in range(0, columns, 2):
                where = [builder.bitcast(builder.gep(at, [COUNT(pair)]), TWO.as_pointer()) for at in rows]
                pairs = [builder.load(at, align=8) for at in where]
                even, odd = (_joined(builder, pairs[half::2]) for half in (0, 1))
                for half in (0, 1):
                    places = [place + half for lane in range(0, LANES, 2) for place in (lane, lane + LANES)]
                    side_by_side.append(_shuffled(builder, even, odd, places))
            return context.make_tuple(builder, found, side_by_side)

        return found(record, row, *[types.int64] * 5), code

    taken: Any = intrinsic(vectors)

    def choose(record: Any, row: Any, first: Any, end: Any, other: Any, column: Any = 0, before: Any = 0) -> Any:
        """``take`` in kernels: the loads of vectors."""
        return lambda record, row, first, end, other, column=0, before=0: taken(
            record, row, first, end, other, column, before
        )

    overload(take, strict=False, jit_options=INLINED)(choose)

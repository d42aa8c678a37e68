"""Lines and rows of arrays as vectors in kernels: the loads, stores and gathers of simd.py."""

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core.cgutils import alloca_once, for_range, for_range_slice
from numba.extending import intrinsic, overload

from porescale.common.compiled.simd import (
    EIGHT,
    LANES,
    WORDS,
    load,
    load_eight,
    mask_tail,
    ramp_eight,
    store,
    store_eight,
    store_sorted,
)
from porescale.common.compiled.simd_code import (
    COUNT,
    INLINED,
    NUMBER,
    SHORT,
    Lanes,
    everywhere,
    lanes,
    shuffled,
    vector_of,
)

VECTOR, TWO = ir.VectorType(NUMBER, LANES), ir.VectorType(NUMBER, 2)


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


_eights = {32: Lanes(types.float32, EIGHT), 64: Lanes(types.float64, EIGHT)}
"""Types of vectors of eight by the bits of a number."""


def _eight_at(context: Any, builder: Any, line: Any, values: Any) -> Any:
    """Where the vector of eight lies that begins with an entry;  values: of the line and of the entry's number."""
    data = context.make_array(line)(context, builder, values[0]).data
    return builder.bitcast(builder.gep(data, [values[1]]), vector_of(_eights[line.dtype.bitwidth]).as_pointer())


def _take_eight(typing: Any, line: Any, first: Any) -> Any:
    """Signature and code of ``load_eight`` in kernels."""

    def code(context: Any, builder: Any, _: Any, values: Any) -> Any:
        """One load, wherever the entry lies."""
        return builder.load(_eight_at(context, builder, line, values), align=line.dtype.bitwidth // 8)

    return _eights[line.dtype.bitwidth](line, types.int64), code


def _eight_steps(typing: Any, line: Any) -> Any:
    """Signature and code of ``ramp_eight`` in kernels."""
    kind = _eights[line.dtype.bitwidth]
    return kind(line), lambda context, builder, _, values: ir.Constant(
        vector_of(kind), [float(k) for k in range(EIGHT)]
    )


def _put_eight(typing: Any, line: Any, first: Any, values: Any) -> Any:
    """Signature and code of ``store_eight`` in kernels."""

    def code(context: Any, builder: Any, _: Any, taken: Any) -> Any:
        """One store, wherever the entry lies."""
        builder.store(taken[2], _eight_at(context, builder, line, taken), align=line.dtype.bitwidth // 8)
        return context.get_dummy_value()

    return types.none(line, types.int64, _eights[line.dtype.bitwidth]), code


_taking_eight: Any = intrinsic(_take_eight)
_putting_eight: Any = intrinsic(_put_eight)
_stepping: Any = intrinsic(_eight_steps)


@overload(load_eight, strict=False, jit_options=INLINED)
def _choose_taking_eight(line: Any, first: Any) -> Any:
    return lambda line, first: _taking_eight(line, first)


@overload(ramp_eight, strict=False, jit_options=INLINED)
def _choose_stepping(line: Any) -> Any:
    return lambda line: _stepping(line)


@overload(store_eight, strict=False, jit_options=INLINED)
def _choose_putting_eight(line: Any, first: Any, values: Any) -> Any:
    return lambda line, first, values: _putting_eight(line, first, values)


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
                every = shuffled(builder, builder.insert_element(blank, one, SHORT(0)), blank, [0] * WORDS)
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
    inside = builder.icmp_signed("<", places, everywhere(builder, builder.sub(end, first)))
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
        parts = [shuffled(builder, parts[k], parts[k + 1], places) for k in range(0, len(parts), 2)]
    return parts[0]


_line: Any = intrinsic(_take_line)
_keeping: Any = intrinsic(_keep)
_put: Any = intrinsic(_put_line)
_ascending: Any = intrinsic(_put_ascending)


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
                    side_by_side.append(shuffled(builder, even, odd, places))
            return context.make_tuple(builder, found, side_by_side)

        return found(record, row, *[types.int64] * 5), code

    taken: Any = intrinsic(vectors)

    def choose(record: Any, row: Any, first: Any, end: Any, other: Any, column: Any = 0, before: Any = 0) -> Any:
        """``take`` in kernels: the loads of vectors."""
        return lambda record, row, first, end, other, column=0, before=0: taken(
            record, row, first, end, other, column, before
        )

    overload(take, strict=False, jit_options=INLINED)(choose)

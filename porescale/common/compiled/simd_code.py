"""What the functions of simd.py are in kernels: the machine's own vectors of LANES float64, and their operators."""

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.cgutils import get_or_insert_function
from numba.core.imputils import lower_builtin, lower_cast
from numba.core.typeconv.castgraph import Conversion
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, models, overload, register_model

from porescale.common.compiled.simd import (
    LANES,
    choose,
    fma,
    maximum,
    minimum,
    ramp,
    reduce_add,
    rint,
    sqrt,
    zeros,
)

NUMBER, COUNT, SHORT = ir.DoubleType(), ir.IntType(64), ir.IntType(32)
VECTOR, TWO = ir.VectorType(NUMBER, LANES), ir.VectorType(NUMBER, 2)
INLINED: Any = {"error_model": "numpy", "nogil": True, "forceinline": True}


class Lanes(types.Type):
    """Type of a vector of ``count`` numbers of a precision in kernels; a number becomes one by standing in every
    lane."""

    def __init__(self, real: Any, count: int) -> None:
        super().__init__(name=f"lanes{count}x{real}")
        self.real, self.count = real, count

    def can_convert_from(self, _: Any, other: Any) -> Any:
        """Numbers may stand for vectors."""
        return Conversion.safe if isinstance(other, types.Float | types.Integer) else None


class _Model(models.PrimitiveModel):
    """A vector is passed on and kept as the machine's own."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, vector_of(kind))


def vector_of(kind: Lanes) -> Any:
    """The machine's own type of a vector."""
    return ir.VectorType(ir.FloatType() if kind.real == types.float32 else NUMBER, kind.count)


def among(arguments: Any) -> Any:
    """The type of the vectors among types of arguments; None where there is none."""
    return next((it for it in arguments if isinstance(it, Lanes)), None)


lanes = Lanes(types.float64, LANES)
register_model(Lanes)(_Model)


def shuffled(builder: Any, a: Any, b: Any, places: list[int]) -> Any:
    """Entries of ``a`` and, counted on, of ``b`` at ``places``."""
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(SHORT, len(places)), places))


def everywhere(builder: Any, value: Any, count: int = LANES) -> Any:
    """A vector with ``value`` in all lanes."""
    none = ir.Constant(ir.VectorType(value.type, count), ir.Undefined)
    return shuffled(builder, builder.insert_element(none, value, SHORT(0)), none, [0] * count)


@lower_cast(types.Float, Lanes)
@lower_cast(types.Integer, Lanes)
def _spread(context: Any, builder: Any, kind: Any, vector: Any, value: Any) -> Any:
    """A number as a vector."""
    return everywhere(builder, context.cast(builder, value, kind, vector.real), vector.count)


def _operator(keys: tuple[Callable[..., Any], ...], code: Callable[..., Any], operands: int = 2) -> None:
    """Let ``keys`` (a + b, a += b) take vectors, or vectors and numbers, by ``code`` (builder, values)."""
    for operation in keys:

        class Template(AbstractTemplate):
            """The operator on vectors, as numba sees it."""

            key: Any = operation

            def generic(self, arguments: Any, _: Any) -> Any:
                """Signature where a vector is among the arguments; None leaves them to others."""
                kind = among(arguments)
                return signature(kind, *[kind] * operands) if kind and len(arguments) == operands else None

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

    def made(*kinds: Any) -> Any:
        """Signature and code for vectors alone."""
        kind = among(kinds)
        return kind(*[kind] * count), lambda context, builder, _, values: code(builder, *values)

    one: Any = intrinsic(lambda typing, a: made(a))
    two: Any = intrinsic(lambda typing, a, b: made(a, b))
    three: Any = intrinsic(lambda typing, a, b, c: made(a, b, c))
    four: Any = intrinsic(lambda typing, a, b, c, d: made(a, b, c, d))

    def choose_one(a: Any) -> Any:
        """The function of one argument, by its type."""
        return (lambda a: one(a)) if among((a,)) else scalar

    def choose_two(a: Any, b: Any) -> Any:
        """The function of two arguments, by their types."""
        return (lambda a, b: two(a, b)) if among((a, b)) else scalar

    def choose_three(a: Any, b: Any, c: Any) -> Any:
        """The function of three arguments, by their types."""
        return (lambda a, b, c: three(a, b, c)) if among((a, b, c)) else scalar

    def choose_four(a: Any, b: Any, c: Any, d: Any) -> Any:
        """The function of four arguments, by their types."""
        return (lambda a, b, c, d: four(a, b, c, d)) if among((a, b, c, d)) else scalar

    chosen: Any = {1: choose_one, 2: choose_two, 3: choose_three, 4: choose_four}
    overload(plain, strict=False, jit_options=INLINED)(chosen[count])
    SCALAR[plain] = scalar


def _by_machine(name: str) -> Callable[..., Any]:
    """Code of LLVM's function of vectors of that name."""

    def code(builder: Any, *values: Any) -> Any:
        """A call of it."""
        vector = values[0].type
        kind, bits = ir.FunctionType(vector, [vector] * len(values)), 64 if vector.element == NUMBER else 32
        return builder.call(get_or_insert_function(builder.module, kind, f"llvm.{name}.v{vector.count}f{bits}"), values)

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
        left, size = values[0], a.count
        while size > 1:
            size //= 2
            none = ir.Constant(left.type, ir.Undefined)
            parts = (list(range(size)), list(range(size, 2 * size)))
            left = builder.fadd(*(shuffled(builder, left, none, part) for part in parts))
        return builder.extract_element(left, SHORT(0))

    return a.real(a), code


_nothing: Any = intrinsic(_zero)
_ramp: Any = intrinsic(_steps)
_total: Any = intrinsic(_sum)


@overload(zeros, strict=False, jit_options=INLINED)
def _choose_nothing() -> Any:
    return lambda: _nothing()


@overload(ramp, strict=False, jit_options=INLINED)
def _choose_ramp() -> Any:
    return lambda: _ramp()


@overload(reduce_add, strict=False, jit_options=INLINED)
def _choose_total(a: Any) -> Any:
    return lambda a: _total(a)

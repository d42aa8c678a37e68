"""What every collision operator provides, and what all of them share.

An operator is one file of this folder.  It holds

  - its law: a flat NamedTuple of numbers whose first fields are ``rate`` (1/tau), ``fx`` and ``fy`` (body force
    density), lattice units, in the dtype of the populations;
  - bodies for that law of the four functions of ``CollisionLaw``, each a kernel:  ``@collide.of(MyLaw)``;
  - its row in the register, ``OPERATOR = Operator(...)``, which choose.py finds (entry.py).

Kernels take the law as their last argument and are compiled once for each law in use.  Numbers of a kernel come from
``numbers``, or they would promote single precision.  Directions in opposite pairs and shifted populations: lattice.py.
"""

from typing import Any, NamedTuple, Protocol

import numpy as np

from porescale.common.compiled.jit import disjoint, inline, law_function, precision_constants, unchecked_view


class Macroscopic(NamedTuple):
    """Of a cell: density excess d = rho - 1, momentum j with half the force that acts here, velocity u = j/rho."""

    d: np.floating
    jx: np.floating
    jy: np.floating
    ux: np.floating
    uy: np.floating


class Partial(NamedTuple):
    """What is left of a collision in a cell that is partly solid, see ``CollisionLaw.collide_partial``."""

    plus: np.floating
    minus: np.floating
    kept: np.floating
    px: np.floating
    py: np.floating


class CollisionLaw(Protocol):
    """The contract of a law of collision: four functions of one cell, compiled into the sweeps of stream.py.

    f: the nine shifted populations of the cell, a tuple;  m: its ``Macroscopic``.  The symmetric and antisymmetric
    halves of a pair are f+ = (f_i + f_-i)/2 and f- = (f_i - f_-i)/2.  Mass must be conserved and momentum must change
    by the force.
    """

    rate: np.floating
    fx: np.floating
    fy: np.floating

    @staticmethod
    def half_force(law: Any) -> Any:
        """Half the body force density: (hx, hy).  ``half_of_force`` serves every law."""

    @staticmethod
    def shear_rate(f: Any, m: Any, law: Any) -> Any:
        """Rate at which the shear stress of this cell relaxes: 1/tau (``molecular_rate``), less with an eddy viscosity
        (``eddy_version``)."""

    @staticmethod
    def collide(f: Any, m: Any, rate: Any, law: Any) -> Any:
        """The nine collided populations of a cell, body force included;  rate: ``shear_rate``."""

    @staticmethod
    def collide_partial(f: Any, m: Any, rate: Any, part: Any, law: Any) -> Any:
        """A share of the collision, in a cell that is partly solid:  (1 - plus) f+ + plus g+  and
        kept f- + minus g- + 3 w c.p,  with g of ``collide``;  part: ``Partial``.

        ``collide_then_add`` serves every law.
        """


@law_function
def row_law(y, law):
    """The law in row ``y``, from 0: other than ``law`` itself where the force differs from cell to cell (field.py)."""


@law_function
def part_law(first, last, law):
    """That of a row in its cells ``first`` to ``last`` - 1."""


@law_function
def cell_law(x, law):
    """That of a part in its cell ``x``."""


@row_law.of(object)
def _same_row(y, law):
    """The law as it is: all rows of the lattice have one."""
    return law


@part_law.of(object)
def _same_part(first, last, law):
    """The law as it is: all parts of a row have one."""
    return law


@cell_law.of(object)
def _same_cell(x, law):
    """The law as it is: all cells of a part have one."""
    return law


half_force = law_function(CollisionLaw.half_force)
shear_rate = law_function(CollisionLaw.shear_rate)
collide = law_function(CollisionLaw.collide)
collide_partial = law_function(CollisionLaw.collide_partial)


class Numbers(NamedTuple):
    """Weights of rest, sides and diagonals, and the numbers that kernels need, in one precision."""

    w0: np.floating
    w1: np.floating
    w2: np.floating
    zero: np.floating
    quarter: np.floating
    half: np.floating
    one: np.floating
    c15: np.floating
    two: np.floating
    three: np.floating
    c45: np.floating
    nine: np.floating
    c34: np.floating
    c38: np.floating


@precision_constants
def numbers(real: type) -> Numbers:
    """``Numbers`` in the precision of a number."""
    return Numbers(*(real(v) for v in (4 / 9, 1 / 9, 1 / 36, 0, 0.25, 0.5, 1, 1.5, 2, 3, 4.5, 9, 0.75, 0.375)))


@inline
def moments(f):
    """Density excess and first moment of nine shifted populations: (d, jx, jy)."""
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = f
    d = f0 + ((f1 + f2) + (f3 + f4)) + ((f5 + f6) + (f7 + f8))
    d5 = f5 - f6
    d7 = f7 - f8
    return d, (f1 - f2) + (d5 - d7), (f3 - f4) + (d5 + d7)


@inline
def stress(f, m):
    """Non-equilibrium part of the second moments: (xx, yy, xy)."""
    _, f1, f2, f3, f4, f5, f6, f7, f8 = f
    c = numbers(m.d)
    third = c.one / c.three * m.d
    diagonal = (f5 + f6) + (f7 + f8)
    return (
        f1 + f2 + diagonal - third - m.jx * m.ux,
        f3 + f4 + diagonal - third - m.jy * m.uy,
        (f5 + f6) - (f7 + f8) - m.jx * m.uy,
    )


@inline
def half_of_force(law):
    """``half_force`` of a law that may have one."""
    half = numbers(law.rate).half
    return half * law.fx, half * law.fy


@inline
def molecular_rate(f, m, law):
    """``shear_rate`` of the molecular viscosity, the same everywhere."""
    return law.rate


@inline
def add_partial(f, g, part):
    """``collide_partial`` from the populations f before and g after any collision."""
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = f
    g0, g1, g2, g3, g4, g5, g6, g7, g8 = g
    c = numbers(f0)
    half, px, py = c.half, part.px, part.py
    ea, eb, oa, ob = half * (c.one - part.plus), half * part.plus, half * part.kept, half * part.minus
    t1, t2 = c.three * c.w1, c.three * c.w2
    q1, m1 = ea * (f1 + f2) + eb * (g1 + g2), oa * (f1 - f2) + ob * (g1 - g2) + t1 * px
    q3, m3 = ea * (f3 + f4) + eb * (g3 + g4), oa * (f3 - f4) + ob * (g3 - g4) + t1 * py
    q5, m5 = ea * (f5 + f6) + eb * (g5 + g6), oa * (f5 - f6) + ob * (g5 - g6) + t2 * (px + py)
    q7, m7 = ea * (f7 + f8) + eb * (g7 + g8), oa * (f7 - f8) + ob * (g7 - g8) + t2 * (py - px)
    rest = (c.one - part.plus) * f0 + part.plus * g0
    return rest, q1 + m1, q1 - m1, q3 + m3, q3 - m3, q5 + m5, q5 - m5, q7 + m7, q7 - m7


@inline
def collide_then_add(f, m, rate, part, law):
    """``collide_partial`` for any operator."""
    return add_partial(f, collide(f, m, rate, law), part)


@inline
def cut(planes, first, n):
    """Entries ``first`` to ``first + n - 1`` of nine rows: an index that might be negative keeps a loop from being
    vectorised."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = planes
    return (
        unchecked_view(a0, first, n),
        unchecked_view(a1, first, n),
        unchecked_view(a2, first, n),
        unchecked_view(a3, first, n),
        unchecked_view(a4, first, n),
        unchecked_view(a5, first, n),
        unchecked_view(a6, first, n),
        unchecked_view(a7, first, n),
        unchecked_view(a8, first, n),
    )


@disjoint
def collide_cells(planes, laws):
    """Collide all cells of nine slots (n,), overwritten as in ``collide_row``;  laws: of ``part_law``."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = planes
    for x in range(a0.shape[0]):
        law = cell_law(x, laws)
        c = numbers(law.rate)
        hx, hy = half_force(law)
        f = (a0[x], a1[x], a2[x], a3[x], a4[x], a5[x], a6[x], a7[x], a8[x])
        d, jx, jy = moments(f)
        jx += hx
        jy += hy
        specific_volume = c.one / (c.one + d)
        m = Macroscopic(d, jx, jy, jx * specific_volume, jy * specific_volume)
        g0, g1, g2, g3, g4, g5, g6, g7, g8 = collide(f, m, shear_rate(f, m, law), law)
        a0[x], a2[x], a1[x], a4[x], a3[x] = g0, g1, g2, g3, g4
        a6[x], a5[x], a8[x], a7[x] = g5, g6, g7, g8


@inline
def collide_row(planes, first, last, law):
    """Collide cells ``first`` to ``last`` - 1 of one row; overwrites its nine slots.

    planes: nine arrays (nx,), the slots where the row's h_i are read; the collided h_i goes to the slot of the opposite
    direction.  Not checked: that density stays positive.
    """
    collide_cells(cut(planes, first, last - first), part_law(first, last, law))

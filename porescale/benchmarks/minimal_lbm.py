"""The smallest lattice that does the job of water alone: one array, one loop, two rates, walls; nothing is chosen.

It is what `study parts` holds a scene of water against: in place as in `lattice.py`, TRT (Ginzburg, Verhaeghe &
d'Humieres 2008) without a body force, half-way bounce-back at all four sides.
"""

import numpy as np

from porescale.common.compiled.jit import inline, kernel, parallel_kernel, prange
from porescale.common.core.types import Reals
from porescale.lbm.lattice import CX, CY, OPPOSITE, padded_populations


@inline
def slots_of(f, n, y, parity):
    """Nine views (n,) of row ``y`` (1 to ny) of f (9, ny + 2, n + 2 or more) for a step of ``parity``: lattice.py."""
    if parity:
        a0, a1, a2 = f[0, y, 1 : n + 1], f[2, y, 0:n], f[1, y, 2 : n + 2]
        a3, a4 = f[4, y - 1, 1 : n + 1], f[3, y + 1, 1 : n + 1]
        a5, a6 = f[6, y - 1, 0:n], f[5, y + 1, 2 : n + 2]
        a7, a8 = f[8, y - 1, 2 : n + 2], f[7, y + 1, 0:n]
    else:
        a0, a1, a2 = f[0, y, 1 : n + 1], f[1, y, 1 : n + 1], f[2, y, 1 : n + 1]
        a3, a4 = f[3, y, 1 : n + 1], f[4, y, 1 : n + 1]
        a5, a6 = f[5, y, 1 : n + 1], f[6, y, 1 : n + 1]
        a7, a8 = f[7, y, 1 : n + 1], f[8, y, 1 : n + 1]
    return a0, a1, a2, a3, a4, a5, a6, a7, a8


@inline
def plain_cells(slots, even, odd):
    """Collide and stream cells by their nine ``slots`` (n,), which are overwritten; ``even``, ``odd`` rates."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = slots
    for x in range(a0.shape[0]):
        f0, f1, f2, f3, f4, f5, f6, f7, f8 = a0[x], a1[x], a2[x], a3[x], a4[x], a5[x], a6[x], a7[x], a8[x]
        d = f0 + ((f1 + f2) + (f3 + f4)) + ((f5 + f6) + (f7 + f8))
        jx, jy = (f1 - f2) + ((f5 - f6) - (f7 - f8)), (f3 - f4) + ((f5 - f6) + (f7 - f8))
        lightness = 1.0 / (1.0 + d)
        xx, yy, xy = 4.5 * jx * jx * lightness, 4.5 * jy * jy * lightness, 9.0 * jx * jy * lightness
        rest = d - (xx + yy) / 3.0
        side, diagonal = 1.0 / 9.0, 1.0 / 36.0
        ox, oy = 3.0 * odd * jx, 3.0 * odd * jy
        a0[x] = f0 + even * (4.0 / 9.0 * rest - f0)
        p, m = even * (side * (rest + xx) - 0.5 * (f1 + f2)), side * ox - 0.5 * odd * (f1 - f2)
        a2[x], a1[x] = f1 + p + m, f2 + p - m
        p, m = even * (side * (rest + yy) - 0.5 * (f3 + f4)), side * oy - 0.5 * odd * (f3 - f4)
        a4[x], a3[x] = f3 + p + m, f4 + p - m
        both = rest + xx + yy
        p, m = even * (diagonal * (both + xy) - 0.5 * (f5 + f6)), diagonal * (ox + oy) - 0.5 * odd * (f5 - f6)
        a6[x], a5[x] = f5 + p + m, f6 + p - m
        p, m = even * (diagonal * (both - xy) - 0.5 * (f7 + f8)), diagonal * (oy - ox) - 0.5 * odd * (f7 - f8)
        a8[x], a7[x] = f7 + p + m, f8 + p - m


@parallel_kernel
def plain_step(f, n, parity, even, odd):
    """Collide and stream all cells of n a row: overwrites f (9, ny + 2, n + 2 or more), shifted populations; ``even``,
    ``odd`` rates."""
    for y in prange(1, f.shape[1] - 1):
        plain_cells(slots_of(f, n, y, parity), even, odd)


@kernel
def largest_of_rows(f, row, largest):
    """Overwrites ``largest`` (ny,): the largest size of the shifted populations f (9, ny + 2, nx + 2 or more) of each
    row, 0 where all is at rest, and ``row`` (nx,).  NaNs are not seen."""
    for y in range(largest.shape[0]):
        row[:] = 0.0
        for i in range(f.shape[0]):
            slot = f[i, y + 1, 1 : row.shape[0] + 1]
            for x in range(row.shape[0]):
                size = abs(slot[x])
                row[x] = size if size > row[x] else row[x]
        most = 0.0
        for x in range(row.shape[0]):
            most = max(most, row[x])
        largest[y] = most


@kernel
def copy_links(flat, source, target):
    """flat[target] = flat[source]: bounce-back of every link through a side."""
    for k in range(source.shape[0]):
        flat[target[k]] = flat[source[k]]


class PlainWater:
    """A closed box of water of nx by ny cells, from the populations (9, ny + 2, nx + 2) of another before step 0."""

    def __init__(self, populations: Reals, relaxation_time: float, magic: float = 3 / 16) -> None:
        _, high, wide = populations.shape
        self.nx, self.step = wide - 2, 0
        self.padded = padded_populations(wide - 2, high - 2, populations.dtype)
        self.populations = self.padded[:, :, :wide]
        self.populations[...] = populations
        self.even = 1.0 / relaxation_time
        self.odd = 1.0 / (0.5 + magic / (relaxation_time - 0.5))
        links = [
            (i, y, x, y + CY[i], x + CX[i])
            for i in range(1, 9) for y in range(1, high - 1) for x in range(1, wide - 1)
            if not (0 < y + CY[i] < high - 1 and 0 < x + CX[i] < wide - 1)
        ]  # fmt: skip
        at = np.array(links)
        out = (at[:, 0], at[:, 3], at[:, 4])
        back = (OPPOSITE[at[:, 0]], at[:, 1], at[:, 2])
        self.halo = np.ravel_multi_index(out, self.padded.shape)
        self.inner = np.ravel_multi_index(back, self.padded.shape)
        self._flat = self.padded.reshape(-1)

    def advance(self, steps: int) -> None:
        """Advance the water by ``steps`` steps."""
        for _ in range(steps):
            plain_step(self.padded, self.nx, self.step % 2, self.even, self.odd)
            self.close()

    def close(self) -> None:
        """Bounce-back after the cells of a step, which is then done."""
        if self.step % 2:
            copy_links(self._flat, self.halo, self.inner)
        else:
            copy_links(self._flat, self.inner, self.halo)
        self.step += 1

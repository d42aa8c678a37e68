"""One thread for a cell or a link: each passes the one entry that is its own to the function that the CPU compiles.

The in-place pattern is kept on the device (lattice.py): half the memory of two arrays and no more traffic, and a cell
reads and writes the same nine slots, so that no order of threads can matter.  Neighbouring threads take neighbouring
cells of a row, whose populations lie side by side in each of the nine planes.

Plain functions: ``device_kernel`` of common/compiled/cuda.py compiles them for a law and a precision.
"""

from typing import Any

from porescale.common.compiled.cuda import grid
from porescale.lbm.boundary.links import pass_one
from porescale.lbm.boundary.pressure import let_in
from porescale.lbm.boundary.thin_plate import exchange
from porescale.lbm.collision.law import collide_row
from porescale.lbm.stream import slots


def sweep_cells(f: Any, n: Any, parity: Any, law: Any) -> None:
    """``sweep`` of stream.py: overwrites padded populations f, of n cells a row;  threads: n ny or more."""
    k = grid()
    if k < n * (f.shape[1] - 2):
        x = k % n
        collide_row(slots(f, n, k // n + 1, parity), x, x + 1, law)


def pass_on_links(flat: Any, of: Any, to: Any, added: Any) -> None:
    """``pass_on`` of boundary/links.py: overwrites flat populations at ``to``;  threads: one a link or more."""
    k = grid()
    if k < to.shape[0]:
        pass_one(flat, of, to, added, k)


def let_in_links(
    flat: Any, slots_of: Any, to: Any, source: Any, along: Any, weight: Any, excess: Any, force: Any
) -> None:
    """``let_in`` of boundary/pressure.py: overwrites flat populations at ``to``;  threads: one a link or more."""
    k = grid()
    if k < to.shape[0]:
        a, b = k, k + 1
        let_in(flat, slots_of[a:b], to[a:b], source[a:b], along[a:b], weight[a:b], excess[a:b], force[:, a:b])


def exchange_links(flat: Any, first: Any, second: Any, pull: Any, begin: Any, speed: Any) -> None:
    """``exchange`` of boundary/thin_plate.py: overwrites flat populations at the slots of links ``begin`` and up;
    threads: one a link or more."""
    k = grid()
    if begin <= k < first.shape[0]:
        exchange(flat, first[k : k + 1], second[k : k + 1], pull[k : k + 1], 0, speed)

"""Seepage around a pile of given thickness in ground of given width, by finite volumes: a few slow lines.

Heads in the middles of square cells, Σ (h_j - h_i) = 0 over open faces; base, sides and pile are closed, the surface
has the head 1 on the left of the pile and 0 on its right, half a cell from the topmost middles.  The ground is 1 deep.
"""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve


def heads(cells: int, beside: int, thick: int, deep: int):
    """h (cells, columns), row 0 lowest, nan in the pile: ``cells`` over the depth, ``beside`` on either side of a pile
    ``thick`` by ``deep``, a sheet if it is not thick."""
    columns = 2 * beside + thick
    pile = np.zeros((cells, columns), bool)
    pile[cells - deep :, beside : beside + thick] = True
    number = np.full((cells, columns), -1)
    number[~pile] = np.arange((~pile).sum())
    count = int((~pile).sum())
    rows, others = [], []
    for one, other in ((number[:, :-1], number[:, 1:]), (number[:-1], number[1:])):
        open_ = (one >= 0) & (other >= 0)
        if thick == 0 and one.shape[1] < columns:
            open_[cells - deep :, beside - 1] = False
        rows += [one[open_], other[open_]]
        others += [other[open_], one[open_]]
    row, column = np.concatenate(rows), np.concatenate(others)
    diagonal, right = np.bincount(row, minlength=count).astype(float), np.zeros(count)
    diagonal[number[-1, :beside]] += 2.0
    diagonal[number[-1, -beside:]] += 2.0
    right[number[-1, :beside]] = 2.0
    at = np.arange(count)
    matrix = coo_matrix(
        (np.concatenate((-np.ones(len(row)), diagonal)), (np.concatenate((row, at)), np.concatenate((column, at))))
    )
    h = np.full((cells, columns), np.nan)
    h[~pile] = spsolve(matrix.tocsc(), right)
    return h


def thick(share: float, rows: int, reach: float, finer: int, short: int):
    """(q/(k h), i_E T/h) of a pile one row thick that ends ``short`` cells above ``share``, ``finer`` cells a row,
    without the cells' own error but for its square: of ``finer`` and twice as many."""
    found = []
    for more in (1, 2):
        cells, beside = rows * finer * more, round(reach * rows) * finer * more
        h = heads(cells, beside, finer * more, round(share * rows) * finer * more - short * more)
        found.append((2.0 * float(h[-1, -beside:].sum()), 2.0 * float(h[-1, -beside]) * cells))
    return 2.0 * np.array(found[1]) - np.array(found[0])


def bounds(share: float, reach: float, cells: int):
    """h/(i_c s) at which Terzaghi's prism, s/2 wide, has lost its weight, and at which the gradient at the pile's exit
    is i_c;  a sheet without thickness, sides 1 : ``reach`` of the depth;  linear in the size of cells, of 1 : 2."""
    found = []
    for count in (cells, 2 * cells):
        h = heads(count, round(reach * count), 0, round(share * count))
        base, wide = count - round(share * count), round(0.5 * share * count)
        half = h.shape[1] // 2
        under = 0.5 * (h[base, half : half + wide] + h[base - 1, half : half + wide]).mean()
        found.append((1.0 / under, 1.0 / (2.0 * h[-1, half] * count * share)))
    return 2.0 * np.array(found[1]) - np.array(found[0])


def weakest_prism(share: float, reach: float, cells: int, friction: float = 30.0):
    """(h/(i_c s), width over s) of the prism by a sheet down to its tip that first has lost its weight and the friction
    along its outer face, of soil that presses there no harder than yield lets it, K_a = (1 - sin φ)/(1 + sin φ), over
    all widths up to s (the way of Tanaka & Verruijt 1999);  friction : φ, degrees.

    The pile is smooth; the upright stress beside the prism is i_c y - h(y), y the depth, and not below nothing.
    """
    h = heads(cells, round(reach * cells), 0, round(share * cells))
    deep, half = round(share * cells), h.shape[1] // 2
    base = cells - deep
    sine, y = np.sin(np.radians(friction)), np.arange(deep) + 0.5
    rubbing = (1.0 - sine) / (1.0 + sine) * np.tan(np.radians(friction))
    under = 0.5 * (h[base, half:] + h[base - 1, half:])
    found = []
    for wide in range(1, deep + 1):
        beside = 0.5 * (h[base:, half + wide - 1] + h[base:, half + wide])[::-1]
        lift, low, high = under[:wide].sum() * cells, 0.0, 10.0 * share  # head over i_c
        for _ in range(50):
            head = 0.5 * (low + high)
            held = wide * deep + rubbing * np.maximum(0.0, y - head * cells * beside).sum()
            low, high = (low, head) if head * lift > held else (head, high)
        found.append((low / share, wide / deep))
    return min(found)

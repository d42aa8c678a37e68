"""Steady flow through a square of ground between part of one side and all of the opposite one."""

import numpy as np
from scipy.sparse import coo_array, dia_array
from scipy.sparse.linalg import spsolve


def discharge(share: float, cells: int = 100) -> float:
    """Flow over k h through a square from the lower ``share`` of its left side to all of its right one, by finite
    volumes; with 100 cells 0.3 % low."""
    number, low = np.arange(cells * cells).reshape(cells, cells), int(share * cells)
    pairs = np.concatenate([np.column_stack((number[:, :-1].ravel(), number[:, 1:].ravel())),
                            np.column_stack((number[:-1].ravel(), number[1:].ravel()))])  # fmt: skip
    one, other = pairs.T
    given = np.concatenate((number[:low, 0], number[:, -1]))  # half a cell from a side of given head
    diagonal = np.bincount(pairs.ravel(), minlength=cells * cells) + 2.0 * np.bincount(given, minlength=cells * cells)
    off = coo_array((-np.ones(len(pairs)), (one, other)), shape=(cells * cells,) * 2)
    right = np.zeros(cells * cells)
    right[number[:low, 0]] = 2.0
    head = spsolve((off + off.T + dia_array((diagonal[None], [0]), shape=off.shape)).tocsr(), right)
    return 2.0 * float(head[number[:, -1]].sum())

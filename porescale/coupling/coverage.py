"""How much of each cell every disc covers, exactly, and the velocity of the solid there.

The area of a disc of radius r inside the corner rectangle [0, a] x [0, b] (a, b >= 0, clamped to r) is

    K(a, b) = a b                                if a² + b² <= r²
            = G(a) + G(b) - pi r²/4              otherwise,     G(a) = (a sqrt(r² - a²) + r² asin(a/r)) / 2

odd in a and in b.  A cell is four such terms, and G belongs to a grid line, not to a cell: a disc d cells wide
needs 2 (d + 2) of them.  Derived from G being the area under the quarter circle up to a.

Each disc fills its own patch of fractions (``cover``); a list of the discs in every row (``list_rows``), in index order
so that sums do not depend on threads, lets a row be laid out (``lay_row``) whenever it is needed.
"""

import math

from porescale.ground.jit import inline, kernel, parallel_kernel, prange


@inline
def quarter_area(a, r):
    """G(a): area under the quarter circle of radius r from 0 to a, 0 <= a <= r.

    The angle comes from both legs: asin(a/r) loses half the digits of a disc that just touches a grid line.
    """
    h = math.sqrt((r - a) * (r + a))
    return 0.5 * (a * h + r * r * math.atan2(a, h))


@inline
def corner_area(a, b, ga, gb, r):
    """K(a, b) for signed a, b already clamped to [-r, r], with ga = G(|a|), gb = G(|b|)."""
    if a * a + b * b <= r * r:
        return a * b
    return math.copysign(ga + gb - 0.25 * math.pi * r * r, a * b)


@inline
def line_areas(first, count, centre, r, signed, area):
    """Distances of ``count`` grid lines from ``first`` on to the centre, clamped to [-r, r], and G of each.

    Overwrites signed and area (count,).
    """
    for i in range(count):
        a = min(max(first + i - centre, -r), r)
        signed[i] = a
        area[i] = quarter_area(abs(a), r)


@inline
def chord(below, above, r):
    """Half the longest and half the shortest chord of the disc between two lines; -1 where there is none."""
    near = 0.0 if below < 0.0 < above else min(abs(below), abs(above))
    far = max(abs(below), abs(above))
    longest = math.sqrt((r - near) * (r + near)) if near < r else -1.0
    shortest = math.sqrt((r - far) * (r + far)) if far < r else -1.0
    return longest, shortest


@parallel_kernel
def cover(centre, radius, patch_start, patch_width, patch, corner, reach, lines):
    """Exact solid fractions of the cells around every disc.

    centre (n, 2), radius (n,): cells;  patch_start (n,), patch_width (n,): where in ``patch`` a disc's width² fractions
    lie;  lines (n, 4, largest width + 1): scratch.  Overwrites patch; corner (n, 2), the cell (x, y) at the patch's
    lower left; reach (n, largest width, 2), in each row of a patch the first cell that the disc may touch and one past
    the last.  Fractions outside reach are left as they were.
    """
    for n in prange(centre.shape[0]):
        r = radius[n]
        w = patch_width[n]
        x0 = math.floor(centre[n, 0] - r)
        y0 = math.floor(centre[n, 1] - r)
        corner[n, 0] = x0
        corner[n, 1] = y0
        a, ga, b, gb = lines[n, 0], lines[n, 1], lines[n, 2], lines[n, 3]
        line_areas(x0, w + 1, centre[n, 0], r, a, ga)
        line_areas(y0, w + 1, centre[n, 1], r, b, gb)
        middle = centre[n, 0] - x0
        for j in range(w):
            longest, shortest = chord(b[j], b[j + 1], r)
            first = 0
            last = 0
            if longest >= 0.0:
                first = max(math.floor(middle - longest), 0)
                last = min(math.floor(middle + longest) + 1, w)
            full_from = w
            full_to = 0
            if shortest >= 0.0:
                full_from = math.ceil(middle - shortest)
                full_to = math.floor(middle + shortest)
            reach[n, j, 0] = first
            reach[n, j, 1] = last
            for i in range(first, last):
                e = 1.0
                if i < full_from or i >= full_to:
                    e = corner_area(a[i + 1], b[j + 1], ga[i + 1], gb[j + 1], r)
                    e -= corner_area(a[i], b[j + 1], ga[i], gb[j + 1], r)
                    e -= corner_area(a[i + 1], b[j], ga[i + 1], gb[j], r) - corner_area(a[i], b[j], ga[i], gb[j], r)
                    if e < 1e-12:
                        e = 0.0
                    elif e > 1.0 - 1e-12:
                        e = 1.0
                patch[patch_start[n] + j * w + i] = e


@kernel
def list_rows(corner, patch_width, reach, ny, periodic_y, row_start, row_disc, row_line):
    """Which discs lie in which row of the lattice, and with which row of their patch, in index order: a counting sort.

    Overwrites row_start (ny + 1,), row_disc and row_line (at least as many entries as patches have rows).
    """
    row_start[:] = 0
    for turn in range(2):
        for n in range(corner.shape[0]):
            for j in range(patch_width[n]):
                y = corner[n, 1] + j
                if periodic_y:
                    y %= ny
                if y < 0 or y >= ny or reach[n, j, 0] >= reach[n, j, 1]:
                    continue
                if turn == 0:
                    row_start[y + 1] += 1
                else:
                    row_disc[row_start[y]] = n
                    row_line[row_start[y]] = j
                    row_start[y] += 1
        if turn == 0:
            for y in range(ny):
                row_start[y + 1] += row_start[y]
    for y in range(ny, 0, -1):
        row_start[y] = row_start[y - 1]
    row_start[0] = 0


@inline
def inside_box(first, last, corner_x, nx, periodic_x):
    """The part of a patch row's cells first to last - 1 that lies in the box, and the lattice column of its cell 0."""
    if periodic_x:
        return first, last, corner_x % nx
    return max(first, -corner_x), min(last, nx - corner_x), corner_x


@inline
def lay_row(
    begin, end, row_disc, row_line, centre, velocity, spin, patch_start, patch_width, patch, corner, reach, periodic_x,
    s, sx, sy,
):  # fmt: skip
    """Add up the solid fractions of one row, and fractions times solid velocity at the cells' centres.

    Entries ``begin`` to ``end`` - 1 of row_disc and row_line are the row's;  centre (n, 2) cells, velocity (n, 2), spin
    (n,): lattice units;  the rest as in ``cover``.  Adds to s, sx, sy (nx,); returns the first covered cell and one
    past the last.
    """
    nx = s.shape[0]
    leftmost = nx
    rightmost = 0
    for k in range(begin, end):
        n = row_disc[k]
        j = row_line[k]
        first, last, base = inside_box(reach[n, j, 0], reach[n, j, 1], corner[n, 0], nx, periodic_x)
        at = patch_start[n] + j * patch_width[n]
        turning = spin[n]
        vx = velocity[n, 0] - turning * (corner[n, 1] + j + 0.5 - centre[n, 1])
        vy = velocity[n, 1] + turning * (corner[n, 0] + 0.5 - centre[n, 0])
        while first < last:  # once, or again for what lies beyond a periodic side
            stop = min(last, nx - base)
            if first < stop:
                e = patch[at + first : at + stop]
                t = s[base + first : base + stop]
                tx = sx[base + first : base + stop]
                ty = sy[base + first : base + stop]
                for i in range(e.shape[0]):
                    t[i] += e[i]
                    tx[i] += e[i] * vx
                    ty[i] += e[i] * (vy + turning * (first + i))
                leftmost = min(leftmost, base + first)
                rightmost = max(rightmost, base + stop)
                first = stop
            base -= nx
    return leftmost, rightmost


@parallel_kernel
def lay_out(
    row_start, row_disc, row_line, centre, velocity, spin, patch_start, patch_width, patch, corner, reach, periodic_x,
    solid, solid_x, solid_y,
):  # fmt: skip
    """All rows at once, for output: overwrites solid, solid_x, solid_y (ny, nx) with what ``lay_row`` gives."""
    for y in prange(solid.shape[0]):
        solid[y, :] = 0
        solid_x[y, :] = 0
        solid_y[y, :] = 0
        lay_row(
            row_start[y], row_start[y + 1], row_disc, row_line, centre, velocity, spin, patch_start, patch_width, patch,
            corner, reach, periodic_x, solid[y], solid_x[y], solid_y[y],
        )  # fmt: skip

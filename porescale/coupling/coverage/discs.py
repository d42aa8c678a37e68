"""How much of each cell every disc covers, exactly.

The area of a disc of radius r inside the corner rectangle [0, a] x [0, b] (a, b >= 0, clamped to r) is

    K(a, b) = a b                                if a² + b² <= r²
            = G(a) + G(b) - pi r²/4              otherwise,     G(a) = (a sqrt(r² - a²) + r² asin(a/r)) / 2

odd in a and in b.  A cell is four such terms, each shared by the four cells around a corner, and G belongs to a grid
line: a disc d cells wide needs 2 (d + 2) of them.  Derived from G being the area under the quarter circle up to a.
"""

import math

import numpy as np

from porescale.common.compiled.jit import inline, kernel, parallel_kernel, prange
from porescale.common.compiled.simd import (
    EIGHT,
    LANES,
    choose,
    fma,
    load,
    maximum,
    minimum,
    ramp_eight,
    sqrt,
    store,
    store_eight,
)
from porescale.coupling.coverage.rows import BLOCK

CHUNKS = 64
"""Parts of the discs that are done side by side; any number gives the same patches."""
ALONE_BELOW = 1024
"""Blocks of all patches below which one thread covers them: in 14 us, 10 by two."""
FAR, NOWHERE = 2.0**40, -(2**40)
"""Cells beyond which a disc counts as gone, since cells are counted in integers; where its patch is put then."""
SCRATCH = 6
"""Rows of scratch that ``cover`` needs."""


@inline
def next_terms(u, p, second, first):
    """u (u p + second) + first, of two polynomials."""
    return fma(u[0], fma(u[0], p[0], second), first), fma(u[1], fma(u[1], p[1], second), first)


@inline
def small_angles(s, t):
    """asin of s and t, both from 0 to sqrt(1/2), by a polynomial in 4 s² - 1.

    The Chebyshev interpolant of asin(s)/s at 18 nodes.  Nearest singularity in 4 s² - 1: at 3, so terms fall by
    3 + sqrt(8) = 5.83 each, to less than a rounding; error measured 2.3e-16.  Two at a time: the polynomials take turns
    where one would wait for itself, a quarter of ``mark_lines``.
    """
    u = 4.0 * s * s - 1.0, 4.0 * t * t - 1.0
    p = next_terms(u, (0.0, 0.0), 4.1062856818522654e-11, 1.341269811266304e-10)
    p = next_terms(u, p, 2.5575438063659323e-10, 8.518395371797598e-10)
    p = next_terms(u, p, 3.2049981064158968e-09, 1.0809672108042573e-08)
    p = next_terms(u, p, 3.647297352409811e-08, 1.257815748470195e-07)
    p = next_terms(u, p, 4.402038834245034e-07, 1.5669849096691668e-06)
    p = next_terms(u, p, 5.701782186250886e-06, 2.1345548280526272e-05)
    p = next_terms(u, p, 8.302317801499006e-05, 0.000340863723836082)
    p = next_terms(u, p, 0.0015196685395952932, 0.0077989022389580815)
    p = next_terms(u, p, 0.05375149359132692, 1.0471975511965979)
    return s * p[0], t * p[1]


@inline
def quarter_areas(a, b, r):
    """G(a), G(b): areas under the quarter circle of radius r from 0 to a, 0 <= a <= r, and to b.

    The angle comes from the shorter leg: asin(a/r) loses half the digits of a disc that just touches a grid line.
    """
    high, wide = sqrt((r - a) * (r + a)), sqrt((r - b) * (r + b))
    share = 1.0 / r if r > 0.0 else 0.0
    one, other = small_angles(minimum(a, high) * share, minimum(b, wide) * share)
    right = 0.5 * math.pi
    return (
        0.5 * (a * high + r * r * choose(a, high, right - one, one)),
        0.5 * (b * wide + r * r * choose(b, wide, right - other, other)),
    )


@inline
def lines_at(first, second, r):
    """Of two grid lines: the distance from the centre clamped to [-r, r], G of it with its sign, and the sign; also of
    several lines side by side (simd.py)."""
    a, b = minimum(maximum(first, -r), r), minimum(maximum(second, -r), r)
    left, down = choose(0.0, a, -1.0, 1.0), choose(0.0, b, -1.0, 1.0)
    area, other = quarter_areas(left * a, down * b, r)
    return (a, area * left, left), (b, other * down, down)


@inline
def mark_lines(left, bottom, count, r, lines):
    """What corners need of grid lines along y and x, the first of them at ``left`` and ``bottom`` from the centre.

    Overwrites, of ``count`` lines of each kind, a multiple of EIGHT, and one more that repeats the last, six rows of
    lines: distance to the centre clamped to [-r, r], G of it with its sign, and the sign; of lines along y, then x.
    """
    a, ga, sa, b, gb, sb = lines[0], lines[1], lines[2], lines[3], lines[4], lines[5]
    for k in range(0, count, EIGHT):
        upright, level = lines_at(ramp_eight(a) + (left + k), ramp_eight(b) + (bottom + k), r)
        store_eight(a, k, upright[0])
        store_eight(ga, k, upright[1])
        store_eight(sa, k, upright[2])
        store_eight(b, k, level[0])
        store_eight(gb, k, level[1])
        store_eight(sb, k, level[2])
    a[count], ga[count], sa[count] = a[count - 1], ga[count - 1], sa[count - 1]
    b[count], gb[count], sb[count] = b[count - 1], gb[count - 1], sb[count - 1]


@inline
def corner_area(a, ga, sa, b, sb, outer, room):
    """K(a, b), a and b signed: ga = sign(a) G(|a|), signs sa, sb, outer = sb (G(|b|) - pi r²/4), room = r² - b²."""
    return choose(a * a, room, ga * sb + sa * outer, a * b)


@inline
def across(line, r):
    """What ``corner_area`` needs of a line along x: b, sb, outer and room;  line: ``line_at``."""
    b, gb, side = line
    quarter = 0.25 * math.pi * r * r
    return b, side, gb - side * quarter, r * r - b * b


@inline
def strip_area(left, right, line):
    """Area of a disc between two lines along y, from the centre's height to a line along x: ``line_at`` of the two, and
    ``across`` of the third."""
    b, side, outer, room = line
    beyond = corner_area(right[0], right[1], right[2], b, side, outer, room)
    return beyond - corner_area(left[0], left[1], left[2], b, side, outer, room)


@inline
def least_part(r):
    """What counts as none, so that cells are full and empty to the bit: what is left of four areas of r², each good to
    four roundings."""
    return 16 * 2.3e-16 * max(r * r, 1.0)


@inline
def full_or_empty(part, little):
    """The part of a cell, or all or none of it where little is missing."""
    part = choose(part, little, part, 0.0)
    return choose(1.0 - little, part, part, 1.0)


@inline
def place_corner(n, centre, r, corner):
    """The cell at the lower left of disc n's patch, into corner (n, 2)."""
    there = abs(centre[n, 0]) < FAR and abs(centre[n, 1]) < FAR  # nor no number, as when a run blows up
    corner[n, 0] = math.floor(centre[n, 0] - r) if there else NOWHERE
    corner[n, 1] = math.floor(centre[n, 1] - r) if there else NOWHERE


@kernel
def place_corners(centre, radius, corner):
    """``place_corner`` of discs of centre (n, 2) and radius (n,)."""
    for n in range(radius.shape[0]):
        place_corner(n, centre, radius[n], corner)


@inline
def strips_at(lines, at):
    """Lines to the left and to the right of LANES strips from the one ``at`` on, for ``strip_area``."""
    a, ga, sa, end = lines[0], lines[1], lines[2], at + LANES
    left = load(a, at, end), load(ga, at, end), load(sa, at, end)
    return left, (load(a, at + 1, end + 1), load(ga, at + 1, end + 1), load(sa, at + 1, end + 1))


@inline
def cover_disc(x, y, r, x0, y0, height, stride, fraction, lines):
    """Fractions of the cells around one disc, centre (x, y), into fraction (height * stride,); lines: scratch.

    stride: a multiple of EIGHT above height, in two halves that share what they need of lines along x.
    """
    b, gb, sb = lines[3], lines[4], lines[5]
    mark_lines(x0 - x, y0 - y, stride, r, lines)
    little = least_part(r)
    for at in range(0, stride, EIGHT):
        near, far = strips_at(lines, at), strips_at(lines, at + LANES)
        line = across((b[0], gb[0], sb[0]), r)
        below = strip_area(near[0], near[1], line), strip_area(far[0], far[1], line)
        for j in range(height):
            line = across((b[j + 1], gb[j + 1], sb[j + 1]), r)
            above = strip_area(near[0], near[1], line), strip_area(far[0], far[1], line)
            here, half = j * stride + at, j * stride + at + LANES
            store(fraction, here, half, full_or_empty(above[0] - below[0], little))
            store(fraction, half, half + LANES, full_or_empty(above[1] - below[1], little))
            below = above


@kernel
def cover_part(part, centre, radius, patches, lines):
    """``cover`` of the discs of one part of lines.shape[0]."""
    count, parts, corner = radius.shape[0], lines.shape[0], patches.corner
    for n in range(part * count // parts, (part + 1) * count // parts):
        r, height, stride, start = radius[n], patches.height[n], patches.stride[n], patches.start[n]
        patch = patches.fraction[start : start + stride * height]
        place_corner(n, centre, r, corner)
        cover_disc(centre[n, 0], centre[n, 1], r, corner[n, 0], corner[n, 1], height, stride, patch, lines[part])


@parallel_kernel
def cover(centre, radius, patches, lines):
    """Exact solid fractions of the cells around every disc.

    centre (n, 2), radius (n,): cells;  lines (CHUNKS, SCRATCH, largest stride + BLOCK): scratch.  Overwrites the first
    n patches, whose rows hold one cell more than a disc can touch, and their corners.  The patch of a centre
    that is no number, or beyond ``FAR``, lies outside of every box with walls.
    """
    if patches.fraction.shape[0] < ALONE_BELOW * BLOCK:
        for part in range(lines.shape[0]):
            cover_part(part, centre, radius, patches, lines)
    else:
        for part in prange(lines.shape[0]):
            cover_part(np.int64(part), centre, radius, patches, lines)

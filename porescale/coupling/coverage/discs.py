"""How much of each cell every disc covers, exactly.

The area of a disc of radius r inside the corner rectangle [0, a] x [0, b] (a, b >= 0, clamped to r) is

    K(a, b) = a b                                if a² + b² <= r²
            = G(a) + G(b) - pi r²/4              otherwise,     G(a) = (a sqrt(r² - a²) + r² asin(a/r)) / 2

odd in a and in b.  A cell is four such terms, each shared by the four cells around a corner, and G belongs to a grid
line: a disc d cells wide needs 2 (d + 2) of them.  Derived from G being the area under the quarter circle up to a.
"""

import math

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
from porescale.coupling.coverage.rows import is_few

CHUNKS = 64
"""Parts of the discs that are done side by side; any number gives the same patches."""
FAR, NOWHERE = 2.0**40, -(2**40)
"""Cells beyond which a disc counts as gone, since cells are counted in integers; where its patch is put then."""
SCRATCH = 6
"""Rows of scratch that ``cover`` needs."""


@inline
def small_angle(s):
    """asin(s) for 0 <= s <= sqrt(1/2), by a polynomial in 4 s² - 1.

    The Chebyshev interpolant of asin(s)/s at 18 nodes.  Nearest singularity in 4 s² - 1: at 3, so terms fall by
    3 + sqrt(8) = 5.83 each, to less than a rounding; error measured 2.3e-16.
    """
    u = 4.0 * s * s - 1.0
    p = fma(u, 4.1062856818522654e-11, 1.341269811266304e-10)
    p = fma(u, fma(u, p, 2.5575438063659323e-10), 8.518395371797598e-10)
    p = fma(u, fma(u, p, 3.2049981064158968e-09), 1.0809672108042573e-08)
    p = fma(u, fma(u, p, 3.647297352409811e-08), 1.257815748470195e-07)
    p = fma(u, fma(u, p, 4.402038834245034e-07), 1.5669849096691668e-06)
    p = fma(u, fma(u, p, 5.701782186250886e-06), 2.1345548280526272e-05)
    p = fma(u, fma(u, p, 8.302317801499006e-05), 0.000340863723836082)
    p = fma(u, fma(u, p, 0.0015196685395952932), 0.0077989022389580815)
    return s * fma(u, fma(u, p, 0.05375149359132692), 1.0471975511965979)


@inline
def quarter_area(a, r):
    """G(a): area under the quarter circle of radius r from 0 to a, 0 <= a <= r.

    The angle comes from the shorter leg: asin(a/r) loses half the digits of a disc that just touches a grid line.
    """
    h = sqrt((r - a) * (r + a))
    angle = small_angle(minimum(a, h) * (1.0 / r if r > 0.0 else 0.0))
    return 0.5 * (a * h + r * r * choose(a, h, 0.5 * math.pi - angle, angle))


@inline
def line_at(distance, r):
    """A grid line's distance from the centre clamped to [-r, r], G of it with its sign, and the sign; also of several
    lines side by side (simd.py)."""
    a = minimum(maximum(distance, -r), r)
    sign = choose(0.0, a, -1.0, 1.0)
    return a, quarter_area(sign * a, r) * sign, sign


@inline
def mark_lines(first, count, r, at, area, side):
    """What corners need of their grid lines, the first of them at ``first`` from the centre.

    Overwrites, of ``count`` lines, a multiple of LANES, and one more that repeats the last: at, distance to the centre
    clamped to [-r, r];  side, its sign;  area, G of it with that sign.  Eight at a time, up to a multiple of that: the
    polynomials of two vectors take turns where one would wait for itself, a tenth of a disc.
    """
    for b in range(0, count, EIGHT):
        distance, g, sign = line_at(ramp_eight(at) + (first + b), r)
        store_eight(at, b, distance)
        store_eight(area, b, g)
        store_eight(side, b, sign)
    at[count], area[count], side[count] = at[count - 1], area[count - 1], side[count - 1]


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
def cover_disc(x, y, r, x0, y0, height, stride, fraction, lines):
    """Fractions of the cells around one disc, centre (x, y), into fraction (height * stride,); lines: scratch.

    Overwrites the first ``height`` + 1 cells of every row, and those up to a multiple of LANES.
    """
    a, ga, sa, b, gb, sb = lines[0], lines[1], lines[2], lines[3], lines[4], lines[5]
    width = (height + LANES) // LANES * LANES
    mark_lines(x0 - x, width, r, a, ga, sa)
    mark_lines(y0 - y, width, r, b, gb, sb)
    little = least_part(r)
    for at in range(0, width, LANES):
        left = load(a, at, width), load(ga, at, width), load(sa, at, width)
        right = load(a, at + 1, width + 1), load(ga, at + 1, width + 1), load(sa, at + 1, width + 1)
        below = strip_area(left, right, across((b[0], gb[0], sb[0]), r))
        for j in range(height):
            above = strip_area(left, right, across((b[j + 1], gb[j + 1], sb[j + 1]), r))
            store(fraction, j * stride + at, fraction.shape[0], full_or_empty(above - below, little))
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
    if is_few(patches):
        for part in range(lines.shape[0]):
            cover_part(part, centre, radius, patches, lines)
    else:
        for part in prange(lines.shape[0]):
            cover_part(part, centre, radius, patches, lines)

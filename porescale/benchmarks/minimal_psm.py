"""The smallest kernels that do the job of discs moving in water: one thread, one law of each kind; nothing is chosen.

They are what `study parts` holds a scene of grains in water against: TRT without a body force, exact walls
(solid/exact_wall.py) in the cells that discs cover, bounce-back at four sides, and dry discs
(benchmarks/minimal_dem.py). Row by row: the discs that lie in it are laid out, its cells collide, and the discs take
their loads at once.  The areas of cells under a disc are coverage.py's: there is nothing in them to leave out.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.benchmarks.minimal_dem import PlainDiscs
from porescale.benchmarks.minimal_lbm import PlainWater, plain_cells, slots_of
from porescale.common.compiled.jit import inline, kernel, unchecked_view
from porescale.common.compiled.simd import load_eight, ramp_eight, reduce_add, store_eight
from porescale.common.core.types import Floats
from porescale.coupling.coverage.discs import SCRATCH, cover_disc
from porescale.coupling.coverage.rows import BLOCK, whole_blocks
from porescale.coupling.immersed import FOLLOWING
from porescale.coupling.psm import LOW_PASS
from porescale.coupling.solid.exact_wall import ONSET, SMOOTHING
from porescale.coupling.step import Coupled

Index = NDArray[np.int64]


class Covered(NamedTuple):
    """What discs cover: centre (n, 2) cells, motion (n, 3) in lattice units and its half-step correction ``turned``,
    corner (n, 2) of the cells under each disc and their rows (n,), at most ``highest``, ``width`` cells wide; fraction
    (n * highest * width,).  Row by row of the lattice, the discs in it: start (ny + 1,), listed."""

    centre: Floats
    motion: Floats
    turned: Floats
    corner: Index
    rows: Index
    highest: int
    width: int
    fraction: Floats
    start: Index
    listed: Index


@kernel
def cover_all(position, velocity, spin, reach, spacing, step, covered, lines):
    """Where discs lie: position (n, 2) m, velocity m/s, spin rad/s, reach (n,) cells; spacing m, step s.

    Overwrites ``covered`` but for the correction and the numbers of rows.  lines: scratch.
    """
    centre, motion, corner, rows = covered.centre, covered.motion, covered.corner, covered.rows
    highest, width, fraction = covered.highest, covered.width, covered.fraction
    start, listed = covered.start, covered.listed
    ny, pace = start.shape[0] - 1, step / spacing
    start[:] = 0
    for n in range(reach.shape[0]):
        centre[n, 0], centre[n, 1] = position[n, 0] / spacing, position[n, 1] / spacing
        motion[n, 0], motion[n, 1], motion[n, 2] = velocity[n, 0] * pace, velocity[n, 1] * pace, spin[n] * step
        x0, y0 = int(np.floor(centre[n, 0] - reach[n])), int(np.floor(centre[n, 1] - reach[n]))
        corner[n, 0], corner[n, 1] = x0, y0
        patch = fraction[n * highest * width : (n * highest + rows[n]) * width]
        cover_disc(centre[n, 0], centre[n, 1], reach[n], x0, y0, rows[n], width, patch, lines)
        for y in range(max(y0, 0), min(y0 + rows[n], ny)):
            start[y + 1] += 1
    for y in range(ny):
        start[y + 1] += start[y]
    for n in range(reach.shape[0]):
        for y in range(max(corner[n, 1], 0), min(corner[n, 1] + rows[n], ny)):
            listed[start[y]] = n
            start[y] += 1
    for y in range(ny, 0, -1):
        start[y] = start[y - 1]
    start[0] = 0


@inline
def lay(n, y, covered, s, sx, sy):
    """Add disc n in row y: its fractions e to s, e times velocity to sx and sy."""
    centre, motion, turned, corner = covered.centre, covered.motion, covered.turned, covered.corner
    highest, width, fraction = covered.highest, covered.width, covered.fraction
    rx, ry = corner[n, 0] + 0.5 - centre[n, 0], y + 0.5 - centre[n, 1]
    vx, cx = motion[n, 0] - motion[n, 2] * ry, turned[n, 0] - turned[n, 2] * ry
    vy, cy = motion[n, 1] + motion[n, 2] * rx, turned[n, 1] + turned[n, 2] * rx
    w, c = motion[n, 2], turned[n, 2]
    first = (n * highest + y - corner[n, 1]) * width
    for at in range(0, width, BLOCK):
        x, e, i = corner[n, 0] + at + BLOCK, load_eight(fraction, first + at), ramp_eight(s) + at
        store_eight(s, x, load_eight(s, x) + e)
        store_eight(sx, x, load_eight(sx, x) + e * (vx + e * cx))
        store_eight(sy, x, load_eight(sy, x) + e * (vy + w * i + e * (cy + c * i)))


@inline
def take(n, y, covered, s, sx, sy, load):
    """Add what row y does to disc n to load (n, 5): force, torque, mass and inertia that answer.  s, sx, sy: as
    wet_cells leaves them."""
    centre, motion, turned, corner = covered.centre, covered.motion, covered.turned, covered.corner
    highest, width, fraction = covered.highest, covered.width, covered.fraction
    rx, ry = corner[n, 0] + 0.5 - centre[n, 0], y + 0.5 - centre[n, 1]
    vx, cx = motion[n, 0] - motion[n, 2] * ry, turned[n, 0] - turned[n, 2] * ry
    w, c = motion[n, 2], turned[n, 2]
    first = (n * highest + y - corner[n, 1]) * width
    for at in range(0, width, BLOCK):
        x, e, arm = corner[n, 0] + at + BLOCK, load_eight(fraction, first + at), ramp_eight(s) + (rx + at)
        rho = load_eight(s, x)
        gx = e * (load_eight(sx, x) - rho * (vx + e * cx))
        gy = e * (load_eight(sy, x) - rho * (motion[n, 1] + w * arm + e * (turned[n, 1] + c * arm)))
        m = e * rho
        load[n, 0] += reduce_add(gx)
        load[n, 1] += reduce_add(gy)
        load[n, 2] += reduce_add(arm * gy - ry * gx)
        load[n, 3] += reduce_add(m)
        load[n, 4] += reduce_add(m * (arm * arm + ry * ry))


@inline
def wet_cells(slots, sums, spare, k, spread):
    """Collide and stream cells that discs cover: nine ``slots`` (n,), three ``sums`` (n,) of ``lay``, all overwritten,
    the sums with what loads are made of.  spare: four of scratch (n,);  k, spread: tau - 1/2, lambda0."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = slots
    s, sx, sy = sums
    share, b, evenly, kept = spare
    onset, smooth, wall = ONSET, SMOOTHING * SMOOTHING, 0.375 / k
    for x in range(a0.shape[0]):
        sum_e = s[x]
        share[x] = 1.0 / (sum_e if sum_e * sum_e > 0.0 else 1.0)
        e = min(1.0, sum_e)
        sx[x] *= share[x]
        sy[x] *= share[x]
        t, n = 1.0 - e, k * e
        b[x] = n / (n + 0.75 * t * t)
        one, two = e + onset, t * t + smooth
        turns = one * two
        dip = t * (spread * turns + e * ((wall - spread) * (1.0 + onset) * two + 0.5 * one))
        q = (0.5 * n + 0.75 * t * t) * turns + 2.0 * n * dip
        beneath, above = (0.5 * t + k) * q - 0.75 * t * n * turns, 0.5 * turns + dip
        both = 1.0 / (beneath * above)
        evenly[x] = t * q * both * above
        kept[x] = turns * both * beneath
    for x in range(a0.shape[0]):
        f0, f1, f2, f3, f4, f5, f6, f7, f8 = a0[x], a1[x], a2[x], a3[x], a4[x], a5[x], a6[x], a7[x], a8[x]
        d = f0 + ((f1 + f2) + (f3 + f4)) + ((f5 + f6) + (f7 + f8))
        jx, jy = (f1 - f2) + ((f5 - f6) - (f7 - f8)), (f3 - f4) + ((f5 - f6) + (f7 - f8))
        rho = 1.0 + d
        lightness = 1.0 / rho
        held, he, lost = b[x], evenly[x], kept[x]
        # What leaves the odd half but is not lost to q is momentum: j less what relaxes, and what the disc gives.
        px = lost * jx + held * (rho * sx[x] - jx)
        py = lost * jy + held * (rho * sy[x] - jy)
        xx, yy, xy = 4.5 * jx * jx * lightness, 4.5 * jy * jy * lightness, 9.0 * jx * jy * lightness
        rest = d - (xx + yy) / 3.0
        side, diagonal = 1.0 / 9.0, 1.0 / 36.0
        a0[x] = f0 + he * (4.0 / 9.0 * rest - f0)
        p, m = he * (side * (rest + xx) - 0.5 * (f1 + f2)), 3.0 * side * px - 0.5 * lost * (f1 - f2)
        a2[x], a1[x] = f1 + p + m, f2 + p - m
        p, m = he * (side * (rest + yy) - 0.5 * (f3 + f4)), 3.0 * side * py - 0.5 * lost * (f3 - f4)
        a4[x], a3[x] = f3 + p + m, f4 + p - m
        full = rest + xx + yy
        p, m = he * (diagonal * (full + xy) - 0.5 * (f5 + f6)), 3.0 * diagonal * (px + py) - 0.5 * lost * (f5 - f6)
        a6[x], a5[x] = f5 + p + m, f6 + p - m
        p, m = he * (diagonal * (full - xy) - 0.5 * (f7 + f8)), 3.0 * diagonal * (py - px) - 0.5 * lost * (f7 - f8)
        a8[x], a7[x] = f7 + p + m, f8 + p - m
        held *= share[x]
        s[x], sx[x], sy[x] = held * rho, held * jx, held * jy


@inline
def cut(slots, first, count):
    """``count`` cells of nine ``slots``, from ``first`` on."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = slots
    return (
        unchecked_view(a0, first, count),
        unchecked_view(a1, first, count),
        unchecked_view(a2, first, count),
        unchecked_view(a3, first, count),
        unchecked_view(a4, first, count),
        unchecked_view(a5, first, count),
        unchecked_view(a6, first, count),
        unchecked_view(a7, first, count),
        unchecked_view(a8, first, count),
    )


@kernel
def wet_rows(f, nx, parity, even, odd, covered, sums, spare, load):
    """Collide and stream all cells: overwrites f (9, ny + 2, nx + 2 or more) and load (n, 5), see ``take``.

    even, odd: rates;  sums (3, BLOCK + nx + more): zero before and after;  spare (4, nx): scratch.
    """
    corner, width, start, listed = covered.corner, covered.width, covered.start, covered.listed
    k, spread = 1.0 / even - 0.5, 1.0 / odd - 0.5
    load[:, :] = 0.0
    for y in range(f.shape[1] - 2):
        slots = slots_of(f, nx, y + 1, parity)
        s, sx, sy = sums[0], sums[1], sums[2]
        left, right = nx, 0
        for entry in range(start[y], start[y + 1]):
            n = listed[entry]
            left, right = min(left, corner[n, 0]), max(right, corner[n, 0] + width)
            lay(n, y, covered, s, sx, sy)
        if left < right:  # whole blocks, or the ends run cell by cell
            left, right = max(left, 0) // BLOCK * BLOCK, min((right + BLOCK - 1) // BLOCK * BLOCK, nx)
        else:
            left, right = nx, nx
        for end in range(2):
            m, o = (right, nx) if end else (0, left)
            plain_cells(cut(slots, m, o - m), even, odd)
        if left < right:
            sums[:, :BLOCK] = 0.0
            sums[:, BLOCK + nx :] = 0.0
            m, n = left, right - left
            here = unchecked_view(s, m + BLOCK, n), unchecked_view(sx, m + BLOCK, n), unchecked_view(sy, m + BLOCK, n)
            room = (
                unchecked_view(spare[0], 0, n),
                unchecked_view(spare[1], 0, n),
                unchecked_view(spare[2], 0, n),
                unchecked_view(spare[3], 0, n),
            )
            wet_cells(cut(slots, m, n), here, room, k, spread)
            for entry in range(start[y], start[y + 1]):
                take(listed[entry], y, covered, s, sx, sy, load)
            sums[:, BLOCK + left : BLOCK + right] = 0.0


@kernel
def answer(load, slow, turned, velocity, spin, weight, inner, inner_mass, units, step, force, turning):
    """What discs are given: force (n, 2) N/m with ``weight``, turning (n,) N m/m, the fluid inside given back.

    As half_step_correction of load.py and total_load of immersed.py.  Overwrites slow, turned, inner (n, 3): the load
    low-passed, the correction, and the motion of the fluid inside, of inner_mass (n, 2) kg/m, kg m²/m;  units (4,)
    N/m, N m/m, kg/m, kg m²/m.
    """
    for n in range(spin.shape[0]):
        for a in range(3):
            round_about = a // 2
            size = load[n, 3 + round_about]
            slow[n, a] += LOW_PASS * (load[n, a] - slow[n, a])
            turned[n, a] = -slow[n, a] / (2.0 * size) if size > 0.0 else 0.0
            mass = inner_mass[n, round_about]
            follows = FOLLOWING * min(1.0, size * units[2 + round_about] / mass)
            change = follows * ((spin[n] if round_about else velocity[n, a]) - inner[n, a])
            inner[n, a] += change
            given = load[n, a] * units[round_about] + mass * change / step
            if round_about:
                turning[n] = given
            else:
                force[n, a] = weight[n, a] + given


class PlainWet:
    """The water and the discs of ``coupled`` in a closed box, before an even step, by the smallest kernels for them.

    They go on from where they are now; ``coupled`` stays as it is.  water, dry: the two; discs that need a virtual
    mass, clumps and other bodies are not supported.
    """

    def __init__(self, coupled: Coupled) -> None:
        fluid, wet, scales, grains = coupled.fluid, coupled.saturated, coupled.scales, coupled.grains
        assert np.all(coupled.response_share == 1.0)
        assert coupled.lubrication is None
        assert not any((fluid.step % 2, *fluid.force, len(grains.held), grains.steered, len(wet.pairs)))
        self._scales, self._contact_steps = scales, coupled.contact_steps
        self.water = PlainWater(fluid.populations, fluid.relaxation_time)
        self.dry = PlainDiscs(grains, coupled.force.copy(), scales.step / coupled.contact_steps)
        count, self._reach = grains.discs.count, wet.covering_radius
        cells = (np.floor(2 * self._reach) + 2).astype(np.int64)
        width, highest = int(whole_blocks(cells + 1).max()), int(cells.max())
        state = wet.state()
        self._slow = state["slow_load"].copy()
        self._covered = Covered(
            np.zeros((count, 2)), np.zeros((count, 3)), state["shift"].copy(), np.zeros((count, 2), np.int64), cells,
            highest, width, np.zeros(count * highest * width), np.zeros(fluid.ny + 1, np.int64),
            np.zeros(int(cells.sum()), np.int64),
        )  # fmt: skip
        self._lines, self._load = np.zeros((SCRATCH, width + BLOCK)), np.zeros((count, 5))
        self._sums, self._spare = np.zeros((3, fluid.nx + width + 2 * BLOCK)), np.zeros((4, fluid.nx))
        self._inner = np.column_stack((coupled.inner_velocity, coupled.inner_spin))
        self._inner_mass = np.column_stack((coupled.inner_mass, coupled.inner_inertia))
        mass = scales.density * scales.spacing**2
        self._units = np.array([scales.force, scales.torque, mass, mass * scales.spacing**2])
        self._weight = coupled.weight

    def advance(self, steps: int) -> None:
        """So many steps of the water, each with its contact steps."""
        s, d, water = self._scales, self.dry.discs, self.water
        for _ in range(steps):
            cover_all(
                d["position"], d["velocity"], d["spin"], self._reach, s.spacing, s.step, self._covered, self._lines
            )  # fmt: skip
            wet_rows(
                water.padded, water.nx, water.step % 2, water.even, water.odd, self._covered, self._sums, self._spare,
                self._load,
            )  # fmt: skip
            water.close()
            answer(
                self._load, self._slow, self._covered.turned, d["velocity"], d["spin"], self._weight, self._inner,
                self._inner_mass, self._units, s.step, self.dry.weight, self.dry.turning,
            )  # fmt: skip
            self.dry.advance(self._contact_steps)

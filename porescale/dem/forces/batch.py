"""Forces between discs, many contacts at once: a pass over a half list of pairs.

Pairs that touch are put down in columns, answered side by side, and added up in the order of the list.  One contact
after another, a processor would wait for each root and quotient; columns are a loop over numbers alone, compiled for as
many contacts at a time as the machine's vectors hold.  What one contact gives depends on no other, so the bits are
those of a loop over pairs.
"""

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import disjoint, inline, unchecked_view
from porescale.common.core.types import Floats
from porescale.dem.contact.budget import add_losses, has_budget
from porescale.dem.contact.law import has_history, load_history, row_numbers, store_history
from porescale.dem.forces.pairs import answer_contact, contact_kinematics, leave_pair, relative_velocity, row_between
from porescale.dem.motion.periodic_cell import add_load, image

BATCH = 128
"""Contacts that are put down before they are answered: they stay in the nearest cache."""
NOTHING = np.nan
"""Put down for a far pair that does not touch: adding a zero could turn -0.0 into 0.0."""
ONE = np.uint64(1)
"""Of a number that is not negative by its type: an index that might be is tested at each use."""
(
    DX, DY, DU, DV, SPIN_I, SPIN_J, RADIUS_I, RADIUS_J, MASS_I, MASS_J, SPRING, ROLL, FX, FY, MOMENT_I, MOMENT_J,
) = np.arange(16)  # fmt: skip
"""Columns of a contact: the way from i to j m, velocity of i relative to j m/s, spins rad/s, radii m, masses kg/m and
springs m;  then what it answers, force on i N/m and torques on both N m/m.  numba compiles what takes plain numbers of
Python for each of them."""
LOST = np.arange(16, 21)
"""Columns of what contacts lost, J/m, see budget.contact_losses: there where an energy budget is kept."""
ONE_DISC, OTHER, PAIR = np.arange(3)
"""Columns of whole numbers: both discs, and the place in the list."""


def scratch(threads: int, budget: bool = False) -> tuple[Floats, NDArray[np.int64]]:
    """Columns of numbers and of whole numbers for each thread, (threads, 16 BATCH) and (threads, 3 BATCH); with an
    energy ``budget`` (threads, 21 BATCH) numbers."""
    return np.zeros((threads, (21 if budget else 16) * BATCH)), np.zeros((threads, 3 * BATCH), np.int64)


@inline
def column(values, at):
    """A column of one thread's numbers, or whole numbers."""
    return unchecked_view(values, at * BATCH, BATCH)


@inline
def answered(numbers):
    """The columns of what contacts answer."""
    return column(numbers, FX), column(numbers, FY), column(numbers, MOMENT_I), column(numbers, MOMENT_J)


@inline
def losses(numbers, budget):
    """The columns of what contacts lost; empty where ``budget`` is None."""
    if budget is None:
        none = unchecked_view(numbers, 0, 0)
        return none, none, none, none, none
    return (
        column(numbers, LOST[0]), column(numbers, LOST[1]), column(numbers, LOST[2]), column(numbers, LOST[3]),
        column(numbers, LOST[4]),
    )  # fmt: skip


@inline
def keep_losses(budget, lost, m, values):
    """Overwrite row m of the columns ``lost`` with the five ``values`` (J/m); nothing where ``budget`` is None."""
    if budget is not None:
        lost[0][m], lost[1][m], lost[2][m], lost[3][m], lost[4][m] = values


@inline
def add_lost(budget, i, lost, m, law):
    """Add row m of the columns ``lost`` to row i of ``budget``; nothing where it is None."""
    if budget is not None:
        add_losses(budget, i, (lost[0][m], lost[1][m], lost[2][m], lost[3][m], lost[4][m]), law.rolling)


@inline
def put_down(i, first, last, m, d, pairs, law, dt, cell, numbers, which):
    """Put down what of the listed pairs ``first`` to ``last`` - 1 of disc ``i`` touches, from place ``m`` on.

    Returns the next free place;  numbers, which: one thread's scratch.  Overwrites springs of the others with 0; what
    they still held goes to the energy budget, if any.  Not checked: that there is room.
    """
    dx_of, dy_of, du_of, dv_of = column(numbers, DX), column(numbers, DY), column(numbers, DU), column(numbers, DV)
    spin_i, spin_j, radius_i, radius_j = (
        column(numbers, SPIN_I), column(numbers, SPIN_J), column(numbers, RADIUS_I), column(numbers, RADIUS_J),
    )  # fmt: skip
    mass_i, mass_j, springs, rolls = (
        column(numbers, MASS_I), column(numbers, MASS_J), column(numbers, SPRING), column(numbers, ROLL),
    )  # fmt: skip
    one, other, listed = column(which, ONE_DISC), column(which, OTHER), column(which, PAIR)
    x, y, radius = d.position[i, 0], d.position[i, 1], d.radius[i]
    for k in range(np.uint64(first), np.uint64(last)):
        j = np.uint64(pairs.partner[k])
        dx, dy = image(d.position[j, 0] - x, d.position[j, 1] - y, cell)
        reach = radius + d.radius[j]
        if dx * dx + dy * dy >= reach * reach:
            if has_budget(d.budget) and has_history(pairs.history, k, law):  # asked within, a cell took 4 times as long
                leave_pair(i, j, k, dx, dy, d, pairs.history, law, dt, cell)
            store_history(pairs.history, k, 0.0, 0.0, law)
            continue
        dx_of[m], dy_of[m] = dx, dy
        du_of[m], dv_of[m] = relative_velocity(i, j, dx, dy, d.velocity, cell)
        spin_i[m], spin_j[m] = d.spin[i], d.spin[j]
        radius_i[m], radius_j[m] = radius, d.radius[j]
        mass_i[m], mass_j[m] = d.body_mass[i], d.body_mass[j]
        springs[m], rolls[m] = load_history(pairs.history, k, law)
        one[m], other[m], listed[m] = i, j, k
        m += ONE
    return m


@disjoint
def answer_columns(count, seen, springs, answers, lost, pair, d, law, dt):
    """Answer ``count`` contacts: overwrites the columns of springs, ``answers`` and ``lost``, if any.

    seen, springs, answers, lost, pair: columns DX to MASS_J, SPRING and ROLL, FX to MOMENT_J, LOST, ONE_DISC and OTHER.
    """
    dx, dy, du, dv, spin_i, spin_j, radius_i, radius_j, mass_i, mass_j = seen
    spring, roll = springs
    fx, fy, moment_i, moment_j = answers
    one, other = pair
    shared, budget, material = row_numbers(law.table[0, 0], law), d.budget, d.material
    for m in range(count):
        way = contact_kinematics(dx[m], dy[m], du[m], dv[m], spin_i[m], spin_j[m], radius_i[m], radius_j[m])
        overlap = radius_i[m] + radius_j[m] - np.sqrt(dx[m] * dx[m] + dy[m] * dy[m])
        mass = mass_i[m] * mass_j[m] / (mass_i[m] + mass_j[m])
        p = row_between(one[m], other[m], shared, law, material)
        held = spring[m], roll[m]
        found, kept, gone = answer_contact(overlap, way, mass, p, held, budget, law, dt)
        fx[m], fy[m], moment_i[m], moment_j[m] = found
        keep_losses(budget, lost, m, gone)
        spring[m], roll[m] = kept


@inline
def answer(count, d, law, dt, numbers, which):
    """Answer the first ``count`` contacts of one thread's scratch, in place."""
    seen = (
        column(numbers, DX), column(numbers, DY), column(numbers, DU), column(numbers, DV), column(numbers, SPIN_I),
        column(numbers, SPIN_J), column(numbers, RADIUS_I), column(numbers, RADIUS_J), column(numbers, MASS_I),
        column(numbers, MASS_J),
    )  # fmt: skip
    springs, pair = (
        (column(numbers, SPRING), column(numbers, ROLL)),
        (column(which, ONE_DISC), column(which, OTHER)),
    )
    answer_columns(count, seen, springs, answered(numbers), losses(numbers, d.budget), pair, d, law, dt)


@inline
def part_of_row(i, start, far_start, far):
    """First and one past the last place in the list of disc i's pairs with its own block, or with ``far`` ones.

    far_start: of Threads, or None where all discs are one block.
    """
    number = 0 if far_start is None else far_start[i + 1] - far_start[i]
    split = start[i + 1] - number
    return (split, start[i + 1]) if far else (start[i], split)


@inline
def answer_batch(i, k, last, far_start, far, d, pairs, law, dt, cell, numbers, which):
    """Put down and answer the next pairs of discs ``i`` to ``last`` - 1, as many as there is room for.

    k: the place in the list from which on pairs of disc i are due;  far_start, far: of ``part_of_row``.  Returns where
    to go on, disc and place, and how many contacts there are.
    """
    m, room = np.uint64(0), BATCH
    while i < last and room > 0:
        begin, end = part_of_row(i, pairs.start, far_start, far)
        begin = max(begin, k)
        k = min(end, begin + room)
        m = put_down(i, begin, k, m, d, pairs, law, dt, cell, numbers, which)
        room -= k - begin
        if k == end:
            i += 1
    answer(m, d, law, dt, numbers, which)
    return i, k, m


@inline
def finish_discs(first, last, sums, far_start, far, d):
    """Add to disc ``first`` the sums over its own row, N/m and N m/m, to it and all before ``last`` their far contacts.

    far: of Threads, with NOTHING where a pair does not touch.
    """
    fx, fy, moment = sums
    for n in range(first, last):
        if far_start is not None:
            for q in range(far_start[n], far_start[n + 1]):
                if far[q, 0] == far[q, 0]:
                    fx += far[q, 0]
                    fy += far[q, 1]
                    moment += far[q, 2]
        d.force[n, 0] += fx
        d.force[n, 1] += fy
        d.torque[n] += moment
        fx, fy, moment = 0.0, 0.0, 0.0


@inline
def block_forces(first, last, far_start, far, d, pairs, law, dt, cell, numbers, which):
    """Add the contacts of discs ``first`` to ``last`` - 1 with partners in this block, and far ones, to force and
    torque: first those with lower discs, in their order, then those of a disc's own row.

    far_start, far: of Threads, None where all discs are one block;  the rest as in pair_forces.
    """
    force, torque = d.force, d.torque
    gx, gy, turn_i, turn_j = answered(numbers)
    dx, dy, springs, rolls = column(numbers, DX), column(numbers, DY), column(numbers, SPRING), column(numbers, ROLL)
    lost = losses(numbers, d.budget)
    one, other, listed = column(which, ONE_DISC), column(which, OTHER), column(which, PAIR)
    i, k, now = first, np.int64(0), first
    fx, fy, moment = 0.0, 0.0, 0.0
    while i < last:
        i, k, count = answer_batch(i, k, last, far_start, False, d, pairs, law, dt, cell, numbers, which)
        for m in range(count):
            if one[m] > now:
                finish_discs(now, one[m], (fx, fy, moment), far_start, far, d)
                now = one[m]
                fx, fy, moment = 0.0, 0.0, 0.0
            j = np.uint64(other[m])
            store_history(pairs.history, np.uint64(listed[m]), springs[m], rolls[m], law)
            add_lost(d.budget, one[m], lost, m, law)
            add_load(gx[m], gy[m], dx[m], dy[m], cell)
            fx += gx[m]
            fy += gy[m]
            moment += turn_i[m]
            force[j, 0] -= gx[m]
            force[j, 1] -= gy[m]
            torque[j] += turn_j[m]
    finish_discs(now, last, (fx, fy, moment), far_start, far, d)


@inline
def block_far_forces(first, last, far_start, far, d, pairs, law, dt, cell, numbers, which):
    """Contacts of discs ``first`` to ``last`` - 1 with partners in later blocks: overwrites their places of ``far``
    (f, 4), and springs.  Arguments as in block_forces."""
    gx, gy, turn_i, turn_j = answered(numbers)
    springs, rolls, lost = column(numbers, SPRING), column(numbers, ROLL), losses(numbers, d.budget)
    one, listed = column(which, ONE_DISC), column(which, PAIR)
    for q in range(far_start[first], far_start[last]):
        far[q, 0] = NOTHING
    i, k = first, np.int64(0)
    while i < last:
        i, k, count = answer_batch(i, k, last, far_start, True, d, pairs, law, dt, cell, numbers, which)
        for m in range(count):
            n = one[m]
            q = far_start[n + 1] - pairs.start[n + 1] + listed[m]
            far[q, 0], far[q, 1], far[q, 2], far[q, 3] = gx[m], gy[m], turn_i[m], turn_j[m]
            add_lost(d.budget, n, lost, m, law)
            store_history(pairs.history, np.uint64(listed[m]), springs[m], rolls[m], law)


@inline
def pair_forces(d, pairs, law, dt, cell, numbers, which):
    """Add the contacts of all listed pairs; reset the springs of those that do not touch.

    d: DiscArrays;  pairs: Pairs;  law see contact/law.py;  dt s;  cell Still or Straining, whose load is added to;
    numbers, which: one thread's ``scratch``.  Adds to ``d.force`` N/m and ``d.torque`` N m/m in the order of the list;
    overwrites ``pairs.history`` m.  Not checked: two centres in one place give nan, which Grains.check reports.
    """
    block_forces(np.int64(0), d.torque.shape[0], None, None, d, pairs, law, dt, cell, numbers, which)

"""Kernels of discs that sleep (sleep.py): tests for rest and for disturbance, and the list of contacts that must be
computed."""

from porescale.common.compiled.jit import inline, kernel

ASLEEP = 1
"""Entry of ``asleep`` (n,) uint8 of a disc that is left out; 0 of one that moves."""


@inline
def beyond(fx, fy, moment, radius, allowed):
    """Whether a force (N/m), or a torque (N m/m) over the radius (m), is more than ``allowed`` (N/m)."""
    return not (fx * fx + fy * fy <= allowed * allowed and abs(moment) <= allowed * radius)


@kernel
def rest_of(asleep, velocity, spin, radius, force, torque, held, speed, allowed, elapsed, quiet):
    """For how long discs have rested: overwrites ``quiet`` (n,) s of those awake.

    At rest are discs that are not held, go slower than ``speed`` (n,) m/s, rim and centre, and are out of balance by no
    more than half of ``allowed`` (n,) N/m.  ``elapsed`` s since the last call;  held (n, 3), or (0, 3) if none is.
    """
    for i in range(quiet.shape[0]):
        if asleep[i] == ASLEEP:
            continue
        still = velocity[i, 0] ** 2 + velocity[i, 1] ** 2 <= speed[i] ** 2 and abs(spin[i]) * radius[i] <= speed[i]
        if held.shape[0] and (held[i, 0] or held[i, 1] or held[i, 2]):
            still = False
        if still and not beyond(force[i, 0], force[i, 1], torque[i], radius[i], 0.5 * allowed[i]):
            quiet[i] += elapsed
        else:
            quiet[i] = 0.0


@kernel
def fall_asleep(asleep, quiet, after, velocity, spin, mass, inertia, removed):
    """Put to sleep discs that have rested for ``after`` s: overwrites ``asleep``, velocities and spins; returns how
    many.

    Adds to ``removed`` (n,) J/m the kinetic energy taken from each.
    """
    count = 0
    for i in range(quiet.shape[0]):
        if asleep[i] != ASLEEP and quiet[i] >= after:
            u, v, w = velocity[i, 0], velocity[i, 1], spin[i]
            removed[i] += 0.5 * (mass[i] * (u * u + v * v) + inertia[i] * w * w)
            velocity[i, 0], velocity[i, 1], spin[i] = 0.0, 0.0, 0.0
            asleep[i] = ASLEEP
            count += 1
    return count


@kernel
def disturbed(index, balance, external_force, external_torque, radius, allowed, force, torque, called):
    """Sleepers out of ``index`` (m,) that are out of balance by more than ``allowed`` (n,) N/m; returns how many.

    balance (n, 3) N/m, N/m, N m/m: of their contacts, to which the external force (n, 2) and torque (n,) are added;
    the sums overwrite force (n, 2) and torque (n,).  Overwrites ``called`` (n,) with 1 for each of them.
    """
    count = 0
    for m in range(index.shape[0]):
        i = index[m]
        fx = balance[i, 0] + external_force[i, 0]
        fy = balance[i, 1] + external_force[i, 1]
        moment = balance[i, 2] + external_torque[i]
        force[i, 0], force[i, 1], torque[i] = fx, fy, moment
        if beyond(fx, fy, moment, radius[i], allowed[i]):
            called[i] = 1
            count += 1
    return count


@kernel
def wake(asleep, called, start, partner, quiet):
    """Wake discs marked in ``called`` (n,) and all that are listed with them: overwrites ``asleep`` and ``quiet``;
    called ends as 0.  start (n + 1,), partner: half list.  Neighbours wake too, so that a blow does not wake one disc a
    call.
    """
    for i in range(asleep.shape[0]):
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            if called[i] == 1 and called[j] == 0:
                called[j] = 2
            elif called[j] == 1 and called[i] == 0:
                called[i] = 2
    for i in range(asleep.shape[0]):
        if called[i] != 0:
            if asleep[i] == ASLEEP:
                asleep[i], quiet[i] = 0, 0.0
            called[i] = 0


@kernel
def find_border(asleep, start, partner, role):
    """Overwrites ``role`` (n,): 0 of sleepers listed with no disc that moves, 1 of the others, 2 of moving discs."""
    for i in range(asleep.shape[0]):
        role[i] = 0 if asleep[i] == ASLEEP else 2
    for i in range(asleep.shape[0]):
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            if asleep[i] != asleep[j]:
                sleeper = i if asleep[i] == ASLEEP else j
                role[sleeper] = 1


@kernel
def list_part(asleep, frozen, index, number, start, partner, part_start, part_partner, origin):
    """The pairs of a half list between members ``index`` (m,) of a part: among sleepers if ``frozen``, else those with
    one that moves.  number (n,): place of each member in the part, -1 of others.  Overwrites part_start (m + 1,),
    part_partner and origin (their places in the list), as far as there is room; returns how many.
    """
    total = 0
    part_start[0] = 0
    for m in range(index.shape[0]):
        i = index[m]
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            both = asleep[i] == ASLEEP and asleep[j] == ASLEEP
            if number[j] >= 0 and both == frozen:
                if total < part_partner.shape[0]:
                    part_partner[total] = number[j]
                    origin[total] = k
                total += 1
        part_start[m + 1] = total
    return total


@kernel
def take_out(index, asleep, balance, d, part):
    """Copy state and external loads of discs ``index`` (m,) of ``d`` to ``part``, both DiscArrays.

    To the external loads of sleepers what their contacts with other sleepers do is added, ``balance`` (n, 3).
    """
    for m in range(index.shape[0]):
        i = index[m]
        for a in range(2):
            part.position[m, a] = d.position[i, a]
            part.velocity[m, a] = d.velocity[i, a]
            part.external_force[m, a] = d.external_force[i, a]
        part.angle[m], part.spin[m], part.external_torque[m] = d.angle[i], d.spin[i], d.external_torque[i]
        if asleep[i] == ASLEEP:
            part.external_force[m, 0] += balance[i, 0]
            part.external_force[m, 1] += balance[i, 1]
            part.external_torque[m] += balance[i, 2]


@kernel
def put_back(index, asleep, d, part, count, allowed, called):
    """Copy the state of ``part``, after ``count`` steps, back to the discs ``index`` (m,) of ``d`` that do not sleep.

    Of those that do, ``part.withheld`` (m, 3), summed over the steps, is what they are out of balance by: its mean
    overwrites their force and torque; those with more than ``allowed`` (n,) N/m are ``called`` (n,).  Returns how many.
    """
    calls = 0
    for m in range(index.shape[0]):
        i = index[m]
        if asleep[i] == ASLEEP:
            fx, fy = part.withheld[m, 0] / count, part.withheld[m, 1] / count
            moment = part.withheld[m, 2] / count
            d.force[i, 0], d.force[i, 1], d.torque[i] = fx, fy, moment
            if beyond(fx, fy, moment, d.radius[i], allowed[i]):
                called[i] = 1
                calls += 1
        else:
            for a in range(2):
                d.position[i, a] = part.position[m, a]
                d.velocity[i, a] = part.velocity[m, a]
                d.force[i, a] = part.force[m, a]
            d.angle[i], d.spin[i], d.torque[i] = part.angle[m], part.spin[m], part.torque[m]
    return calls


@kernel
def return_history(origin, history, part_history):
    """Copy the springs of a part's pairs (p, s) m back to rows ``origin`` (p,) of ``history``."""
    for k in range(origin.shape[0]):
        for a in range(history.shape[1]):
            history[origin[k], a] = part_history[k, a]


@kernel
def return_springs(index, spring, part_spring):
    """Copy the springs (s, m, c) of discs ``index`` (m,) at s surfaces back to spring (s, n, c)."""
    for s in range(spring.shape[0]):
        for m in range(index.shape[0]):
            for a in range(spring.shape[2]):
                spring[s, index[m], a] = part_spring[s, m, a]


@kernel
def differs(table, seen, columns):
    """Whether the first ``columns`` of two tables (s, c) differ anywhere."""
    for s in range(table.shape[0]):
        for c in range(columns):
            if table[s, c] != seen[s, c]:
                return True
    return False


@kernel
def any_speed(table, first, last):
    """Whether columns ``first`` to ``last`` of a table (s, c) hold anything but zeros."""
    for s in range(table.shape[0]):
        for c in range(first, last):
            if table[s, c] != 0.0:
                return True
    return False

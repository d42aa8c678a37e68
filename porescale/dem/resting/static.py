"""Discs that are all held and at rest, without contacts: nothing can move, and the constraints bear what acts on
them from outside.  Their contact steps change nothing else, and are left out.
"""

from porescale.common.compiled.jit import kernel
from porescale.dem.motion.periodic_cell import image
from porescale.dem.state import State, StaticState


@kernel
def resting(held, velocity, spin):
    """Whether all discs are held (n, 3) altogether, with no velocity (n, 2) m/s and spin (n,) rad/s."""
    for i in range(spin.shape[0]):
        if not (held[i, 0] and held[i, 1] and held[i, 2]):
            return False
        if not (velocity[i, 0] == 0.0 and velocity[i, 1] == 0.0 and spin[i] == 0.0):
            return False
    return True


@kernel
def clear(position, radius, start, partner, walls, cell):
    """Whether no listed pair touches, and no disc a wall (w, 4 or wider): as in forces/pairs.py and forces/walls.py."""
    for i in range(radius.shape[0]):
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            dx, dy = image(position[j, 0] - position[i, 0], position[j, 1] - position[i, 1], cell)
            if not dx * dx + dy * dy >= (radius[i] + radius[j]) * (radius[i] + radius[j]):
                return False
        for w in range(walls.shape[0]):
            distance = (position[i, 0] - walls[w, 0]) * walls[w, 2] + (position[i, 1] - walls[w, 1]) * walls[w, 3]
            if not radius[i] - distance <= 0.0:
                return False
    return True


@kernel
def unchanged(position, radius, walls, last_position, last_radius, last_walls):
    """Whether positions (n, 2) m, radii (n,) m and walls (w, WALL) are, number by number, what they were last."""
    if walls.shape[0] != last_walls.shape[0]:
        return False
    for i in range(radius.shape[0]):
        if position[i, 0] != last_position[i, 0] or position[i, 1] != last_position[i, 1]:
            return False
        if radius[i] != last_radius[i]:
            return False
    for w in range(walls.shape[0]):
        for k in range(walls.shape[1]):
            if walls[w, k] != last_walls[w, k]:
                return False
    return True


@kernel
def bear(count, d, walls, last):
    """Whether all discs are held and at rest, and they and the walls as they were last; if so, what ``count`` steps
    write.

    d: DiscArrays;  walls (w, WALL);  last: StaticState.  Overwrites d.withheld (n, 3) with the mean of the external
    loads over the steps, rounded as they round it.  Returning False, it writes nothing.
    """
    if not resting(d.held, d.velocity, d.spin):
        return False
    if not unchanged(d.position, d.radius, walls, last.position, last.radius, last.walls):
        return False
    force, torque, withheld = d.external_force, d.external_torque, d.withheld
    for i in range(d.spin.shape[0]):
        fx, fy, moment = 0.0, 0.0, 0.0
        for _ in range(count):
            fx += force[i, 0]
            fy += force[i, 1]
            moment += torque[i]
        withheld[i, 0], withheld[i, 1], withheld[i, 2] = fx / count, fy / count, moment / count
    return True


def others_are_about(grains: State) -> bool:
    """Whether a step does more than discs and walls: plates, rectangles, bodies, bonds, sleep or an energy budget."""
    others = grains.drivers, grains.segments, grains.bonds, grains.sleep, grains.budget
    return bool(len(grains.plates) or len(grains.rectangles) or any(other is not None for other in others))


def what_stands(grains: State, drag: float) -> StaticState | None:
    """What ``grains`` are right after a step in full, if another would leave them so; None if something may change.

    Copies go into those of the step before, if there are any.
    """
    d, pairs, walls, last = grains.discs, grains.pairs, grains.walls, grains.static
    if grains.stale or others_are_about(grains) or not resting(grains.held, d.velocity, d.spin):
        return None
    if not clear(d.position, d.radius, pairs.start, pairs.partner, walls, grains.cell):
        return None
    if last is None or last.walls.shape != walls.shape:
        return StaticState(d.position.copy(), d.radius.copy(), walls.copy(), grains.last_dt, drag)
    last.position[:], last.radius[:], last.walls[:] = d.position, d.radius, walls
    return last._replace(dt=grains.last_dt, drag=drag)


def leave_out(grains: State, last: StaticState, dt: float, count: int, drag: float) -> bool:
    """Do ``count`` contact steps under grains.external_force and external_torque, if all stands as it did ``last``,
    without doing each; else False, and nothing is done.  Other arguments as in Grains.step.
    """
    if dt != last.dt or drag != last.drag or not count > 0 or others_are_about(grains):
        return False
    if not bear(count, grains.disc_arrays(), grains.walls, last):
        return False
    grains.steps += count
    grains.steps_of_dt += count
    return True

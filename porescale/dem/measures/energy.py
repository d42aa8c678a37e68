"""Energy budget of grains: work supplied, energy stored and energy dissipated.

Kept by ``Grains(..., energy=True)``: contact kernels enter losses and works at every step, at the lower disc of a pair
(contact/law.py), the integrator those of external forces, holders and drag.  Entries follow leap-frog: with positions
at whole and velocities at half steps
    m/2 v(n+1/2).v(n-1/2) - m/2 v(n-1/2).v(n-3/2) = (F(n) + F(n-1))/2 . v(n-1/2) dt      (exactly),
so the kinetic energy of step n is the product of the velocities around it, and work is that of the mean force at both
ends of a step.  Springs and weights obey that up to the curvature of the path; dashpots, whose force lags by half a
step, moving surfaces and forces that change from call to call to first order in the step.  What is left is the
``residual``.

All terms refer to the last force evaluation: positions a step back, springs and losses as they were left by it.
Velocities that an owner writes between steps are no work here: held components are left out of the kinetic energy.
Bonds made on the way are no work either (count_in_bonds).
"""

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.bodies.bonding import framed_parts
from porescale.dem.contact.budget import (
    BEFORE_SPIN,
    BEFORE_X,
    DRAG,
    EXTERNAL,
    FRICTION,
    HOLDERS,
    NORMAL_DASHPOT,
    ROLLING_DASHPOT,
    ROLLING_FRICTION,
    SURFACES,
    TANGENTIAL_DASHPOT,
)
from porescale.dem.contact.law import load_history, material_of, stored
from porescale.dem.forces.bonds import stored_in_bonds
from porescale.dem.forces.rectangle import BOTTOM, LEFT, RIGHT, TOP, VELOCITY_X
from porescale.dem.forces.segments import survey_segments
from porescale.dem.forces.walls import HIGH, LOW, NX, NY, PRESENT, PX, TURN, VELOCITY, VX, X
from porescale.dem.motion.affine_strain import WORK
from porescale.dem.motion.periodic_cell import before, image
from porescale.dem.state import State

LOSSES = {
    "lost in normal dashpots (J/m)": NORMAL_DASHPOT,
    "lost in tangential dashpots (J/m)": TANGENTIAL_DASHPOT,
    "lost in friction (J/m)": FRICTION,
    "lost in rolling dashpots (J/m)": ROLLING_DASHPOT,
    "lost in rolling friction (J/m)": ROLLING_FRICTION,
    "lost to background drag (J/m)": DRAG,
}
WORKS = {"work of moving surfaces (J/m)": SURFACES, "work of holders (J/m)": HOLDERS}


@kernel
def elastic_pairs(position, radius, material, pairs, law, cell):
    """Elastic energy of all pairs, J/m: (normal, tangential, rolling).  Arguments as in pairs.pair_forces."""
    start, partner, history = pairs.start, pairs.partner, pairs.history
    normal, tangential, rolling = 0.0, 0.0, 0.0
    for i in range(radius.shape[0]):
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            dx, dy = image(position[j, 0] - position[i, 0], position[j, 1] - position[i, 1], cell)
            overlap = radius[i] + radius[j] - np.sqrt(dx * dx + dy * dy)
            if overlap > 0.0:
                p = law.table[material_of(material, i), material_of(material, j)]
                spring, roll = load_history(history, k, law)
                parts = stored(overlap, spring, roll, radius[i] * radius[j] / (radius[i] + radius[j]), p, law)
                normal, tangential, rolling = normal + parts[0], tangential + parts[1], rolling + parts[2]
    return normal, tangential, rolling


@kernel
def elastic_surface(distance, radius, material, memory, laws, law):
    """Elastic energy of all discs at one surface, J/m: (normal, tangential, rolling).

    distance (n,) m from the centres;  memory (n, 1 or 2) m;  laws (m, COLUMNS) with each material.
    """
    normal, tangential, rolling = 0.0, 0.0, 0.0
    for i in range(radius.shape[0]):
        overlap = radius[i] - distance[i]
        if overlap > 0.0:
            spring, roll = load_history(memory, i, law)
            parts = stored(overlap, spring, roll, radius[i], laws[material_of(material, i)], law)
            normal, tangential, rolling = normal + parts[0], tangential + parts[1], rolling + parts[2]
    return normal, tangential, rolling


def distances(grains: State, position: Floats, dt: float) -> list[tuple[Floats, Floats, Floats]]:
    """(distance (n,) m, springs (n, s) m, laws (m, COLUMNS)) of every surface, ``dt`` (s) before now.

    Negative inside of rectangles and behind walls, infinite from plates that are gone.
    """
    found = []
    x, y = position.T
    for row, memory, laws in zip(grains.walls, grains.wall_spring, grains.wall_laws, strict=True):
        cosine, sine = np.cos(dt * row[TURN]), -np.sin(dt * row[TURN])
        normal = np.array([cosine * row[NX] - sine * row[NY], sine * row[NX] + cosine * row[NY]])
        found.append(((position - row[PX : PX + 2] + dt * row[VX : VX + 2]) @ normal, memory, laws))
    for row, memory, laws in zip(grains.plates, grains.plate_spring, grains.plate_laws, strict=True):
        rise = row[VELOCITY] * row[PRESENT] * dt
        away = np.hypot(row[X] - x, np.clip(y, row[LOW] - rise, row[HIGH] - rise) - y)
        found.append((away if row[PRESENT] else np.full_like(x, np.inf), memory, laws))
    for row, memory, laws in zip(grains.rectangles, grains.rectangle_spring, grains.rectangle_laws, strict=True):
        at = position + dt * row[VELOCITY_X : VELOCITY_X + 2]
        outside = np.hypot(*(np.clip(at, row[[LEFT, BOTTOM]], row[[RIGHT, TOP]]) - at).T)
        depth = np.minimum(at - row[[LEFT, BOTTOM]], row[[RIGHT, TOP]] - at).min(axis=1)
        found.append((np.where(outside > 0.0, outside, -depth), memory, laws))
    return found


def elastic(grains: State, dt: float = 0.0) -> tuple[float, float, float]:
    """Elastic energy of all contacts, J/m, ``dt`` (s) before now: (normal, tangential, rolling).

    That of back tension (bonds.py), below zero, belongs to the normal part.
    """
    d, material = grains.discs, grains.material
    position, cell = before(d.position, d.velocity, grains.cell, dt)
    parts = [elastic_pairs(position, d.radius, material, grains.pair_arrays(), grains.contact, cell)]
    for distance, memory, laws in distances(grains, position, dt):
        parts.append(elastic_surface(distance, d.radius, material, memory, laws, grains.contact))
    framed = framed_parts(grains)
    if framed is not None:
        segments, bonds = framed
        parts.append(survey_segments(position, d.radius, material, segments, grains.contact, grains.cell)[3:])
        parts.append((stored_in_bonds(position, d.radius, segments, bonds, grains.cell), 0.0, 0.0))
    normal, tangential, rolling = (float(part) for part in np.sum(parts, axis=0))
    return normal, tangential, rolling


def energy_of_bonds(grains: State) -> float:
    """Energy of all bonds that hold, J/m, below zero: the mean of that now and at the last force evaluation, so that of
    bonds just made is what is missing once their first force has done work over half a step."""
    framed = framed_parts(grains)
    if framed is None:
        return 0.0
    segments, bonds = framed
    d, found = grains.discs, 0.0
    for dt in (0.0, grains.last_dt):
        position, cell = before(d.position, d.velocity, grains.cell, dt)
        found += 0.5 * float(stored_in_bonds(position, d.radius, segments, bonds, cell))
    return found


def count_in_bonds(grains: State, was: float) -> None:
    """Count bonds made since ``energy_of_bonds`` gave ``was`` (J/m) as there from the begin of the budget on: what
    makes them is no work of anything in it.  Nothing where no budget has begun."""
    if grains.budget_start is not None:
        grains.budget_start[0] += energy_of_bonds(grains) - was


def kinetic(grains: State, budget: Floats) -> tuple[float, float]:
    """Kinetic energy of the last force evaluation, J/m: (translation, rotation), without held components.

    Members of a clump translate with its centroid; what they move besides is its rotation.  In a strained cell
    velocities are those relative to it, and members move besides as the cell does at their places, which is no energy.
    """
    d = grains.discs
    along = d.velocity * budget[:, BEFORE_X : BEFORE_X + 2]
    around = d.spin * budget[:, BEFORE_SPIN]
    if len(grains.held):
        along, around = np.where(grains.held[:, :2], 0.0, along), np.where(grains.held[:, 2], 0.0, around)
    moving, turning = 0.5 * float(d.mass @ along.sum(axis=1)), 0.5 * float(d.inertia @ around)
    if grains.drivers is not None and grains.drivers.clumps.count:
        clumps = grains.drivers.clumps
        body, share = clumps.group[clumps.member], d.mass[clumps.member]
        now, then = (
            np.array([np.bincount(body, share * speed[clumps.member, axis], clumps.count) for axis in range(2)])
            for speed in (d.velocity, budget[:, BEFORE_X : BEFORE_X + 2])
        )
        rest = 0.5 * float(share @ along[clumps.member].sum(axis=1)) - 0.5 * float(np.sum(now * then / clumps.mass))
        moving, turning = moving - rest, turning + rest
        if grains.drivers.cell is not None:
            own, first = clumps.inertia.copy(), clumps.member[clumps.start[:-1]]
            own -= np.bincount(body, d.inertia[clumps.member], clumps.count)
            turning += 0.5 * float(own @ (d.spin[first] * budget[first, BEFORE_SPIN])) - rest
    return moving, turning


def open_budget(grains: State, budget: Floats, dt: float) -> Floats:
    """Start of the budget before a first step of ``dt`` (s): (kinetic and elastic energy J/m, sum m x, sum m y kg m/m).

    Overwrites the velocities before the last force in ``budget``: those of now.
    """
    d = grains.discs
    budget[:, BEFORE_X : BEFORE_X + 2], budget[:, BEFORE_SPIN] = d.velocity, d.spin
    return np.array([sum(kinetic(grains, budget)) + sum(elastic(grains, dt)), *moment(grains, dt)])


def moment(grains: State, dt: float) -> Floats:
    """Sum of m x over discs, (2,) kg m/m, ``dt`` (s) before now."""
    d = grains.discs
    total: Floats = d.mass @ (d.position - dt * d.velocity)
    return total


def energy_budget(grains: State, acceleration: tuple[float, float] = (0.0, 0.0)) -> dict[str, float]:
    """The budget of ``grains`` by the names of its entries, J/m, since its first step; zeros before that.

    acceleration : of free fall, m/s^2; its work is the potential energy, and what the external forces did besides is
    their work.  "turned over" is half the sum of all changes: every joule leaves one entry and enters another.
    A strained cell does work, and all is said relative to it: there must be no ``acceleration`` then.  Raises
    InputError where no budget is kept.

    kinetic energy of translation (J/m) : of all discs
    kinetic energy of rotation (J/m) : of all discs
    potential energy (J/m) : in the field of gravity
    elastic energy, normal (J/m) : stored in normal springs of contacts and in bonds
    elastic energy, tangential (J/m) : stored in tangential springs
    elastic energy, rolling (J/m) : stored in rolling springs
    lost in normal dashpots (J/m) : since the budget began
    lost in tangential dashpots (J/m) : since the budget began
    lost in friction (J/m) : in sliding contacts, since the budget began
    lost in rolling dashpots (J/m) : since the budget began
    lost in rolling friction (J/m) : since the budget began
    lost to background drag (J/m) : since the budget began
    work of external forces (J/m) : other than gravity, such as those of the fluid, since the budget began
    work of moving surfaces (J/m) : of walls, plates and rectangles, since the budget began
    work of holders (J/m) : of what holds or drives bodies, since the budget began
    work of the cell (J/m) : of the strain of a periodic cell, since the budget began
    residual (J/m) : what does not close: energy now less that at the begin, plus losses, less works
    turned over (J/m) : half of the sum of all changes, to hold the residual against
    """
    budget, start, dt = grains.budget, grains.budget_start, grains.last_dt
    if budget is None:
        raise InputError(Fault("energy", False, "no energy budget is kept", repair="make Grains with energy=True"))
    if start is None:
        start, dt = open_budget(grains, budget, 0.0), 0.0
    moving, turning = kinetic(grains, budget)
    normal, tangential, rolling = elastic(grains, dt)
    g = np.asarray(acceleration, float)
    height, height_before = -float(g @ moment(grains, dt)), -float(g @ start[1:])
    total = budget.sum(axis=0)
    losses = {name: float(total[column]) for name, column in LOSSES.items()}
    works = {
        "work of external forces (J/m)": float(total[EXTERNAL]) + height - height_before,
        **{name: float(total[column]) for name, column in WORKS.items()},
    }
    if grains.drivers is not None and grains.drivers.cell is not None:
        works["work of the cell (J/m)"] = float(grains.drivers.cell[WORK])
    kept = moving + turning + normal + tangential + rolling
    residual = kept + height - float(start[0]) - height_before + sum(losses.values()) - sum(works.values())
    changes = [kept - float(start[0]), height - height_before, *losses.values(), *works.values()]
    return {
        "kinetic energy of translation (J/m)": moving,
        "kinetic energy of rotation (J/m)": turning,
        "potential energy (J/m)": height,
        "elastic energy, normal (J/m)": normal,
        "elastic energy, tangential (J/m)": tangential,
        "elastic energy, rolling (J/m)": rolling,
        **losses,
        **works,
        "residual (J/m)": residual,
        "turned over (J/m)": 0.5 * sum(abs(change) for change in changes),
    }

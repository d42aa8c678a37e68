"""Clumps: rigid bodies made of discs that may overlap.

Every member keeps its row among the discs, where contacts, pair list and fluid find it; contacts between members
of one clump are left out.  A clump's mass is that of the union of its members at one density, exact
(union.py), or given by hand.  The members' rows hold shares of it, m_i > 0 with
    sum m_i = M,     sum m_i o_i = 0,     sum (m_i |o_i|^2 + I_i) = I,     o_i from the centroid to the member,
so that sums over discs of momentum, angular momentum, energy and weight are those of the bodies.  Such shares exist as
the centroid of a union lies within the hull of its centres: reflected at a line beside all centres, what lies beyond
the line falls on other parts of the union.  The ones taken are w_i exp(l.o_i), which stay closest (in relative entropy)
to the lengths w_i of outline that the members show.  Of long rows and of pieces apart these have more second moment
than the body, as ends show more outline than the middle; then w_i exp(l.o_i - b |o_i|^2) are taken, with a b that
leaves every member the moment of a disc of its mass.  Frames of segments (frames.py) have their corners as members, far
out: the shares I_i of their inertia come out negative, the sums hold all the same.

Motion: forces of members are summed about the centroid at the whole step; the body is kicked and drifts like a disc;
members then sit at their places, with the rigid body's velocity there.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.compiled.jit import kernel
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.arrays import contact_arrays
from porescale.dem.bodies.union import outline
from porescale.dem.discs import Discs, overwrite

NEWTON_STEPS = 100
LEAST = 1e-3  # of the radius: outline with which a member that shows none is counted
DRAWN = tuple(2.0 ** (0.5 * k - 5.0) for k in range(19))
"""b of `drawn_in`, over the square of the largest distance: rows of 8 to 200 discs need 0.03 to 0.36."""
MOVING = ("position", "angle", "velocity", "spin", "arm", "force", "torque", "held", "withheld")
"""Names of the arrays of :class:`Clumps` that change as it moves."""


@dataclass(frozen=True)
class Body:
    """Mass kg/m, centroid (m) and moment of inertia about it (kg m^2/m) given by hand.

    frame : the members are the corners of a frame of segments, and may be points;  area : m^2, None: of the union;
    own : its centroid, m, where no force moves it: the point that is given as its centroid and about which it turns may
    then lie anywhere, as the hinge of a door; its mass stays about its own, and its inertia is that about the hinge.
    """

    mass: float
    centroid: tuple[float, float]
    inertia: float
    frame: bool = False
    area: float | None = None
    own: tuple[float, float] | None = None


class ClumpArrays(NamedTuple):
    """Clumps as kernels take them: fields as in Clumps, those of the bodies named as those of discs."""

    start: NDArray[np.int64]
    member: NDArray[np.int64]
    offset: Floats
    arm: Floats
    turn: Floats
    position: Floats
    angle: Floats
    velocity: Floats
    spin: Floats
    mass: Floats
    inertia: Floats
    force: Floats
    torque: Floats
    held: NDArray[np.uint8]
    withheld: Floats


class Clumps:
    """b clumps with k members in all, in the order given.

    start (b + 1,) int64, member (k,) int64: clump c has the discs ``member[start[c]:start[c + 1]]``;
    mass, inertia (b,) kg/m, kg m^2/m;  position (b, 2) m, angle (b,) rad at whole steps, velocity (b, 2) m/s, spin (b,)
    rad/s at half steps: of the centroid;  offset (k, 2) m from it to the members at angle 0, arm (k, 2) now;
    turn (k,) rad: a member's angle less the body's;  force (b, 2) N/m and torque (b,) N m/m of the last step;
    held, withheld (b, 3) as of discs;  group (n,) int32: clump of every disc, -1 for none;  corner_contacts (k,):
    number assumed at a corner and its segments (stable step), 0 for members that are discs.
    """

    def __init__(
        self, discs: Discs, members: Sequence[ArrayLike], density: ArrayLike, bodies: Sequence[Body | None] = ()
    ) -> None:
        """Bind ``discs``; overwrites mass, inertia, velocity and spin of the members.

        members : disc numbers of each clump;  density kg/m^3, a number or one for each clump, not used where ``bodies``
        gives the numbers.  The motion of a clump at the start is that with the momentum and angular momentum of its
        members as they are given.  Raises InputError at a disc of two clumps, one within another, or a centroid or
        inertia that no shares can have.
        """
        listed = [np.asarray(each, np.int64).ravel() for each in members]
        self.start = np.concatenate(([0], np.cumsum([len(each) for each in listed]))).astype(np.int64)
        self.member = np.concatenate([np.zeros(0, np.int64), *listed])
        self._check(discs.count)
        self.radius = discs.radius[self.member]
        count = len(listed)
        self.group = np.full(discs.count, -1, np.int32)
        self.group[self.member] = np.repeat(np.arange(count), np.diff(self.start))
        self.mass, self.inertia = np.zeros(count), np.zeros(count)
        self.position, self.velocity = np.zeros((count, 2)), np.zeros((count, 2))
        self.angle, self.spin = np.zeros(count), np.zeros(count)
        self.offset = np.zeros((len(self.member), 2))
        self.force, self.torque = np.zeros((count, 2)), np.zeros(count)
        self.held, self.withheld = np.zeros((count, 3), np.uint8), np.zeros((count, 3))
        self._areas = [None if body is None else body.area for body in bodies or [None] * count]
        heavy = np.broadcast_to(np.asarray(density, float), (count,))
        for c in range(count):
            self._weigh(c, discs, float(heavy[c]), bodies[c] if len(bodies) else None)
        self.arm, self.turn = self.offset.copy(), discs.angle[self.member]
        self.corner_contacts = np.zeros(len(self.member))
        self.place(discs)

    def place(self, discs: Discs) -> None:
        """Put the members of every clump where the body is, moving as it does: overwrites their rows."""
        at = contact_arrays(discs.position, discs.velocity, discs.spin, discs.radius, discs.mass)
        place_members(self.arrays(), at._replace(angle=discs.angle), 0.0, 0.0, 0.0)

    def arrays(self) -> ClumpArrays:
        """The clumps as kernels take them."""
        return ClumpArrays(*(getattr(self, name) for name in ClumpArrays._fields))

    @property
    def count(self) -> int:
        """Number of clumps of the system."""
        return len(self.mass)

    @cached_property
    def area(self) -> Floats:
        """Area of each clump, (b,) m^2: as given, or of the union of its discs; of points none."""
        found = np.zeros(self.count)
        for c, given in enumerate(self._areas):
            own = slice(*self.start[c : c + 2])
            found[c] = given or (outline(self.offset[own], self.radius[own]).area if self.radius[own].any() else 0.0)
        return found

    def discs_of(self, clump: int) -> NDArray[np.int64]:
        """Numbers of the discs of ``clump``."""
        return self.member[self.start[clump] : self.start[clump + 1]]

    def _check(self, count: int) -> None:
        for c, size in enumerate(np.diff(self.start)):
            if size < 1:
                raise InputError(Fault(f"clump[{c}]", problem="has no disc"))
        bad = self.member[(self.member < 0) | (self.member >= count)]
        if len(bad):
            raise InputError(Fault("clump", int(bad[0]), "no such disc", allowed=f"0 to {count - 1}"))
        number, times = np.unique(self.member, return_counts=True)
        if np.any(times > 1):
            raise InputError(Fault("clump", int(number[times > 1][0]), "this disc is a member twice"))

    def _check_hidden(self, own: NDArray[np.int64], name: str, discs: Discs) -> None:
        for k, i in enumerate(own):
            within = np.hypot(*(discs.position[own] - discs.position[i]).T) + discs.radius[i] <= discs.radius[own]
            within[k] = False
            if within.any():
                where = f"lies within disc {own[within.argmax()]}"
                raise InputError(Fault(f"{name}.disc", int(i), where, repair="leave it out: nothing can touch it"))

    def _weigh(self, c: int, discs: Discs, density: float, body: Body | None) -> None:
        """Mass, place and motion of clump c, and the shares of its members."""
        own, name = self.discs_of(c), f"clump[{c}]"
        frame = body is not None and body.frame
        if not frame:
            self._check_hidden(own, name, discs)
        weight = np.ones(len(own))
        if body is None or not frame:
            union = outline(discs.position[own], discs.radius[own])
            weight = discs.radius[own] * np.maximum(union.exposed, LEAST * discs.radius[own])
        if body is None:
            if not (density > 0.0 and np.isfinite(density)):
                raise InputError(Fault(f"{name}.density", density, "", "kg/m^3", "> 0"))
            body = Body(density * union.area, tuple(union.centroid.tolist()), density * union.second_moment)
        self.mass[c], self.inertia[c], self.position[c] = body.mass, body.inertia, body.centroid
        offset = discs.position[own] - self.position[c]
        size = max(float(discs.radius[own].max()), float(np.abs(offset).max()) if frame else 0.0)
        share = shares(weight, offset, size) if body.mass > 0.0 else None
        if share is not None and not frame:
            share = drawn_in(share, weight, offset, discs.radius[own], body.inertia / body.mass)
        if share is None and body.own is not None:
            away = np.array(body.own) - self.position[c]
            share = shares(weight, offset - away, size)
            self.inertia[c] += body.mass * float(away @ away)
        if share is None:
            raise InputError(Fault(f"{name}.centroid", body.centroid, "must lie amid the members", "m"))
        momentum = discs.mass[own] @ discs.velocity[own]
        given = float(discs.mass[own].sum())
        self.velocity[c] = momentum / given
        slip = discs.velocity[own] - self.velocity[c]
        turning = discs.mass[own] @ (offset[:, 0] * slip[:, 1] - offset[:, 1] * slip[:, 0])
        turning += discs.inertia[own] @ discs.spin[own]
        about = discs.mass[own] @ np.sum(offset**2, axis=1) + discs.inertia[own].sum()
        self.spin[c] = turning / about
        mass = body.mass * share
        rest = float(self.inertia[c]) - float(mass @ np.sum(offset**2, axis=1))
        if not (rest > 0.0 or (frame and body.inertia > 0.0)):
            raise InputError(Fault(f"{name}.inertia", body.inertia, "", "kg m^2/m", f"> {body.inertia - rest:.6g}"))
        discs.mass[own] = mass
        around = weight if frame else weight * discs.radius[own]
        discs.inertia[own] = rest * around / around.sum()
        self.offset[self.start[c] : self.start[c + 1]] = offset

    def state(self) -> dict[str, Any]:
        """Copies of everything that moves, and of what it is made of."""
        return {name: getattr(self, name).copy() for name in MOVING}

    def restore(self, state: dict[str, Any]) -> None:
        """Overwrite what moves, bit for bit; raises InputError when the clumps are others."""
        overwrite({name: getattr(self, name) for name in MOVING}, state, "state.clumps")


def shares(weight: Floats, offset: Floats, radius: float) -> Floats | None:
    """Positive shares w exp(l.o) of 1 whose centre is the origin of ``offset`` (k, 2) m; None if there are none.
    radius (m): offsets below 1e-12 of it are none.

    Newton's method for the smallest of the convex sum w exp(l.o); collinear members need a least-squares step.
    """
    size = float(np.abs(offset).max())
    if size < 1e-12 * radius:
        return np.asarray(weight / weight.sum())
    way, tilt = offset / size, np.zeros(2)
    share: Floats = weight / weight.sum()
    for _ in range(NEWTON_STEPS):
        centre = share @ way
        if np.abs(centre).max() < 4e-16:
            break
        spread = (way * share[:, None]).T @ way - np.outer(centre, centre)
        step = np.linalg.lstsq(spread, -centre, rcond=1e-12)[0]
        tilt += step * min(1.0, 2.0 / max(float(np.abs(step).max()), 1e-300))
        power = way @ tilt
        share = np.asarray(weight * np.exp(power - power.max()))
        share /= share.sum()
    centred = float(np.abs(share @ way).max()) < 1e-13 and float(share.min()) > 1e-12
    return share if centred else None


def drawn_in(share: Floats, weight: Floats, offset: Floats, radius: Floats, second: float) -> Floats:
    """``share`` (k,) where it leaves some of the second moment of a body for its members to turn with, else the first
    of w exp(l.o - b |o|^2) that leaves each that of a disc, r^2/2 of its mass; ``share`` where none does.

    weight, offset : as of `shares`;  radius (k,) m;  second : moment of inertia over mass, m^2.
    """
    square = np.sum(offset**2, axis=1)
    if second - float(share @ square) > 0.0:
        return share
    for b in DRAWN:
        nearer = shares(weight * np.exp(-b * square / square.max()), offset, float(radius.max()))
        if nearer is not None and second - float(nearer @ square) > 0.5 * float(nearer @ radius**2):
            return nearer
    return share


@kernel
def place_members(c, d, gxx, gxy, gyy):
    """Put the members of every clump where the body is, moving as it does.

    c: ClumpArrays;  d: DiscArrays;  gxx, gxy, gyy 1/s: the cell's affine motion, relative to which velocities are.
    Overwrites c.arm (k, 2) m and the members' rows of position, angle, velocity and spin of the discs.
    """
    offset, arm, position, velocity, spin = c.offset, c.arm, c.position, c.velocity, c.spin
    disc_position, disc_velocity = d.position, d.velocity
    for b in range(spin.shape[0]):
        cosine, sine = np.cos(c.angle[b]), np.sin(c.angle[b])
        for k in range(c.start[b], c.start[b + 1]):
            i = c.member[k]
            ax = cosine * offset[k, 0] - sine * offset[k, 1]
            ay = sine * offset[k, 0] + cosine * offset[k, 1]
            arm[k, 0], arm[k, 1] = ax, ay
            disc_position[i, 0], disc_position[i, 1] = position[b, 0] + ax, position[b, 1] + ay
            disc_velocity[i, 0] = velocity[b, 0] - spin[b] * ay - gxx * ax - gxy * ay
            disc_velocity[i, 1] = velocity[b, 1] + spin[b] * ax - gyy * ay
            d.angle[i], d.spin[i] = c.angle[b] + c.turn[k], spin[b]


@kernel
def gather(c, disc_force, disc_torque):
    """Overwrite force (b, 2) N/m and torque (b,) N m/m of ClumpArrays ``c`` with the sums over members about the
    centroids, from force (n, 2) N/m and torque (n,) N m/m of the discs."""
    arm, force, torque = c.arm, c.force, c.torque
    for b in range(torque.shape[0]):
        fx, fy, moment = 0.0, 0.0, 0.0
        for k in range(c.start[b], c.start[b + 1]):
            i = c.member[k]
            fx += disc_force[i, 0]
            fy += disc_force[i, 1]
            moment += disc_torque[i] + arm[k, 0] * disc_force[i, 1] - arm[k, 1] * disc_force[i, 0]
        force[b, 0], force[b, 1], torque[b] = fx, fy, moment


def fastest(
    clumps: Clumps, radius: Floats, normal: float, tangential: float, rolling: float, neighbours: int,
    rolling_friction: float = 0.0,
) -> float:  # fmt: skip
    """Largest bound on w^2 (rad/s)^2 of all clumps for contact stiffnesses (N/m), or, with dashpots in their place
    (N s/m), on the damping rate 1/s;  radius (n,) m of all discs.

    As in integrate.packing_factor each contact counts twice at each end, and a disc of radius r has at most
    N = max(neighbours, pi (1 + r/r_min)) of them (``corner_contacts`` at a corner), spread so that the sum of n n^T is
    at most N/2.  With o the way from the centroid to a member, the translation block is at most N (k_n + k_t)/M summed
    over members, the rotation block N (k_n |o|^2 + 2 k_t (|o|/sqrt 2 + r)^2 + 2 k_r R^2)/I, R = r, or at a
    corner that of the largest disc, which may roll on its sides, but at most |o| over the friction of rolling, as half
    a side is no longer than the larger |o| of its ends; and the largest eigenvalue of both together at most their sum.
    """
    own, sizes = radius[clumps.member], radius[radius > 0.0]
    smallest = float(sizes.min()) if len(sizes) else 1.0
    touch, around = clumps.corner_contacts, np.maximum(float(neighbours), np.pi * (1.0 + own / smallest))
    touch = np.where(touch > 0.0, touch, around)
    far = np.hypot(*clumps.offset.T)
    at_sides = np.minimum(radius.max(), far / rolling_friction) if rolling_friction > 0.0 else own
    rolls_at = np.where(clumps.corner_contacts > 0.0, np.maximum(own, at_sides), own)
    turning = normal * far**2 + 2.0 * tangential * (np.sqrt(0.5) * far + own) ** 2 + 2.0 * rolling * rolls_at**2
    body = clumps.group[clumps.member]
    both = np.bincount(body, touch * (normal + tangential), clumps.count) / clumps.mass
    both += np.bincount(body, touch * turning, clumps.count) / clumps.inertia
    moving = ~clumps.held.all(axis=1)  # what is with a prescribed velocity gives no answer
    if moving.any() or np.any(clumps.group < 0):
        both = both[moving]
    return float(both.max(initial=0.0))

"""Clumps, controlled bodies, servo walls and strained cells: small experiments with exact answers.  SI."""

import math

import numpy as np
from scipy.special import ellipk

from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.network import moduli as elastic
from porescale.dem.motion.control import Moved
from porescale.dem.motion.drivers import Clump
from porescale.validation.dem.momentum import momentum_drift
from porescale.validation.dem.setups import DENSITY, MASS, RADIUS, STIFFNESS, free, law_at, slowest_wave, weights

VALIDATIONS = Validations()

PRESSED = 1e-4  # of a diameter: overlap of a lattice at the start


def lattice(
    law: Linear, cells: int, pressed: float = PRESSED, stretch: float = 0.0, skin: float = 0.2 * RADIUS
) -> Grains:  # fmt: skip
    """A periodic triangular lattice (cells x cells discs, even), overlapping by ``pressed`` of a diameter alike.

    stretch : taken off the height and added to the width, over ``pressed``: the twin that is not isotropic.
    """
    apart = 2.0 * RADIUS * (1.0 - pressed)
    wide, high = apart * (1.0 + stretch * pressed), math.sqrt(0.75) * apart * (1.0 - stretch * pressed)
    places = np.array([(wide * (i + 0.5 * (j % 2)), high * j) for j in range(cells) for i in range(cells)])
    box = Box((0.0, 0.0), (cells * wide, cells * high), *("periodic",) * 4)
    return Grains(make_discs(places, RADIUS, DENSITY), law, box, skin=skin)


def random_cell(
    law: Linear, seed: int, side: int = 6, skin: float | None = None, *, energy: bool = False
) -> Grains:  # fmt: skip
    """A periodic cell of side x side discs of radii 2:3, thrown about."""
    rng = np.random.default_rng(seed)
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2) + 0.5
    apart = 1.9 * RADIUS
    size = RADIUS * rng.uniform(2.0 / 3.0, 1.0, side**2)
    speed = rng.normal(0.0, 1.0, (side**2, 2))
    box = Box((0.0, 0.0), (side * apart, side * apart), *("periodic",) * 4)
    return Grains(make_discs(grid * apart, size, DENSITY, speed), law, box, skin=skin, energy=energy)


def clumped_cell(law: Linear, seed: int, side: int = 6, *, energy: bool = False) -> Grains:
    """The cell of `random_cell` with a smaller disc bound to the rim of every third one."""
    rng = np.random.default_rng(seed)
    plain, few = random_cell(law, seed, side), side**2 // 3
    angle = rng.uniform(0.0, 2.0 * math.pi, few)
    d = plain.discs
    at = np.concatenate(
        (d.position, d.position[:few] + 0.65 * RADIUS * np.column_stack((np.cos(angle), np.sin(angle))))
    )
    size = np.concatenate((d.radius, 0.5 * d.radius[:few]))
    speed = np.concatenate((d.velocity, d.velocity[:few]))
    grains = Grains(make_discs(at, size, DENSITY, speed), law, plain.box, energy=energy)
    grains.steering.bind([[k, side**2 + k] for k in range(few)], DENSITY)
    return grains


def clumped_cloud(seed: int = 1, friction: float = 0.5) -> Grains:
    """60 discs, two in three of them bound in overlapping pairs, thrown at each other and spinning, in free space."""
    rng = np.random.default_rng(seed)
    grid = np.stack(np.meshgrid(np.arange(7), np.arange(6)), axis=-1).reshape(-1, 2)[:40]
    size = RADIUS * rng.uniform(0.5, 1.0, 60)
    angle = rng.uniform(0.0, 2.0 * math.pi, 20)
    ways = np.array([np.cos(angle), np.sin(angle)]) * (0.4 * (size[:20] + size[40:]) + 0.6 * abs(size[:20] - size[40:]))
    at = (grid - 3.0) * 3.6 * RADIUS
    at = np.concatenate((at, at[:20] + ways.T))
    law = law_at(0.1, tangential_stiffness=0.25 * STIFFNESS, friction=friction, tangential_damping=50.0)
    grains = free(at, law, size)
    discs = grains.discs
    discs.velocity[:] = -40.0 * discs.position + rng.normal(0.0, 1.0, at.shape)
    discs.spin[:] = rng.normal(0.0, 100.0, 60)
    grains.steering.bind([[k, 40 + k] for k in range(20)], DENSITY)
    return grains


def dumbbell_bounce(
    angle: float, spin: float = 0.0, speed: float = 1e-3, steps_per_contact: float = 1000.0
) -> tuple[float, float]:
    """A dumbbell whose lower end hits a floor without friction or loss, falling at ``speed`` (m/s).

    Two discs that touch, the way between them at ``angle`` (rad) to the floor, turning at ``spin`` (1/m) times the
    speed.  Returns speed up and spin after, over the speed.
    """
    law = law_at(0.0)
    way = RADIUS * np.array([math.cos(angle), math.sin(angle)])
    lever = 2.0 * MASS * way[0] ** 2 / (3.0 * MASS * RADIUS**2)
    dt = law.contact_time(2.0 * MASS / (1.0 + lever)) / steps_per_contact
    gap = 0.5 * speed * dt
    grains = free(np.add([-way, way], (0.0, RADIUS + abs(way[1]) + gap)), law, floor=True)
    rate = spin * speed
    grains.discs.velocity[:] = rate * np.array([[way[1], -way[0]], [-way[1], way[0]]]) + (0.0, -speed)
    grains.discs.spin[:] = rate
    clump = grains.steering.bind([[0, 1]], DENSITY)
    grains.step(dt, count=int(1.2 * steps_per_contact) + 3)
    return float(clump.velocity[0, 1]) / speed, float(clump.spin[0]) / speed


def dumbbell_exact(angle: float, spin: float = 0.0) -> tuple[float, float]:
    """Exact `dumbbell_bounce`: J = -2 v_n/(1/M + a^2/I) up at the lower end, a = -r cos(angle) from the centroid."""
    mass = 2.0 * MASS
    inertia = 2.0 * (0.5 * MASS * RADIUS**2 + MASS * RADIUS**2)
    arm = -RADIUS * math.cos(angle)
    closing = -1.0 + spin * arm
    impulse = -2.0 * closing / (1.0 / mass + arm**2 / inertia)
    return -1.0 + impulse / mass, spin + arm * impulse / inertia


def pendulum_period(swing: float, steps: int = 20_000) -> float:
    """Period (s) of a clump of two touching discs held at its centroid, where only one disc has weight: a physical
    pendulum, let go at ``swing`` (rad).
    """
    way = RADIUS * np.array([math.sin(swing), -math.cos(swing)])
    grains = free(np.array([-way, way]), law_at(0.0))
    clump = grains.steering.bind([[0, 1]], DENSITY)
    grains.steering.control(Clump(0), x=Moved(), y=Moved())
    weights = np.array([[0.0, 0.0], [0.0, -MASS * GRAVITY]])
    guess = 2.0 * math.pi * math.sqrt(float(clump.inertia[0]) / (MASS * GRAVITY * RADIUS))
    dt, before, crossed = 1.5 * guess / steps, swing, []
    for _ in range(steps):
        grains.step(dt, weights)
        now = swing + float(clump.angle[0])
        if now * before < 0.0:
            crossed.append(grains.time - dt * now / (now - before))
        before = now
    return 2.0 * (crossed[1] - crossed[0])


def pendulum_exact(swing: float) -> float:
    """4 K(sin(swing/2)) sqrt(I/(m g r)), s."""
    inertia = 3.0 * MASS * RADIUS**2
    return float(4.0 * ellipk(math.sin(0.5 * swing) ** 2) * math.sqrt(inertia / (MASS * GRAVITY * RADIUS)))


def column_under_servo(load: float, count: int = 10, gravity: float = GRAVITY) -> tuple[float, float]:
    """Force (N/m) on the floor and on the lid of a column of ``count`` discs under its weight and a servo lid."""
    law = law_at(0.3)
    y = RADIUS * (2.0 * np.arange(count) + 1.0)
    grains = free(np.column_stack((np.zeros(count), y)), law, floor=True)
    grains.add_wall("lid", (0.0, 2.0 * RADIUS * count), (0.0, -1.0))
    grains.steering.servo_wall("lid", force=load, speed=0.1)
    dt, slowest = grains.stable_step(), slowest_wave(count)
    grains.step(dt, weights(count, gravity), None, int(160.0 / (slowest * dt)), slowest)
    floor = -float(grains.wall_force[grains.wall_names.index("bottom"), 1])
    return floor, float(grains.wall_force[grains.wall_names.index("lid"), 1])


def lattice_moduli(shear: float, strain: float = 1e-7, steps: int = 100) -> Floats:
    """C11, C12 and the shear stress over shear strain (xy), all over k_n, of a lattice with k_t = ``shear`` k_n.

    Discs do not turn; the pressure at the start is taken off.
    """
    found = []
    for stretch, slide in ((1.0, 0.0), (0.0, 1.0)):
        grains = lattice(Linear(STIFFNESS, 0.0, shear * STIFFNESS, friction=1e6), 6)
        grains.hold(slice(None), x=False, y=False)
        dt = grains.stable_step()
        grains.steering.strain_cell()
        grains.step(dt)
        before = grains.steering.cell_pressure()
        rate = -strain / (steps * dt)
        grains.steering.strain_cell(xx=stretch * rate, xy=slide * rate)
        grains.step(dt, count=steps + 1)
        found.append((grains.steering.cell_pressure() - before) / (strain * STIFFNESS))
    return np.array([found[0][0], found[0][2], found[1][1]])


def moduli_by_springs(shear: float, stretch: float = 0.0) -> Floats:
    """C11, C12 and the shear modulus over k_n of a lattice with k_t = ``shear`` k_n; stretch : see `lattice`."""
    law = Linear(STIFFNESS, 0.0, shear * STIFFNESS, friction=1.0)
    grains = lattice(law, 6, stretch=stretch)
    d = grains.discs
    made = elastic(d.position, d.radius, (grains.period[0], grains.period[1]), law) / STIFFNESS
    return np.array([made[0, 0], made[0, 1], made[2, 2]])


def lattice_exact(shear: float) -> Floats:
    """sqrt(3)/4 (3 + s), sqrt(3)/4 (1 - s), sqrt(3)/4 (1 + 3 s): sums over three contacts a disc, s = k_t/k_n."""
    return math.sqrt(3.0) / 4.0 * np.array([3.0 + shear, 1.0 - shear, 1.0 + 3.0 * shear])


BOUNCES = ((0.5, 0.0), (1.0, 20.0), (1.5, -30.0))
"""Angle (rad) of a dumbbell and its spin over its speed (1/m)."""
SHEARS = (0.0, 0.5)


@VALIDATIONS.row(
    "dem.dumbbell_bounce",
    source="impulse of a rigid body: J = -2 v_n/(1/M + a^2/I) at a frictionless, elastic contact",
    because="1e-3: the contact lasts 1000 steps and is met up to one late; the body turns by 1e-4 meanwhile",
    tolerance=1e-3,
)
def dumbbell() -> Measured:
    """Speed up and r times spin after a clump of two discs has hit a floor with one end, over its speed."""
    scale = np.array([1.0, RADIUS])
    exact = np.array([dumbbell_exact(*case) for case in BOUNCES]) * scale
    return Measured.absolute(exact, np.array([dumbbell_bounce(*case) for case in BOUNCES]) * scale)


@VALIDATIONS.row(
    "dem.clump_as_pendulum",
    source="physical pendulum, T = 4 K(sin(s/2)) sqrt(I/(m g r)), I of two discs exact",
    because="leap-frog: (w dt)^2/24 = 3e-9 at 13 000 steps a period, start half a step late: dt/T squared",
    tolerance=3e-8,
)
def pendulum() -> Measured:
    """Period of a clump held at its centroid of which one disc has weight, let go at 1 rad, s."""
    return Measured.relative(pendulum_exact(1.0), pendulum_period(1.0))


@VALIDATIONS.row(
    "dem.momentum_of_clumps",
    source="Newton's third law; shares of members add up to the body",
    because="60 discs, 5000 steps: round-off 1e-16 per sum, growing like its root, 1e-13 at most",
    tolerance=1e-13,
)
def momenta() -> Measured:
    """20 clumps and 20 discs that spin, collide and rub in free space: relative drift of both momenta."""
    return Measured.absolute((0.0, 0.0), momentum_drift(clumped_cloud(), 5000))


@VALIDATIONS.row(
    "dem.servo_wall",
    source="statics: the lid bears the wanted force, the floor that and the weight",
    because="left to rest for 160 decay times of its slowest wave at half critical drag, the lid's own are twice that",
    tolerance=1e-6,
)
def servo() -> Measured:
    """Force on floor and lid of a column of ten discs under a lid that is to bear 50 N/m."""
    return Measured.relative((50.0 + 10 * MASS * GRAVITY, 50.0), column_under_servo(50.0))


@VALIDATIONS.row(
    "dem.affine_moduli_of_a_lattice",
    source="triangular lattice: sqrt(3)/4 (3 + s), sqrt(3)/4 (1 - s), sqrt(3)/4 (1 + 3 s) k_n with s = k_t/k_n",
    because="the lattice is pressed by 1e-4 of a diameter: geometric stiffness sqrt(3) 1e-4 k_n, up to twice",
    tolerance=4e-4,
)
def moduli() -> Measured:
    """C11, C12 and the shear stress over the shear of a strained periodic cell, over k_n, s = 0 and 0.5."""
    exact = np.array([lattice_exact(shear) for shear in SHEARS])
    return Measured.absolute(exact, np.array([lattice_moduli(shear) for shear in SHEARS]))


@VALIDATIONS.row(
    "dem.elastic_moduli_of_a_lattice",
    source="triangular lattice: sqrt(3)/4 (3 + s), sqrt(3)/4 (1 - s), sqrt(3)/4 (1 + s) k_n with s = k_t/k_n",
    because="ties of 1e-9 of a contact hold what nothing holds; each disc has six contacts, none of them softer than"
    " s = 0.5 of a spring: 1e-9 of what a disc bears",
    tolerance=1e-9,
)
def elastic_moduli() -> Measured:
    """C11, C12 and the shear modulus by the springs of all contacts, discs free to turn, over k_n, s = 0 and 0.5."""
    exact = np.array([math.sqrt(3.0) / 4.0 * np.array([3.0 + s, 1.0 - s, 1.0 + s]) for s in SHEARS])
    return Measured.absolute(exact, np.array([moduli_by_springs(shear) for shear in SHEARS]))

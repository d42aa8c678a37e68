"""A clump of two discs falls, bounces and spins: mass properties, impact, energy, rest, against exact answers."""

import math
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from scipy.integrate import quad

from porescale import Floats, build, load
from porescale.dem import Grains
from porescale.dem.measures import energy_budget
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
SCENE = HERE / "clump.toml"
LARGE, SMALL, ACROSS, UP, DENSITY, GRAVITY = 0.02, 0.01, 0.02, 0.01, 2500.0, 9.8  # m, kg/m³, m/s²
APART = math.hypot(ACROSS, UP)  # m between the centres
STEP, LASTS = 5e-5, 1.0  # s
RIGID, FINE = 1e4, 0.25  # times the stiffness, where a contact is to last next to nothing; times the step, there


def clump(
    stiffer: float = 1.0, step: float = STEP, *, book: bool = False, **contact: float
) -> tuple[Grains, Floats]:  # fmt: skip
    """The scene's clump with ``stiffer`` contacts, its ``step`` (s) and other keys of [contact], and with or without
    an energy budget; its weights (n, 2)."""
    told = {"stiffness": 1e7 * stiffer, "step": step, **contact}
    settings = [f"contact.{key}={value!r}" for key, value in told.items()]
    simulation = build(load(SCENE, settings=[*settings, f"output.energy={str(book).lower()}"]))
    assert simulation.grains
    assert simulation.weight is not None
    return simulation.grains, simulation.weight


def by_strips() -> tuple[float, float, float]:
    """Area (m²) of the union, its centroid from the large disc's centre along the line of centres (m), and its polar
    second moment about that (m⁴): integrals over strips across the line, between the ends and the crossing."""

    def half(x: float) -> float:
        """Half the length of the strip at ``x``, m."""
        return math.sqrt(max(LARGE**2 - x**2, SMALL**2 - (x - APART) ** 2, 0.0))

    meet = (APART**2 + LARGE**2 - SMALL**2) / (2.0 * APART)
    parts = ((-LARGE, meet), (meet, APART + SMALL))

    def over(weight: int) -> float:
        """Integral over all strips: area, first moment or polar second moment, by ``weight`` 0, 1 or 2."""
        kinds = (lambda x: 2.0 * half(x), lambda x: 2.0 * x * half(x),
                 lambda x: 2.0 * (x**2 * half(x) + half(x) ** 3 / 3.0))  # fmt: skip
        return sum(float(quad(kinds[weight], *part, epsabs=1e-18, epsrel=1e-12)[0]) for part in parts)

    area, first, second = over(0), over(1), over(2)
    return area, first / area, second - first**2 / area


def mass_properties(grains: Grains) -> dict[str, float]:
    """Relative differences of mass, centroid and inertia from those of the union by strips."""
    c = grains.steering.clumps
    area, along, second = by_strips()
    centre = np.array([0.1, 0.05]) + along * np.array([ACROSS, UP]) / APART
    return {
        "mass over that of the union": float(c.mass[0]) / (DENSITY * area),
        "centroid, off by": float(np.hypot(*(c.position[0] - centre))) / LARGE,
        "inertia over that of the union": float(c.inertia[0]) / (DENSITY * second),
    }


def impact() -> dict[str, float]:
    """Upward speed and spin after the first bounce over those of a rigid body: J = 2 M v/(1 + M a²/I)."""
    step = FINE * STEP / math.sqrt(RIGID)
    grains, weight = clump(RIGID, step)
    c, d = grains.steering.clumps, grains.discs
    while d.position[0, 1] >= LARGE:
        grains.step(step, weight, count=100 if d.position[0, 1] > 1.01 * LARGE else 1)
    speed, lever = -float(c.velocity[0, 1]), float(d.position[0, 0] - c.position[0, 0])
    while d.position[0, 1] < LARGE:
        grains.step(step, weight, count=1)
    mass, inertia = float(c.mass[0]), float(c.inertia[0])
    pushed = 2.0 * speed / (1.0 / mass + lever**2 / inertia)
    return {
        "upward speed over that of a rigid body": float(c.velocity[0, 1]) / (pushed / mass - speed),
        "spin over that of a rigid body": float(c.spin[0]) / (lever * pushed / inertia),
    }


def flight(grains: Grains) -> float:
    """Energy (J/m) of the body half a step ago: what leap-frog keeps to round-off in free flight."""
    c = grains.steering.clumps
    high = float(c.position[0, 1] - 0.5 * grains.last_dt * c.velocity[0, 1])
    moving = float(c.mass[0] * (c.velocity[0] @ c.velocity[0]) + c.inertia[0] * c.spin[0] ** 2)
    return 0.5 * moving + float(c.mass[0]) * GRAVITY * high


def drift(step: float) -> float:
    """Largest change of the energy in flight within LASTS, over that of the fall."""
    grains, weight = clump(1.0, step)
    grains.step(step, weight)
    start, most = flight(grains), 0.0
    fall = float(grains.steering.clumps.mass[0]) * GRAVITY * (0.05 - LARGE)
    for _ in range(round(LASTS / step) // 10):
        grains.step(step, weight, count=10)
        if not np.any(grains.wall_force):
            most = max(most, abs(flight(grains) - start) / fall)
    return most


def rest() -> dict[str, float]:
    """The same clump with friction and dashpots, at rest on both discs: loads on the floor and its lean over exact."""
    grains, weight = clump(damping=2000.0, friction=0.5, tangential_stiffness=5e6)
    grains.step(STEP, weight, count=round(3.0 * LASTS / STEP))
    c, d = grains.steering.clumps, grains.discs
    _, along, _ = by_strips()
    flat = APART * math.cos(math.asin((LARGE - SMALL) / APART))  # between the places where they touch
    share = along / APART  # of the weight, on the small disc: the centroid lies on the line of centres
    way = d.position[1] - d.position[0]
    floor = -float(grains.wall_force[2, 1])
    deep = d.radius - d.position[:, 1]
    assert abs(abs(way[0]) - flat) < 0.01 * flat
    return {
        "load on the floor over the weight": floor / (float(c.mass[0]) * GRAVITY),
        "load on the small disc over the lever's": 1e7 * float(deep[1]) / (share * float(c.mass[0]) * GRAVITY),
        "lean at rest": math.degrees(math.asin(abs(float(way[1])) / APART)),
    }


def measure() -> tuple[dict[str, float], Figure]:
    """All of them, and the picture."""
    drifts = [drift(STEP / k) for k in (1, 10)]
    numbers = mass_properties(clump()[0]) | impact()
    numbers |= {"change of energy at the tutorial's step": drifts[0], "the same at a tenth of it": drifts[1]}
    return numbers | rest(), draw()


def draw() -> Figure:
    """Where the clump is, and its energies over time, at the tutorial's step."""
    figure, axes = stage(3, 12.0, 3.4)
    grains, weight = clump(book=True)
    c, d = grains.steering.clumps, grains.discs
    time, book, spins, colours = [], [], [], ("#8c1c2f", "#d9833c", "#2a6f97", "#3b352b")
    for k in range(round(LASTS / STEP) // 10):
        if k % 80 == 0 and k < 400:
            for i in range(2):
                axes[0].add_patch(Circle(1e2 * d.position[i], 1e2 * d.radius[i], fc="none", ec=colours[k // 80 % 4]))
        grains.step(STEP, weight, count=10)
        time.append(grains.time)
        book.append(energy_budget(grains, (0.0, -GRAVITY)))
        spins.append(float(c.spin[0]))
    names = {"potential energy (J/m)": "potential", "kinetic energy of translation (J/m)": "of translation",
             "kinetic energy of rotation (J/m)": "of rotation", "elastic energy, normal (J/m)": "elastic"}  # fmt: skip
    table = {name: np.array([row[name] for row in book]) for name in names}
    for (name, label), colour in zip(names.items(), colours, strict=True):
        axes[1].plot(time, table[name], color=colour, lw=0.9, label=label)
    axes[1].plot(time, sum(table.values()), "k:", lw=1.2, label="sum")
    axes[2].plot(time, spins, color=colours[0], lw=1)
    axes[0].set(aspect="equal", xlim=(4, 18), ylim=(0, 9), xlabel="x, cm", ylabel="y, cm", title="every 40 ms")
    axes[1].set(xlabel="time, s", ylabel="energy, J a metre of depth", title="energies")
    axes[2].set(xlabel="time, s", ylabel="spin, rad/s", title="spin: constant in flight")
    axes[1].legend(fontsize=7)
    for ax in axes:
        ax.title.set_fontsize(9)
    return figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))

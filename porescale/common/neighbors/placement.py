"""Seeded placement of discs in a rectangle without overlap, and lattices.  Pure geometry: no forces of nature.

Discs start at random and slide apart: overlaps are the energy of a fictitious spring and FIRE (Bitzek et al.,
Phys. Rev. Lett. 97 (2006) 170201) brings it to zero, which it can reach below random close packing (0.84 in
the plane).  Discs of equal size crystallise into grains of triangular lattice on the way: give a spread where
the packing should be disordered.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range, numbers, require_in_range
from porescale.common.core.types import Floats
from porescale.common.neighbors.cells import minimum_image
from porescale.common.neighbors.pair_list import PairList

DENSEST = 0.80  # packing fraction; above it random starts jam before their overlaps are gone
INFLATED = 0.81  # fraction with the radii that are slid apart, larger than the real ones so that these end clear
ROOMIEST = 1.05  # most that radii are enlarged by
CLEAR = 1e-4  # least enlargement of radii: the end is then reached in finite time
MOST_SWEEPS = 20_000
FEWER_SWEEPS = 5_000  # among what stands, where another start may do
LENGTH = Range("m")


@dataclass(frozen=True)
class Standing:
    """Discs that stand where they are while others slide apart: position (k, 2) m from the box's lower corner, radius
    (k,) m; they may overlap each other.  area (m²): what all that stands takes of the box.

    beside : of other bodies, for points (n, 2) m from the corner: the distance (n,) m of each from a body, below zero
    inside, and the unit vector (n, 2) away from it, body by body.
    """

    position: Floats
    radius: Floats
    area: float
    beside: Callable[[Floats], Iterable[tuple[Floats, Floats]]] = lambda points: ()


@dataclass(frozen=True)
class Placement:
    """position (n, 2) m; radius (n,) m; fraction: disc area over box area; sweeps: steps of overlap removal."""

    position: Floats
    radius: Floats
    fraction: float
    sweeps: int


def place(
    lower: tuple[float, float],
    upper: tuple[float, float],
    *,
    diameter: float | None = None,
    spread: float = 0.0,
    count: int | None = None,
    packing_fraction: float | None = None,
    radii: Floats | None = None,
    periodic: tuple[bool, bool] = (False, False),
    seed: int = 0,
    start: Floats | None = None,
    standing: Standing | None = None,
) -> Placement:
    """Discs wholly inside the box (or across a periodic side), none touching another; the same for the same seed.

    Either ``radii`` (n,) m, or two of mean ``diameter`` (m), ``count`` and ``packing_fraction`` (disc area
    over box area, at most 0.80): the third follows.  Diameters are uniform in diameter (1 ± spread), with
    0 <= spread < 1.  A fraction that fixes the count is matched as nearly as whole discs allow; ``Placement.fraction``
    gives what was reached.  Equal discs (spread 0) crystallise above a fraction of about 0.7.  start (n, 2) m: where
    the discs of ``radii`` slide apart from, over the lower corner, in place of random places.  standing: discs between
    which they are placed; fractions are then of the area that these leave.

    Raises InputError for values out of range, or with the overlap left when the discs do not fit.
    """
    low, high = numbers("lower", lower, (2,), LENGTH), numbers("upper", upper, (2,), LENGTH)
    if not (low < high).all():
        repair = "give the corners of a box"
        raise InputError(Fault("upper", str(upper), "must lie right of and above lower", "m", f"> {lower}", repair))
    require_in_range("place", {"seed": seed}, {"seed": Range(ge=0, whole=True)})
    size = (upper[0] - lower[0], upper[1] - lower[1])
    rng = np.random.default_rng(seed)
    if radii is None:
        radii = draw_radii(size[0] * size[1], diameter, spread, count, packing_fraction, rng)
    radius = np.array(radii, dtype=np.float64)
    if radius.size and not (np.all(np.isfinite(radius)) and radius.min() > 0.0):
        raise InputError(Fault("radii", float(radius.min()), "every radius must be a length", "m", "> 0"))
    room = size[0] * size[1] - (standing.area if standing else 0.0)
    fraction = float(np.pi * np.sum(radius**2) / room) if room > 0.0 else np.inf
    _check_fraction(round(fraction, 4), fraction)
    largest = 2.0 * float(radius.max(initial=0.0))
    if largest > min(size):
        raise InputError(Fault("diameter", largest, "a disc is larger than the box", "m", f"<= {min(size):.6g}"))
    if start is None:
        start = rng.uniform((0.0, 0.0), size, (len(radius), 2))
    position, sweeps = slide_apart(start, radius, size, periodic, fraction, standing=standing)
    return Placement(position + np.array(lower), radius, fraction, sweeps)


def _check_fraction(shown: float, fraction: float) -> None:
    if fraction > DENSEST:
        repair = "place loosely and compact by gravity or moving walls"
        problem = "denser than random placement reaches"
        raise InputError(Fault("packing_fraction", shown, problem, "", f"<= {DENSEST}", repair))


def part(position: Floats, radius: Floats) -> Floats:
    """Places (n, 2) m near ``position`` where no disc of ``radius`` (n,) m overlaps another: for measured circles.

    The rectangle around all of them holds them, with a mean diameter more at its top.  Raises InputError, with the
    overlap left, where they do not fit.
    """
    low, high = (position - radius[:, None]).min(axis=0), (position + radius[:, None]).max(axis=0)
    high[1] += 2.0 * float(radius.mean())
    size = float(high[0] - low[0]), float(high[1] - low[1])
    fraction = float(np.pi * np.sum(radius**2)) / (size[0] * size[1])
    moved, _ = slide_apart(position - low, radius, size, (False, False), fraction, 1.0 + CLEAR)
    return np.asarray(moved + low)


def draw_radii(
    area: float,
    diameter: float | None,
    spread: float,
    count: int | None,
    packing_fraction: float | None,
    rng: np.random.Generator,
) -> Floats:
    """Radii (n,) m of discs of mean ``diameter`` (1 ± spread, uniform) in a box of ``area`` m²; two of three given."""
    given = {"diameter": diameter, "count": count, "packing_fraction": packing_fraction}
    if sum(value is not None for value in given.values()) != 2:
        problem = f"give exactly two of {', '.join(given)}"
        raise InputError(Fault("placement", None, problem, repair="the third follows"))
    for name, value in given.items():
        if value is not None and not 0.0 < value < np.inf:
            raise InputError(Fault(name, value, "out of range", "m" if name == "diameter" else "", "> 0"))
    if not 0.0 <= spread < 1.0:
        raise InputError(Fault("spread", spread, "out of range", "", "0 <= spread < 1"))
    if packing_fraction is not None:
        _check_fraction(packing_fraction, packing_fraction)
    if count is not None:
        relative = 1.0 + spread * rng.uniform(-1.0, 1.0, count)
        if diameter is None:
            assert packing_fraction is not None
            diameter = 2.0 * float(np.sqrt(packing_fraction * area / (np.pi * np.sum(relative**2))))
            # One rounding too many must not make the fraction exceed the densest.
            diameter *= 1.0 - 1e-12
        return 0.5 * diameter * relative
    assert diameter is not None
    assert packing_fraction is not None
    mean_area = 0.25 * np.pi * diameter**2 * (1.0 + spread**2 / 3.0)
    enough = int(2.0 * packing_fraction * area / mean_area) + 10
    radius = 0.5 * diameter * (1.0 + spread * rng.uniform(-1.0, 1.0, enough))
    covered = np.concatenate(([0.0], np.cumsum(np.pi * radius**2))) / area
    allowed = covered[covered <= DENSEST]
    return radius[: int(np.argmin(np.abs(allowed - packing_fraction)))]


def slide_apart(
    start: Floats,
    radius: Floats,
    size: tuple[float, float],
    periodic: tuple[bool, bool],
    fraction: float,
    roomiest: float = ROOMIEST,
    standing: Standing | None = None,
) -> tuple[Floats, int]:
    """Positions (n, 2) m in a box from the origin to ``size`` without overlap, near ``start``; sweeps it took.

    roomiest : factor of the radii that are slid apart, or less where the box is full.  standing : discs that do not
    move.
    """
    n = len(radius)
    if n == 0:
        return start, 0
    unit = 2.0 * float(radius.mean())  # lengths in mean diameters: springs and steps then suit any size
    x = start / unit
    real = radius / unit
    grown = real * max(1.0 + CLEAR, min(roomiest, float(np.sqrt(INFLATED / fraction))))
    if standing:
        x = np.concatenate((x, standing.position / unit))
        real, grown = (np.concatenate((each, standing.radius / unit)) for each in (real, grown))
    box = (size[0] / unit, size[1] / unit)
    pairs = PairList(len(x), 0.3, (0.0, 0.0), box, periodic)
    velocity, force = np.zeros(x.shape), np.zeros(x.shape)
    step, mixing, uphill = 0.1, 0.1, 0
    worst = np.inf
    most_sweeps = FEWER_SWEEPS if standing else MOST_SWEEPS
    for sweep in range(most_sweeps):
        pairs.update(x, grown)
        worst, power = repel(x, grown, real, pairs.start, pairs.partner, *box, *pairs.period, velocity, force, n)
        if standing:
            most, more = _repel_from(standing, x[:n], grown[:n], real[:n], unit, velocity[:n], force[:n])
            worst, power = max(worst, most), power + more
        if worst <= 0.0:
            for axis in (0, 1):
                if periodic[axis]:
                    x[:, axis] %= box[axis]
            return x[:n] * unit, sweep
        # FIRE with the constants of Bitzek et al. 2006; the longest step stays below 2/sqrt(6), the limit of a
        # triangular lattice of unit springs and masses.
        if power > 0.0:
            uphill += 1
            if uphill > 5:
                step, mixing = min(1.1 * step, 0.5), 0.99 * mixing
        else:
            velocity[:] = 0.0
            step, mixing, uphill = 0.5 * step, 0.1, 0
        glide(x, velocity, force, step, mixing)
    problem = f"discs still overlap by {worst:.2g} mean diameters after {most_sweeps} sweeps"
    repair = "lower the fraction, widen the spread of sizes or take another seed"
    raise InputError(Fault("packing_fraction", round(fraction, 4), problem, repair=repair))


def _repel_from(
    standing: Standing, x: Floats, grown: Floats, real: Floats, unit: float, velocity: Floats, force: Floats
) -> tuple[float, float]:
    """Unit springs between discs and the bodies that stand: adds to ``force`` (n, 2).  As ``repel``, lengths in units
    of ``unit`` (m)."""
    worst, power = -np.inf, 0.0
    for distance, normal in standing.beside(x * unit):
        pushed = np.maximum(grown - distance / unit, 0.0)[:, None] * normal
        force += pushed
        power += float(np.sum(pushed * velocity))
        worst = max(worst, float((real - distance / unit).max()))
    return worst, power


@kernel
def repel(x, grown, real, start, partner, width, height, period_x, period_y, velocity, force, loose):
    """Unit springs between discs of radius ``grown`` (n,) and at walls without period: overwrites ``force`` (n, 2).

    The first ``loose`` discs move; the others stand, without force, and what they overlap of each other is not counted.
    Returns the largest overlap of discs of radius ``real`` with each other or a wall (negative: clear), and
    the power force · ``velocity``.  Centres that coincide are parted along x.
    """
    worst = -np.inf
    force[:] = 0.0
    for i in range(loose):
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            dx = minimum_image(x[i, 0] - x[j, 0], period_x)
            dy = minimum_image(x[i, 1] - x[j, 1], period_y)
            distance = np.sqrt(dx * dx + dy * dy)
            worst = max(worst, real[i] + real[j] - distance)
            overlap = grown[i] + grown[j] - distance
            if overlap > 0.0:
                if distance > 0.0:
                    fx, fy = overlap * dx / distance, overlap * dy / distance
                else:
                    fx, fy = overlap, 0.0
                force[i, 0] += fx
                force[i, 1] += fy
                force[j, 0] -= fx
                force[j, 1] -= fy
        for axis in range(2):
            if (period_x if axis == 0 else period_y) == 0.0:
                side = width if axis == 0 else height
                low = x[i, axis]
                high = side - x[i, axis]
                worst = max(worst, real[i] - low, real[i] - high)
                force[i, axis] += max(0.0, grown[i] - low) - max(0.0, grown[i] - high)
    force[loose:] = 0.0
    power = 0.0
    for i in range(loose):
        power += force[i, 0] * velocity[i, 0] + force[i, 1] * velocity[i, 1]
    return worst, power


@kernel
def glide(x, velocity, force, step, mixing):
    """One FIRE step: kick, turn the velocity towards the force, drift.  Overwrites ``x`` and ``velocity`` (n, 2)."""
    speed2 = 0.0
    force2 = 0.0
    for i in range(x.shape[0]):
        for axis in range(2):
            velocity[i, axis] += step * force[i, axis]
            speed2 += velocity[i, axis] ** 2
            force2 += force[i, axis] ** 2
    turn = mixing * np.sqrt(speed2 / force2) if force2 > 0.0 else 0.0
    for i in range(x.shape[0]):
        for axis in range(2):
            velocity[i, axis] = (1.0 - mixing) * velocity[i, axis] + turn * force[i, axis]
            x[i, axis] += step * velocity[i, axis]


def _check_lattice(lower: tuple[float, float], upper: tuple[float, float], spacing: float) -> None:
    """InputError unless corners and spacing are lengths, m."""
    for key, corner in (("lower", lower), ("upper", upper)):
        numbers(f"lattice.{key}", corner, (2,), LENGTH)
    require_in_range("lattice", {"spacing": spacing}, {"spacing": Range("m", gt=0)})


def square_lattice(lower: tuple[float, float], upper: tuple[float, float], spacing: float) -> Floats:
    """Positions (n, 2) m of a square lattice, half a ``spacing`` (m) inside the lower corner, row after row.

    Raises InputError where the spacing is not positive or a corner is no pair of numbers.
    """
    _check_lattice(lower, upper, spacing)
    columns, rows = (round((upper[a] - lower[a]) / spacing) for a in (0, 1))
    xs = lower[0] + (np.arange(columns) + 0.5) * spacing
    ys = lower[1] + (np.arange(rows) + 0.5) * spacing
    grid_x, grid_y = np.meshgrid(xs, ys)
    return np.column_stack((grid_x.ravel(), grid_y.ravel()))


def triangular_lattice(lower: tuple[float, float], upper: tuple[float, float], spacing: float) -> Floats:
    """Positions (n, 2) m of a triangular lattice of discs of diameter ``spacing`` (m) that fit inside the box.

    Raises InputError as `square_lattice` does.
    """
    _check_lattice(lower, upper, spacing)
    rise = 0.5 * np.sqrt(3.0) * spacing
    width, height = upper[0] - lower[0], upper[1] - lower[1]
    fit = 1e-9  # of a spacing: a box of exactly n spacings holds n discs whatever its corners round to
    rows = int(np.floor((height / spacing - 1.0 + fit) / (rise / spacing))) + 1 if height >= spacing else 0
    lines = []
    for row in range(rows):
        shift = 0.5 * spacing * (row % 2)
        columns = int(np.floor((width - shift) / spacing + fit))
        xs = lower[0] + shift + (np.arange(columns) + 0.5) * spacing
        lines.append(np.column_stack((xs, np.full(columns, lower[1] + 0.5 * spacing + row * rise))))
    return np.concatenate(lines) if lines else np.empty((0, 2))

"""A sample or packing before anything slides or breaks: rigid bodies joined by springs, solved as statics.

Each bond or contact is two springs where its bodies touch, k along the normal and k_t across, between the points of
both bodies there; resistance to rolling is a third, R times the rotation of one against the other, R the reduced
radius.  Of a bonded sample one plate is displaced, the other held; a packing in a periodic cell is strained as a whole.
The bodies between come to rest: a sparse linear system, without time.  The stiffness of a sample follows, to compare
with what a loaded one shows, and with Voigt's bound: all bodies displaced as one straining sheet, none turned.  Of a
packing the elastic moduli follow; the forces that its contacts bear change them by the order of overlap over diameter,
which is left out.

Sources: Cundall & Strack 1979 (contact as two springs);  bound: Chang et al. 1990, J. Eng. Mech. 116, 1077;  moduli of
packings as those of their springs: Agnolin & Roux 2007, Phys. Rev. E 76, 061304.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import spsolve
from scipy.spatial import KDTree

from porescale.common.core.types import Floats
from porescale.dem.bodies.bonding import segments_now
from porescale.dem.contact.linear import Linear
from porescale.dem.forces.bonds import touched
from porescale.dem.measures.contact_list import nearest_image
from porescale.dem.prepare.rock import Rock

LOOSE = 1e-9  # of a contact's stiffness: ties of bodies that nothing, or but one bond, holds


class Network(NamedTuple):
    """stretch (2 m, 3 b): lengthening of the 2 m springs for displacements x, y m and rotations rad of b bodies;
    spring (2 m,) N/m: their stiffnesses;  place (b, 2) m: centroids;  plates : rows of both."""

    stretch: csr_array
    spring: Floats
    place: Floats
    plates: tuple[int, int]


def network(rock: Rock) -> Network:
    """The springs of a sample that has not been loaded yet.  Its law must be Linear."""
    grains = rock.grains
    d, clumps, bonds = grains.discs, grains.steering.clumps, grains.bonds
    assert bonds is not None
    assert isinstance(grains.law, Linear)
    law, known = grains.law, segments_now(grains)
    ends, back = bonds.ends, bonds.back
    way, far, other = np.zeros((len(ends), 2)), np.zeros((len(ends), 2)), np.zeros(len(ends), np.int64)
    touched(d.position, ends, known, grains.cell, way, far, other)
    one = ends[:, 0]
    distance, normal, across, arm = _chords(way, d.radius[one], d.radius[other])
    point = d.position[one] + arm[:, None] * normal
    row = np.where(clumps.group >= 0, clumps.group, clumps.count + np.arange(d.count))
    place = np.concatenate((clumps.position, d.position))
    both = row[one], row[other]
    rows = [_springs((point - place[both[0]], point - place[both[1]]), along, both) for along in (normal, across)]
    weight = np.rint(back / (law.stiffness * (d.radius[one] + d.radius[other] - distance)))  # of corners, see segments
    spring = np.concatenate((law.stiffness * weight, law.tangential_stiffness * (weight > 0.0)))
    return Network(_stacked(rows, len(ends), 3 * len(place)), spring, place, (clumps.count - 2, clumps.count - 1))


def stiffness(rock: Rock) -> float:
    """Stress over strain (Pa) of a sample between plates that do not turn, by its springs."""
    net = network(rock)
    count = len(net.place)
    moved = np.zeros(3 * count)
    moved[3 * net.plates[1]] = rock.length
    free = np.ones(count, bool)
    free[list(net.plates)] = False
    within = np.flatnonzero(np.repeat(free, 3))
    moved[within] = _at_rest(net.stretch[:, within], net.spring, net.stretch @ moved, rock.diameter)
    return _energy(net, moved) / (0.5 * rock.length * rock.height)


def voigt(rock: Rock) -> float:
    """The same if all bodies followed one strain, of the Poisson's ratio that costs least: no less than that."""
    net = network(rock)
    left, right = net.plates
    apart = float(net.place[right, 0] - net.place[left, 0])
    start = net.place[left] + (0.5 * (apart - rock.length), 0.0)
    cost = []
    for lateral in (-1.0, 0.0, 1.0):
        moved = np.zeros((len(net.place), 3))
        moved[:, :2] = (net.place - start) * (1.0, lateral)
        moved[left], moved[right] = 0.0, (rock.length, 0.0, 0.0)
        cost.append(_energy(net, moved.ravel()))
    curved, sloped = 0.5 * (cost[0] + cost[2]) - cost[1], 0.5 * (cost[2] - cost[0])
    return (cost[1] - sloped**2 / (4.0 * curved)) / (0.5 * rock.length * rock.height)


def moduli(position: Floats, radius: Floats, box: tuple[float, float], law: Linear) -> Floats:
    """Elastic moduli (3, 3), Pa: stresses xx, yy, xy over the strains xx, yy and the shear 2 xy of a packing.

    position (n, 2) m, radius (n,) m: discs of one material in a periodic cell;  box : its width and height, m.  All
    contacts stick; discs that nothing holds bear nothing.
    """
    inside = position % box % box  # once more: what lies below 0 by round-off alone is the box itself after the first
    pairs = KDTree(inside, boxsize=box).query_pairs(2.0 * float(radius.max()), output_type="ndarray")
    pairs = pairs[np.lexsort(pairs.T[::-1])]  # the order of sums, and with it the last digits, is then that of discs
    way = nearest_image(position[pairs[:, 1]] - position[pairs[:, 0]], (*box, 0.0))
    near = np.hypot(*way.T) < radius[pairs].sum(axis=1)
    (one, other), way = pairs[near].T, way[near]
    distance, normal, across, first = _chords(way, radius[one], radius[other])
    arms = first[:, None] * normal, (first - distance)[:, None] * normal
    rows = [_springs(arms, along, (one, other)) for along in (normal, across)]
    reduced = radius[one] * radius[other] / (radius[one] + radius[other])
    rows.append(_rolling(reduced, (one, other)))
    stretch = _stacked(rows, len(one), 3 * len(position))
    slides, rolls = law.friction > 0.0, law.rolling_friction > 0.0
    each = law.stiffness, law.tangential_stiffness * slides, law.rolling_stiffness * rolls
    spring = np.repeat(each, len(one))
    strained = np.zeros((len(spring), 3))
    for k, strain in enumerate((((1.0, 0.0), (0.0, 0.0)), ((0.0, 0.0), (0.0, 1.0)), ((0.0, 0.5), (0.5, 0.0)))):
        apart = -way @ np.array(strain)
        strained[: 2 * len(one), k] = np.concatenate([np.sum(along * apart, axis=1) for along in (normal, across)])
    moved = _at_rest(stretch, spring, strained, float(np.mean(radius)))
    made: Floats = strained.T @ (spring[:, None] * (strained + stretch @ moved)) / (box[0] * box[1])
    return made


def elasticity(position: Floats, radius: Floats, box: tuple[float, float], law: Linear) -> tuple[float, float]:
    """E (Pa) and Poisson's ratio, in plane strain, of a packing as in `moduli`, their mean over all directions."""
    made = moduli(position, radius, box, law)
    bulk = 0.25 * (made[0, 0] + made[1, 1] + 2.0 * made[0, 1])
    shear = 0.125 * (made[0, 0] + made[1, 1] - 2.0 * made[0, 1]) + 0.5 * made[2, 2]
    poisson = 0.5 * (bulk - shear) / bulk
    return float(2.0 * shear * (1.0 + poisson)), float(poisson)


def confined(stiffness: float, poisson: float) -> float:
    """M (Pa), stress over strain of what cannot widen, of E (Pa) and Poisson's ratio in plane strain."""
    return stiffness * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))


def _chords(way: Floats, radius: Floats, other: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Distance (m,) m, unit vectors along and across (m, 2), and how far the common chord lies from the first centre
    (m,) m, of discs ``way`` (m, 2) m apart with radii ``radius`` and ``other`` (m,) m."""
    distance = np.hypot(*way.T)
    normal = way / distance[:, None]
    across = np.column_stack((-normal[:, 1], normal[:, 0]))
    return distance, normal, across, 0.5 * (distance + (radius**2 - other**2) / distance)


def _at_rest(stretch: csr_array, spring: Floats, strained: Floats, size: float) -> Floats:
    """Displacements (m) and rotations (rad) of bodies, three a body, at which springs that are lengthened by
    ``strained`` (m,) or (m, k) m hold them at rest; size (m): of a body, by which ties resist rotation."""
    ties = np.tile((1.0, 1.0, size**2), stretch.shape[1] // 3)
    matrix = stretch.T @ diags_array(spring) @ stretch + diags_array(LOOSE * float(np.abs(spring).max()) * ties)
    moved: Floats = spsolve(matrix.tocsc(), -(stretch.T @ (spring * strained.T).T))
    return moved


def _energy(net: Network, moved: Floats) -> float:
    """Energy (J/m) in the springs for displacements (3 b,)."""
    return 0.5 * float(net.spring @ (net.stretch @ moved) ** 2)


def _springs(arms: tuple[Floats, Floats], way: Floats, ends: tuple[NDArray[np.int64], NDArray[np.int64]]) -> Floats:
    """Entries (6 m, 3), spring, column and value, of springs along ``way`` (m, 2) between the bodies ``ends``, at the
    points that lie off their centroids by ``arms`` (m, 2) m."""
    count, found = len(way), []
    for body, arm, sign in zip(ends, arms, (1.0, -1.0), strict=True):
        turn = arm[:, 0] * way[:, 1] - arm[:, 1] * way[:, 0]
        for axis, value in enumerate((way[:, 0], way[:, 1], turn)):
            found.append(np.column_stack((np.arange(count), 3 * body + axis, sign * value)))
    return np.concatenate(found)


def _rolling(reduced: Floats, ends: tuple[NDArray[np.int64], NDArray[np.int64]]) -> Floats:
    """The same (2 m, 3) of what resists rolling, at the ``reduced`` radius (m,) m."""
    count = np.arange(len(reduced))
    return np.concatenate(
        [np.column_stack((count, 3 * body + 2, sign * reduced)) for body, sign in zip(ends, (1.0, -1.0), strict=True)]
    )


def _stacked(rows: list[Floats], each: int, columns: int) -> csr_array:
    """One sparse array of the entries of several kinds of ``each`` springs."""
    entries = np.concatenate([np.add(part, (k * each, 0.0, 0.0)) for k, part in enumerate(rows)])
    where = (entries[:, 0].astype(np.int64), entries[:, 1].astype(np.int64))
    return csr_array(coo_array((entries[:, 2], where), shape=(len(rows) * each, columns)))

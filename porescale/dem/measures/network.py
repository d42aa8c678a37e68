"""A bonded sample as what it is before anything slides or breaks: rigid bodies joined by springs, solved as statics.

Each bond is two springs where its bodies touch, k along the normal and k_t across, between the points of both bodies
there.  One plate is displaced, the other held, and the bodies between come to rest: a sparse linear system, without
time.  The stiffness of a sample follows, to compare with what a loaded one shows, and with Voigt's bound: all bodies
displaced as one straining sheet, none turned.

Sources: Cundall & Strack 1979 (contact as two springs);  bound: Chang et al. 1990, J. Eng. Mech. 116, 1077.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import spsolve

from porescale.common.core.types import Floats
from porescale.dem.bodies.bonding import segments_now
from porescale.dem.contact.linear import Linear
from porescale.dem.forces.bonds import touched
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
    one, distance = ends[:, 0], np.hypot(*way.T)
    normal = way / distance[:, None]
    across = np.column_stack((-normal[:, 1], normal[:, 0]))
    arm = 0.5 * (distance + (d.radius[one] ** 2 - d.radius[other] ** 2) / distance)
    point = d.position[one] + arm[:, None] * normal
    row = np.where(clumps.group >= 0, clumps.group, clumps.count + np.arange(d.count))
    place = np.concatenate((clumps.position, d.position))
    rows = [_springs(point, along, row[one], row[other], place) for along in (normal, across)]
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
    part = net.stretch[:, within]
    weighted = diags_array(net.spring)
    size = np.tile((1.0, 1.0, rock.diameter**2), int(free.sum()))
    matrix = part.T @ weighted @ part + diags_array(LOOSE * float(np.abs(net.spring).max()) * size)
    moved[within] = spsolve(matrix.tocsc(), -(part.T @ (net.spring * (net.stretch @ moved))))
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


def _energy(net: Network, moved: Floats) -> float:
    """Energy (J/m) in the springs for displacements (3 b,)."""
    return 0.5 * float(net.spring @ (net.stretch @ moved) ** 2)


def _springs(point: Floats, way: Floats, one: NDArray[np.int64], other: NDArray[np.int64], place: Floats) -> Floats:
    """Entries (6 m, 3), spring, column and value, of springs along ``way`` (m, 2) at ``point`` (m, 2) m."""
    count, found = len(point), []
    for body, sign in ((one, 1.0), (other, -1.0)):
        arm = point - place[body]
        turn = arm[:, 0] * way[:, 1] - arm[:, 1] * way[:, 0]
        for axis, value in enumerate((way[:, 0], way[:, 1], turn)):
            found.append(np.column_stack((np.arange(count), 3 * body + axis, sign * value)))
    return np.concatenate(found)


def _stacked(rows: list[Floats], each: int, columns: int) -> csr_array:
    """One sparse array of the entries of several kinds of ``each`` springs."""
    entries = np.concatenate([np.add(part, (k * each, 0.0, 0.0)) for k, part in enumerate(rows)])
    where = (entries[:, 0].astype(np.int64), entries[:, 1].astype(np.int64))
    return csr_array(coo_array((entries[:, 2], where), shape=(len(rows) * each, columns)))

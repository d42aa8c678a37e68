"""Rock from a packing: bonded discs, Delaunay triangles or Voronoi cells between two plates, pulled or pressed.

The packing's discs, or polygons with its discs' centres as seeds, fill a rectangle that stands between plates left and
right (segments); plates and all are bonded by back tension, and then one plate is moved along x.  Discs overlap by what
the packing was pressed with; polygons are shrunk to stand ``gap`` apart and get so much thickness that sides overlap by
the requested value.  The naive estimate of a strength is the mean back tension over the mean diameter, that of a
stiffness the contact's.

Source: Matsushima, DEMseg tutorial II-4.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.bodies.bonding import bond
from porescale.dem.bodies.frames import Frame, chain, framed, polygon
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.survey import max_overlap
from porescale.dem.motion.control import Moved
from porescale.dem.motion.drivers import Clump
from porescale.dem.prepare.tessellate import Corner, delaunay, shrunk, voronoi

Kind = Literal["discs", "triangles", "cells"]

KINDS = ("discs", "triangles", "cells")
BEYOND = 0.1  # of the length of a plate's side of the sample: how far it stands out at both ends
NEAR = 0.5  # of the gap, skin of lists of polygons: half a side long it lists twice to three times as many, for bodies
#             that hardly pass each other
REST = Moved()


@dataclass(frozen=True)
class Rock:
    """A bonded sample at the start of a test.

    grains : with the plates as its last two clumps, the left one first;  length, height : m, between the plates and
    along them;  diameter : m, mean of the packing;  bonds : number;  tension : N/m, mean back tension.
    """

    grains: Grains
    length: float
    height: float
    diameter: float
    bonds: int
    tension: float

    @property
    def naive_strength(self) -> float:
        """Mean back tension over mean diameter, Pa: what it would bear if all bonds did alike."""
        return self.tension / self.diameter

    @property
    def plates(self) -> tuple[Clump, Clump]:
        """The left and the right plate."""
        count = self.grains.steering.clumps.count
        return Clump(count - 2), Clump(count - 1)


class Curve(NamedTuple):
    """A test, moment by moment: time s, strain (> 0 pulled) and stress Pa (> 0 tension; mean of both plates), both
    means of the time since the last moment, bonds broken so far, and the deepest overlap (measure.max_overlap: polygons
    go through each other at 1), each (m,)."""

    time: Floats
    strain: Floats
    stress: Floats
    broken: NDArray[np.int64]
    deepest: Floats

    def strength(self) -> float:
        """Largest stress in the direction of the test, Pa."""
        return float(np.max(self.stress * np.sign(self.strain[-1])))

    def stiffness(self, share: float = 0.3) -> float:
        """Slope of stress over strain up to ``share`` of the strength, by least squares through zero, Pa."""
        peak = share * self.strength()
        above = np.flatnonzero(np.abs(self.stress) > peak)
        first = slice(0, max(int(above[0]) if len(above) else len(self.stress), 2))
        return float(self.strain[first] @ self.stress[first] / (self.strain[first] @ self.strain[first]))


def rock(
    kind: Kind,
    packing: Discs,
    lower: Corner,
    upper: Corner,
    law: Linear,
    density: float,
    *,
    gap: float = 0.0,
    pressed: float = 0.0,
    rule: str = "outline",
) -> Rock:
    """A bonded sample of ``kind`` in the rectangle from ``lower`` to ``upper`` (m), in which ``packing`` lies.

    Discs keep their overlaps; they touch the sides left and right as they touch the walls of their box.  Polygons stand
    ``gap`` (m) apart and their sides overlap by ``pressed`` (m).  density kg/m^3;  rule : of contacts with segments,
    see segments.py.  Raises InputError for a kind that is none, polygons without gap or overlap, and a sample in which
    nothing touches.
    """
    if kind not in KINDS:
        raise InputError(Fault("kind", kind, "no such rock", allowed=", ".join(KINDS)))
    diameter = 2.0 * float(packing.radius.mean())
    if kind == "discs":
        frames = []
        discs = make_discs(packing.position, packing.radius, density)
        thickness, off = lines(0.5 * diameter)
        plates = plates_beside(lower, upper, thickness, off, density)
        grains = framed(discs, plates, law, _open(lower, upper), rule=rule)
    else:
        if not (gap > 0.0 and pressed > 0.0):
            bad, name = (gap, "gap") if not gap > 0.0 else (pressed, "pressed")
            raise InputError(Fault(name, bad, "of polygons", "m", "> 0"))
        thickness, off = lines(0.5 * diameter, gap, pressed)
        frames = [polygon(part, thickness, density) for part in blocks(kind, packing.position, lower, upper, gap)]
        plates = plates_beside(lower, upper, thickness, off, density)
        grains = framed(None, [*frames, *plates], law, _open(lower, upper), rule=rule, skin=NEAR * gap)
    made = bond(grains)
    if not made or grains.bonds is None:
        raise InputError(Fault("packing", packing.count, "nothing touches, so there is nothing to bond"))
    back = grains.bonds.back
    width, height = upper[0] - lower[0], upper[1] - lower[1]
    return Rock(grains, width, height, diameter, made, float(back[back > 0.0].mean()))


def load(
    rock: Rock,
    strain: float,
    seconds: float,
    moments: int = 200,
    step: float | None = None,
    look: Callable[[Grains], object] | None = None,
) -> Curve:
    """Move the right plate away (strain > 0) or inwards until ``strain`` in ``seconds`` (s), the left one held.

    moments : of the curve;  step : s, default the stable one;  look : called at every moment, for pictures.  Breaks
    with their places: ``rock.grains.bonds``.
    """
    grains, (left, right) = rock.grains, rock.plates
    grains.steering.control(left, REST, REST, REST)
    grains.steering.control(right, Moved(strain * rock.length / seconds), REST, REST)
    grains.steering.watch(left, right)
    dt = grains.stable_step() if step is None else step
    count = max(round(seconds / (moments * dt)), 1)
    rows, before = [], 0.0
    for _ in range(moments):
        grains.step(seconds / (moments * count), count=count)
        one, other = grains.steering.record()
        assert grains.bonds is not None
        pulled = 0.5 * (one.contact[0] - other.contact[0]) / rock.height
        gone, deepest = rock.bonds - grains.bonds.count, max_overlap(grains).share
        rows.append((grains.time, 0.5 * (before + other.displacement[0]) / rock.length, pulled, gone, deepest))
        before = other.displacement[0]
        if look is not None:
            look(grains)
    time, strains, stress, broken, deep = np.array(rows).T
    return Curve(time, strains, stress, broken.astype(np.int64), deep)


def blocks(kind: str, at: Floats, lower: Corner, upper: Corner, gap: float) -> list[Floats]:
    """Corners (k, 2) m of the cells, or triangles, of points ``at`` (n, 2) m in a rectangle, that stand ``gap`` (m)
    apart."""
    parts = (voronoi if kind == "cells" else delaunay)(at, lower, upper)
    # A side shorter than the gap would be hidden behind the thickness of its neighbours.
    left = (shrunk(part, 0.5 * gap, shortest=gap) for part in parts)
    return [part for part in left if part is not None]


def lines(radius: float, gap: float | None = None, pressed: float | None = None) -> tuple[float, float]:
    """(thickness of the plates and of the sides of polygons, how far the plates' lines stand off the sample), m.

    radius : mean of the packing's, m, for rock of discs;  gap, pressed : of polygons, m.
    """
    if gap is None or pressed is None:
        return 0.5 * radius, 0.5 * radius
    return 0.5 * (gap + pressed), 0.5 * gap


def plates_beside(
    lower: Corner, upper: Corner, thickness: float, off: float, density: float, *, axis: int = 0, material: int = 0
) -> list[Frame]:
    """Segments ``off`` (m) beside the rectangle, across ``axis``: left and right of it, or below and above."""
    out = BEYOND * (upper[1 - axis] - lower[1 - axis])
    made = []
    for place in (lower[axis] - off, upper[axis] + off):
        ends = np.array([(place, lower[1 - axis] - out), (place, upper[1 - axis] + out)])
        points = ends if axis == 0 else ends[:, ::-1]
        made.append(chain(points, thickness, density, width=2.0 * max(thickness, off), long=True, material=material))
    return made


def _open(lower: Corner, upper: Corner) -> Box:
    """An open box with as much room on all sides as there is within."""
    width, height = upper[0] - lower[0], upper[1] - lower[1]
    return Box(
        (lower[0] - width, lower[1] - height), (upper[0] + width, upper[1] + height), "open", "open", "open", "open"
    )

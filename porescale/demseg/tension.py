"""in_cf0.dat: back tensions, by which a run with jclid 3 is bonded (DEMseg II-3), read and written.

For each point that has some, a line with its number and how many, then as many lines with the number of the other and
the tension, the force of the contact with its sign turned.  Points are the discs, in the order of in_gm.dat, then the
ends of segments, those that coincide once; a number beyond the points is a segment.  Each bond stands there twice.
With discs only that is the layout of the DEMseg tutorial, which gives none for segments.  The numbers are negative: a
bond cancels a contact that presses.  Only corners of segments may have positive ones, and with rule "outline" alone,
those that count less than once (segments.py).  Bonds are between bodies, and between discs that touch.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.dem.bodies.bonding import bond
from porescale.demseg.build import Built
from porescale.demseg.deck import MOST_BODIES
from porescale.demseg.numbers import Reader, real
from porescale.demseg.outputs import bodies_of

Row = tuple[int, int, int, float]
APART = 0.1
"""Most that two bonded discs may stand apart, over the smaller radius: a bond that breaks in the next step may."""


def tensions(built: Built) -> list[Row]:
    """Bonds that hold, or else what would cancel all contacts there are: (point, other, 1 if a segment, tension > 0).

    The grains are left as they are.
    """
    grains, own = built.grains, built.grains.bonds
    if own is None:
        bond(grains)
        listed, grains.bonds = grains.bonds, None
    else:
        listed = own
    assert listed is not None
    whole = np.flatnonzero(listed.whole)
    return [(*listed.ends[k].tolist(), float(listed.back[k])) for k in whole]


def tension_text(built: Built) -> str:
    """in_cf0.dat of what bonds there are, or would be."""
    points = built.grains.discs.count
    lists: dict[int, list[tuple[int, float]]] = {}
    for point, other, sided, back in tensions(built):
        one, two = point + 1, other + 1 + points * sided
        lists.setdefault(one, []).append((two, -back))
        lists.setdefault(two, []).append((one, -back))
    lines = []
    for one in sorted(lists):
        lines.append(f"{one} {len(lists[one])}")
        lines += [f"{two} {real(value)}" for two, value in sorted(lists[one])]
    return "\n".join(lines) + "\n" * bool(lines)


def read_tensions(path: Path, built: Built) -> list[Row]:
    """The bonds of a file; InputError naming line, field and what was expected."""
    points = built.grains.discs.count
    segments = 0 if built.grains.segments is None else len(built.grains.segments.ends)
    known, file = points + segments, Reader(path)
    corners = points if built.grains.segments is None else int(built.grains.segments.is_corner.argmax())
    outlined = built.grains.segments is not None and built.grains.segments.rule == "outline"
    body, positive = _bodies(built), list[int]()  # of the latter: places among the faults, one for each row
    found: dict[tuple[int, int], float] = {}
    from_: dict[tuple[int, int], set[int]] = {}
    while file.more():
        one, count = file.record(("number", int), ("count", int))
        file.must(1 <= one <= known, "number", one, f"1 to {known}")
        file.must(0 <= count <= MOST_BODIES, "count", count, "0 or more")
        for _ in range(int(count)):
            two, value = file.record(("other", int), ("tension", float))
            pair = (int(min(one, two)), int(max(one, two)))
            file.must(1 <= two <= known and one != two, "other", two, f"1 to {known}, not {one:g} itself")
            file.must(pair[0] <= points, "other", two, f"1 to {points}: segments are bonded to points")
            file.must(found.setdefault(pair, value) == value, "tension", value, f"{found[pair]:g}, as before")
            if pair not in from_ and pair[0] >= 1 and pair[1] <= known and one != two:
                same = int(body[pair[0] - 1])
                file.must(
                    same != body[pair[1] - 1], "other", two, f"a point of another body: {one:g} is of body {same}"
                )
                if pair[1] <= corners and (gap := _gap(built, pair[0] - 1, pair[1] - 1)) > 0.0:
                    file.must(False, "other", two, f"a disc that touches {one:g}: they stand {gap:.3g} apart")
            beyond = outlined and corners < pair[1] <= points  # a corner, but no segment
            if not (value < 0.0 or beyond):
                positive.append(len(file.faults))
                if len(positive) == 1:
                    file.must(False, "tension", value, "< 0, as a bond cancels a contact that presses")
            sides = from_.setdefault(pair, set())
            file.must(int(one) not in sides, "other", two, f"each once for {one:g}")
            sides.add(int(one))
    if len(positive) > 1:
        first, more = file.faults[positive[0]], len(positive) - 1
        also = "so is 1 more row" if more == 1 else f"so are {more} more rows"
        file.faults[positive[0]] = replace(first, problem=f"{first.problem}; {also}")
    file.done()
    if not found:
        repair = "write jclid 0 in in_bc.dat to run without bonds"
        raise InputError(Fault("bonds", 0, "there are none, and jclid 3 needs some", repair=repair, file=str(path)))
    halves = [(pair, min(sides)) for pair, sides in sorted(from_.items()) if len(sides) == 1]
    if halves:
        (one, two), named = halves[0]
        absent = two if named == one else one
        rest = f", and so of {len(halves) - 1} more" if len(halves) > 1 else ""
        problem = f"has no bond with {named}, but {named} has one with it{rest}"
        raise InputError(Fault(f"number {absent}", None, problem, repair="name each bond at both ends", file=str(path)))
    rows = []
    for (one, two), value in sorted(found.items()):
        sided = int(two > points)
        rows.append((one - 1, two - 1 - points * sided, sided, -value))
    return rows


def _bodies(built: Built) -> NDArray[np.int64]:
    """Number (from 1) of the body of each point, then of each segment."""
    body, segments = bodies_of(built), built.grains.segments
    return body if segments is None else np.concatenate((body, body[segments.ends[:, 0]]))


def _gap(built: Built, one: int, other: int) -> float:
    """How far two discs stand apart, 0 where they touch or nearly do (APART)."""
    d = built.grains.discs
    gap = float(np.hypot(*(d.position[one] - d.position[other])) - d.radius[one] - d.radius[other])
    return gap if gap > APART * min(d.radius[one], d.radius[other]) else 0.0

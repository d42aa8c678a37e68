"""Further files that DEMseg leaves: its tutorial names them (I-1, I-4, II-4) and prints the layout of none.

Every nprn1 steps, written at the end of a run:
output.dat    a line "step time n", then for each of the n elements: body, element, then of a disc 1, radius, x, y,
              angle, of a segment 2, x1, y1, x2, y2;
cont.dat      a line "step time n", then for each of the n contacts between bodies: body, other body, x, y of the
              contact, force x, force y on the other, normal and tangential part;  the contact of two discs and their
              bond are one line, those of a corner or segment lines of their own;  the normal part is negative where
              a bond pulls;  tangential > 0 pushes the first body along the normal turned left by a right angle;
cont2.dat     the same with the sides of the domain in place of the other: -1 left, -2 right, -3 bottom, -4 top.
Every nprn2 steps, written with energy.dat:
velocity_y.dat    step, then the vertical velocity of every recorded body;
emissions.dat     step, bonds that hold, bonds that broke since the line before, and in all; where there are bonds.
breaks.csv    a row for each bond that broke, by time: time, x, y, strength, body, other body; where there are bonds.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.atomic import write_text
from porescale.common.core.types import Floats
from porescale.common.evidence.files import csv_text
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.open_run import Run
from porescale.dem.forces.walls import SIDES
from porescale.dem.grains import Grains
from porescale.dem.measures.contact_list import Contacts
from porescale.dem.measures.contacts import contacts
from porescale.demseg.build import Built
from porescale.demseg.deck import Deck
from porescale.demseg.numbers import plain

Index = NDArray[np.int64]
CONTACTS = "contacts"
"""Cloud of a snapshot."""
BREAKS = ("time", "x", "y", "strength", "body", "other body")


def bodies_of(built: Built) -> Index:
    """Number (from 1) of the body that each point, disc or corner, belongs to."""
    return np.repeat(np.arange(1, len(built.first)), np.diff(built.first))


def contact_cloud(built: Built) -> Cloud:
    """Contacts at their points, with bodies or side, and what they carry: a contact of discs and its bond are one row.

    Rows of corners stay apart, and so do those of their bonds, see `_apart`.
    """
    grains, body = built.grains, bodies_of(built)
    found = contacts(grains)
    sides = np.array([-1 - SIDES.index(name) for name in grains.wall_names] or [0])
    other = np.where(found.pairs, body[found.second], sides[found.surface])
    key = np.column_stack((found.first, found.second, found.surface, _apart(grains, found)))
    _, rows, same = np.unique(key, axis=0, return_index=True, return_inverse=True)
    same = same.reshape(-1)

    def summed(values: Floats) -> Floats:
        """Sum over the rows of one contact."""
        return np.bincount(same, values, len(rows)).astype(float)  # whole numbers where there is none

    flat = {name: np.zeros((len(rows), 3)) for name in ("force", "start", "branch")}
    for k in range(2):
        flat["force"][:, k] = summed(found.force[:, k])
        flat["start"][:, k], flat["branch"][:, k] = found.start[rows, k], found.branch[rows, k]
    data = {"body": body[found.first[rows]], "other": other[rows], **flat}
    data |= {name: summed(getattr(found, name)) for name in ("normal_force", "tangential_force")}
    return Cloud(found.point[rows], data)


def _apart(grains: Grains, found: Contacts) -> Index:
    """0 of rows of discs and sides alone: those between the same two are one.  A number of its own of each row of a
    corner: points touch several segments that begin at one corner."""
    if grains.segments is None:
        return np.zeros(found.count, np.int64)
    ends = np.unique(grains.segments.ends)
    own = np.isin(found.first, ends) | (found.pairs & np.isin(found.second, ends))
    return np.where(own, np.arange(1, found.count + 1), 0)


def write_places(folder: Path, run: Run, built: Built, deck: Deck) -> None:
    """output.dat, cont.dat and cont2.dat from the snapshots of a run."""
    lines: dict[str, list[tuple[Any, ...]]] = {"output": [], "cont": [], "cont2": []}
    for shot in run.snapshots(cells=()):
        head = (deck.iloop + shot.step, float(shot.time))
        elements = list(_elements(shot, built, deck))
        lines["output"] += [(*head, len(elements)), *elements]
        rows = list(_contact_rows(shot.clouds[CONTACTS])) if CONTACTS in shot.clouds else []
        for name, own in (("cont", [it for it in rows if it[1] > 0]), ("cont2", [it for it in rows if it[1] < 0])):
            lines[name] += [(*head, len(own)), *own]
    for name, all_rows in lines.items():
        write_text(folder / f"{name}.dat", plain(all_rows))


def _elements(shot: Snapshot, built: Built, deck: Deck) -> Iterator[tuple[Any, ...]]:
    """The discs and segments of all bodies where they were in a snapshot."""
    frames, ends, disc = iter(built.frames), 0, 0
    for number, body in enumerate(deck.bodies):
        if body.discs:
            cloud = shot.clouds["grains"]
            for k in range(len(body.discs)):
                radius, angle = float(cloud["radius"][disc]), float(cloud["angle"][disc])
                yield (number + 1, k + 1, 1, radius, *map(float, cloud.position[disc, :2]), angle)
                disc += 1
            continue
        frame, at = next(frames), shot.clouds["ends"].position
        for k, (a, b) in enumerate(frame.ends):
            yield (number + 1, k + 1, 2, *map(float, at[ends + a, :2]), *map(float, at[ends + b, :2]))
        ends += len(frame.corners)


def _contact_rows(cloud: Cloud) -> Iterator[tuple[Any, ...]]:
    """Rows of cont.dat, one a contact or bond, in the columns that the head of the file names."""
    for k in range(len(cloud.position)):
        numbers = (
            *cloud.position[k, :2],
            *cloud["force"][k, :2],
            cloud["normal_force"][k],
            cloud["tangential_force"][k],
        )
        yield (int(cloud["body"][k]), int(cloud["other"][k]), *map(float, numbers))


def write_breaks(folder: Path, built: Built) -> None:
    """breaks.csv of what broke until now."""
    bonds, body = built.grains.bonds, bodies_of(built)
    if bonds is None:
        return
    gone = np.flatnonzero((bonds.whole == 0) & (bonds.back > 0.0))
    gone = gone[np.argsort(bonds.broken[gone, 0], kind="stable")]
    partners = bonds.partners(built.grains.segments)
    rows = [
        [*map(repr, (*bonds.broken[k].tolist(), float(bonds.back[k]))), *map(str, body[partners[k]].tolist())]
        for k in gone.tolist()
    ]
    write_text(folder / "breaks.csv", csv_text(BREAKS, rows))


def write_emissions(folder: Path, step: list[int], whole: Floats) -> None:
    """emissions.dat from the number of bonds that hold at each of the steps."""
    holding = whole.astype(int)
    lost = -np.diff(holding, prepend=holding[:1])
    rows = zip(step, holding.tolist(), lost.tolist(), (holding[0] - holding).tolist(), strict=True)
    write_text(folder / "emissions.dat", "# step bonds broken broken_in_all\n" + plain(rows))

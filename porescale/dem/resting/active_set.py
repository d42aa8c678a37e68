"""Some of the discs as a system of their own, for the same contact steps: arrays of their own, a list of their own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.dem.contact.law import KernelLaw
from porescale.dem.forces.threads import Serial, serial
from porescale.dem.resting.sleep_kernels import list_part, return_springs
from porescale.dem.state import State
from porescale.dem.step import contact_steps

Array = NDArray[np.float64]
Index = NDArray[np.int64]
ROOM = 4
"""Pairs per disc that there is room for at first."""


@dataclass(eq=False)
class Part:
    """m discs of a system, those of ``index`` (m,) in rising order, with copies of what contact steps need.

    origin (p,): places of the part's pairs in the system's list;  held, withheld (m, 3) as in Grains;  load (w, 3),
    plate_load (p, 2), rectangle_load (r, 2) N/m, N m/m: of these discs on the surfaces, after ``steps``.
    """

    index: Index
    position: Array
    angle: Array
    velocity: Array
    spin: Array
    radius: Array
    mass: Array
    inertia: Array
    force: Array
    torque: Array
    external_force: Array
    external_torque: Array
    anchor: Array
    held: NDArray[np.uint8]
    withheld: Array
    start: Index
    partner: NDArray[np.int32]
    carried: Array
    origin: Index
    wall_spring: Array
    plate_spring: Array
    rectangle_spring: Array
    load: Array
    plate_load: Array
    rectangle_load: Array
    law: KernelLaw
    sweep: Serial

    def steps(
        self, grains: State, count: int, dt: float, drag: float, limit: float, first: bool, surfaces: bool = True
    ) -> tuple[int, bool]:
        """Up to ``count`` contact steps of ``dt`` (s): (steps done, whether the system's list must be renewed first).

        limit : m², of the list's skin test;  first : sums of withheld forces begin anew;  surfaces : False leaves out
        walls, plates and rectangles.
        """
        g = grains
        walls, plates, rectangles = g.walls, g.plates, g.rectangles
        if not surfaces:
            walls, plates, rectangles = walls[:0], plates[:0], rectangles[:0]
        done, moved = contact_steps(
            count, dt, drag,
            self.position, self.angle, self.velocity, self.spin, self.radius, self.mass, self.inertia, self.force,
            self.torque, self.external_force, self.external_torque,
            self.start, self.partner, self.carried, self.anchor, limit,
            self.law,
            walls, g.wall_laws, self.wall_spring, self.load[: len(walls)],
            plates, g.plate_laws, self.plate_spring, self.plate_load[: len(plates)],
            rectangles, g.rectangle_laws, self.rectangle_spring, self.rectangle_load[: len(rectangles)],
            self.held, self.withheld, first,
            self.sweep if surfaces else serial(len(self.mass), 0),
            None, g.cell, None, None,
        )  # fmt: skip
        return int(done), bool(moved)

    def springs_back(self, grains: State) -> None:
        """Copy the springs at surfaces and the energy book, if any, back to the system."""
        for own, kept in (
            (self.wall_spring, grains.wall_spring), (self.plate_spring, grains.plate_spring),
            (self.rectangle_spring, grains.rectangle_spring),
        ):  # fmt: skip
            if len(own):
                return_springs(self.index, kept, own)
        if grains.book is not None:
            grains.book[self.index] = self.law.book


def part_of(
    grains: State, asleep: NDArray[np.uint8], index: Index, *, frozen: bool, pairs: bool = True
) -> Part:  # fmt: skip
    """The discs ``index`` of ``grains``, whose list is up to date, without external loads.

    asleep (n,): who sleeps; they are held here.  frozen : pairs are those among sleepers, else those with a disc that
    moves;  pairs : False leaves all out.
    """
    d, listed, m = grains.discs, grains.pairs, len(index)
    number = np.full(d.count, -1, np.int64)
    number[index] = np.arange(m)
    start = np.zeros(m + 1, np.int64)
    partner, origin = np.zeros(ROOM * m * pairs, np.int32), np.zeros(ROOM * m * pairs, np.int64)
    if pairs:
        total = list_part(asleep, frozen, index, number, listed.start, listed.partner, start, partner, origin)
        if total > len(partner):
            partner, origin = np.zeros(total, np.int32), np.zeros(total, np.int64)
            list_part(asleep, frozen, index, number, listed.start, listed.partner, start, partner, origin)
        partner, origin = partner[:total], origin[:total]
    held = np.repeat(asleep[index, None], 3, axis=1)
    if len(grains.held):
        held |= grains.held[index]
    law = grains.contact
    own = type(law)(
        law.table, None if law.material is None else law.material[index], law.mass[index],
        None if law.book is None else law.book[index],
    )  # fmt: skip
    surfaces = len(grains.walls) + len(grains.plates) + len(grains.rectangles)
    return Part(
        index=index, position=d.position[index], angle=d.angle[index], velocity=d.velocity[index], spin=d.spin[index],
        radius=d.radius[index], mass=d.mass[index], inertia=d.inertia[index], force=np.zeros((m, 2)),
        torque=np.zeros(m), external_force=np.zeros((m, 2)), external_torque=np.zeros(m),
        anchor=listed.checked_position[index],
        held=held, withheld=np.zeros((m, 3)), start=start, partner=partner, carried=listed.carried[origin],
        origin=origin, wall_spring=np.ascontiguousarray(grains.wall_spring[:, index]),
        plate_spring=np.ascontiguousarray(grains.plate_spring[:, index]),
        rectangle_spring=np.ascontiguousarray(grains.rectangle_spring[:, index]),
        load=np.zeros((len(grains.walls), 3)), plate_load=np.zeros((len(grains.plates), 2)),
        rectangle_load=np.zeros((len(grains.rectangles), 2)), law=own, sweep=serial(m, surfaces),
    )  # fmt: skip

"""Some of the discs as a system of their own, for the same contact steps: arrays of their own, a list of their own."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.dem.arrays import DiscArrays, Pairs, Surfaces
from porescale.dem.contact.law import KernelLaw
from porescale.dem.forces.threads import Serial, serial
from porescale.dem.resting.sleep_kernels import list_part, return_springs
from porescale.dem.state import State
from porescale.dem.step import contact_steps

Index = NDArray[np.int64]
ROOM = 4
"""Pairs per disc that there is room for at first."""


@dataclass(eq=False)
class ActiveSet:
    """m discs of a system, those of ``index`` (m,) in rising order, with copies of what contact steps need.

    discs, pairs: as DiscArrays and Pairs;  origin (p,): places of its pairs in the system's list;  wall_spring,
    plate_spring, rectangle_spring (s, m, c) m: at surfaces;  load (w, 3), plate_load (p, 2), rectangle_load (r, 2) N/m,
    N m/m: of these discs on the surfaces, after ``steps``.
    """

    index: Index
    discs: DiscArrays
    pairs: Pairs
    origin: Index
    wall_spring: NDArray[np.float64]
    plate_spring: NDArray[np.float64]
    rectangle_spring: NDArray[np.float64]
    load: NDArray[np.float64]
    plate_load: NDArray[np.float64]
    rectangle_load: NDArray[np.float64]
    law: KernelLaw
    sweep: Serial

    def steps(
        self, grains: State, count: int, dt: float, drag: float, limit: float, surfaces: bool = True
    ) -> tuple[int, bool]:
        """Up to ``count`` contact steps of ``dt`` (s): (steps done, whether the system's list must be renewed first).

        limit : m², of the list's skin test;  surfaces : False leaves out walls, plates and rectangles.  Sums of
        withheld forces begin anew.
        """
        g, all_or_none = grains, slice(None) if surfaces else slice(0)
        around = Surfaces(
            g.walls[all_or_none], g.wall_laws, self.wall_spring, self.load[all_or_none],
            g.plates[all_or_none], g.plate_laws, self.plate_spring, self.plate_load[all_or_none],
            g.rectangles[all_or_none], g.rectangle_laws, self.rectangle_spring, self.rectangle_load[all_or_none],
        )  # fmt: skip
        done, moved = contact_steps(
            count, dt, drag, True, self.discs[:], self.pairs._replace(limit_square=limit)[:], self.law, around[:],
            self.sweep if surfaces else serial(len(self.index), 0, g.budget is not None), None, g.cell, None,
        )  # fmt: skip
        return int(done), bool(moved)

    def springs_back(self, grains: State) -> None:
        """Copy the springs at surfaces and the energy budget, if any, back to the system."""
        for own, kept in (
            (self.wall_spring, grains.wall_spring), (self.plate_spring, grains.plate_spring),
            (self.rectangle_spring, grains.rectangle_spring),
        ):  # fmt: skip
            if len(own):
                return_springs(self.index, kept, own)
        if grains.budget is not None:
            grains.budget[self.index] = self.discs.budget


def active_set(
    grains: State, asleep: NDArray[np.uint8], index: Index, *, frozen: bool, pairs: bool = True
) -> ActiveSet:  # fmt: skip
    """The discs ``index`` of ``grains``, whose list is up to date, without external loads.

    asleep (n,): sleeping discs; they are held here.  frozen : pairs are those among sleepers, else those with a disc
    that moves;  pairs : False leaves all out.
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
    own = grains.some_discs(index)._replace(
        angle=d.angle[index], mass=d.mass[index], inertia=d.inertia[index], external_force=np.zeros((m, 2)),
        external_torque=np.zeros(m), held=held, withheld=np.zeros((m, 3)),
        budget=None if grains.budget is None else grains.budget[index],
    )  # fmt: skip
    return ActiveSet(
        index, own, Pairs(start, partner, listed.carried[origin], listed.checked_position[index], 0.0), origin,
        np.ascontiguousarray(grains.wall_spring[:, index]), np.ascontiguousarray(grains.plate_spring[:, index]),
        np.ascontiguousarray(grains.rectangle_spring[:, index]),
        np.zeros((len(grains.walls), 3)), np.zeros((len(grains.plates), 2)), np.zeros((len(grains.rectangles), 2)),
        grains.contact, serial(m, grains.surface_count, grains.budget is not None),
    )  # fmt: skip

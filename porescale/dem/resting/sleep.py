"""Discs that rest are left out of contact steps until something disturbs them.

A disc falls asleep when for ``after`` seconds it went slower than a speed and was out of balance by less than half of
a share of its weight; its velocity is then zero (the energy taken is counted, ``removed``).  Contacts among sleepers
are frozen: their forces are worked out once.  Discs that move, and the sleepers they are listed with, are a system of
their own (active_set.py), in which the same kernel does the same contact steps; sleepers are held there.  A sleeper
wakes, its neighbours with it, as soon as its contacts and external forces are out of balance by more than ``share`` of
its weight, be it by a blow, by a neighbour that leaves or by the fluid.  So what is left out is never out of balance by
more than that share: it stands within  share W/k  of where its springs balance, a share of its own overlap.

All sleep ends while a wall, plate or rectangle moves or comes or goes (plates above all discs do not count).
One thread works; results are the same at any number.  Clumps, frames, bonds and strained cells are without sleep.
"""

from typing import Any

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.contact.budget import BEFORE_SPIN, BEFORE_X, DRAG
from porescale.dem.forces.rectangle import VELOCITY_X, VELOCITY_Y
from porescale.dem.forces.walls import LOW, PRESENT, VELOCITY, VX, WALL
from porescale.dem.listing import current_pairs
from porescale.dem.resting.active_set import ActiveSet, active_set
from porescale.dem.resting.sleep_kernels import (
    ASLEEP,
    any_speed,
    differs,
    disturbed,
    fall_asleep,
    find_border,
    put_back,
    rest_of,
    return_history,
    take_out,
    wake,
)
from porescale.dem.state import State

LOOK = 32
"""Contact steps between checks for resting discs: an oscillation in a contact takes 20 to 60."""
AFTER = 100.0
"""Oscillations of the hardest contact for which a disc must rest before it sleeps."""


class Sleep:
    """Sleeping discs of ``grains``.

    weight (n,) N/m: what a disc's share is of, its weight or that less its lift;  share : of it;  after : s, by default
    100 oscillations of the smallest disc on its hardest contact.  A disc rests below the speed  v = share sqrt(W r/m):
    what is taken of its energy is at most share² W r, what lifts it by that share² of its radius.
    asleep (n,) uint8;  removed (n,) J/m, kinetic energy taken so far.  Call ``wake_all`` or ``wake_disc`` before
    changing discs by hand.  Raises InputError where there is more than discs.
    """

    def __init__(self, grains: State, weight: Floats, share: float = 0.01, after: float | None = None) -> None:
        if grains.steered or grains.segments is not None or grains.bonds is not None or grains.reach is not None:
            raise InputError(Fault("sleep", None, "is for free discs only", repair="leave it out"))
        count, smallest = grains.discs.count, float(grains.discs.radius.min(initial=np.inf))
        self.allowed = share * np.abs(weight)
        self.speed = share * np.sqrt(np.abs(weight) * grains.discs.radius / grains.discs.mass)
        lightest = float(grains.discs.mass.min(initial=np.inf))
        stiffness = max(law.stiffest(lightest, smallest).stiffness[0] for law in grains.laws)
        self.after = AFTER * np.pi * float(np.sqrt(lightest / stiffness)) if after is None else after
        self.asleep, self.called = np.zeros(count, np.uint8), np.zeros(count, np.uint8)
        self.quiet, self.removed = np.zeros(count), np.zeros(count)
        self.balance = np.zeros((count, 3))
        self._role = np.zeros(count, np.uint8)
        self._some = False
        self._looked = grains.steps  # steps of the system at the last check
        self._surfaces = self._surfaces_of(grains)
        self._part: ActiveSet | None = None  # as the sets of sleepers and the list were when it was made
        self._builds = self._looks = -1
        self._deep = np.zeros(0, np.int64)  # sleepers that are listed with no moving disc
        self._loads = np.zeros((0, 3)), np.zeros((0, 2)), np.zeros((0, 2))  # of those on the surfaces

    @property
    def count(self) -> int:
        """Number of sleeping discs."""
        return int(np.count_nonzero(self.asleep))

    def wake_all(self) -> None:
        """Wake all discs, and set their times at rest to zero."""
        self.asleep[:], self.quiet[:] = 0, 0.0
        self._some, self._part = False, None

    def wake_disc(self, grains: State, disc: int) -> None:
        """Wake a disc and its neighbours, before it is moved by hand."""
        self.called[disc] = 1
        current_pairs(grains)
        self._wake(grains)

    def step(self, grains: State, dt: float, drag: float, count: int) -> int:
        """Up to ``count`` contact steps with the external loads of ``grains``; how many are left, for all awake."""
        self._look(grains, dt)
        left = count
        while left > 0 and self._part_now(grains, dt):
            part = self._part
            assert part
            self._take_out(grains, part)
            done, grains.stale = part.steps(grains, left, dt, drag, grains.pairs.skin_margin**2)
            calls = self._put_back(grains, part, done, left == count)
            left -= done
            grains.steps += done
            grains.steps_of_dt += done
            if calls:
                self._wake(grains)
        return left

    def _look(self, grains: State, dt: float) -> None:
        """End all sleep where surfaces move or changed; else, at every check, put to sleep the discs that have
        rested."""
        still = not self._moving(grains)
        if not still or self._others(grains):
            self._surfaces = self._surfaces_of(grains)
            self.wake_all()
        if not still or grains.steps - self._looked < LOOK:
            return
        d, elapsed, self._looked = grains.discs, (grains.steps - self._looked) * dt, grains.steps
        rest_of(
            self.asleep, d.velocity, d.spin, d.radius, d.force, d.torque, grains.held, self.speed, self.allowed,
            elapsed, self.quiet,
        )  # fmt: skip
        if not (self.quiet >= self.after).any(where=self.asleep != ASLEEP):
            return
        before = self.removed.copy()
        fall_asleep(self.asleep, self.quiet, self.after, d.velocity, d.spin, d.mass, d.inertia, self.removed)
        if grains.budget is not None:
            grains.budget[:, DRAG] += self.removed - before
            grains.budget[self.asleep == ASLEEP, BEFORE_X : BEFORE_SPIN + 1] = 0.0
        self._some, self._part = True, None

    def _moving(self, grains: State) -> bool:
        """Whether a wall, a rectangle, or a plate that reaches below the highest disc moves."""
        if any_speed(grains.walls, VX, WALL) or any_speed(grains.rectangles, VELOCITY_X, VELOCITY_Y + 1):
            return True
        if not any_speed(grains.plates, VELOCITY, VELOCITY + 1):
            return False
        rising = (grains.plates[:, PRESENT] != 0.0) & (grains.plates[:, VELOCITY] != 0.0)
        if not rising.any():
            return False
        top = float((grains.discs.position[:, 1] + grains.discs.radius).max(initial=-np.inf))
        return bool((grains.plates[rising, LOW] < top).any())

    def _surfaces_of(self, grains: State) -> tuple[Floats, Floats, Floats]:
        """What there is of surfaces: places of walls and rectangles, and which plates are there (p, 1)."""
        return grains.walls[:, :VX].copy(), grains.rectangles[:, :VELOCITY_X].copy(), grains.plates[:, PRESENT:].copy()

    def _others(self, grains: State) -> bool:
        """Whether the surfaces differ from those of the last check."""
        walls, rectangles, plates = self._surfaces
        if len(walls) != len(grains.walls) or len(rectangles) != len(grains.rectangles):
            return True
        present = np.not_equal(grains.plates[:, PRESENT:], plates).any()
        return bool(differs(grains.walls, walls, VX) or differs(grains.rectangles, rectangles, VELOCITY_X) or present)

    def _part_now(self, grains: State, dt: float) -> bool:
        """Whether any disc sleeps; then the active set is up to date, and no sleeper is out of balance."""
        while self._some:
            pairs = current_pairs(grains)
            if self._part is None or self._builds != pairs.builds:
                self._divide(grains, dt)
                self._builds = pairs.builds
            elif self._looks != pairs.looks:  # by this step, or by another user of the list since the last
                np.take(
                    pairs.checked_position, self._part.index, axis=0, out=self._part.pairs.checked_position, mode="clip"
                )
            self._looks = pairs.looks
            d = grains.discs
            if not disturbed(
                self._deep, self.balance, grains.external_force, grains.external_torque, d.radius, self.allowed,
                d.force, d.torque, self.called,
            ):  # fmt: skip
                return True
            self._wake(grains)
        return False

    def _wake(self, grains: State) -> None:
        """Wake the discs marked in ``called``, and their neighbours."""
        pairs = grains.pairs
        wake(self.asleep, self.called, pairs.start, pairs.partner, self.quiet)
        self._some, self._part = bool(self.asleep.any()), None

    def _divide(self, grains: State, dt: float) -> None:
        """The discs that move and those beside them as a part; of all others the balance of their frozen contacts."""
        find_border(self.asleep, grains.pairs.start, grains.pairs.partner, self._role)
        sleepers = np.flatnonzero(self.asleep)
        among = active_set(grains, self.asleep, sleepers, frozen=True)
        among.steps(grains, 1, dt, 0.0, np.inf, surfaces=False)
        self.balance[:] = 0.0
        self.balance[sleepers] = among.discs.withheld
        self._deep = np.flatnonzero(self._role == 0)
        against = active_set(grains, self.asleep, self._deep, frozen=True, pairs=False)
        against.steps(grains, 1, dt, 0.0, np.inf)
        self.balance[self._deep] += against.discs.withheld
        self._loads = against.load, against.plate_load, against.rectangle_load
        self._part = active_set(grains, self.asleep, np.flatnonzero(self._role), frozen=False)

    def _take_out(self, grains: State, part: ActiveSet) -> None:
        """Bring the part to the state of the system."""
        take_out(part.index, self.asleep, self.balance, grains.disc_arrays(), part.discs)

    def _put_back(self, grains: State, part: ActiveSet, done: int, first: bool) -> int:
        """Bring the system to the state of the part after ``done`` steps; how many sleepers are called."""
        return_history(part.origin, grains.pairs.carried, part.pairs.history)
        calls: int = put_back(
            part.index, self.asleep, grains.disc_arrays(), part.discs, done, self.allowed, self.called
        )
        part.springs_back(grains)
        np.add(part.load, self._loads[0], out=grains.wall_load)
        np.add(part.plate_load, self._loads[1], out=grains.plate_force)
        np.add(part.rectangle_load, self._loads[2], out=grains.rectangle_force)
        if len(grains.held):
            grains.withheld[:] *= not first
            by_owner = grains.held[part.index].any(axis=1)
            grains.withheld[part.index[by_owner]] += part.discs.withheld[by_owner]
        return calls

    def state(self) -> dict[str, Any]:
        """The quantities that decide which discs sleep from here on, for a checkpoint."""
        names = ("walls", "rectangles", "plates")
        return {
            "asleep": self.asleep.copy(), "quiet": self.quiet.copy(), "removed": self.removed.copy(),
            "looked": self._looked, **dict(zip(names, self._surfaces, strict=True)),
        }  # fmt: skip

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from ``state``: what is left out is worked out anew, from what has not changed since."""
        for name in ("asleep", "quiet", "removed"):
            getattr(self, name)[:] = state[name]
        self._looked = int(state["looked"])
        walls, rectangles, plates = (np.array(state[name]) for name in ("walls", "rectangles", "plates"))
        self._surfaces = walls, rectangles, plates
        self._some, self._part = bool(self.asleep.any()), None

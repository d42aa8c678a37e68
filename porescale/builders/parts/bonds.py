"""Bonds of a scene: made at their times between chosen bodies, counted, and located when they break."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.builders.initial.contact_laws import law_class
from porescale.builders.initial.frames import Placed, disc_count
from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.core.errors import Fault, InputError, warn
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.part import Part
from porescale.dem.bodies.bonding import bond, segments_now
from porescale.dem.bodies.rigid import as_bodies
from porescale.dem.forces.bonds import BondList, pressing, touched
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import count_in_bonds, energy_of_bonds
from porescale.dem.measures.region import Region
from porescale.dem.motion.drivers import Clump as ClumpNumber
from porescale.dem.sanity import WORST_OVERLAP
from porescale.output.frame_clouds import BONDS
from porescale.scene.bodies.bonds import KINDS, Bonds

Body = tuple[int, int]


class Bodies:
    """What the bodies of a system are called: kind and number of every disc's."""

    def __init__(self, grains: Grains, placed: Sequence[Placed], held: int) -> None:
        """``held`` : discs that are no bodies, the last ones before corners."""
        discs, self.clumps = disc_count(grains), grains.steering.clumps if grains.steered else None
        self.placed = placed
        self.kind, self.number = np.zeros(grains.discs.count, np.int32), np.arange(grains.discs.count, dtype=np.int32)
        first = 0 if self.clumps is None else self.clumps.count - len(placed)
        counts: dict[str, int] = {}
        self.named: dict[Body, int | ClumpNumber] = {(0, i): i for i in range(discs - held)}
        for c in range(0 if self.clumps is None else self.clumps.count):
            kind = "clump" if c < first else placed[c - first].kind
            number = counts[kind] = counts.get(kind, -1) + 1
            assert self.clumps is not None
            own = self.clumps.discs_of(c)
            self.kind[own], self.number[own] = KINDS.index(kind), number
            for i in own:
                self.named.pop((0, int(i)), None)
            self.named[KINDS.index(kind), number] = ClumpNumber(c)

    def chosen(self, words: tuple[str, ...], key: str) -> list[Body]:
        """The bodies that words name; raises InputError at one that is not there."""
        found: list[Body] = []
        for k, word in enumerate(words):
            kind, _, number = word.partition(" ")
            of_kind = [body for body in self.named if body[0] == KINDS.index(kind)]
            one = [body for body in of_kind if not number or body[1] == int(number)]
            if not one:
                there = ", ".join(sorted({KINDS[body[0]] for body in self.named}))
                raise InputError(Fault(f"{key}.bodies[{k}]", word, "there is no such body", "", f"of {there}"))
            found += one
        return found or list(self.named)


class BondsPart(Part):
    """Makes the bonds of a scene at their times.  made : how many sections have been."""

    def __init__(self, system: System) -> None:
        """Of a scene with [bonds] or [rock], whose pieces are all bonded at the start."""
        assert system.grains
        self.clock, self.grains = system.clock, system.grains
        self.bodies = Bodies(system.grains, system.frames, system.held)
        whole = [("rock", Bonds(bodies=(), known=()))] if system.scene.rock else []
        own = [(f"bonds[{k}]", it) for k, it in enumerate(system.scene.bonds)]
        self.sections = sorted([*whole, *own], key=lambda it: it[1].at)
        self.chosen = [self.bodies.chosen(it.bodies, key) for key, it in self.sections]
        for key, section in self.sections:
            self._require_numbers(key, section)
        contact = system.scene.contact
        self.linear = contact is not None and law_class(contact).compresses
        self.made = 0
        self.before()  # what is bonded at time 0 is there in the first record

    @property
    def acts_from(self) -> float:
        """The step of the next section."""
        return self.clock.step_of(self.sections[self.made][1].at) if self.made < len(self.sections) else math.inf

    def before(self) -> None:
        """Bond what is to be bonded in the step that begins nearest to its time.  Warns of what pulls too hard but at
        time 0, as what contacts carry later is not known before."""
        time, step = self.clock.time, self.clock.seconds
        while self.made < len(self.sections) and time >= self.sections[self.made][1].at - 0.5 * step:
            key, section = self.sections[self.made]
            before = 0 if self.grains.bonds is None else len(self.grains.bonds.back)
            stored = energy_of_bonds(self.grains)
            if section.known:
                self._join(section)
                count_in_bonds(self.grains, stored)
                self._made(before)
                continue
            bodies = self._within(self.chosen[self.made], section)
            count = bond(self.grains, [self.bodies.named[body] for body in bodies])
            if count:
                own = self.grains.bonds.back[before:]  # type: ignore[union-attr]
                own *= section.factor if section.tension is None else section.tension / float(np.mean(own[own > 0.0]))
                count_in_bonds(self.grains, stored)
                self._made(before)
                continue
            nothing = "nothing touches"
            if before:  # as of a rock, whose pieces are bonded first
                nothing += " that is not bonded already"
            if section.at == 0.0:
                repair = f"{'leave it out' if before else 'place bodies closer'}, or bond later"
                problem = f"{nothing}, so there is nothing to bond"
                raise InputError(Fault(f"{key}.at", section.at, problem, "s", repair=repair))
            warn(f"t = {time:.6g} s: {key} makes no bond, as {nothing}")
            self._made(before)

    def _made(self, first: int) -> None:
        """Count a section whose bonds are those from ``first`` on, and warn of later ones that pull too hard."""
        self.made += 1
        for text in self.doubts(first) if self.clock.time > 0.0 else []:
            warn(f"t = {self.clock.time:.6g} s: {text}")

    def _join(self, section: Bonds) -> None:
        """The bonds that a section gives by number."""
        ends = np.array([row[:3] for row in section.known], np.int64)
        made = BondList(ends, np.array([row[3] for row in section.known]))
        self.grains.bonds = made if self.grains.bonds is None else self.grains.bonds.joined(made)

    def _require_numbers(self, key: str, section: Bonds) -> None:
        """InputError where a section gives a bond by a number that there is not, within a body, or twice."""
        grains = self.grains
        ends = np.array([row[:3] for row in section.known], np.int64).reshape(-1, 3)
        segments = 0 if grains.segments is None else len(grains.segments.ends)
        most = np.where(ends[:, 2] == 1, segments, grains.discs.count)
        bad = np.flatnonzero((ends < 0).any(axis=1) | (ends[:, 0] >= grains.discs.count) | (ends[:, 1] >= most))
        if len(bad):
            problem = f"there are {grains.discs.count} discs and corners, and {segments} segments"
            raise InputError(Fault(f"{key}.known[{bad[0]}]", None, problem, repair="number them from 0"))
        held: set[tuple[int, int, int]] = set()
        for k, (here, other, sided) in enumerate(ends.tolist()):
            pair = (here, other, sided) if sided else (min(here, other), max(here, other), 0)
            two = int(grains.segments.ends[other, 0]) if sided and grains.segments else other
            if self.bodies.kind[here] == self.bodies.kind[two] and self.bodies.number[here] == self.bodies.number[two]:
                problem, repair = "bonds a body to itself", "name discs, corners or segments of two bodies"
            elif pair in held:
                problem, repair = "bonds what an earlier row bonds", "give each bond once"
            else:
                held.add(pair)
                continue
            raise InputError(Fault(f"{key}.known[{k}]", None, problem, repair=repair))

    def doubts(self, first: int = 0) -> list[str]:
        """Warnings about the bonds from number ``first`` on that hold nothing, or pull too hard, as they are now.

        A bond of tension b on a contact of overlap d that carries f sets its bodies into motion with (b - f)/m, m their
        reduced mass.  Where that is more than d in a step, (b - f) dt²/m > d, steps decide whether they part when they
        come back, with an error of energy of order b²dt²/m, of any size beside that of the motion before.  Under a
        linear law without damping they swing to an overlap of 2 b/k - d, k = f/d.
        """
        grains, bonds, seconds = self.grains, self.grains.bonds, self.clock.seconds
        if bonds is None:
            return []
        d, segments, n = grains.discs, segments_now(grains), len(bonds.back)
        way, far, other, carried = np.zeros((n, 2)), np.zeros((n, 2)), np.zeros(n, np.int64), np.zeros(n)
        touched(d.position, bonds.ends, segments, grains.cell, way, far, other)
        pressing(
            d.position, d.radius, grains.body_mass, grains.material, bonds.ends, segments, grains.contact, grains.cell,
            carried,
        )  # fmt: skip
        here, found = bonds.ends[:, 0], list[str]()
        overlap = d.radius[here] + d.radius[other] - np.hypot(way[:, 0], way[:, 1])
        own = np.arange(n) >= first
        if (free := own & (overlap <= 0.0) & (bonds.back > 0.0)).any():
            k = int(np.argmin(np.where(free, overlap, np.inf)))
            ends = ", ".join(str(number) for number in bonds.ends[k])
            found.append(
                f"bonds between what does not touch break in their first step: {int(free.sum())} of bonds.known, such"
                f" as [{ends}, …], {-overlap[k]:.3g} m apart; place bodies closer"
            )
        apart = own & (carried > 0.0) & (overlap > 0.0) & (bonds.back > carried)
        if not apart.any():
            return found
        one, two = grains.body_mass[here], grains.body_mass[other]
        pull, carried, overlap, mass = (it[apart] for it in (bonds.back, carried, overlap, one * two / (one + two)))
        at_most = carried + overlap * mass / seconds**2
        if (pull > at_most).any():
            k = int(np.argmax(pull / at_most))
            found.append(
                f"a bond of {pull[k]:.3g} N/m is {pull[k] / carried[k]:.2g} times what its contact carries, and moves "
                f"its bodies in a step by more than its overlap of {overlap[k]:.2g} m: whether it breaks, and with "
                f"what energy, is left to the steps, which resolve {at_most[k]:.2g} N/m at most: press bodies together "
                "before they are bonded (bonds.at), or lower bonds.factor or tension"
            )
        limit = WORST_OVERLAP * np.minimum(d.radius[here], d.radius[other])[apart]
        deepest = (2.0 * pull / carried - 1.0) * overlap
        if self.linear and (deepest > limit).any():
            k = int(np.argmax(deepest / limit))
            found.append(
                f"a bond of {pull[k]:.3g} N/m draws its bodies into each other by up to {deepest[k]:.2g} m, and beyond "
                f"{limit[k]:.2g} m, {WORST_OVERLAP:g} of the radius, a run stops: contacts "
                f"{1.1 * deepest[k] / limit[k]:.2g} times as stiff suffice, or lower bonds.factor or tension"
            )
        return found

    def _within(self, bodies: list[Body], section: Bonds) -> list[Body]:
        """Those with their centre in the rectangle of a section, or an image of it through periodic sides."""
        if section.within is None:
            return bodies
        left, bottom, right, top = section.within
        rectangle, clumps = Region((left, bottom), (right, top)), self.bodies.clumps
        at = rectangle.near(as_bodies(self.grains).position, self.grains.period)

        def inside(body: Body) -> bool:
            """Whether a body's centre lies there; a clump's is its first disc's."""
            name = self.bodies.named[body]
            if isinstance(name, ClumpNumber):
                assert clumps is not None
                name = int(clumps.discs_of(name.number)[0])
            return bool(left <= at[name, 0] <= right and bottom <= at[name, 1] <= top)

        return [body for body in bodies if inside(body)]

    def row(self) -> Row:
        """Columns of the bonds in series.csv.

        bonds () : bonds that hold
        broken bonds () : bonds that have broken since they were made
        """
        bonds = self.grains.bonds
        there = 0 if bonds is None else int(np.sum(bonds.back > 0.0))
        whole = 0 if bonds is None else bonds.count
        return {"bonds ()": float(whole), "broken bonds ()": float(there - whole)}

    def show(self, snapshot: Snapshot) -> None:
        """The cloud of bonds."""
        snapshot.clouds[BONDS] = self.cloud()

    def state(self) -> dict[str, Any]:
        """How many sections have been; the bonds are of the grains."""
        return {"bonds_made": self.made}

    def restore(self, state: dict[str, Any]) -> None:
        """Restore the state of a checkpoint."""
        self.made = int(state["bonds_made"])

    def cloud(self) -> Cloud:
        """Bonds as lines between what they hold: two points each, with whether it is whole, its back tension, when and
        where it broke, and the kind (see KINDS) and number of both bodies."""
        bonds = self.grains.bonds or BondList(np.zeros((0, 3), np.int64), np.zeros(0))
        shown = bonds.back > 0.0
        ends = np.ascontiguousarray(bonds.ends[shown])
        way, far, other = np.zeros((len(ends), 2)), np.zeros((len(ends), 2)), np.zeros(len(ends), np.int64)
        known = segments_now(self.grains)
        at = self.grains.discs.position
        if known is not None:
            touched(at, ends, known, self.grains.cell, way, far, other)
        points = np.repeat(at[ends[:, 0]], 2, axis=0)
        points[1::2] += way
        broken = bonds.broken[shown]
        data: dict[str, NDArray[Any]] = {
            "whole": bonds.whole[shown], "back_tension": bonds.back[shown], "broken_time": broken[:, 0],
            "first_kind": self.bodies.kind[ends[:, 0]], "first_number": self.bodies.number[ends[:, 0]],
            "second_kind": self.bodies.kind[other], "second_number": self.bodies.number[other],
        }  # fmt: skip
        data = {name: np.repeat(values, 2) for name, values in data.items()}
        data["broken_place"] = np.repeat(np.column_stack((broken[:, 1:], np.zeros(len(ends)))), 2, axis=0)
        units = {"back_tension": "N/m", "broken_time": "s", "broken_place": "m"}
        return Cloud(points, data, units, lines=np.arange(len(points)).reshape(-1, 2))

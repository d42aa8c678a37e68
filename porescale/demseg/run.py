"""A deck driven through time: the model that porescale/runs drives, and the files that DEMseg leaves.

energy.dat (DEMseg tutorial I-2): step, then
    enrg potential;  enva kinetic;  enka elastic, bonds included;  enca lost in dashpots;  enfr lost in friction;
    enxd work of bodies with prescribed motion;  enxf work of prescribed forces;  err what does not balance.
f-d_curve.dat (I-3): step, body, force x, place x, force y, place y, moment, angle, the order of the numbers in DEMseg's
output (the text beside them has force and place the other way round); forces are those of contacts.
Both every nprn2 steps and at both ends, written anew, whole or absent, every nprn1 steps; steps count on from iloop.
output.dat, cont.dat, cont2.dat, velocity_y.dat, emissions.dat and breaks.csv: see outputs.py.
At the end: new_in_gm.dat, new_in_bc.dat (jclid 1), new_in_cf.dat (see state.py) and new_in_cf0.dat (see tension.py),
for the next run, without new_.
"""

import re
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from porescale.common.core.atomic import write_text
from porescale.common.core.errors import Fault, InputError, Unstable
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.open_run import open_run
from porescale.common.record.series import NAME as SERIES
from porescale.common.record.series import read_series
from porescale.dem.bodies.frames import cells_of
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import LOSSES, WORKS, energy_budget
from porescale.demseg.build import Options, bodies_now, bonded, build, posture, with_bodies
from porescale.demseg.check import check_bodies
from porescale.demseg.deck import BC, BONDED, CF, CF0, GM, GO_ON, Body, Deck, boundary_text, grains_text, read_deck
from porescale.demseg.numbers import plain
from porescale.demseg.options import kept_options, require_kept
from porescale.demseg.outputs import CONTACTS, bodies_of, contact_cloud, write_breaks, write_emissions, write_places
from porescale.demseg.state import read_state, state_text
from porescale.demseg.tension import read_tensions, tension_text

ENERGY = ("enrg", "enva", "enka", "enca", "enfr", "enxd", "enxf", "err")
RECORD = ("force x", "place x", "force y", "place y", "moment", "angle")
FRICTION = ("lost in friction (J/m)", "lost in rolling friction (J/m)")
HOLDING = "bonds"
"""Column of the series: bonds that hold."""
SPEED = "velocity y"
FORCES = "fd"
"""Name of the table of recorded bodies in the run folder."""


class DeckRun:
    """A deck in motion; ``step`` counts from its beginning, ``deck.iloop`` what was done before."""

    def __init__(self, deck: Deck, options: Options, folder: Path) -> None:
        """``folder`` holds in_cf.dat or in_cf0.dat where the deck needs one; else see read."""
        self.deck, self.options = with_bodies(deck, options.seed), options
        before = read_state(folder / CF) if deck.jclid == GO_ON else None
        if before is not None:
            require_kept(before, self.deck, options, folder / CF)
        if before is None and deck.random is None:
            check_bodies(deck)
        self._start = self.deck.bodies if before is None else _started(self.deck, before, folder / CF)
        self.built = build(replace(self.deck, bodies=self._start), options)
        self.grains = self.built.grains
        self.step, self.time, self.step_seconds = 0, 0.0, deck.dt
        self._weight = self.grains.discs.mass[:, None] * np.array(deck.gravity)
        if before is not None:
            self._go_on(before, folder)
        if deck.jclid == BONDED:
            bonded(self.built, read_tensions(folder / CF0, self.built))

    def _go_on(self, before: dict[str, Any], folder: Path) -> None:
        """Take over the state of in_cf.dat; in_gm.dat must hold the same bodies."""
        walls = self.grains.walls.copy()
        try:
            _restore(self.grains, before["grains"])
        except (KeyError, ValueError, InputError) as error:
            problem = f"does not fit in_gm.dat ({' '.join(str(error).split())[:100]}), expected that of the same bodies"
            raise InputError(Fault("state", None, problem, file=str(folder / CF))) from None
        self.grains.walls[:] = walls  # the domain may have changed
        now = bodies_now(self.deck, self.built)
        for number, (given, is_) in enumerate(zip(self.deck.bodies, now, strict=True)):
            if given != is_:
                repair = "write jclid 0 or 3 in in_bc.dat to start from in_gm.dat"
                problem = "is not as in_cf.dat has it"
                raise InputError(Fault(f"body {number + 1}", None, problem, repair=repair, file=str(folder / GM)))

    def advance(self, steps: int) -> None:
        """Do ``steps`` steps.  The last is a call of its own: the record of forces is that of one step."""
        try:
            for count in (steps - 1, 1):
                if count:
                    self.grains.step(self.step_seconds, self._weight, count=count)
                    self.step += count
        except Unstable as e:  # grains count from 0 and have units, decks do not
            where = re.sub(r"^grain (\d+)$", lambda found: f"point {int(found[1]) + 1}", e.where)
            raise Unstable(where, e.quantity, e.value, "", e.step, e.time, e.cause) from None
        finally:
            self.time = self.step * self.step_seconds

    def doubts(self) -> list[str]:
        """What is doubtful of the deck and goes on all the same, one line each."""
        limit = self.grains.stable_step(safety=1.0, steps_per_contact=0.0)
        if self.step_seconds <= limit:
            return []
        text = f"dt = {self.step_seconds:g} is beyond {limit:.3g}, up to which bodies in any contacts are stable"
        return [f"{self.deck.file}: {text}: energies may grow without bound, see err in energy.dat"]

    def check(self) -> None:
        """Raise Unstable when a point is nowhere, or outside of the domain by more than the domain is long.

        Nothing else stops a deck: what steps that are too long do to its energies, ``err`` shows, see doubts.
        """
        x1, x2, y1, y2 = self.deck.domain
        at = self.grains.discs.position
        out = np.maximum(np.array([x1, y1]) - at, at - np.array([x2, y2])).max(axis=1)
        lost = np.flatnonzero(~(out <= max(x2 - x1, y2 - y1)))
        if len(lost):
            worst, name = int(lost[0]), "distance from the domain"
            cause = "a contact step too long, or a wall that was passed"
            raise Unstable(f"point {worst + 1}", name, float(out[worst]), "", self.step, self.time, cause)

    def series(self) -> dict[str, float]:
        """Time, step and the columns of energy.dat."""
        budget = energy_budget(self.grains, self.deck.gravity)
        values = (
            budget["potential energy (J/m)"],
            sum(value for name, value in budget.items() if name.startswith("kinetic")),
            sum(value for name, value in budget.items() if name.startswith("elastic")),
            sum(budget[name] for name in LOSSES if name not in FRICTION),
            sum(budget[name] for name in FRICTION),
            sum(budget[name] for name in WORKS),
            budget["work of external forces (J/m)"],
            budget["residual (J/m)"],
        )
        row = {"time": self.time, "step": self.deck.iloop + self.step}
        bonds = self.grains.bonds
        return row | dict(zip(ENERGY, values, strict=True)) | ({} if bonds is None else {HOLDING: float(bonds.count)})

    def tables(self) -> dict[str, dict[str, float]]:
        """The recorded bodies, a column for each body and column of f-d_curve.dat."""
        if not self.deck.recorded:
            return {}
        row: dict[str, float] = {"step": self.deck.iloop + self.step}
        now = bodies_now(self.deck, self.built)
        for body, line in zip(self.deck.recorded, self.grains.steering.record(), strict=True):
            row[f"body {body}: {SPEED}"] = now[body - 1].velocity[1]
            for k, place in enumerate(posture(self.built, body - 1)):
                row[f"body {body}: {RECORD[2 * k]}"] = line.contact[k]
                row[f"body {body}: {RECORD[2 * k + 1]}"] = place
        return {FORCES: row}

    def snapshot(self) -> Snapshot:
        """Discs, and the ends of segments, with what they make: lines and polygons."""
        d, shot = self.grains.discs, Snapshot(self.time, self.step)
        split, numbers = sum(len(body.discs) for body in self.deck.bodies), bodies_of(self.built)
        for name, own in (("grains", slice(0, split)), ("ends", slice(split, d.count))):
            if len(d.radius[own]):
                flat = np.zeros((len(d.radius[own]), 3))
                flat[:, :2] = d.velocity[own]
                turned = {"angle": d.angle[own], "velocity": flat, "spin": d.spin[own]}
                data = {"radius": d.radius[own], **turned, "body": numbers[own]}
                shot.clouds[name] = Cloud(d.position[own], data)
        if self.built.frames:
            lines, polygons = cells_of(self.built.frames)
            shot.clouds["ends"].lines, shot.clouds["ends"].polygons = lines, polygons
        shot.clouds[CONTACTS] = contact_cloud(self.built)
        return shot

    def state(self) -> dict[str, Any]:
        """All it takes to go on bit for bit."""
        return {"step": self.step, "time": self.time, "grains": self.grains.state()}

    def restore(self, state: dict[str, Any]) -> None:
        """Go on exactly from ``state()`` of the same deck."""
        self.grains.restore(state["grains"])
        self.step, self.time = int(state["step"]), float(state["time"])

    def write(self, folder: Path) -> None:
        """All that DEMseg leaves, and the files of the next run, into the run folder."""
        self.write_tables(folder)
        write_places(folder, open_run(folder), self.built, self.deck)
        write_breaks(folder, self.built)
        self.write_next(folder)

    def write_tables(self, folder: Path) -> None:
        """energy.dat and the other tables from the run folder's so far, into it, each whole or absent."""
        energy = read_series(folder / SERIES)
        if HOLDING in energy:
            write_emissions(folder, energy["step"].astype(int).tolist(), energy[HOLDING])
        rows = zip(energy["step"].astype(int).tolist(), *(energy[name].tolist() for name in ENERGY), strict=True)
        write_text(folder / "energy.dat", f"# step {' '.join(ENERGY)}\n" + plain(rows))
        if self.deck.recorded:
            record = read_series(folder / f"{FORCES}.csv")
            columns = [[record[f"body {body}: {name}"] for name in RECORD] for body in self.deck.recorded]
            lines = (
                (step, body, *(float(column[k]) for column in columns[n]))
                for k, step in enumerate(record["step"].astype(int).tolist())
                for n, body in enumerate(self.deck.recorded)
            )
            speeds = [record[f"body {body}: {SPEED}"].tolist() for body in self.deck.recorded]
            numbers = " ".join(str(body) for body in self.deck.recorded)
            moving = zip(record["step"].astype(int).tolist(), *speeds, strict=True)
            write_text(folder / "velocity_y.dat", f"# step, then bodies {numbers}\n" + plain(moving))
            names = "force_x place_x force_y place_y moment angle"
            write_text(folder / "f-d_curve.dat", f"# step body {names}\n" + plain(lines))

    def write_next(self, folder: Path) -> None:
        """Write the files of the next run, new_in_*.dat, into ``folder``."""
        after = replace(
            self.deck, bodies=bodies_now(self.deck, self.built), jclid=GO_ON, iloop=self.deck.iloop + self.step
        )  # fmt: skip
        kept = {
            "start": _numbers(self._start),
            "options": kept_options(self.deck, self.options),
            "heading": self.built.heading,
            "grains": self.grains.state(),
        }
        write_text(folder / f"new_{GM}", grains_text(after))
        write_text(folder / f"new_{BC}", boundary_text(after))
        write_text(folder / f"new_{CF}", state_text(kept))
        write_text(folder / f"new_{CF0}", tension_text(self.built))


def read(folder: Path, options: Options) -> DeckRun:
    """The deck in ``folder``, ready to run; InputError, one line a fault."""
    return DeckRun(read_deck(folder), options, folder)


def card_of(deck: Deck, options: Options) -> dict[str, Any]:
    """The deck and what was chosen beside it, as the run's card keeps them."""
    kept = {name: value for name, value in asdict(deck).items() if name not in ("file", "lines")}  # where it stands
    return {"deck": kept, "options": asdict(options)}


def _numbers(bodies: tuple[Body, ...]) -> list[tuple[float, ...]]:
    return [element for body in bodies for element in (body.discs or body.segments)]


def _started(deck: Deck, before: dict[str, Any], path: Path) -> tuple[Body, ...]:
    """The bodies of ``deck`` as they were when the run began that in_cf.dat goes on from: they are built alike."""
    rows = np.asarray(before.get("start", ()))
    if rows.shape != (count := len(_numbers(deck.bodies)), 4):
        raise InputError(
            Fault("start", str(rows.shape), f"does not fit in_gm.dat, expected ({count}, 4)", file=str(path))
        )
    left = iter(tuple(row) for row in rows.tolist())
    found = []
    for body in deck.bodies:
        own = tuple(next(left) for _ in (body.discs or body.segments))
        found.append(replace(body, discs=own) if body.discs else replace(body, segments=own))
    return tuple(found)


def _restore(grains: Grains, state: dict[str, Any]) -> None:
    """``grains`` as ``state`` has them, but for controls and records where others were prescribed then."""
    held = grains.held.copy()
    clumps = grains.steering.clumps.held.copy() if grains.steered else None
    if grains.steered:
        own = grains.steering.state(grains.walls)
        then = state.setdefault("steering", own)
        for name in ("given", "watched_load", "watched_from"):
            if own[name].shape != np.shape(then[name]):
                then[name] = own[name]
    radius = grains.discs.radius.copy()
    grains.restore(state)
    if held.shape != grains.held.shape:
        grains.withheld = np.zeros_like(held, float)
    grains.held = held
    if clumps is not None:
        grains.steering.clumps.held[:] = clumps
    if not np.array_equal(radius, grains.discs.radius):
        raise InputError(Fault("thick", problem="is another"))

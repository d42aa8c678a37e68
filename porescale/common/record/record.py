"""The files of one run while it is driven: series, snapshot parts, checkpoint, card.

The checkpoint is the authority.  It holds the model's state, how long series.csv was, and which snapshot
was the last; resuming cuts both back to it.  Rows and snapshots that are there only because the run ended
(not on their schedule) are marked, so that a run extended later is the same as one that was longer from the
start.
"""

import time as clock
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from porescale.common.core.errors import Fault, InputError, PorescaleError, warn
from porescale.common.core.machine import peak_bytes
from porescale.common.record import card as cards
from porescale.common.record import snapshots
from porescale.common.record.check_state import CHECKPOINT
from porescale.common.record.checkpoint import write_checkpoint
from porescale.common.record.cost import Cost
from porescale.common.record.model import Model, tables_of
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card
from porescale.common.record.resume import how_far, take_up
from porescale.common.record.sampler import Sampler
from porescale.common.record.schedule import Schedule
from porescale.common.record.series import NAME as SERIES
from porescale.common.record.series import Series, require_length
from porescale.common.schema.messages import parse_key
from porescale.common.schema.scene_file import holds

MADE_LATER = (
    "final.png", "montage.png", "streamlines.png", "vorticity.png", "stream_function.png", "film.mp4", "film.webm",
    "profile.csv", "lines.csv", "permeability.csv", "packing.csv", "chains.png", "coordination.png", "rose.png",
    "grains_solid_fraction.png", "grains_density.png", "grains_velocity.png", "grains_strain_rate_shear.png",
    "grains_stress_mean.png", "grains_stress_shear.png", "grains_kinetic_stress_mean.png", "chains.vtp", "breaks.csv",
    "energy.dat", "f-d_curve.dat", "rock.png", "output.dat", "cont.dat", "cont2.dat", "velocity_y.dat", "emissions.dat",
    "contacts.png", "numbers.png", "report.html", "pressure.png", "velocity.png", "porosity.png", "mean_stress.png",
    "plastic_strain.png",
)  # fmt: skip
"""What packages make of a finished run: an older run's must not lie beside a new one that makes none."""
TABLES = "tables"
"""Key of a run card: names of the run's further time series, without suffix."""
ABANDONED = (cards.RUNNING, cards.INTERRUPTED, cards.FAILED)
Today = Callable[[Mapping[str, Any]], Mapping[str, Any]]
"""Completes the scene of an older run with the keys that came after it, at what they were before."""
WORTH_KEEPING = 60.0
"""An unfinished run that cost more than this many seconds is not overwritten without the option for it."""


class Gone(PorescaleError):
    """The run folder was moved or removed while the run was writing there: nothing is written in its place."""


class Record:
    """Open files of a run.  Made by :meth:`fresh` or :meth:`resumed`."""

    def __init__(
        self, folder: Path, card: dict[str, Any], keep: int = 0, tables: Mapping[str, int] | None = None
    ) -> None:
        self.folder, self.card = folder, card
        self._place = _identity(folder)
        self.series = Series(folder / SERIES, keep)
        self.scheduled_bytes = keep
        self.table_bytes = dict(tables or {})
        self.tables = {name: Series(_table(folder, name), size) for name, size in self.table_bytes.items()}
        self.row_step = self.snapshot_step = -1
        self.sample_steps: dict[str, int] = {}
        self.scheduled_sample_steps: dict[str, int] = {}
        self.before = float(card["seconds"])
        self.began = clock.perf_counter()
        self.saved = self.began
        self.save_cost = 0.0
        self.cost = Cost()
        self.saved_step: int | None = None
        self.saved_time = 0.0
        self.snapshots = len(snapshots.catalogue(folder))
        self.scheduled_row_step = self.scheduled_snapshot_step = -1

    @classmethod
    def fresh(cls, folder: Path, given: dict[str, Any], *, overwrite: bool = False) -> "Record":
        """Start in ``folder``; an older run there is removed, unless it is unfinished, was dear, and not ``overwrite``.

        Its card goes last: a kill before that leaves a folder that is still recognised as a run's.
        """
        if (folder / CARD).exists():
            if not overwrite:
                _require_replaceable(folder)
            snapshots.clear(folder)
            older = [f"{name}.csv" for name in _tables_of_run(folder)]
            for name in (SERIES, *older, CHECKPOINT, *MADE_LATER, CARD):
                (folder / name).unlink(missing_ok=True)
        card = cards.new_card(given)
        cards.write_card(folder, card)
        return cls(folder, card)

    @classmethod
    def resumed(cls, folder: Path, given: dict[str, Any], model: Model, schedules: dict[str, Schedule]) -> "Record":
        """Go on from the checkpoint: the model, the schedules and the files as they were then.

        InputError, and nothing touched, where checkpoint or rows are not those of such a run.
        """
        card = read_card(folder)
        saved = take_up(folder, model, schedules)
        require_length(folder / SERIES, saved.series_bytes)
        for name, size in saved.table_bytes.items():
            require_length(_table(folder, name), size)
        snapshots.require_all(folder, model.snapshot())
        now = cards.circumstances()
        changed = cards.changed_circumstances(card, now)
        card |= cards.plain(given)
        extra = saved.snapshot_step != saved.last_snapshot_step
        snapshots.trim(folder, model.step - 1 if extra else model.step)
        snapshots.assemble(folder)
        card["seconds"] = saved.reached.seconds
        reached = {"at": cards.now(), "step": model.step, "time": model.time, **now}
        on = {"device": card["device"]} if "device" in card else {}
        card["resumed"] = [*card.get("resumed", []), {**reached, **on}]
        if changed:
            warn(f"resumed with other {', '.join(changed)}: not promised to go on bit for bit")
        card.update(outcome=cards.RUNNING, ended=None)
        card.pop("problem", None)
        cards.write_card(folder, card)
        record = cls(folder, card, saved.series_bytes, saved.table_bytes)
        record.row_step = record.scheduled_row_step = saved.row_step
        record.snapshot_step = record.scheduled_snapshot_step = saved.snapshot_step
        record.sample_steps, record.scheduled_sample_steps = dict(saved.sample_steps), dict(saved.sample_steps)
        record.saved_step, record.saved_time = model.step, model.time
        record.cost = saved.cost
        return record

    def seconds(self) -> float:
        """Wall-clock time spent on this run so far, all sessions together."""
        return self.before + clock.perf_counter() - self.began

    def require_present(self) -> None:
        """Gone unless the folder is the one that the run began to write."""
        if _identity(self.folder) != self._place:
            raise Gone(
                f"{self.folder}: the run folder was moved or removed while the run was writing; the run ends, and what "
                "was saved of it lies where the folder was moved to"
            )

    def row(self, model: Model, *, scheduled: bool) -> None:
        """Append a row of the series and of every table."""
        self.series.append(model.series())
        rows = tables_of(model)
        for name, row in rows.items():
            self._open(name).append(row)
        self.row_step = model.step
        if scheduled:
            self.scheduled_row_step, self.scheduled_bytes = model.step, self.series.length
            self.table_bytes |= {name: self.tables[name].length for name in rows}

    def sample(self, model: Model, sampler: Sampler, *, scheduled: bool) -> None:
        """Append what a sampler gives, if anything, to its table."""
        row, name = sampler.sample(scheduled=scheduled), sampler.name
        if row is not None:
            self._open(name).append(row)
        self.sample_steps[name] = model.step
        if scheduled:
            self.scheduled_sample_steps[name] = model.step
            self.table_bytes |= {name: self.tables[name].length} if name in self.tables else {}

    def _open(self, name: str) -> Series:
        """The table of that name; the card names it before its file is there, so that it is never left over."""
        if name not in self.tables:
            self.card[TABLES] = sorted({*self.card.get(TABLES, []), name})
            cards.write_card(self.folder, self.card)
            self.tables[name] = Series(_table(self.folder, name))
        return self.tables[name]

    def close_series(self) -> None:
        """Sync and close the series and the tables."""
        for series in (self.series, *self.tables.values()):
            series.close()

    def snapshot(self, model: Model, *, scheduled: bool) -> None:
        """Put a snapshot on disk."""
        self.require_present()
        snapshots.write_part(self.folder, model.snapshot())
        self.snapshot_step = model.step
        self.snapshots += 1
        if scheduled:
            self.scheduled_snapshot_step = model.step

    def save(self, model: Model, schedules: dict[str, Schedule]) -> None:
        """Write the checkpoint, whole or not at all."""
        self.require_present()
        start = clock.perf_counter()
        for series in (self.series, *self.tables.values()):
            series.sync()
        content = {
            "step": model.step,
            "time": model.time,
            "seconds": self.seconds(),
            "cost": self.cost.state(),
            "record": {
                "series_bytes": self.scheduled_bytes,
                "table_bytes": self.table_bytes,
                "row_step": self.scheduled_row_step,
                "snapshot_step": self.scheduled_snapshot_step,
                "last_snapshot_step": self.snapshot_step,
                "snapshots": self.snapshots,
                "sample_steps": self.scheduled_sample_steps,
            },
            "schedules": {name: schedule.state() for name, schedule in schedules.items()},
            "state": model.state(),
        }
        write_checkpoint(self.folder / CHECKPOINT, content)
        self.saved = clock.perf_counter()
        self.save_cost = self.saved - start
        self.saved_step, self.saved_time = model.step, model.time

    def last_good(self) -> str:
        """Text that says where the last valid state is stored."""
        if self.saved_step is None:
            return "no good state was saved"
        where = f"step {self.saved_step}, t = {self.saved_time:.6g} s"
        return f"last good state: {self.folder / CHECKPOINT} ({where})"

    def close(self, model: Model, outcome: str, problem: str = "") -> None:
        """Join the parts and write into the card how the run ended."""
        self.close_series()
        self.require_present()
        snapshots.assemble(self.folder)
        self.conclude(model, outcome, problem)

    def conclude(self, model: Model, outcome: str, problem: str = "") -> None:
        """Say in the card how the run ended."""
        self.require_present()
        self.card.update(outcome=outcome, ended=cards.now(), seconds=self.seconds(), step=model.step, time=model.time)
        self.card["core_seconds"] = self.cost.of(model.step)
        self.card["core_seconds_besides"] = self.cost.besides()
        self.card["core_pace"] = self.cost.pace()
        self.card["peak_bytes"] = max(peak_bytes(), int(self.card.get("peak_bytes") or 0))
        if problem:
            self.card["problem"] = problem
        cards.write_card(self.folder, self.card)


def check_changes(folder: Path, given: dict[str, Any], today: Today | None = None) -> None:
    """InputError naming every scene key that must not differ from the run in ``folder``; or whose run that is.

    Keys that came after that run are filled in by ``today`` with values that continue it unchanged.
    """
    old, new = read_card(folder, given.get("package"))["scene"], cards.plain(given).get("scene")
    whole: Any = old
    if today is not None and isinstance(old, Mapping) and cards.changed_keys(old, new):
        whole = cards.plain(today(old))
    faults = []
    for key, (was, now) in cards.changed_keys(whole, new).items():
        problem, way = f"was {was!r}", f"resume with {was!r}, or "
        if was is None:
            problem, way = "was absent", "resume without it, or "
        if key and not holds(old, parse_key(key)):
            problem = "the run was begun by a version without it"
            same = "leave it out" if was is None else f"set it to {was!r}"
            way = "" if whole is old else f"{same} to go on as that did, or "
        value = now if now is not None else "absent"
        faults.append(Fault(key or "scene", value, problem, repair=f"{way}start another run"))
    faults += cards.changed_laws(read_card(folder), cards.plain(given))
    faults += changed_hooks(read_card(folder).get("hooks") or {}, given.get("hooks") or {})
    if faults:
        raise InputError(faults)


def changed_hooks(old: Mapping[str, Any], new: Mapping[str, Any]) -> list[Fault]:
    """What differs between the hooks of two cards, of a run and of what is to go on with it."""
    faults = []
    for name in dict.fromkeys([*old, *new]):
        was, now, repair = old.get(name), new.get(name), f"take it from {CARD}, or start another run"
        if now is None:
            problem, repair = "the run was begun with this hook", "resume it from Python with the hook"
        elif was is None:
            problem, repair = "the run was begun without this hook", "leave it out, or start another run"
        elif was.get("source") != now["source"] or was.get("kind") != now["kind"]:
            problem = "its source is not that with which the run was begun"
        elif was.get("hash") != now["hash"]:
            problem = "a value or function that it uses is not the one with which the run was begun"
        else:
            continue
        faults.append(Fault(f"hook {name}", None, problem, repair=repair))
    return faults


def _identity(folder: Path) -> tuple[int, int] | None:
    """The system's identity of ``folder``, whatever its name; None where there is none."""
    try:
        found = folder.stat()
    except (FileNotFoundError, NotADirectoryError):
        return None
    return found.st_dev, found.st_ino


def _table(folder: Path, name: str) -> Path:
    return folder / f"{name}.csv"


def _tables_of_run(folder: Path) -> list[str]:
    """Names of the tables of the run in ``folder``, as its card has them; none where the card is damaged."""
    try:
        return [str(name) for name in read_card(folder).get(TABLES, []) if Path(str(name)).name == str(name)]
    except InputError:
        return []


def _require_replaceable(folder: Path) -> None:
    """InputError when ``folder`` holds an unfinished run worth keeping."""
    try:
        outcome = read_card(folder).get("outcome")
        reached = how_far(folder)
    except InputError:  # nothing there that could be resumed
        return
    if outcome in ABANDONED and reached.seconds > WORTH_KEEPING:
        problem = f"holds an unfinished run of {reached.seconds:.0f} s, saved at t = {reached.time:.4g} s"
        repair = "resume it (--resume), replace it (--overwrite), or name another folder"
        raise InputError(Fault("run folder", str(folder), problem, repair=repair))

"""Drive a model through time and keep its record.  The loop handles steps, events and files, no physics."""

import time as clock
from collections.abc import Callable, Mapping
from contextlib import ExitStack, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from porescale.common.compiled.turns import TURNS
from porescale.common.core.atomic import clean, folder_in_use, owned
from porescale.common.core.errors import Fault, InputError, Unstable
from porescale.common.duration.expected import FINISHING, RECORDING, STEPS
from porescale.common.duration.quiet import moment, quiet_seconds, share
from porescale.common.duration.threads import Threads
from porescale.common.record import card as cards
from porescale.common.record import snapshots
from porescale.common.record.check_state import CHECKPOINT, check_state
from porescale.common.record.cost import UNCOUNTED
from porescale.common.record.model import Model, variable_step
from porescale.common.record.progress import Watch
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card
from porescale.common.record.record import Gone, Record, Today, check_changes
from porescale.common.record.resume import how_far, require_same_run
from porescale.common.record.sampler import Sampler, samplers_of
from porescale.common.record.schedule import CHECK_EVERY, SLACK, Schedule, block, positive
from porescale.common.record.stop import Interrupted, StopRequest, polite_stop

SAVE_SHARE = 0.02
"""A checkpoint is also written at a snapshot when it costs at most this share of the time since the last."""


@dataclass(frozen=True)
class Outcome:
    """How a run ended: ``outcome`` "finished" or "already finished", and what it took.

    steps_per_second : but for the first blocks, which compile;  phases : seconds of a quiet machine that the steps
    took, rows, snapshots and checkpoints between them, and pictures, film and all else after them.
    """

    folder: Path
    outcome: str
    step: int
    time: float
    seconds: float
    snapshots: int
    steps_per_second: float
    phases: Mapping[str, float] = field(default_factory=dict)


def drive(
    model: Model,
    folder: Path | str,
    duration: float,
    *,
    snapshot_interval: float,
    series_interval: float,
    card: dict[str, Any],
    checkpoint_seconds: float = 300.0,
    resume: bool = False,
    overwrite: bool = False,
    quiet: bool = False,
    after: Callable[[Path], object] | None = None,
    meanwhile: Callable[[Path], object] | None = None,
    today: Today | None = None,
    finish: float = 0.0,
) -> Outcome:
    """Advance ``model`` to ``duration`` (s) and write the run folder.

    Rows and snapshots are made at time 0, at multiples of their intervals (s; ``math.inf``: only first and
    last) and at the end.  With a fixed step, times are rounded to whole steps.  Output never changes the
    steps. checkpoint_seconds : wall clock;  card : {"scene": full scene as dict, "seeds": ...} for card.json;
    after : called with the folder once all data are in place (pictures, film);  finish : seconds that it is expected to
    take;  meanwhile : called with the folder whenever a snapshot is on disk.

    resume : go on from the checkpoint, bit for bit as the uninterrupted run; without a checkpoint it starts
    from the beginning, and a finished run is left alone.  The scene must be the same but for the keys
    `card.FREE`: the duration may grow, intervals may change (they count from time 0).  Keys that came after the run are
    the same where they do nothing that it did not do, by ``today``.  Other sources or versions than the run had
    are warned of on stderr.

    overwrite : replace the run in the folder even if it is unfinished and took long (without: InputError); a
    finished one is replaced anyway, and files that no run makes are left alone.

    Raises InputError (wrong numbers, folder in use, changed scene, damaged checkpoint), Interrupted (after
    SIGINT or SIGTERM, checkpoint written), Unstable (from the model; the last good checkpoint stays and is
    named), Gone (the folder vanished).
    """
    folder = Path(folder)
    positive("duration", duration)
    step_seconds = None if variable_step(model) else positive("step", model.step_seconds)
    schedules = {
        "series": Schedule(positive("series_interval", series_interval, endless=True), step_seconds),
        "snapshots": Schedule(positive("snapshot_interval", snapshot_interval, endless=True), step_seconds),
    }
    samplers = samplers_of(model)
    for sampler in samplers:
        sampler.restart()
        schedules[f"every {sampler.name}"] = sampler.schedule
    with ExitStack() as until_stepped:
        stop = until_stepped.enter_context(polite_stop())  # a stop waits until the folder holds a state to go on from
        folder.mkdir(parents=True, exist_ok=True)
        with owned(folder) as held:
            if not held:
                raise folder_in_use(folder)
            clean(folder)
            run = _Run(model, duration, step_seconds, schedules, samplers, checkpoint_seconds, meanwhile)
            name = str(card.get("name") or folder.name)
            resume = resume and (folder / CHECKPOINT).exists() and (folder / CARD).exists()
            if resume:
                check_changes(folder, card, today)
                done = _already(folder, run)
                if done is not None:
                    text = f"{folder}: finished at t = {done.time:.6g} s, nothing to do"
                    Watch(name, 0, duration, quiet=quiet).say(text)
                    return done
                record = Record.resumed(folder, card, model, schedules)
            else:
                record = Record.fresh(folder, card, overwrite=overwrite)
            with Watch(name, model.time, duration, quiet=quiet, finish=finish) as watch:
                return _watched(run, record, watch, (stop, until_stepped), after)


def check_resume(folder: Path, card: dict[str, Any], today: Today | None = None) -> None:
    """InputError where the run in ``folder`` cannot be gone on with, with the ``card`` of this run (as of `drive`).

    What can be checked without a model, which may take long to build: whether it is this scene's, and whether its
    checkpoint is one and valid.  Nothing where there is no checkpoint yet.
    """
    if (folder / CHECKPOINT).exists() and (folder / CARD).exists():
        check_changes(folder, card, today)
        check_state(folder)


@dataclass
class _Run:
    """Model, duration (s), schedules and samplers that the loop over steps works with."""

    model: Model
    duration: float
    step_seconds: float | None
    schedules: dict[str, Schedule]
    samplers: list[Sampler]
    checkpoint_seconds: float
    meanwhile: Callable[[Path], object] | None = None

    def ended(self, step: int, time: float) -> bool:
        """Whether the run is over at this step."""
        if self.step_seconds is None:
            return time >= self.duration * (1 - SLACK)
        return step >= self.last_step

    @property
    def last_step(self) -> int:
        """The step nearest to the duration; fixed step only."""
        assert self.step_seconds is not None
        return max(1, round(self.duration / self.step_seconds))


def _watched(
    run: _Run,
    record: Record,
    watch: Watch,
    stopping: tuple[StopRequest, ExitStack],
    after: Callable[[Path], object] | None,
) -> Outcome:
    """The loop, and how it may end; stopping : the request, and what ends waiting for it once all steps are done."""
    model, began = run.model, moment()
    stop, until_stepped = stopping
    try:
        with until_stepped, Threads() as threads:
            spent = _loop(run, record, stop, watch, threads)
        stepped = moment()
        watch.enter("joining snapshots")
        record.close(model, cards.RUNNING)
        if after is not None:
            watch.enter("writing pictures and film")
            after(record.folder)
        record.conclude(model, cards.FINISHED)
    except Interrupted as error:
        record.close(model, cards.INTERRUPTED, str(error))
        raise
    except Unstable as error:
        error.args = (f"{error}; {record.last_good()}",)
        record.close(model, cards.UNSTABLE, str(error))
        raise
    except BaseException as error:
        with suppress(OSError, Gone):
            record.close_series()
            stopped = isinstance(error, KeyboardInterrupt)
            outcome = cards.INTERRUPTED if stopped else cards.FAILED
            notes = getattr(error, "__notes__", [])  # which function of the user's raised it
            record.conclude(model, outcome, "; ".join([f"{type(error).__name__}: {error}", *notes]))
            if notes:
                error.add_note(record.last_good())
        raise
    seconds, count = record.seconds(), record.snapshots
    steps = (spent.seconds - spent.compiling) * share(began, stepped)
    phases = {STEPS: steps, RECORDING: quiet_seconds(began, stepped) - steps,
              FINISHING: quiet_seconds(stepped, moment())}  # fmt: skip
    return Outcome(record.folder, cards.FINISHED, model.step, model.time, seconds, count, spent.speed(), phases)


@dataclass
class _Spent:
    """Steps and wall-clock seconds of this session, and of its first blocks, which compile kernels.

    compiling : seconds of compiling in the steps.
    """

    steps: int = 0
    seconds: float = 0.0
    blocks: int = 0
    compiling: float = 0.0
    early: tuple[int, float] = (0, 0.0)

    def block(self, steps: int, seconds: float) -> None:
        """Count a block of steps."""
        self.steps, self.seconds, self.blocks = self.steps + steps, self.seconds + seconds, self.blocks + 1
        if self.blocks == UNCOUNTED:
            self.early = self.steps, self.seconds

    def speed(self) -> float:
        """Steps a second but for the first blocks, or of all where there are no others; 0 where there are none."""
        steps, seconds = self.steps - self.early[0], self.seconds - self.early[1]
        if not steps:
            steps, seconds = self.steps, self.seconds
        return steps / seconds if seconds > 0 else 0.0


def _loop(run: _Run, record: Record, stop: StopRequest, watch: Watch, threads: Threads) -> _Spent:
    """Advance to the end, on as many ``threads`` as pay; returns what was spent in the model's steps."""
    model, rate, spent = run.model, 0.0, _Spent()
    if record.saved_step is None:
        model.check()
        _record_due(run, record)
        record.save(model, run.schedules)
    while not run.ended(model.step, model.time):
        if stop:
            if record.saved_step != model.step:
                model.check()
                record.save(model, run.schedules)
            raise Interrupted(
                f"interrupted at step {model.step} (t = {model.time:.6g} s); state saved in "
                f"{record.folder / CHECKPOINT}, resume to continue"
            )
        busy, before, compiled = clock.process_time(), model.step, TURNS.seconds
        last = None if run.step_seconds is None else run.last_step
        wall = threads.advance(model, block(model, last, run.schedules.values(), rate))
        assert model.step > before, "advance() must count its steps"
        assert run.step_seconds in (None, model.step_seconds), "a varying step needs variable_step = True"
        record.cost.block(model.step - before, clock.process_time() - busy)
        rate = (model.step - before) / max(wall, 1e-9)
        spent.block(model.step - before, wall)
        spent.compiling += TURNS.seconds - compiled
        watch.update(model.step, model.time)
        _after_block(run, record)
    model.check()
    if record.row_step != model.step:
        record.row(model, scheduled=False)
    if record.snapshot_step != model.step:
        record.snapshot(model, scheduled=False)
    for sampler in run.samplers:
        if record.sample_steps.get(sampler.name) != model.step:
            record.sample(model, sampler, scheduled=False)
    record.save(model, run.schedules)
    return spent


def _after_block(run: _Run, record: Record) -> None:
    """Check, record and save what is due at this step."""
    model = run.model
    if model.step % CHECK_EVERY == 0:
        model.check()
    pictured = _record_due(run, record)
    since = clock.perf_counter() - record.saved
    if since >= run.checkpoint_seconds or (pictured and record.save_cost <= SAVE_SHARE * since):
        model.check()
        record.save(model, run.schedules)


def _record_due(run: _Run, record: Record) -> bool:
    """Row, samples and snapshot where their schedules have an event; returns whether there was a snapshot."""
    model = run.model
    row = run.schedules["series"].due(model.step, model.time)
    snapshot = run.schedules["snapshots"].due(model.step, model.time)
    due = [it for it in run.samplers if it.schedule.due(model.step, model.time)]
    if row or snapshot or due:
        model.check()
    if row:
        record.row(model, scheduled=True)
    for sampler in due:
        record.sample(model, sampler, scheduled=True)
    if snapshot:
        record.snapshot(model, scheduled=True)
        if run.meanwhile is not None:
            run.meanwhile(record.folder)
    return snapshot


def _already(folder: Path, run: _Run) -> Outcome | None:
    """The outcome of a finished run; InputError when it is unfinished but beyond ``duration``."""
    reached = how_far(folder)
    step, time = reached.step, reached.time
    if not run.ended(step, time):
        return None
    card = read_card(folder)
    if card.get("outcome") == cards.FINISHED:
        require_same_run(folder, reached, card)
        count = len(snapshots.catalogue(folder))
        return Outcome(folder, "already finished", step, time, reached.seconds, count, 0.0)
    if run.step_seconds is not None and step > run.last_step:
        problem = f"the run is already at t = {time:.6g} s"
        raise InputError(Fault("duration", run.duration, problem, unit="s", repair="name a later end"))
    return None

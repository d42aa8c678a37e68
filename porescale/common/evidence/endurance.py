"""Endurance: quantities that must not drift in a very long run of a small system, read from mark to mark, with memory.

Packages register systems; `study endurance` runs it, a million steps by default, and writes a table and a picture.
Quantities are taken as they are at marks, equal numbers of steps apart; each has a largest distance from its value at
the first mark that counts, and a reason for it.  The peak of the process's memory must not grow from there on, either,
and nothing must be found wrong: that is checked as often as in a run.

A flow may go on in another process: it is kept in a file of its own now and then, and then ends with the same numbers.
Seconds add up, and so does what the peak of memory grew by in each process, from its first mark on.
"""

import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Protocol

from porescale.common.core.errors import Fault, InputError, Unstable
from porescale.common.core.machine import peak_bytes
from porescale.common.evidence import files
from porescale.common.evidence.register import Register
from porescale.common.record.check_state import other
from porescale.common.record.checkpoint import read_checkpoint, write_checkpoint
from porescale.common.record.schedule import CHECK_EVERY

NAME = "endurance"
MARKS = 20
MEMORY = "peak memory (MiB)"
GROWTH = 1.0
"""MiB by which the peak may grow: the interpreter's own memory; a leak of a byte a step is as much in a million."""
FOUND = "found wrong ()"
FEWEST = MARKS * CHECK_EVERY
"""Steps of a flow at least: from the first mark on, a check is behind it, and all memory that one takes."""
KEEP_EVERY = 30.0
"""Seconds after which an unfinished flow is kept again: what a killed process loses at most."""


class Lasting(Protocol):
    """A system that can be advanced and checked, as long as the study runs."""

    def advance(self, steps: int) -> None:
        """Advance by ``steps`` steps."""

    def check(self) -> None:
        """Raise Unstable where the state is not finite or out of bounds."""

    def read(self) -> Mapping[str, float]:
        """The monitored quantities, by name with unit."""

    def state(self) -> dict[str, Any]:
        """All it takes to go on bit for bit."""

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from a ``state`` of a system of the same start."""


@dataclass(frozen=True)
class Held:
    """A quantity that must hold.  allowed : largest distance from its first value that counts, over ``steps`` steps."""

    name: str
    allowed: Callable[[int], float]
    because: str


@dataclass(frozen=True)
class Endurance:
    """What lasts.  start : makes it;  settles : marks before the first that counts;  share : of the requested steps
    that it does, where they are dear;  before : steps before all marks, in which the start comes to rest;  least :
    requested steps at least: with fewer what ``settles`` has not come to rest at the mark from which on it must."""

    name: str
    title: str
    start: Callable[[], Lasting]
    held: tuple[Held, ...]
    settles: int = 1
    share: float = 1.0
    before: int = 0
    least: int = FEWEST

    def steps(self, requested: int) -> int:
        """Number of steps out of ``requested`` ones that this row does."""
        return max(MARKS, round(self.share * requested))


@dataclass(frozen=True)
class Line:
    """A quantity over a run; the fields are the JSON keys.  at : steps;  values : at these marks;  off : largest
    distance from the first value that counts;  allowed, because : see Held;  holds : whether off is within."""

    flow: str
    quantity: str
    steps: int
    at: list[int]
    values: list[float]
    off: float
    allowed: float
    because: str
    holds: bool
    seconds: float


Say = Callable[[str], object]


@dataclass
class Noted:
    """What was seen of a flow so far.  done : steps, from -``before`` on;  wrong : how often a check found something;
    seen : values at the marks so far, by quantity;  seconds : of earlier processes."""

    done: int
    wrong: int
    seen: dict[str, list[float]]
    seconds: float

    def note(self, values: Mapping[str, float], peak: float, last: float | None) -> None:
        """Add the values at a mark, with what was found wrong and memory by then.

        peak, last : MiB of this process now and at its mark before, None at its first
        """
        memory = self.seen.get(MEMORY, [peak])[-1] + (0.0 if last is None else peak - last)
        for name, value in {**values, FOUND: self.wrong, MEMORY: memory}.items():
            self.seen.setdefault(name, []).append(float(value))


def endure(it: Endurance, steps: int, say: Say = lambda text: None, kept: Path | None = None) -> list[Line]:
    """Run it for ``steps`` steps, or its share: lines of each quantity, of what was found wrong, and of memory.

    kept : the file in which it is kept every KEEP_EVERY seconds, and gone on from if there is one of as many steps.
    InputError where that is damaged.
    """
    steps = it.steps(steps)
    run, noted, begun = it.start(), Noted(-it.before, 0, {}, 0.0), time.perf_counter()
    marks = [steps * mark // MARKS for mark in range(MARKS + 1)]
    if kept is not None:
        noted = _taken_up(kept, steps, run, noted)
        say(f"{it.name}: begins at step {noted.done} of {steps}")

    def seconds() -> float:
        """Seconds of all processes, as they are written."""
        return round(noted.seconds + time.perf_counter() - begun, 3)

    saved, last = begun, None
    for mark in range(len(noted.seen.get(FOUND, [])), MARKS + 1):
        while noted.done < marks[mark]:
            noted.done += _block(run, noted, min(CHECK_EVERY, marks[mark] - noted.done), say)
            # Not at a mark: a process that goes on has advanced by its first one, and loaded what it needs.
            due = noted.done < marks[mark] and time.perf_counter() - saved > KEEP_EVERY
            if kept is not None and due:
                _keep(kept, steps, run, replace(noted, seconds=seconds()))
                saved = time.perf_counter()
        peak = peak_bytes() / 2**20
        noted.note(run.read(), peak, last)
        last = peak
        if mark:
            left = seconds() / mark * (MARKS - mark)
            say(f"{it.name}: {noted.done} of {steps} steps, about {left:.0f} s left")

    def line(name: str, allowed: float, because: str, first: int = it.settles) -> Line:
        """The verdict on one quantity: how far its values leave the first that counts, against ``allowed``."""
        values = noted.seen[name]
        off = max(abs(value - values[first]) for value in values[first:])
        return Line(it.name, name, steps, marks, values, off, allowed, because, off <= allowed, seconds())

    # Before the first mark kernels are compiled or loaded: memory counts from there.
    return [
        *(line(each.name, each.allowed(steps), each.because) for each in it.held),
        line(FOUND, 0.0, f"all is well, asked every {CHECK_EVERY} steps", 0),
        line(MEMORY, GROWTH, "nothing is kept from step to step", max(1, it.settles)),
    ]


def _block(run: Lasting, noted: Noted, steps: int, say: Say) -> int:
    """So many steps and a check; their number."""
    run.advance(steps)
    try:
        run.check()
    except Unstable as error:
        noted.wrong += 1
        say(str(error))
    return steps


def _keep(kept: Path, steps: int, run: Lasting, noted: Noted) -> None:
    """Write all it takes to go on, whole or not at all."""
    write_checkpoint(kept, {"steps": steps, "noted": asdict(noted), "state": run.state()})


def _taken_up(kept: Path, steps: int, run: Lasting, start: Noted) -> Noted:
    """What was noted of the flow in a file, which ``run`` goes on from; what is there of other steps begins anew.

    Every process writes and reads it first, so that its memory holds from the start what that takes.
    """
    if not kept.exists() or read_checkpoint(kept, skip="state").get("steps") != steps:
        _keep(kept, steps, run, start)
    content = read_checkpoint(kept)
    if wrong := other(run.state(), content["state"]):
        repair = "remove the file, and the flow begins anew"
        raise InputError(Fault("unfinished flow", str(kept), f"does not fit this version ({wrong})", repair=repair))
    run.restore(content["state"])
    noted = Noted(**content["noted"])
    _keep(kept, steps, run, noted)
    return noted


class Endurances(Register[Endurance]):
    """Register of the systems that `study endurance` runs."""

    what = "flow"


def kept_file(folder: Path, it: Endurance) -> Path:
    """Where a flow is kept until it has finished."""
    return folder / f"{it.name.replace(' ', '_')}.h5"


def write(folder: Path, about: Mapping[str, Any], lines: Sequence[Line]) -> None:
    """endurance.json, .md and .png into ``folder``, each whole or not at all.  about : command, machine, date."""
    files.write_study(
        folder,
        NAME,
        json=files.json_text([asdict(line) for line in lines], about, "lines"),
        md=markdown(str(about.get("command", "")), lines),
        png=picture(lines),
    )


def finished(folder: Path) -> dict[str, list[Line]]:
    """Lines of the flows that an earlier call finished in ``folder``, by flow; {} where there are none."""
    try:
        lines = [Line(**row) for row in json.loads((folder / f"{NAME}.json").read_bytes())["lines"]]
    except (OSError, ValueError, KeyError, TypeError):
        return {}
    return {flow: [line for line in lines if line.flow == flow] for flow in dict.fromkeys(it.flow for it in lines)}


def markdown(command: str, lines: Sequence[Line]) -> str:
    """The table of quantities, in bold where one does not hold."""
    header = ("flow", "steps", "quantity", "first, last", "largest change", "allowed", "because", "seconds")
    rows = []
    for line in lines:
        off = f"{line.off:.3g}" if line.holds else f"**{line.off:.3g}**"
        ends = f"{line.values[1]:.6g}, {line.values[-1]:.6g}"
        because, seconds = line.because, f"{line.seconds:.0f}"
        rows.append((line.flow, line.steps, line.quantity, ends, off, f"{line.allowed:.3g}", because, seconds))
    top = ["# Long runs", "", f"Written by `{command}`.", "", f"![marks]({NAME}.png)", ""]
    return "\n".join([*top, *files.markdown_table(header, rows)]) + "\n"


def picture(lines: Sequence[Line]) -> bytes:
    """A small plot for each quantity of each flow, its values over steps: a PNG."""
    flows = list(dict.fromkeys(line.flow for line in lines))
    widest = max(sum(line.flow == flow for line in lines) for flow in flows)
    figure = files.new_figure(3.0 * widest, 2.2 * len(flows))
    grid = figure.subplots(len(flows), widest, squeeze=False)
    for row, flow in zip(grid, flows, strict=True):
        mine = [line for line in lines if line.flow == flow]
        for axes, line in zip(row, mine, strict=False):
            axes.plot(line.at, line.values, "o-", markersize=2.5, linewidth=0.8, color="C0" if line.holds else "C3")
            axes.set_title(f"{flow}: {line.quantity}", fontsize=7)
            axes.tick_params(labelsize=6)
            for axis in (axes.xaxis, axes.yaxis):
                axis.get_offset_text().set_fontsize(6)
        for axes in row[len(mine) :]:
            axes.set_axis_off()
    return files.png(figure, 110)

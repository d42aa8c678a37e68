"""Endurance: quantities that must not drift in a very long run of a small system, read from mark to mark, with memory.

Packages register systems; `study endurance` runs it, a million steps by default, and writes a table and a picture.
Quantities are taken as they are at marks, equal numbers of steps apart; each has a largest distance from its value at
the first mark that counts, and a reason for it.  The peak of the process's memory must not grow from there on, either,
and nothing must be found wrong: that is checked as often as in a run.
"""

import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Protocol

from porescale.common.core.errors import Unstable
from porescale.common.core.machine import peak_bytes
from porescale.common.evidence import files
from porescale.common.evidence.register import Register

NAME = "endurance"
MARKS = 20
MEMORY = "peak memory (MiB)"
GROWTH = 1.0
"""MiB by which the peak may grow: the interpreter's own memory; a leak of a byte a step is as much in a million."""
FOUND = "found wrong ()"
CHECK_EVERY = 100
"""Steps between checks of the state, as in a run."""


class Lasting(Protocol):
    """A system that can be advanced and checked, as long as the study runs."""

    def advance(self, steps: int) -> None:
        """Advance by ``steps`` steps."""

    def check(self) -> None:
        """Raise Unstable where the state is not finite or out of bounds."""

    def read(self) -> Mapping[str, float]:
        """The monitored quantities, by name with unit."""


@dataclass(frozen=True)
class Held:
    """A quantity that must hold.  allowed : largest distance from its first value that counts, over ``steps`` steps."""

    name: str
    allowed: Callable[[int], float]
    because: str


@dataclass(frozen=True)
class Endurance:
    """What lasts.  start : makes it;  settles : marks before the first that counts;  share : of the requested steps
    that it does, where they are dear;  before : steps before all marks, in which the start comes to rest."""

    name: str
    title: str
    start: Callable[[], Lasting]
    held: tuple[Held, ...]
    settles: int = 1
    share: float = 1.0
    before: int = 0

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


def endure(it: Endurance, steps: int, say: Say = lambda text: None) -> list[Line]:
    """Run it for ``steps`` steps, or its share: lines of each quantity, of what was found wrong, and of memory."""
    steps = it.steps(steps)
    run, at, begun = it.start(), [0], time.perf_counter()
    wrong = _advance(run, it.before, say)
    seen: dict[str, list[float]] = {name: [float(value)] for name, value in run.read().items()}
    memory, found = [peak_bytes() / 2**20], [float(wrong)]
    for mark in range(1, MARKS + 1):
        to = steps * mark // MARKS
        found.append(found[-1] + _advance(run, to - at[-1], say))
        at.append(to)
        for name, value in run.read().items():
            seen[name].append(float(value))
        memory.append(peak_bytes() / 2**20)
        spent = time.perf_counter() - begun
        say(f"{it.name}: {to} of {steps} steps, about {spent / mark * (MARKS - mark):.0f} s left")
    seconds = time.perf_counter() - begun

    def line(name: str, values: list[float], allowed: float, because: str, first: int = it.settles) -> Line:
        """The verdict on one quantity: how far its values leave the first that counts, against ``allowed``."""
        counted = values[first:]
        off = max(abs(value - counted[0]) for value in counted)
        return Line(it.name, name, steps, at, values, off, allowed, because, off <= allowed, round(seconds, 3))

    # Before the first mark kernels are compiled or loaded: memory counts from there.
    lines = [line(each.name, seen[each.name], each.allowed(steps), each.because) for each in it.held]
    return [
        *lines,
        line(FOUND, found, 0.0, f"all is well, asked every {CHECK_EVERY} steps", 0),
        line(MEMORY, memory, GROWTH, "nothing is kept from step to step", max(1, it.settles)),
    ]


def _advance(run: Lasting, steps: int, say: Say) -> int:
    """So many steps; how often something was found wrong."""
    wrong = 0
    for done in range(0, steps, CHECK_EVERY):
        run.advance(min(CHECK_EVERY, steps - done))
        try:
            run.check()
        except Unstable as error:
            wrong += 1
            say(str(error))
    return wrong


class Endurances(Register[Endurance]):
    """Register of the systems that `study endurance` runs."""

    what = "flow"


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

"""Extremes: what a simulator may be asked for, from mild to absurd, and how each ends, as a table and a picture.

Rooms register what they try; `study extremes` runs it.  A try is refused before the start (InputError), stopped with
the place, the criterion and the reason (Unstable), or stable: it came to its end in sense.  Where a number is known it
is judged as well, and right when that holds.  Any other end is a fault of ours and is not caught.
"""

from __future__ import annotations

import io
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from porescale.common.cli.folders import write_whole
from porescale.common.core.errors import InputError, Unstable
from porescale.common.evidence import stability as study
from porescale.common.evidence import stability_files as study_files
from porescale.common.evidence.select import choose

NAME = "extremes"
RIGHT, STABLE, REFUSED, STOPPED = "right", "stable", "refused", "stopped"
COLOURS = {
    RIGHT: study_files.COLOURS[study.RIGHT],
    STABLE: study_files.COLOURS[study.STABLE],
    REFUSED: "#bdbdbd",
    STOPPED: study_files.COLOURS[study.UNSTABLE],
}
"""Those of the map of stability, and one for what never starts."""


@dataclass(frozen=True)
class Judged:
    """What there is to say of a try whose result is known: text, and whether it is right."""

    said: str
    right: bool


@dataclass(frozen=True)
class Extreme:
    """One try.  axis : what is varied;  value : how far, as text;  run : does it, returns what there is to say of it,
    raises InputError or Unstable."""

    axis: str
    value: str
    run: Callable[[], str | Judged]

    def tried(self) -> Row:
        """How it ended."""
        start = time.perf_counter()
        try:
            came = self.run()
            end, said = (STABLE, came) if isinstance(came, str) else (RIGHT if came.right else STABLE, came.said)
        except InputError as refusal:
            end, said = REFUSED, str(refusal)
        except Unstable as stop:
            end, said = STOPPED, str(stop)
        return Row(self.axis, self.value, end, " ".join(said.splitlines()), time.perf_counter() - start)


@dataclass(frozen=True)
class Row:
    """One try; the fields are the JSON keys."""

    axis: str
    value: str
    end: str
    said: str
    seconds: float


class Extremes:
    """What a package tries, axis after axis."""

    def __init__(self, tries: Sequence[Extreme]) -> None:
        self._tries = tuple(tries)

    def axes(self) -> list[str]:
        """Names of what is varied, in order."""
        return list(dict.fromkeys(it.axis for it in self._tries))

    def chosen(self, names: Sequence[str]) -> list[Extreme]:
        """Tries of the axes of these names, all if none is given; InputError for a name that there is not."""
        axes = choose(names, self.axes(), "axis")
        return [it for it in self._tries if it.axis in axes]


def write(folder: Path, command: str, rows: Sequence[Row]) -> None:
    """extremes.json, .md and .png into ``folder``, which is made if it is not there; each whole or not at all."""
    folder.mkdir(parents=True, exist_ok=True)
    made = [{**asdict(row), "seconds": round(row.seconds, 3)} for row in rows]
    write_whole(folder / f"{NAME}.json", (json.dumps(made, indent=1, allow_nan=False) + "\n").encode())
    write_whole(folder / f"{NAME}.md", markdown(command, rows).encode())
    write_whole(folder / f"{NAME}.png", picture(rows))


def markdown(command: str, rows: Sequence[Row]) -> str:
    """The table."""
    lines = [
        f"Written by `{command}`.  *Stable*: it came to its end in sense;  *right*: and a known number holds.",
        "",
        "| what | how far | end | said |",
        "|---|---|---|---|",
    ]
    lines += [f"| {row.axis} | {row.value} | **{row.end}** | {row.said} |" for row in rows]
    return "\n".join(lines) + "\n"


def picture(rows: Sequence[Row]) -> bytes:
    """A line of squares for each axis, coloured by how the try ended: a PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    axes = list(dict.fromkeys(row.axis for row in rows))
    widest = max(sum(row.axis == axis for row in rows) for axis in axes)
    figure = Figure(figsize=(2.4 + 1.15 * widest, 0.9 + 0.55 * len(axes)), layout="constrained")
    FigureCanvasAgg(figure)
    plot = figure.add_subplot()
    for line, axis in enumerate(axes):
        for place, row in enumerate(row for row in rows if row.axis == axis):
            plot.barh(line, 0.96, left=place, height=0.9, color=COLOURS[row.end])
            ink = "black" if row.end in (STABLE, REFUSED) else "white"
            plot.text(place + 0.48, line, row.value, ha="center", va="center", color=ink, fontsize=7)
    plot.set_yticks(range(len(axes)), axes)
    plot.set_xticks([])
    plot.invert_yaxis()
    plot.spines[:].set_visible(False)
    marks = [Patch(color=colour, label=end) for end, colour in COLOURS.items()]
    figure.legend(handles=marks, ncols=len(marks), loc="outside upper center", frameon=False)
    written = io.BytesIO()
    figure.savefig(written, format="png", dpi=130)
    return written.getvalue()

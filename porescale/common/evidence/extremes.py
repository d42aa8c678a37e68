"""Extremes: a simulator tried with mild to extreme input, and how each run ends, as a table and a picture.

Packages register their tries; `study extremes` runs it.  A try is refused before the start (InputError), stopped with
the place, the criterion and the reason (Unstable), or stable: it ended within bounds.  Where a number is known it
is compared as well, and right when that holds.  Any other end is a bug and is not caught.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from porescale.common.core.errors import InputError, Unstable
from porescale.common.evidence import files, stability, stability_files
from porescale.common.evidence.register import Register

NAME = "extremes"
RIGHT, STABLE, REFUSED, STOPPED = "right", "stable", "refused", "stopped"
COLOURS = {
    RIGHT: stability_files.COLOURS[stability.RIGHT],
    STABLE: stability_files.COLOURS[stability.STABLE],
    REFUSED: "#bdbdbd",
    STOPPED: stability_files.COLOURS[stability.UNSTABLE],
}
"""Those of the map of stability, and one for what never starts."""


@dataclass(frozen=True)
class Verdict:
    """The result of a try with a reference value: text, and whether it is right."""

    said: str
    right: bool


@dataclass(frozen=True)
class Extreme:
    """One try.  axis : what is varied;  value : how far, as text;  run : does it, returns its result in words,
    raises InputError or Unstable."""

    axis: str
    value: str
    run: Callable[[], str | Verdict]

    @property
    def name(self) -> str:
        """What it is chosen by: the axis stands for all of its tries."""
        return f"{self.axis}.{self.value}"

    def tried(self) -> "Row":
        """Run it, and give how it ended."""
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


class Extremes(Register[Extreme]):
    """Register of the tries of `study extremes`, axis after axis."""

    what = "axis"


def write(folder: Path, command: str, rows: Sequence[Row]) -> None:
    """extremes.json, .md and .png into ``folder``, which is made if it is not there; each whole or not at all."""
    lines = files.json_text({**asdict(row), "seconds": round(row.seconds, 3)} for row in rows)
    files.write_study(folder, NAME, json=lines, md=markdown(command, rows), png=picture(rows))


def markdown(command: str, rows: Sequence[Row]) -> str:
    """The table of all tries, one a row."""
    said = f"Written by `{command}`.  *Stable*: it came to its end in sense;  *right*: and a known number holds."
    cells = [(row.axis, row.value, f"**{row.end}**", row.said) for row in rows]
    table = files.markdown_table(("what", "how far", "end", "said"), cells)
    return "\n".join(["# Extremes", "", said, "", *table]) + "\n"


def picture(rows: Sequence[Row]) -> bytes:
    """A line of squares for each axis, coloured by how the try ended: a PNG."""
    from matplotlib.patches import Patch

    axes = list(dict.fromkeys(row.axis for row in rows))
    widest = max(sum(row.axis == axis for row in rows) for axis in axes)
    figure = files.new_figure(2.4 + 1.15 * widest, 0.9 + 0.55 * len(axes))
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
    return files.png(figure, 130)

"""What each kind of scene builds and costs: parts, bytes, and its time beside the smallest thing that does the same.

Packages keep those smallest kernels (minimal_*.py) and register kinds; `study parts` times each kind and what it is
held against in turns, so that a busy machine slows both alike, and writes a table.  Times are those of the one thread,
which stand still while others have the core.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from porescale.common.evidence import files
from porescale.common.evidence.register import Register
from porescale.common.evidence.timing import core_seconds_of

NAME = "parts"
DEARER = 1.05
"""Largest ratio to the smallest kernel that counts as no overhead."""
PACKAGES = ("porescale", "continuum_sph")
SMALLEST = "smallest kernel"

Steps = Callable[[int], object]


@dataclass(frozen=True)
class BuiltScene:
    """A kind of scene, made.

    model : whose arrays are counted;  parts : names of sections that are built;  count : of ``item``s;  steps : does so
    many;  other : does as many of what it is held against.
    """

    model: Any
    parts: Sequence[str]
    count: int
    steps: Steps
    other: Steps


@dataclass(frozen=True)
class SceneKind:
    """A kind of scene.  item : "cell", "grain" or "particle";  beside : what it is held against, `SMALLEST`, or another
    kind that lacks a part;  because : what a larger ratio than `DEARER` is due to."""

    name: str
    item: str
    beside: str
    make: Callable[[], BuiltScene]
    steps: int = 50
    because: str = ""


@dataclass(frozen=True)
class Row:
    """A measured kind; the fields are the JSON keys.  bytes : per item;  seconds, other_seconds : of a step, the
    least over rounds in turns;  ratio : of them."""

    name: str
    built: list[str]
    item: str
    count: int
    bytes: float
    seconds: float
    beside: str
    other_seconds: float
    ratio: float
    because: str

    @property
    def lean(self) -> bool:
        """Whether it is at most 5 % dearer than the smallest kernel; True of what is held against another kind."""
        return self.beside != SMALLEST or self.ratio <= DEARER


def measure(kind: SceneKind, rounds: int = 15) -> Row:
    """Build and time a kind: the least over rounds, since others on the machine only ever make a call slower.

    Bytes are those before the rounds, whose number of steps is not the same in each run: pairs may be listed anew.
    """
    made = kind.make()
    size = bytes_of(made.model)
    calls = (lambda: made.other(kind.steps)), (lambda: made.steps(kind.steps))
    least = [float("inf"), float("inf")]
    for turn in range(-1, rounds):  # the first to warm up
        for at in (0, 1) if turn % 2 else (1, 0):
            seconds = core_seconds_of(calls[at])
            least[at] = min(least[at], seconds) if turn >= 0 else least[at]
    other, own = (seconds / kind.steps for seconds in least)
    return Row(
        kind.name, list(made.parts), kind.item, made.count, size / made.count, own, kind.beside, other,
        own / other, kind.because,
    )  # fmt: skip


def bytes_of(model: Any) -> int:
    """Bytes of all arrays that a model keeps, each memory counted once."""
    seen: set[int] = set()
    arrays: dict[int, int] = {}
    stack = [model]
    while stack:
        it = stack.pop()
        if id(it) in seen:
            continue
        seen.add(id(it))
        if isinstance(it, np.ndarray):
            base = it
            while isinstance(base.base, np.ndarray):
                base = base.base
            arrays[id(base)] = base.nbytes
        elif isinstance(it, Mapping):
            stack += it.values()
        elif isinstance(it, list | tuple):
            stack += it
        elif type(it).__module__.partition(".")[0] in PACKAGES and hasattr(it, "__dict__"):
            stack += vars(it).values()
    return sum(arrays.values())


class SceneKinds(Register[SceneKind]):
    """The kinds of scenes that a package measures."""

    what = "kind"


def write(folder: Path, about: Mapping[str, Any], rows: Sequence[Row]) -> None:
    """parts.json, .md and .png into ``folder``, each whole or not at all.  about : command, machine, date."""
    files.write_study(
        folder, NAME, json=files.json_text(map(asdict, rows), about), md=markdown(about, rows), png=picture(rows)
    )


def picture(rows: Sequence[Row]) -> bytes:
    """A line for each kind as a PNG: its time over that of what it is held against."""
    figure = files.new_figure(9.0, 1.2 + 0.22 * len(rows))
    axes = figure.subplots()
    looks = ((True, "o", "#0072B2", "beside the smallest kernel"), (False, "s", "#E69F00", "beside a scene without it"))
    for smallest, marker, colour, label in looks:
        mine = [(row.ratio, at) for at, row in enumerate(rows) if (row.beside == SMALLEST) is smallest]
        if mine:
            ratios, places = zip(*mine, strict=True)
            axes.hlines(places, 1.0, ratios, color=colour, lw=1.5)
            axes.plot(ratios, places, marker, color=colour, ms=5, label=label)
    names = [row.name if row.beside == SMALLEST else f"{row.name} (beside {row.beside})" for row in rows]
    files.striped(axes, names, 8)
    axes.axvline(1.0, color="black", lw=1.0)
    axes.axvline(DEARER, color="black", lw=0.8, ls=":")
    axes.set_xlabel(f"time over that of what it is held against (dotted: {DEARER:g})", fontsize=8.5)
    axes.grid(True, axis="x", color="#d8d8d8", lw=0.6)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), fontsize=8, frameon=False, ncols=2)
    return files.png(figure, 100, files.digest([[row.name, row.beside, row.ratio] for row in rows]))


def markdown(about: Mapping[str, Any], rows: Sequence[Row]) -> str:
    """Two tables, each if there is anything in it: kinds beside the smallest kernel, and what parts add."""
    lines = [
        "# Only what a scene requires", "",
        f"Made by `{about.get('command', '')}`, {about.get('date', '')}, "
        f"{about.get('machine', {}).get('processor', '')}, one thread.",
        "Times are the least over rounds in which both are timed in turns.", "",
        f"![Time over that of what each is held against]({NAME}.png)",
    ]  # fmt: skip
    tables = {
        ("Scenes beside the smallest kernel that does the same", "smallest"): [r for r in rows if r.beside == SMALLEST],
        ("What a part adds to a scene that asks for it", "beside"): [r for r in rows if r.beside != SMALLEST],
    }
    for (title, other), mine in tables.items():
        cells = []
        for row in mine:
            ratio = f"{row.ratio:.3f}" if row.lean else f"**{row.ratio:.3f}**"
            what = _each(row, row.other_seconds) if other == "smallest" else row.beside
            cells.append([*_head(row), what, ratio, row.because])
        if mine:
            header = ("scene", "built", "bytes", "ns a step", other, "ratio", "")
            lines += ["", f"## {title}", "", *files.markdown_table(header, cells)]
    return "\n".join(lines) + "\n"


def _head(row: Row) -> list[str]:
    items = f"{row.name} ({row.count} {row.item}s)"
    return [items, ", ".join(row.built), f"{row.bytes:.0f} a {row.item}", _each(row, row.seconds)]


def _each(row: Row, seconds: float) -> str:
    return f"{1e9 * seconds / row.count:.3g}"

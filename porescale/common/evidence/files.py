"""The files of a study: JSON, CSV, Markdown and PNG from rows, each file whole or not at all."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from porescale.common.core.atomic import write_bytes
from porescale.common.core.errors import Fault, InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

T = TypeVar("T")


def write_files(folder: Path, files: Mapping[str, str | bytes]) -> None:
    """Write texts and pictures by file name into ``folder``, which is made if it is not there."""
    for name, content in files.items():
        write_bytes(folder / name, content.encode() if isinstance(content, str) else content)


def write_study(folder: Path, name: str, **contents: str | bytes) -> None:
    """Write the files of a study into ``folder``: ``name`` with each kind of file as its ending, json, csv, md, png."""
    write_files(folder, {f"{name}.{kind}": content for kind, content in contents.items()})


def stored_rows(file: Path, read: Callable[[dict[str, Any]], T]) -> list[T]:
    """What ``read`` makes of each row that a study's JSON ``file`` keeps; [] where there is none.

    Raises InputError where it is torn, or none of that study, whose rows would be lost.
    """
    if not file.exists():
        return []
    try:
        return [read(row) for row in json.loads(file.read_text(encoding="utf-8"))["rows"]]
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        repair = "remove it, or name another folder"
        raise InputError(Fault("--out", str(file), "cannot be read as a file of this study", repair=repair)) from None


def finite(value: Any) -> Any:
    """``value`` JSON-able: numpy numbers and arrays as plain ones, nan and infinities as None, at any depth."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {key: finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def json_text(rows: Iterable[Mapping[str, Any]], about: Mapping[str, Any] | None = None, key: str = "rows") -> str:
    """Rows a line each, so that two files can be compared: under ``key`` after ``about``, or alone without it."""
    lines = ",\n  ".join(json.dumps(finite(row), allow_nan=False) for row in rows)
    if about is None:
        return f"[\n  {lines}\n]\n"
    head = json.dumps(about, indent=1, allow_nan=False).removesuffix("\n}")
    return f'{head},\n "{key}": [\n  {lines}\n ]\n}}\n'


def csv_text(header: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """A table as CSV; None is an empty cell."""
    out = io.StringIO()
    lines = csv.writer(out, lineterminator="\n")
    lines.writerow(header)
    lines.writerows(rows)
    return out.getvalue()


def markdown_table(header: Sequence[str], rows: Iterable[Iterable[object]]) -> list[str]:
    """The lines of a Markdown table."""
    return [markdown_row(header), f"|{'|'.join('---' for _ in header)}|", *map(markdown_row, rows)]


def markdown_row(cells: Iterable[object]) -> str:
    """A line of a Markdown table; what would end a cell or the line in it is written so that it does not."""
    safe = [str(cell).replace("|", "\\|").replace("\n", " ") for cell in cells]
    return f"| {' | '.join(safe)} |"


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of this size in inches, drawn without a window."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def striped(axes: Axes, names: Sequence[str], fontsize: float) -> None:
    """Make axes of which each line is something that has a name, the first at the top, every other one on grey."""
    for at in range(0, len(names), 2):
        axes.axhspan(at - 0.5, at + 0.5, color="#f4f4f4", lw=0, zorder=0)
    axes.set_yticks(range(len(names)), names, fontsize=fontsize)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", labelsize=8)
    axes.spines[["top", "right", "left"]].set_visible(False)


def digest(shown: Any) -> str:
    """What tells whether a figure was drawn of these numbers, names and lists: a hash, 16 hexadecimal digits."""
    return hashlib.sha256(json.dumps(shown).encode()).hexdigest()[:16]


def png(figure: Figure, dpi: int, drawn_of: str = "") -> bytes:
    """The figure as a PNG file that does not name the version of the library.  drawn_of : its `digest`, kept as its
    description."""
    out = io.BytesIO()
    named = {"Description": drawn_of} if drawn_of else {}
    figure.savefig(out, format="png", dpi=dpi, metadata={"Software": None} | named)
    return out.getvalue()

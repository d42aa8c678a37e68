"""The report of `check` on a scene: named values under headings, and warnings."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from porescale.common.core.errors import InputError
from porescale.common.duration.expected import COMPILING, STEPS, Work, expected
from porescale.common.duration.quiet import BUSY, load_now
from porescale.common.record.schedule import recorded, too_many

if TYPE_CHECKING:
    from rich.console import Console

ROW = 300
"""Bytes of a row of series.csv, about."""
Value = float | int | str | bool


@dataclass(frozen=True)
class Row:
    """One value of a report;  unit : SI unit or "";  note : what it means, or what is recommended."""

    name: str
    value: Value
    unit: str = ""
    note: str = ""


@dataclass(repr=False)
class Report:
    """Rows under headings, in the order they were added, and warnings.

    ``heading`` opens a group, ``row`` adds to the group opened last, ``warn`` adds one line of warning.
    work : what a run has to do, where a report says so.
    """

    title: str
    groups: dict[str, list[Row]] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    work: Work | None = None

    def heading(self, name: str) -> None:
        """Open the group ``name``; opening it again goes on with it."""
        self.groups[name] = self.groups.pop(name, [])

    def row(self, name: str, value: Value, unit: str = "", note: str = "") -> None:
        """Add a row to the group opened last (one without a name if none is)."""
        if not self.groups:
            self.heading("")
        self.groups[next(reversed(self.groups))].append(Row(name, value, unit, note))

    def warn(self, text: str) -> None:
        """Add a warning: what is doubtful, why, and what to do, in one line."""
        self.warnings.append(text)

    def as_dict(self) -> dict[str, Any]:
        """JSON-able: ``{"title", "groups": {heading: [{"name", "value", "unit", "note"}]}, "warnings"}``."""
        groups = {name: [asdict(row) for row in rows] for name, rows in self.groups.items()}
        return {"title": self.title, "groups": groups, "warnings": list(self.warnings)}

    def __repr__(self) -> str:
        rows = sum(len(group) for group in self.groups.values())
        many = len(self.warnings)
        words = [f"{rows} values", *([f"{many} warning{'s' * (many > 1)}"] if many else [])]
        return f"Report {self.title!r}: {', '.join(words)}; show() prints it"

    def __str__(self) -> str:
        from io import StringIO

        from rich.console import Console

        text = StringIO()
        self.show(Console(file=text, width=120))
        return text.getvalue().rstrip()

    def _repr_html_(self) -> str:
        from html import escape

        from porescale.common.core.html import html_table

        tables = (
            html_table(name, (), [[row.name, shown(row.value), row.unit, row.note] for row in rows])
            for name, rows in self.groups.items()
        )
        doubts = "".join(f"<p><b>warning:</b> {escape(text)}</p>" for text in self.warnings)
        return f"<p><b>{escape(self.title)}</b></p>{''.join(tables)}{doubts}"

    def show(self, console: Console | None = None) -> None:
        """Print the report, a table per heading, warnings last."""
        from rich.console import Console
        from rich.table import Table
        from rich.text import Text

        console = console or Console()
        console.print(Text(self.title, style="bold"))
        for name, rows in self.groups.items():
            table = Table(title=name or None, title_justify="left", box=None, show_header=False, pad_edge=False)
            for justify in ("left", "right", "left", "left"):
                table.add_column(justify=justify)
            for row in rows:
                table.add_row(*map(Text, (row.name, shown(row.value), row.unit, row.note)))
            console.print(table)
        for warning in self.warnings:
            console.print(Text(f"warning: {warning}", style="yellow"), soft_wrap=True)


def report_time(out: Report, work: Work) -> None:
    """Add how long a run takes on a quiet machine, of what, and beside what runs on it now where that is much more.

    work : what it has to do; the report keeps it.
    """
    out.work, told = work, expected(work)
    compiling, steps = told.seconds[COMPILING], told.seconds[STEPS]
    out.row("time", told.total, "s", told.known)
    out.row("of it compiling", compiling, "s", "kernels that are not kept on disk")
    out.row("of it steps", steps, "s")
    out.row("of it the rest", told.total - compiling - steps, "s", "start, packing, files, pictures and film")
    if (busy := load_now()) > BUSY:
        out.row("time beside what runs now", busy * told.total, "s", f"{busy:.2g} times that of a quiet machine")


def report_output(out: Report, end: float, output: Any, steps: int, snapshot_bytes: float) -> None:
    """Add how many snapshots a run of ``steps`` until ``end`` (s) writes, with a warning of far too many.

    output : the section [output];  snapshot_bytes : of one, about.  InputError where they are beyond what can be
    written.
    """
    snapshots, rows = (recorded(end, it, steps) for it in (output.snapshot_interval, output.series_interval))
    size = snapshots * snapshot_bytes
    out.row("snapshots", snapshots, "", f"about {size / 2**20:.3g} MiB")
    faults = []
    for what, interval, count, bytes_ in (
        ("snapshot", output.snapshot_interval, snapshots, size), ("series", output.series_interval, rows, ROW * rows),
    ):  # fmt: skip
        try:
            if doubt := too_many(what, interval, count, bytes_):
                out.warn(doubt)
        except InputError as error:
            faults += error.faults
    if faults:
        raise InputError(faults)


def shown(value: Any) -> str:
    """A value as text: six digits of a float, words for booleans, "–" for nothing."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple):
        few = [shown(part) for part in value[:4]]
        return ", ".join([*few, "…"] if len(value) > 4 else few)
    return "–" if value is None else str(value)

"""The directive ``{rows}``: rows of validations, by name, with the numbers that were recorded last.

A page on a method names the rows that are about it; their numbers have one place, the record that ``verify`` writes.
"""

import json
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).resolve().parents[2]
RECORD = ROOT / "docs" / "evidence" / "rows.json"
HEAD = ("row", "compared with", "reference", "measured", "error", "tolerance")
MOST = 4
"""Numbers of a list that a cell shows."""


def text(value: Any, count: int | None = None) -> str:
    """A number, the first of a list of numbers, or a text, short;  count: how many there are, if not all are given."""
    if isinstance(value, list):
        whole = count or len(value)
        return ", ".join(map(text, value[:MOST])) + f" … {whole} in all" * (whole > MOST)
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def recorded() -> dict[str, list[str]]:
    """The cells of every row that is recorded, by its name."""
    found = {}
    for row in json.loads(RECORD.read_text(encoding="utf-8")):
        numbers = [text(row[key], row.get("of")) for key in ("reference", "measured", "error", "tolerance")]
        found[row["name"]] = [row["name"], row["source"], *numbers]
    return found


class RowsDirective(SphinxDirective):
    """Inserts a table of the rows named in its content, a name a line."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """The table; a warning at a name that the record has not."""
        known = recorded()
        self.env.note_dependency(str(RECORD))
        names = [name for line in self.content for name in line.split()]
        missing = [name for name in names if name not in known]
        group = nodes.tgroup("", *(nodes.colspec(colwidth=1) for _ in HEAD), cols=len(HEAD))
        group += nodes.thead("", self.line_of(list(HEAD)))
        group += nodes.tbody("", *(self.line_of(known[name], name=True) for name in names if name in known))
        faults = [
            self.state.document.reporter.warning(f"no row {name} is recorded", line=self.lineno) for name in missing
        ]
        return [*faults, nodes.table("", group, classes=["rows"])]

    @staticmethod
    def line_of(cells: list[str], *, name: bool = False) -> nodes.row:
        """A line of the table;  name: the first cell is the name of a row."""
        entries = []
        for at, cell in enumerate(cells):
            shown: nodes.Node = nodes.literal(cell, cell) if name and at == 0 else nodes.Text(cell)
            entries.append(nodes.entry("", nodes.paragraph("", "", shown)))
        return nodes.row("", *entries)


def setup(app: Sphinx) -> dict[str, Any]:
    """Add the directive."""
    app.add_directive("rows", RowsDirective)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}

"""The directive ``{rows}``: rows of validations, by name, with the numbers that were recorded last.

A page on a method names the rows that are about it; their numbers have one place, the record that ``verify`` writes.
"""

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from docs._ext.docstring import ROOT
from porescale.common.evidence.validation_files import number, stored

RECORD = ROOT / "docs" / "evidence" / "rows.json"
HEAD = ("row", "compared with", "reference", "measured", "error", "tolerance")


def recorded() -> dict[str, list[str]]:
    """The cells of every row that is recorded, by its name."""
    found = {}
    for name, row in stored(RECORD).items():
        numbers = [number(row[key], row.get("of")) for key in ("reference", "measured", "error", "tolerance")]
        found[name] = [name, row["source"], *numbers]
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
    """Make ``{rows}`` known to Sphinx."""
    app.add_directive("rows", RowsDirective)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}

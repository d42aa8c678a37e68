"""The directive ``{docstring} dotted.name``: the docstring of a module, class or function, as text, and where it is.

A formula has one place.  Where that place is a docstring, a page shows it with this directive and adds what it lacks.
"""

import ast
import inspect
import re
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).resolve().parents[2]
LITERAL = re.compile(r"``([^`]+)``")
FORMULA = re.compile(r" = |<=|>=|\^|\bd/d")
"""What makes a short line one that must not be joined with the next."""


def file_of(name: str) -> tuple[Path, list[str]]:
    """The file that a dotted name lies in, and the names within it; LookupError if there is none."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        base = ROOT.joinpath(*parts[:count])
        for path in (base.with_suffix(".py"), base / "__init__.py"):
            if path.is_file():
                return path, parts[count:]
    raise LookupError(f"no module holds {name}")


def docstring(name: str) -> tuple[str, Path, int]:
    """Docstring of a dotted name, its file, and the line it starts at; LookupError if there is none.

    The file is read, not imported: a kernel needs no compiler to be documented.
    """
    path, inner = file_of(name)
    node: ast.AST = ast.parse(path.read_text(encoding="utf-8"))
    for part in inner:
        body = getattr(node, "body", [])
        found = [one for one in body if getattr(one, "name", None) == part]
        if not found:
            raise LookupError(f"{path.relative_to(ROOT)} has no {'.'.join(inner)}")
        node = found[-1]
    assert isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
    text = ast.get_docstring(node)
    if not text:
        raise LookupError(f"{name} has no docstring")
    return inspect.cleandoc(text), path, getattr(node, "lineno", 1)


def inline(text: str) -> list[nodes.Node]:
    """Text with what stands in double backticks as code."""
    found: list[nodes.Node] = []
    for index, part in enumerate(LITERAL.split(text)):
        if part:
            found.append(nodes.literal(part, part) if index % 2 else nodes.Text(part))
    return found


def as_printed(lines: list[str]) -> bool:
    """Whether the lines of a paragraph are formulas or a table, which keep their breaks and spaces."""
    inner = lines[:-1] if len(lines) > 1 else lines
    short = sum(len(line) < 88 for line in inner) > len(inner) // 2 and len(lines) > 1
    return all(line.startswith(" ") for line in lines) or (
        any(FORMULA.search(line) for line in lines) and (short or any("   " in line.strip() for line in lines))
    )


def pieces(text: str) -> list[nodes.Node]:
    """Paragraphs of a docstring: prose flows, formulas keep their lines."""
    found: list[nodes.Node] = []
    prose: list[str] = []
    plain: list[str] = []

    def close() -> None:
        """End the paragraph or the formulas that are open."""
        if plain:
            block = "\n".join(plain)
            found.append(nodes.literal_block(block, block, language="text"))
        if prose:
            found.append(nodes.paragraph("", "", *inline(" ".join(line.strip() for line in prose))))
        plain.clear()
        prose.clear()

    for paragraph in re.split(r"\n\s*\n", text):
        lines = paragraph.splitlines()
        printed = as_printed(lines)
        for line in lines:
            keep = printed or line.startswith("    ")
            if (plain and not keep) or (prose and keep):
                close()
            (plain if keep else prose).append(line)
        close()
    return found


class DocstringDirective(SphinxDirective):
    """Inserts the docstring of the dotted name that is its argument."""

    required_arguments = 1
    has_content = False

    def run(self) -> list[nodes.Node]:
        """The paragraphs in a box that names the file."""
        name = self.arguments[0]
        try:
            text, path, line = docstring(name)
        except LookupError as fault:
            return [self.state.document.reporter.warning(f"docstring {name}: {fault}", line=self.lineno)]
        self.env.note_dependency(str(path))
        where = f"{path.relative_to(ROOT).as_posix()}, line {line}"
        box = nodes.container(classes=["from-source"])
        box += nodes.paragraph("", "", nodes.Text("From the source, "), nodes.literal(where, where), classes=["where"])
        box.extend(pieces(text))
        return [box]


def setup(app: Sphinx) -> dict[str, Any]:
    """Make ``{docstring}`` known to Sphinx."""
    app.add_directive("docstring", DocstringDirective)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}

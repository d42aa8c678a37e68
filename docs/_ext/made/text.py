"""Markdown of tables and of docstrings, for all that is made."""

import re
from collections.abc import Iterable, Sequence

LITERAL = re.compile(r"``([^`]+)``|(?<!`)`([^`\n]+)`(?!`)")
MARK = re.compile(r"([\\*_<>\[\]$|~`#])")


def escaped(text: str) -> str:
    """Plain text as Markdown that shows it: marks escaped, what stands in backticks as code."""
    made, end = [], 0
    for match in LITERAL.finditer(text):
        made += [MARK.sub(r"\\\1", text[end : match.start()]), code(match[1] or match[2])]
        end = match.end()
    return "".join([*made, MARK.sub(r"\\\1", text[end:])])


def code(text: str) -> str:
    """Text as code in a cell or a line."""
    fence = "``" if "`" in text else "`"
    pad = " " if "`" in text else ""
    return f"{fence}{pad}{text}{pad}{fence}" if text else ""


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; bars in cells are escaped."""
    lines = [header, ["---"] * len(header), *rows]
    cells = ([" ".join(it.split()).replace("\\|", "|").replace("|", "\\|") for it in line] for line in lines)
    return "\n".join(f"| {' | '.join(line)} |" for line in cells) + "\n"


def prose(text: str) -> str:
    """A docstring as Markdown: paragraphs flow, lines that are indented keep their breaks."""
    found = []
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        lines = paragraph.splitlines()
        if all(line.startswith(" ") for line in lines):
            found.append("```text\n" + paragraph + "\n```")
        else:
            found.append(escaped(" ".join(line.strip() for line in lines)))
    return "\n\n".join(found)


def slug(text: str) -> str:
    """A name as an anchor."""
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")

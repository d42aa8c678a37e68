"""The cases of a topic with their pictures, the command that runs each, and the numbers that it must show.

Topics are the sections of docs/cases.md, texts its lines; the rest comes from the folders of the cases.
"""

import re
import tomllib

from docs._ext.docstring import ROOT
from docs._ext.made.text import code, escaped, table

COMMAND = re.compile(r"^    ((?:porescale|continuum-sph|python) .*)$", re.MULTILINE)
LINK = re.compile(r"\[(\w+)\]\(\.\./cases/\w+\)")
PICTURE = re.compile(r"!\[([^\]]*)\]\(picture\.png\)")
PAGES = {path.parent.name: path for path in sorted((ROOT / "runs").glob("*/report.html"))}
"""Pages of runs in this tree, by name; `tests.manual` puts those of cases beside the manual."""
MOST = 8
"""Numbers of a case that are shown; its README has all."""


def topics() -> dict[str, list[tuple[list[str], str]]]:
    """Sections of docs/cases.md: each line of their tables as the cases that it names and what it says of them."""
    found: dict[str, list[tuple[list[str], str]]] = {}
    for part in re.split(r"^## ", (ROOT / "docs" / "cases.md").read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        title = part.split("\n", 1)[0].strip()
        lines = [line.strip("| ").split(" | ", 1) for line in part.splitlines() if line.startswith("| [")]
        found[title] = [(LINK.findall(line[0]), line[1]) for line in lines]
    return {title: lines for title, lines in found.items() if lines}


def numbers(case: str) -> str:
    """The first numbers that a case must show, as a table; how many more there are."""
    path = ROOT / "cases" / case / "expected.toml"
    rows = tomllib.loads(path.read_text(encoding="utf-8")).get("expected", []) if path.is_file() else []
    if not rows:
        return ""
    cells = []
    for it in rows[:MOST]:
        unit = escaped(str(it.get("unit", "")))
        cells.append((escaped(str(it["name"])), f"{it['value']:g} ± {it['tolerance']:g} {unit}".strip()))
    more = f"\nand {len(rows) - MOST} more, in its README.\n" if len(rows) > MOST else ""
    return table(("it must show", "expected"), cells) + more


def entry(case: str, text: str) -> str:
    """A case as Markdown: title, picture, command, numbers, link.  text : what the list of cases says of it."""
    readme = (ROOT / "cases" / case / "README.md").read_text(encoding="utf-8")
    title = readme.split("\n", 1)[0].removeprefix("# ").strip()
    made = [f"## {title}\n", f"{text[0].upper()}{text[1:]}.\n"]
    if shown := PICTURE.search(readme):
        made.append(f"```{{image}} ../../cases/{case}/picture.png\n:alt: {shown[1]}\n:width: 90%\n```\n")
    commands = COMMAND.findall(readme)
    if commands:
        made.append(f"```sh\n{commands[0]}\n```\n")
    if case in PAGES:
        text = f"The page of its run in this tree: {case}, to play, to point at and to measure in"
        made.append(f'```{{raw}} html\n<p><a href="../../runs/{case}/report.html">{text}</a></p>\n```\n')
    made.append(numbers(case))
    made.append(f"[{code(f'cases/{case}')}](../../cases/{case}/README.md): source, what is computed, what to see, "
                "what falls short, the last recorded run.\n")  # fmt: skip
    return "\n".join(made)


def page(title: str) -> str:
    """All cases of a topic."""
    return "\n".join(entry(case, text) for cases, text in topics()[title] for case in cases)

"""Every command of a package with its arguments and options, from the program's own command line."""

import re
from collections.abc import Iterator
from typing import Any

from cyclopts import App

from docs._ext.made.text import code, escaped, slug, table

NONE = re.compile(r"\s*\|\s*None\b|\bOptional\[(.*)\]$")
KINDS = {"str": "text", "int": "whole number", "float": "number", "bool": "", "Path": "path"}


def app_of(package: str) -> App:
    """The command line of a package."""
    if package == "porescale":
        from porescale.cli.main import commands

        return commands()
    from continuum_sph.cli import PACKAGE
    from porescale.common.cli.application import application

    return application(PACKAGE)


def every(app: App, before: str) -> Iterator[tuple[str, App]]:
    """Commands in their order, each with those within it."""
    for word in app:
        if not word.startswith("-"):
            yield f"{before} {word}", app[word]
            yield from every(app[word], f"{before} {word}")


def prose(text: str) -> str:
    """Help as Markdown; it has its own marks of code already."""
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(it if k % 2 else escaped(it) for k, it in enumerate(parts))


def kind(argument: Any) -> str:
    """What an argument takes: choices, or the kind of value."""
    if choices := argument.get_choices():
        return " or ".join(map(code, choices))
    text = str(getattr(argument.hint, "__name__", argument.hint)) if not getattr(
        argument.hint, "__args__", None) else str(argument.hint)  # fmt: skip
    text = re.sub(r"\btyping\.|\bpathlib\.|\bcollections\.abc\.", "", text)
    many = re.search(r"(list|tuple|Sequence)\[", text)
    words = [KINDS[it] for it in re.findall(r"\w+", text) if it in KINDS]
    return " or ".join(dict.fromkeys(filter(None, words))) + (", repeatable" if many and words else "")


def default(argument: Any) -> str:
    """The default, or that it must be given."""
    value = argument.field_info.default
    if argument.required:
        return "required"
    return code(str(value)) if value not in (None, False, (), "") and value is not argument.field_info.empty else ""


def section(name: str, app: App) -> str:
    """One command: usage, what it does, its arguments and options."""
    inner = [word for word in app if not word.startswith("-")]
    depth = "##" if name.count(" ") == 1 else "###"
    made = [f"({slug('command ' + name)})=\n{depth} {name}\n", f"{prose(' '.join((app.help or '').split()))}\n"]
    if inner:
        links = [f"[{it}](#{slug(f'command {name} {it}')})" for it in inner]
        made.append(f"Commands in it: {', '.join(links)}.\n")
        return "\n".join(made)
    rows, words = [], []
    for it in app.assemble_argument_collection(parse_docstring=True):
        names = [one for one in it.names if not one.startswith(("--no-", "--empty-"))]
        if not it.show and it.parameter.show is False:
            continue
        if names and not names[0].startswith("-"):
            words.append(names[0] if it.required else f"[{names[0]}]")
        about = prose(it.parameter.help or "")
        rows.append((", ".join(map(code, names)), kind(it), default(it), about))
    made.append(f"```text\n{name} {' '.join([*words, '[OPTIONS]'])}\n```\n")
    if rows:
        made.append(table(("argument or option", "takes", "default", "meaning"), rows))
    return "\n".join(made)


def page(package: str) -> str:
    """All commands of a package."""
    app = app_of(package)
    found = list(every(app, app.name[0]))
    first = [(name, it) for name, it in found if name.count(" ") == 1]
    rows = [
        (f"[{name}](#{slug('command ' + name)})", prose((it.help or "").split(". ")[0].strip())) for name, it in first
    ]
    return table(("command", "does"), rows) + "\n" + "\n".join(section(name, it) for name, it in found)

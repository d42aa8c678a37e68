"""Every public name of the packages, from their ``__init__.pyi`` and docstrings."""

import ast
import functools
import inspect
import itertools
import re
import textwrap
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from docs._ext.docstring import ROOT
from docs._ext.made.text import code, escaped, prose, slug, table

NAMES = r"\*{0,2}[A-Za-z_]\w*(?:(?:, | and )\*{0,2}[A-Za-z_]\w*)*(?: \([^)]*\))?"
ENTRY = re.compile(rf"(?:^|(?<=[;.:])\s+|\n)({NAMES}) : ")
"""A parameter of a docstring: its name, or several, before a colon between spaces."""


def public(package: str) -> dict[str, list[str]]:
    """Public modules of a package, each a folder with ``__init__.pyi``, and the names it lists."""
    found = {}
    for path in sorted((ROOT / package).rglob("__init__.pyi")):
        names = [alias.asname or alias.name for node in ast.parse(path.read_text(encoding="utf-8")).body
                 if isinstance(node, ast.ImportFrom) for alias in node.names]  # fmt: skip
        found[".".join(path.parent.relative_to(ROOT).parts)] = names
    return found


def described(text: str) -> str:
    """A docstring as Markdown; its parameters become a list."""
    parts = []
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        pieces = ENTRY.split(paragraph)
        if len(pieces) < 3 or all(line.startswith(" ") for line in paragraph.splitlines()):
            parts.append(prose(paragraph))
            continue
        if pieces[0].strip():
            parts.append(prose(pieces[0]))
        after, items = "", []
        for name, about in zip(pieces[1::2], pieces[2::2], strict=True):
            said, mark, rest = re.sub(r"\s+", " ", about.replace(".  ", ".\0").replace(".\n", ".\0")).partition("\0")
            items.append(f"* {', '.join(code(it) for it in name.split(', '))}: {escaped(said.strip(' ;'))}")
            after = f"{after} {rest}".strip() if mark else after
        parts.append("\n".join(items))
        if after:
            parts.append(escaped(" ".join(after.replace("\0", " ").split())))
    return "\n\n".join(parts)


def shown(default: Any) -> Any:
    """A default as a signature shows it: dots for one that is long, or that is printed by its address."""
    if default is inspect.Parameter.empty or (len(repr(default)) < 30 and "<" not in repr(default)):
        return default
    return ...


def signature(thing: Any, bound: bool = False) -> str:
    """Parameters of a function or class, without their annotations where those are long."""
    try:
        found = inspect.signature(thing)
    except (TypeError, ValueError):
        return "()"
    given = list(found.parameters.values())
    if bound and given and given[0].name in ("self", "cls"):
        given = given[1:]
    short = [it.replace(annotation=inspect.Parameter.empty, default=shown(it.default)) for it in given]
    return str(inspect.Signature(short))


def entry(kind: str, name: str, shown: str, body: str, options: str = "") -> str:
    """A directive of Sphinx that describes a name, so that it can be found and linked to."""
    longest = max((len(it) for it in re.findall(r"^:{3,}", body, re.MULTILINE)), default=3)
    fence = ":" * (longest + 1)
    return f"{fence}{{py:{kind}}} {name}{shown}\n{options}\n{body}\n{fence}\n"


def members(cls: type) -> Iterator[tuple[str, Any]]:
    """Public members of a class that the packages define, in their order, those of bases after its own."""
    seen = set()
    for base in cls.__mro__:
        if not base.__module__.startswith(("porescale", "continuum_sph")):
            continue
        for name, it in vars(base).items():
            if name.startswith(("_", "model_")) or name in seen:  # the latter are of pydantic
                continue
            seen.add(name)
            plain = it.__func__ if isinstance(it, staticmethod | classmethod) else it
            if (inspect.isfunction(plain) or isinstance(plain, property | functools.cached_property)) and plain.__doc__:
                yield name, it


def one(module: str, name: str) -> str:
    """A public name of a module as Markdown: signature, docstring, and those of its members."""
    thing = getattr(import_module(module), name)
    doc = inspect.cleandoc(thing.__doc__ or "")
    ours = str(getattr(thing, "__module__", "")).startswith(("porescale", "continuum_sph"))
    if inspect.isclass(thing) and ours:
        body = [described(doc)]
        for inner, it in members(thing):
            plain = it.__func__ if isinstance(it, staticmethod | classmethod) else it
            text = described(inspect.cleandoc(plain.__doc__ or ""))
            if inspect.isfunction(plain):
                body.append(entry("method", inner, signature(plain, not isinstance(it, staticmethod)), text))
            else:
                body.append(entry("property", inner, "", text))
        kind = "exception" if issubclass(thing, BaseException) else "class"
        return entry(kind, f"{module}.{name}", signature(thing), "\n\n".join(body))
    if inspect.ismodule(thing):
        return f"{code(f'{module}.{name}')}: {escaped(doc.split(chr(10))[0])}\n"
    if callable(thing) and ours:
        return entry("function", f"{module}.{name}", signature(thing, True), described(doc))
    said = docs_of_value(module, name)
    value = f":value: {thing!r}\n" if isinstance(thing, int | float | str) else ""
    return entry("data", f"{module}.{name}", "", described(said), value)


def docs_of_value(module: str, name: str) -> str:
    """The text below a constant in the file that makes it."""
    for path in sorted((ROOT / module.replace(".", "/")).rglob("*.py")):
        body = ast.parse(path.read_text(encoding="utf-8")).body
        for node, after in itertools.pairwise(body):
            targets = getattr(node, "targets", None) or [getattr(node, "target", None)]
            if any(getattr(it, "id", "") == name for it in targets) and isinstance(after, ast.Expr):
                value = getattr(after, "value", None)
                if isinstance(value, ast.Constant) and isinstance(value.value, str):
                    return inspect.cleandoc(value.value)
    return ""


def page(package: str) -> str:
    """All public modules of a package, or of those that a name with a star begins."""
    inner = package.endswith(".*")
    base = package.removesuffix(".*")
    found = {module: names for module, names in public(base.split(".")[0]).items() if (module != base) == inner}
    made = []
    if inner:
        rows = []
        for module in found:
            about = (import_module(module).__doc__ or "").strip().split("\n")[0]
            rows.append((f"[`{module}`](#{slug('module ' + module)})", escaped(about)))
        made.append(table(("module", "has"), rows))
    for module, names in found.items():
        if inner:
            made.append(f"({slug('module ' + module)})=\n## {module}\n\n{prose(import_module(module).__doc__ or '')}\n")
        made += [textwrap.dedent(one(module, name)) for name in sorted(names, key=str.lower)]
    return "\n".join(made)

"""Every message that a user can be given, read from the source: faults, warnings, what stops a run; with the repair."""

import ast
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from docs._ext.docstring import ROOT
from docs._ext.made.text import escaped, slug, table

LEFT_OUT = "…"
"""What stands in a message for what a run puts there."""
MOST = 4
"""Forms of one message that are listed."""
AREAS = {
    "porescale/scene": "Sections of a scene",
    "porescale/builders": "Scenes as a whole",
    "porescale/common/schema": "Scene files",
    "porescale/common/cli": "Commands",
    "porescale/common": "Runs, files and the Python interface",
    "porescale/cli": "Commands of porescale",
    "porescale/dem": "Grains",
    "porescale/lbm": "Fluid",
    "porescale/coupling": "Fluid and grains",
    "porescale/piv": "Films and pictures",
    "porescale/demseg": "Decks of DEMseg",
    "porescale": "Elsewhere in porescale",
    "continuum_sph": "The continuum",
}
"""Where a message comes from, by the folder of its source; the first that holds it."""
ORDER = ("key", "value", "problem", "unit", "allowed", "repair", "file")
"""Arguments of a Fault."""
STABLE_ORDER = ("where", "quantity", "value", "unit", "step", "time", "cause")
"""Arguments of an Unstable."""
Scope = dict[str, list[ast.expr]]


@dataclass(frozen=True)
class Message:
    """kind : fault, warning, stop or error;  key, text, allowed, repair : as printed;  why : what is checked;  path."""

    kind: str
    key: str
    text: str
    allowed: str
    repair: str
    why: str
    path: str


def assigned(body: Sequence[ast.stmt] | ast.AST) -> Scope:
    """Expressions that names are given anywhere below."""
    found: Scope = {}
    for top in body if isinstance(body, list) else [body]:
        for node in ast.walk(top):
            pairs: list[tuple[ast.expr, ast.expr]] = []
            if isinstance(node, ast.Assign):
                pairs = [(target, node.value) for target in node.targets]
            elif isinstance(node, ast.AnnAssign) and node.value:
                pairs = [(node.target, node.value)]
            elif isinstance(node, ast.For | ast.comprehension) and isinstance(node.iter, ast.Tuple | ast.List):
                pairs = [(node.target, it) for it in node.iter.elts]
            for target, value in pairs:
                if isinstance(target, ast.Name):
                    found.setdefault(target.id, []).append(value)
                elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple | ast.IfExp):
                    for one in [value] if isinstance(value, ast.Tuple) else [value.body, value.orelse]:
                        if isinstance(one, ast.Tuple) and len(one.elts) == len(target.elts):
                            for name, it in zip(target.elts, one.elts, strict=True):
                                if isinstance(name, ast.Name):
                                    found.setdefault(name.id, []).append(it)
    return found


def texts(node: ast.AST | None, scopes: Sequence[Scope], depth: int = 0) -> list[str]:
    """The texts that an expression can be, with an ellipsis for what is known only in a run."""
    if node is None or depth > 4:
        return [""] if node is None else [LEFT_OUT]
    if isinstance(node, ast.Constant):
        return [node.value if isinstance(node.value, str) else ""]
    if isinstance(node, ast.JoinedStr):
        parts = [""]
        for it in node.values:
            inner = it.value if isinstance(it, ast.FormattedValue) else it
            plain = isinstance(it, ast.Constant) or (isinstance(inner, ast.IfExp | ast.Name) and it.format_spec is None)
            more = texts(inner, scopes, depth + 1) if plain else [LEFT_OUT]
            parts = [a + b for a in parts for b in more[:MOST]][:MOST]
        return parts
    if isinstance(node, ast.IfExp):
        return [*texts(node.body, scopes, depth + 1), *texts(node.orelse, scopes, depth + 1)][:MOST]
    if isinstance(node, ast.BoolOp):
        return [it for one in node.values for it in texts(one, scopes, depth + 1) if it != LEFT_OUT][:MOST] or [
            LEFT_OUT
        ]
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return [a + b for a in texts(node.left, scopes, depth + 1) for b in texts(node.right, scopes, depth + 1)][:MOST]
    if isinstance(node, ast.Name):
        for scope in scopes:
            if node.id in scope:
                found = [it for one in scope[node.id] for it in texts(one, scopes, depth + 1)]
                return list(dict.fromkeys(found))[:MOST] or [LEFT_OUT]
    if isinstance(node, ast.Call):
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if name == "nearest":
            return ["did you mean …? or: known names are listed"]
    return [LEFT_OUT]


def tidy(text: str) -> str:
    """A text in one line, ellipses not repeated."""
    return re.sub(r"(…[\s,]*)+…", LEFT_OUT, " ".join(text.split()))


@dataclass
class Reader:
    """Reads the messages of one file."""

    path: Path

    @cached_property
    def tree(self) -> ast.Module:
        """The syntax tree of its text."""
        return ast.parse(self.path.read_text(encoding="utf-8"))

    def messages(self) -> Iterator[Message]:
        """All of them, in the order of the source."""
        yield from self.walk(self.tree, [assigned([it for it in self.tree.body if not hasattr(it, "body")])], "")

    def walk(self, node: ast.AST, scopes: list[Scope], why: str) -> Iterator[Message]:
        """Messages below a node; ``scopes`` from the innermost, ``why`` the docstring of the innermost function."""
        for child in ast.iter_child_nodes(node):
            inner, reason = scopes, why
            if isinstance(child, ast.FunctionDef | ast.ClassDef):
                doc = (ast.get_docstring(child) or "").split("\n\n")[0]
                reason = " ".join(doc.split()) or why
                inner = [assigned(child.body), *scopes] if isinstance(child, ast.FunctionDef) else scopes
            if isinstance(child, ast.Call):
                yield from self.call(child, inner, reason)
            yield from self.walk(child, inner, reason)

    def call(self, node: ast.Call, scopes: list[Scope], why: str) -> Iterator[Message]:
        """The messages of one call."""
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        path = self.path.relative_to(ROOT).as_posix()
        if name in ("Fault", "Unstable"):
            order = ORDER if name == "Fault" else STABLE_ORDER
            given = dict(zip(order, node.args, strict=False)) | {it.arg: it.value for it in node.keywords if it.arg}
            if name == "Unstable":
                quantities, causes = texts(given.get("quantity"), scopes), texts(given.get("cause"), scopes)
                for cause in causes:
                    text = f"unstable at step … (t = … s): {quantities[0]} = … at …"
                    yield Message("stop", "", tidy(text), "", tidy(cause), why, path)
                return
            key = " or ".join(dict.fromkeys(texts(given.get("key"), scopes)))
            problems, repairs = texts(given.get("problem"), scopes), texts(given.get("repair"), scopes)
            allowed = " or ".join(dict.fromkeys(texts(given.get("allowed"), scopes)))
            for k, problem in enumerate(problems):
                repair = repairs[k] if len(repairs) == len(problems) else " or ".join(dict.fromkeys(repairs))
                yield Message("fault", tidy(key), tidy(problem), tidy(allowed), tidy(repair), why, path)
        elif name == "warn" or (name == "append" and "warnings" in ast.unparse(node.func)):
            for text in texts(node.args[0] if node.args else None, scopes):
                problem, _, repair = text.partition("; ")
                yield Message("warning", "", tidy(problem), "", tidy(repair), why, path)
        elif name == "PorescaleError" and node.args:
            for text in texts(node.args[0], scopes):
                problem, _, repair = text.partition("; ")
                yield Message("error", "", tidy(problem), "", tidy(repair), why, path)


def area(path: str) -> str:
    """The heading that a source's messages stand below."""
    return next(title for folder, title in AREAS.items() if path.startswith(folder + "/"))


def collected() -> list[Message]:
    """All messages of both packages, those of validations and benchmarks aside."""
    found = []
    for package in ("porescale", "continuum_sph"):
        for path in sorted((ROOT / package).rglob("*.py")):
            if not {"validation", "benchmarks"} & set(path.relative_to(ROOT).parts):
                found += list(Reader(path).messages())
    return [it for it in dict.fromkeys(found) if re.search(r"[A-Za-z]{2,} [A-Za-z]{1,}|[a-z]{4,}", it.text)]


def page(_: str) -> str:
    """All messages, by where they come from, in alphabetical order."""
    found = collected()
    made = []
    for title in dict.fromkeys(AREAS.values()):
        mine = [it for it in found if area(it.path) == title]
        rows = []
        for it in sorted(mine, key=lambda one: (one.text.lower(), one.key)):
            kind = "" if it.kind == "fault" else f"*{it.kind}:* "
            allowed = f" (allowed: {escaped(it.allowed)})" if it.allowed not in ("", LEFT_OUT) else ""
            repair = escaped(it.repair) if it.repair != LEFT_OUT else ""
            rows.append((kind + escaped(it.text) + allowed, escaped(it.key), repair, escaped(it.why)))
        if rows:
            made.append(f"({slug('messages ' + title)})=\n## {title}\n")
            made.append(table(("message", "key", "repair", "where it is checked"), rows))
    return "\n".join(made)

"""Sources as syntax trees: what the architecture checks read.  Nothing of the packages is imported."""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from tests.reference.folders import ROOT

PACKAGES = ("porescale", "continuum_sph")
KERNELS = {"kernel", "parallel_kernel", "inline", "disjoint", "law_function"}

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass
class Source:
    """One module: dotted name, path inside the repository, text."""

    module: str
    path: str
    text: str

    @cached_property
    def tree(self) -> ast.Module:
        return ast.parse(self.text, self.path)

    def at(self, node: ast.AST) -> str:
        return f"{self.path}:{node.lineno}"

    def imports(self) -> Iterator[tuple[ast.AST, str]]:
        """Every imported name, dotted and absolute, wherever it stands: ``a.b.c`` for ``from a.b import c``."""
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Import):
                yield from ((node, alias.name) for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                base = node.module or ""
                if node.level:
                    package = self.module.split(".")
                    if not self.path.endswith("__init__.py"):
                        package = package[:-1]
                    above = package[: len(package) - node.level + 1]
                    base = ".".join([*above, *([base] if base else [])])
                yield from ((node, f"{base}.{alias.name}") for alias in node.names)


def read(path: Path, root: Path = ROOT) -> Source:
    """The source in a file below ``root``."""
    inside = path.relative_to(root)
    parts = list(inside.with_suffix("").parts)
    if parts[-1] == "__init__":
        parts.pop()
    return Source(".".join(parts), inside.as_posix(), path.read_text(encoding="utf-8"))


def sources(root: Path = ROOT, folders: tuple[str, ...] = PACKAGES) -> list[Source]:
    """Every module of the folders."""
    return [read(path, root) for folder in folders for path in sorted((root / folder).rglob("*.py"))]


def exports(root: Path = ROOT, folders: tuple[str, ...] = PACKAGES) -> dict[str, dict[str, str]]:
    """Every public module, with the names of its ``__init__.pyi`` and the module that each lies in."""
    found: dict[str, dict[str, str]] = {}
    for path in (it for folder in folders for it in sorted((root / folder).rglob("__init__.pyi"))):
        package = ".".join(path.parent.relative_to(root).parts)
        names = found.setdefault(package, {})
        for node in ast.parse(path.read_text(encoding="utf-8"), str(path)).body:
            if isinstance(node, ast.ImportFrom):
                for alias in node.names:
                    names[alias.name] = f"{package}.{node.module or alias.name}"
    return found


def written(module: str, text: str) -> Source:
    """A source that was never in a file: what the twins that must fail are made of."""
    return Source(module, module.replace(".", "/") + ".py", text)


def is_kernel(node: Function) -> bool:
    """Whether a function is compiled: decorated by one of ground.jit's decorators, or a body ``@name.of(Law)``."""
    return any(
        (isinstance(it, ast.Name) and it.id in KERNELS)
        or (isinstance(it, ast.Call) and isinstance(it.func, ast.Attribute) and it.func.attr == "of")
        for it in node.decorator_list
    )


def functions(tree: ast.AST, inside_kernels: bool = False) -> Iterator[Function]:
    """Every function and method, nested ones too, but for those within kernels."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node
            if is_kernel(node) and not inside_kernels:
                continue
        yield from functions(node, inside_kernels)

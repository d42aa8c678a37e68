"""The rules of the tree, each a function from a tree to the places that break it; in words: CONTRIBUTING.md.

A tree is a `Tree`: the modules of both packages and what they import, in functions and under TYPE_CHECKING too.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from tests.architecture.sources import ROOT, Function, Source, exports, functions, is_kernel, sources

MOST_FILES, MOST_LINES = 20, 400
MOST_KERNEL_ARGUMENTS, MOST_KERNEL_LINES, MOST_ARGUMENTS = 12, 80, 8
BASE = ("porescale.common.core", "porescale.common.compiled", "porescale.common.neighbors")
PHYSICS = {
    "porescale.lbm": (),
    "porescale.dem": (),
    "porescale.coupling": ("porescale.lbm", "porescale.dem"),
    "porescale.piv": (),
    "continuum_sph.water": (),
    "continuum_sph.soil": ("continuum_sph.water",),
    "continuum_sph.seepage": ("continuum_sph.water", "continuum_sph.soil"),
    "continuum_sph.unsaturated": ("continuum_sph.water", "continuum_sph.soil", "continuum_sph.seepage"),
}
"""Folders of physics, and which lower ones each may import."""
READS_RUNS = tuple(f"porescale.common.{it}" for it in ("record", "pictures", "schema", "page"))
"""What `porescale.piv` may import besides: it reads films and runs from disk and writes fields and a page."""
EVIDENCE = ("validation", "benchmarks")
MAY_IMPORT_EVIDENCE = (*EVIDENCE, "cli")
KERNEL_FOLDERS = (*BASE, *PHYSICS)
STATED = re.compile(r"flat arguments.*\d\s*%", re.IGNORECASE | re.DOTALL)
"""What the docstring of a kernel says that is wider than others, or longer, because bundles or pieces cost speed."""


def inside(name: str, *folders: str) -> bool:
    """Whether a dotted name lies in one of the folders, or is one."""
    return any(name == folder or name.startswith(f"{folder}.") for folder in folders)


@dataclass
class Tree:
    """The modules of a checkout.  exports : of every public module, the modules that its names lie in."""

    modules: list[Source]
    exports: dict[str, dict[str, str]] = field(default_factory=dict)

    @classmethod
    def at(cls, root: Path = ROOT) -> Tree:
        """Both packages below ``root``."""
        return cls(sources(root), exports(root))

    @cached_property
    def named(self) -> dict[str, Source]:
        """Modules by dotted name."""
        return {source.module: source for source in self.modules}

    @cached_property
    def imports(self) -> dict[str, dict[str, ast.AST]]:
        """For every module, the modules that it imports, with the statement that does.

        A name of a public module is an import of where it lies; a public module by itself is one of all its names.
        """
        found: dict[str, dict[str, ast.AST]] = {
            package: {it: ast.Pass(lineno=1) for it in names.values() if it in self.named}
            for package, names in self.exports.items()
        }
        for source in self.modules:
            targets = found.setdefault(source.module, {})
            for node, name in source.imports():
                package, _, own = name.rpartition(".")
                module = name if name in self.named else self.exports.get(package, {}).get(own, package)
                if module in self.named and module != source.module:
                    targets.setdefault(module, node)
        return found

    @cached_property
    def with_kernels(self) -> set[str]:
        """Modules in which kernels are defined."""
        return {source.module for source in self.modules if any(is_kernel(it) for it in functions(source.tree))} - {
            "porescale.common.compiled.jit"
        }

    def reached(self, module: str) -> set[str]:
        """Every module that is imported when this one is, itself included; TYPE_CHECKING counts."""
        seen, left = {module}, [module]
        while left:
            for other in self.imports[left.pop()]:
                if other not in seen:
                    seen.add(other)
                    left.append(other)
        return seen


def _wrong(tree: Tree, allowed: Callable[[str, str], bool]) -> Iterator[str]:
    """Imports that are not allowed."""
    for module, targets in tree.imports.items():
        for other, node in targets.items():
            if not allowed(module, other):
                yield f"{tree.named[module].at(node)}: {module} imports {other}"


def rule_1_common_stands_alone(tree: Tree) -> Iterator[str]:
    """`common` imports nothing outside itself, and `continuum_sph` nothing of porescale but `common`."""

    def allowed(module: str, other: str) -> bool:
        if inside(module, "porescale.common"):
            return inside(other, "porescale.common")
        if inside(module, "continuum_sph"):
            return inside(other, "porescale.common", "continuum_sph")
        return not inside(other, "continuum_sph")

    yield from _wrong(tree, allowed)


def rule_2_evidence_apart(tree: Tree) -> Iterator[str]:
    """Nobody imports validation or benchmarks but themselves and `cli`; physics imports its base and lower physics."""

    def allowed(module: str, other: str) -> bool:
        parts = module.split(".")
        if any(word in other.split(".")[1:2] for word in EVIDENCE):
            return parts[1] in MAY_IMPORT_EVIDENCE
        for folder, lower in PHYSICS.items():
            if inside(module, folder):
                extra = READS_RUNS if folder == "porescale.piv" else ()
                return inside(other, folder, *lower, *BASE, *extra)
        return True

    yield from _wrong(tree, allowed)


def rule_3_sections_hold_no_kernel(tree: Tree) -> Iterator[str]:
    """No section file holds a kernel or comes, by whatever way, to one that does."""
    for module in tree.named:
        if inside(module, "porescale.scene", "continuum_sph.scene"):
            kernels = sorted(tree.reached(module) & tree.with_kernels)
            if kernels:
                yield f"{tree.named[module].path}: reaches the kernels of {kernels[0]} and {len(kernels) - 1} more"


def circles(tree: Tree) -> list[list[str]]:
    """Groups of modules that import each other, directly or through others (Tarjan 1972, without recursion)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    on: set[str] = set()
    found: list[list[str]] = []
    for root in tree.named:
        if root in index:
            continue
        work = [(root, iter(tree.imports[root]))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on.add(root)
        while work:
            module, targets = work[-1]
            for other in targets:
                if other not in index:
                    index[other] = low[other] = len(index)
                    stack.append(other)
                    on.add(other)
                    work.append((other, iter(tree.imports[other])))
                    break
                if other in on:
                    low[module] = min(low[module], index[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[module])
                if low[module] == index[module]:
                    group = []
                    while True:
                        one = stack.pop()
                        on.discard(one)
                        group.append(one)
                        if one == module:
                            break
                    if len(group) > 1:
                        found.append(sorted(group))
    return sorted(found)


def rule_4_no_circles(tree: Tree) -> Iterator[str]:
    """No module imports one that imports it, through however many others."""
    for group in circles(tree):
        yield f"circle of {len(group)}: {', '.join(group)}"


def crowded(modules: Iterable[Source]) -> Iterator[str]:
    """Folders of too many files, ``__init__`` not counted."""
    folders = (source.path.rpartition("/")[0] for source in modules if not source.path.endswith("__init__.py"))
    for folder, count in sorted(Counter(folders).items()):
        if count > MOST_FILES:
            yield f"{folder}: {count} files"


def arguments(node: Function) -> int:
    """Parameters of a function, ``self`` and ``cls`` not counted, nor those that are given by name only."""
    names = [it.arg for it in (*node.args.posonlyargs, *node.args.args)]
    return len(names) - (names[:1] in (["self"], ["cls"]))


def lines(node: Function) -> int:
    """Lines of a function without its docstring."""
    doc = ast.get_docstring(node, clean=False)
    return node.end_lineno - node.lineno + 1 - (len(doc.splitlines()) if doc else 0)


def rule_5_nothing_too_large(tree: Tree) -> Iterator[str]:
    """At most 20 files a folder, 400 lines a file, 12 arguments and 80 lines a kernel, 8 arguments elsewhere."""
    yield from crowded(tree.modules)
    for source in tree.modules:
        count = len(source.text.splitlines())
        if count > MOST_LINES:
            yield f"{source.path}: {count} lines"
        for node in functions(source.tree, inside_kernels=True):
            compiled = is_kernel(node)
            if compiled and STATED.search(ast.get_docstring(node) or ""):
                continue
            most = MOST_KERNEL_ARGUMENTS if compiled else MOST_ARGUMENTS
            if arguments(node) > most:
                yield f"{source.at(node)}: {node.name} has {arguments(node)} arguments"
            if compiled and lines(node) > MOST_KERNEL_LINES:
                yield f"{source.at(node)}: {node.name} has {lines(node)} lines"


def rule_6_kernels_stand_on_kernels(tree: Tree) -> Iterator[str]:
    """What a file with kernels imports lies in folders of kernels: an edit elsewhere compiles nothing anew."""
    for module in sorted(tree.with_kernels):
        if not inside(module, *KERNEL_FOLDERS):
            continue  # studies and user code may stand on what they like
        for other in sorted(tree.reached(module)):
            if not inside(other, *KERNEL_FOLDERS, *((READS_RUNS) if inside(module, "porescale.piv") else ())):
                yield f"{tree.named[module].path}: stands on {other}"


LAW_FOLDERS = (
    "porescale.lbm.collision", "porescale.coupling.solid", "porescale.coupling.weighting", "porescale.dem.contact",
    "continuum_sph.water.eos",
)  # fmt: skip
"""Folders of laws whose names stand for nothing else."""
SIDES = "porescale.lbm.boundary"
"""The kinds of sides; some are called as quantities and other things are (velocity, wall)."""
OWN_WORDS = ("porescale.dem", "continuum_sph")
"""What may not import the lattice: the boxes there have words of their own."""
QUANTITIES = {"wall", "velocity", "pressure"}
"""Names of sides that other things have, too: a comparison is with a side where it is with a kind."""


def law_names(tree: Tree, *folders: str) -> set[str]:
    """What the files of these folders call their laws: ``name="…"``, ``name = "…"`` or ``name: … = "…"``."""
    found = set()
    for source in tree.modules:
        if not inside(source.module, *folders):
            continue
        for node in ast.walk(source.tree):
            if isinstance(node, ast.keyword) and node.arg == "name":
                value: ast.AST | None = node.value
            elif (isinstance(node, ast.AnnAssign) and getattr(node.target, "id", "") == "name") or (
                isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "name"
            ):
                value = node.value
            else:
                continue
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                found.add(value.value)
    return found


def _of_kind(node: ast.AST) -> bool:
    """Whether a comparison is with something called kind: ``kind``, ``side.kind``, ``kind(side)``, ``side["kind"]``."""
    return any(
        "kind" in (getattr(it, "id", ""), getattr(it, "attr", ""), getattr(it, "value", "")) for it in ast.walk(node)
    )


def rule_7_laws_decide_themselves(tree: Tree) -> Iterator[str]:
    """No comparison with the name of a law or kind of side decides outside its folder; evidence may choose."""
    laws, sides = law_names(tree, *LAW_FOLDERS) - {"wall"}, law_names(tree, SIDES)
    for source in tree.modules:
        if source.module.split(".")[1:2] in ([it] for it in EVIDENCE):
            continue
        names = set() if inside(source.module, *LAW_FOLDERS) else laws
        kinds = set() if inside(source.module, SIDES, *OWN_WORDS) else sides
        for node in ast.walk(source.tree):
            if not isinstance(node, ast.Compare | ast.Match):
                continue
            compared = [case.pattern for case in node.cases] if isinstance(node, ast.Match) else [node]
            found = names | (kinds if _of_kind(getattr(node, "subject", node)) else kinds - QUANTITIES)
            for it in (it for part in compared for it in ast.walk(part)):
                if isinstance(it, ast.Constant) and it.value in found:
                    yield f"{source.at(it)}: compares with {it.value!r}"


def rule_8_stubs_are_contracts(tree: Tree) -> Iterator[str]:
    """A function whose bodies stand in other files, chosen by a law's type, stands in a ``law.py``: the contract."""
    for source in tree.modules:
        taken = {
            alias.asname or alias.name: node.module
            for node in ast.walk(source.tree)
            if isinstance(node, ast.ImportFrom) and node.module
            for alias in node.names
        }
        for node in functions(source.tree):
            for it in node.decorator_list:
                if isinstance(it, ast.Call) and isinstance(it.func, ast.Attribute) and it.func.attr == "of":
                    owner = taken.get(getattr(it.func.value, "id", ""))
                    if owner and owner.rpartition(".")[2] != "law":
                        yield f"{source.at(node)}: a body of {it.func.value.id}, whose stub stands in {owner}"


RULES = [rule for name, rule in sorted(globals().items()) if name.startswith("rule_")]


def main() -> None:
    """Print what breaks each rule."""
    tree = Tree.at()
    for rule in RULES:
        broken = list(rule(tree))
        print(f"{rule.__name__}: {len(broken)}")
        for place in broken:
            print("   ", place)


if __name__ == "__main__":
    main()

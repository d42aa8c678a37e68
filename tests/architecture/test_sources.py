"""Every source is documented, annotated, short and finished; numba is configured in one place."""

import ast
import re
from collections.abc import Callable, Iterator

import pytest

from tests.architecture import rules
from tests.architecture.sources import ROOT, Source, functions, is_kernel, read, sources, written

LONGEST = 400
UNFINISHED = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b")
JIT = "porescale.common.compiled.jit"
COMPILING = tuple(
    f"porescale.common.compiled.{name}" for name in ("compiling", "library", "simd_code", "simd_rows_code")
)


def undocumented(source: Source) -> Iterator[str]:
    """Public modules, classes, functions and methods, and all kernels, that say nothing about themselves."""
    if source.text.strip() and ast.get_docstring(source.tree) is None:
        yield f"{source.path}: module"

    def look(body: list[ast.stmt], public: bool) -> Iterator[str]:
        for node in body:
            if isinstance(node, ast.If | ast.Try):
                yield from look(node.body, public)
            if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                continue
            known = public and not node.name.startswith("_")
            compiled = not isinstance(node, ast.ClassDef) and is_kernel(node)
            if (known or compiled) and not ast.get_docstring(node):
                yield f"{source.at(node)}: {node.name}"
            if isinstance(node, ast.ClassDef):
                yield from look(node.body, known)

    yield from look(source.tree.body, True)


def undocumented_within(source: Source) -> Iterator[str]:
    """Functions and classes within functions, but for kernels, that do not say what they are for."""

    def look(node: ast.AST, within: bool) -> Iterator[str]:
        """Those below a node; ``within`` : it lies in a function."""
        for child in ast.iter_child_nodes(node):
            function = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef)
            named = (function or isinstance(child, ast.ClassDef)) and not child.name.startswith("__")
            if within and named and not ast.get_docstring(child):
                yield f"{source.at(child)}: {child.name}"
            if not function or not is_kernel(child):
                yield from look(child, within or function)

    yield from look(source.tree, False)


def unannotated(source: Source) -> Iterator[str]:
    """Functions, but for kernels, with a parameter or result without a type; kernels with one."""
    methods = {
        node
        for owner in ast.walk(source.tree)
        if isinstance(owner, ast.ClassDef)
        for node in owner.body
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    }
    for node in functions(source.tree):
        given = node.args
        parameters = [*given.posonlyargs, *given.args, *given.kwonlyargs]
        parameters += [extra for extra in (given.vararg, given.kwarg) if extra is not None]
        if is_kernel(node):
            if node.returns or any(parameter.annotation for parameter in parameters):
                yield f"{source.at(node)}: kernel {node.name} is annotated"
            continue
        static = any(isinstance(it, ast.Name) and it.id == "staticmethod" for it in node.decorator_list)
        if node in methods and not static:
            parameters = parameters[1:]
        missing = [parameter.arg for parameter in parameters if parameter.annotation is None]
        if missing or node.returns is None:
            yield f"{source.at(node)}: {node.name}: {', '.join(missing) or 'its result'}"


def compiled_elsewhere(source: Source) -> Iterator[str]:
    """Imports of numba or llvmlite outside the modules that configure them and add to what kernels know."""
    for node, name in source.imports():
        if name.split(".")[0] in ("numba", "llvmlite") and source.module not in COMPILING:
            yield f"{source.at(node)}: imports {name}"


def too_long(source: Source) -> Iterator[str]:
    """Files that nobody reads to the end."""
    count = len(source.text.splitlines())
    if count > LONGEST:
        yield f"{source.path}: {count} lines"


def unfinished(source: Source) -> Iterator[str]:
    """Marks of work left undone, and errors swallowed whole."""
    for number, line in enumerate(source.text.splitlines(), 1):
        if UNFINISHED.search(line):
            yield f"{source.path}:{number}: {line.strip()}"
    for node in ast.walk(source.tree):
        if isinstance(node, ast.Name) and node.id == "NotImplementedError":
            yield f"{source.at(node)}: NotImplementedError"
        if isinstance(node, ast.ExceptHandler) and _catches_all(node) and _does_nothing(node):
            yield f"{source.at(node)}: swallows every exception"


def _catches_all(handler: ast.ExceptHandler) -> bool:
    kinds = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return any(
        kind is None or (isinstance(kind, ast.Name) and kind.id in ("Exception", "BaseException")) for kind in kinds
    )


def _does_nothing(handler: ast.ExceptHandler) -> bool:
    return all(isinstance(node, ast.Pass | ast.Continue | ast.Expr) for node in handler.body) and not any(
        isinstance(node, ast.Call) for node in ast.walk(handler)
    )


def skipped(source: Source) -> Iterator[str]:
    """Tests that do not run: skipped or expected to fail.  One reason is allowed, in one place: there is no browser."""
    for node in ast.walk(source.tree) if source.module != "tests.browser" else ():
        if isinstance(node, ast.Attribute) and node.attr in ("skip", "skipif", "xfail", "importorskip"):
            yield f"{source.at(node)}: {node.attr}"


PACKAGE_CHECKS = [undocumented, undocumented_within, unannotated, compiled_elsewhere, too_long, unfinished]


@pytest.mark.parametrize("check", PACKAGE_CHECKS, ids=lambda check: check.__name__)
def test_packages_are(check: Callable[[Source], Iterator[str]]) -> None:
    assert [fault for source in sources() for fault in check(source)] == []


@pytest.mark.parametrize("check", [undocumented, undocumented_within], ids=lambda check: check.__name__)
def test_scripts_of_cases_are(check: Callable[[Source], Iterator[str]]) -> None:
    assert [fault for source in sources(folders=("cases",)) for fault in check(source)] == []


@pytest.mark.parametrize("check", [too_long, skipped], ids=lambda check: check.__name__)
def test_tests_are_not(check: Callable[[Source], Iterator[str]]) -> None:
    assert [fault for source in sources(folders=("tests", "cases")) for fault in check(source)] == []


def test_no_folder_of_tests_or_cases_is_too_full() -> None:
    assert list(rules.crowded(sources(folders=("tests", "cases")))) == []
    full = [written(f"tests.one.file_{k}", "") for k in range(rules.MOST_FILES + 1)]
    assert list(rules.crowded(full)) == [f"tests/one: {len(full)} files"]
    assert list(rules.crowded(full[1:])) == []


def test_there_is_something_to_check() -> None:
    every = [node for source in sources() for node in functions(source.tree)]
    assert len(every) > 100
    assert sum(is_kernel(node) for node in every) > 10
    assert read(ROOT / "porescale" / "common" / "compiled" / "jit.py").module == JIT


DOC = '"""What it is."""\n'
BAD = [
    (undocumented, "x = 1"),
    (undocumented, DOC + "def f(): pass"),
    (undocumented, DOC + "class A:\n    pass"),
    (undocumented, DOC + "class A:\n    '''A.'''\n    def f(self): pass"),
    (undocumented, DOC + "@inline\ndef _f(x): return x"),
    (undocumented, DOC + "if x:\n    def f(): pass"),
    (undocumented_within, "def f():\n    def g(): pass"),
    (undocumented_within, "class A:\n    def f(self):\n        with x:\n            def _g(): pass"),
    (undocumented_within, "def f():\n    class A:\n        'A.'\n        def g(self): pass"),
    (unannotated, "def f(x) -> None: ..."),
    (unannotated, "def f(x: int): ..."),
    (unannotated, "def f(*x, y: int) -> None: ..."),
    (unannotated, "class A:\n    def f(self, x) -> None: ..."),
    (unannotated, "class A:\n    @staticmethod\n    def f(x) -> None: ..."),
    (unannotated, "def f() -> None:\n    def g(x) -> None: ..."),
    (unannotated, "@kernel\ndef f(x: float): ..."),
    (compiled_elsewhere, "import numba"),
    (compiled_elsewhere, "def f():\n    from numba.typed import List"),
    (compiled_elsewhere, "import llvmlite.binding as llvm"),
    (too_long, "x = 1\n" * (LONGEST + 1)),
    (unfinished, "x = 1  # TODO: more"),
    (unfinished, "raise NotImplementedError"),
    (unfinished, "raise NotImplementedError('x')"),
    (unfinished, "try:\n    f()\nexcept Exception:\n    pass"),
    (unfinished, "for x in y:\n    try:\n        f()\n    except:\n        continue"),
    (skipped, "@pytest.mark.skip\ndef test(): ..."),
    (skipped, "def test():\n    pytest.xfail('later')"),
]
GOOD = [
    (undocumented, ""),
    (undocumented, DOC + "def _f(): pass\nclass _A:\n    def f(self): pass"),
    (undocumented, DOC + "def f():\n    '''F.'''\n    def g(): pass"),
    (undocumented_within, "def f(): pass\nclass A:\n    def f(self): pass"),
    (undocumented_within, "def f():\n    def g(): 'G.'\n    return lambda: g()"),
    (undocumented_within, "def f():\n    class A:\n        'A.'\n        def __bool__(self): pass"),
    (undocumented_within, "@kernel\ndef f():\n    def g(): pass"),
    (unannotated, "def f(x: int, *y: int, **z: int) -> None: ..."),
    (unannotated, "class A:\n    def f(self) -> None: ...\n    @classmethod\n    def g(cls) -> None: ..."),
    (unannotated, "@kernel\ndef f(x):\n    def g(y): return y\n    return g(x)"),
    (compiled_elsewhere, "from porescale.common.compiled.jit import kernel"),
    (too_long, "x = 1\n" * LONGEST),
    (unfinished, "try:\n    f()\nexcept Exception as error:\n    note(error)"),
    (unfinished, "try:\n    f()\nexcept KeyError:\n    pass"),
]


@pytest.mark.parametrize(("check", "text"), BAD)
def test_a_bad_source_is_found(check: Callable[[Source], Iterator[str]], text: str) -> None:
    assert len(list(check(written("porescale.lbm.bad", text)))) == 1


@pytest.mark.parametrize(("check", "text"), GOOD)
def test_a_good_source_is_left_alone(check: Callable[[Source], Iterator[str]], text: str) -> None:
    assert list(check(written("porescale.lbm.good", text))) == []

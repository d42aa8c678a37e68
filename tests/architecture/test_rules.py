"""The tree keeps its rules, and each rule finds a tree that breaks it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from tests.architecture import rules
from tests.architecture.rules import RULES, Tree
from tests.architecture.sources import written

Rule = Callable[[Tree], Iterator[str]]


@pytest.fixture(scope="module")
def tree() -> Tree:
    return Tree.at()


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.__name__)
def test_the_tree_keeps(rule: Rule, tree: Tree) -> None:
    assert list(rule(tree)) == []


def test_there_is_something_to_check(tree: Tree) -> None:
    assert len(tree.modules) > 300
    assert len(tree.with_kernels) > 50
    assert sum(map(len, tree.imports.values())) > 1000


KERNEL = "from porescale.common.compiled.jit import kernel\n@kernel\ndef f(x):\n    return x\n"
MANY = ", ".join(f"a{k}" for k in range(13))
UP = "def f():\n    from porescale.builders import build"
TYPE_CHECKING = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from porescale.dem.a import A"
BODY_ELSEWHERE = "from porescale.dem.grains import force\n@force.of(A)\ndef body(x, law): ..."
BODY_OF_LAW = "from porescale.dem.law import force\n@force.of(A)\ndef body(x): ..."
NEW_SIDES = 'class Glass:\n    name = "glass"\nclass Wall:\n    name = "wall"'
WRONG = [
    (rules.rule_1_common_stands_alone, {"porescale.common.record.drive": "import porescale.lbm.fluid"}),
    (rules.rule_1_common_stands_alone, {"porescale.common.core.units": UP}),
    (rules.rule_1_common_stands_alone, {"continuum_sph.water.step": "from porescale.lbm import fluid"}),
    (rules.rule_1_common_stands_alone, {"porescale.cli.main": "import continuum_sph.water.step"}),
    (rules.rule_2_evidence_apart, {"porescale.lbm.fluid": "from porescale.validation.lbm import channels"}),
    (rules.rule_2_evidence_apart, {"porescale.builders.build": "from porescale.benchmarks import lbm"}),
    (rules.rule_2_evidence_apart, {"porescale.lbm.fluid": "from porescale.dem import grains"}),
    (rules.rule_2_evidence_apart, {"porescale.dem.grains": "from porescale.coupling import step"}),
    (rules.rule_2_evidence_apart, {"porescale.dem.grains": "from porescale.common.record import drive"}),
    (rules.rule_2_evidence_apart, {"continuum_sph.water.step": "from continuum_sph.soil import flow"}),
    (rules.rule_2_evidence_apart, {"porescale.piv.fields.field": "from ...scene import fluid"}),
    (rules.rule_3_sections_hold_no_kernel, {"porescale.scene.fluid": KERNEL}),
    (
        rules.rule_3_sections_hold_no_kernel,
        {"porescale.scene.fluid": "from porescale.builders import build", "porescale.builders.build": KERNEL},
    ),
    (rules.rule_4_no_circles, {"porescale.dem.a": "from porescale.dem import b", "porescale.dem.b": TYPE_CHECKING}),
    (
        rules.rule_4_no_circles,
        {
            "porescale.dem.a": "import porescale.dem.b",
            "porescale.dem.b": "import porescale.dem.c",
            "porescale.dem.c": "def f():\n    from porescale.dem import a",
        },
    ),
    (rules.rule_5_nothing_too_large, {f"porescale.dem.file_{k}": "" for k in range(21)}),
    (rules.rule_5_nothing_too_large, {"porescale.dem.long": "x = 1\n" * 401}),
    (rules.rule_5_nothing_too_large, {"porescale.dem.wide": f"@kernel\ndef f({MANY}):\n    'Sum.'\n"}),
    (rules.rule_5_nothing_too_large, {"porescale.dem.tall": "@kernel\ndef f(x):\n" + "    x = x + 1\n" * 80}),
    (rules.rule_5_nothing_too_large, {"porescale.cli.wide": "def f(a, b, c, d, e, f, g, h, i): ..."}),
    (
        rules.rule_6_kernels_stand_on_kernels,
        {"porescale.dem.step": "from porescale.scene.fluid import X\n" + KERNEL, "porescale.scene.fluid": "X = 1"},
    ),
    (
        rules.rule_6_kernels_stand_on_kernels,
        {
            "porescale.dem.step": "from porescale.dem.other import X\n" + KERNEL,
            "porescale.dem.other": "from porescale.builders.report import X",
            "porescale.builders.report": "X = 1",
        },
    ),
    (
        rules.rule_7_laws_decide_themselves,
        {"porescale.dem.contact.law_of_glue": 'name: str = "glue"', "porescale.builders.build": 'x = y.law == "glue"'},
    ),
    (
        rules.rule_7_laws_decide_themselves,
        {"porescale.lbm.collision.new": 'OPERATOR = Row(name="new")', "porescale.lbm.fluid": 'x = y in ("new", "old")'},
    ),
    *(
        (rules.rule_7_laws_decide_themselves, {"porescale.lbm.boundary.new": NEW_SIDES, "porescale.builders.build": it})
        for it in (
            'x = side.kind == "wall"',
            'x = "glass" in (left, right)',
            'x = scene["left"]["kind"] != "wall"',
            'match side:\n    case "glass":\n        x = 1',
            'match it.kind:\n    case "slip" | "wall":\n        x = 1',
        )
    ),
    (rules.rule_8_stubs_are_contracts, {"porescale.dem.step": BODY_ELSEWHERE}),
]
PRESENT = (
    "porescale.common.compiled.jit", "porescale.lbm.fluid", "porescale.builders.build", "porescale.benchmarks.lbm",
    "porescale.validation.lbm.channels", "porescale.dem.grains", "porescale.coupling.step", "porescale.scene.fluid",
    "porescale.common.record.drive", "continuum_sph.water.step", "continuum_sph.soil.flow",
)  # fmt: skip


def made(modules: dict[str, str]) -> Tree:
    return Tree([written(module, text) for module, text in {**dict.fromkeys(PRESENT, ""), **modules}.items()])


@pytest.mark.parametrize(("rule", "modules"), WRONG)
def test_a_wrong_tree_is_found(rule: Rule, modules: dict[str, str]) -> None:
    assert list(rule(made(modules)))


def test_the_tree_that_the_wrong_ones_differ_from_is_right() -> None:
    assert [list(rule(made({}))) for rule in RULES] == [[] for _ in RULES]


@pytest.mark.parametrize(
    "modules",
    [
        {"porescale.coupling.step": "from porescale.lbm import fluid\nfrom porescale.dem import grains"},
        {"porescale.cli.verify": "from porescale.validation.lbm import channels"},
        {"porescale.dem.wide": f"@kernel\ndef f({MANY}):\n    'Sum.  Flat arguments: bundles cost 7 % of the rate.'\n"},
        {"porescale.cli.options": "def f(a, *, b, c, d, e, f, g, h, i, j): ..."},
        {"porescale.dem.law": "", "porescale.dem.a": BODY_OF_LAW},
        {"porescale.lbm.boundary.new": NEW_SIDES, "porescale.cli.a": 'x = surface == "wall"'},
        {"porescale.lbm.boundary.new": NEW_SIDES, "porescale.dem.a": 'x = kind == "glass"'},
        {"porescale.dem.a": "@law_function\ndef force(x): ...\n@force.of(A)\ndef body(x): ..."},
    ],
)
def test_a_right_tree_passes(modules: dict[str, str]) -> None:
    assert [list(rule(made(modules))) for rule in RULES] == [[] for _ in RULES]

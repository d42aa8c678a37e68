"""A law or a case dropped as one file into its folder is offered by the command line, and runs."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.reference.folders import ROOT
from tests.reference.waiting import done

LAWS = {
    "lbm/collision/shear_only.py": '''
"""Everything at the rate of the shear: BGK by another name."""
from typing import NamedTuple

import numpy as np

from porescale.lbm.collision.entry import Operator
from porescale.lbm.collision.law import (
    collide, collide_partial, collide_then_add, half_force, half_of_force, molecular_rate, shear_rate,
)
from porescale.lbm.collision.smagorinsky import eddy_version
from porescale.lbm.collision.trt import relax_halves


class ShearOnly(NamedTuple):
    rate: np.floating
    fx: np.floating
    fy: np.floating


EddyShearOnly = eddy_version(ShearOnly)
half_force.of(ShearOnly, EddyShearOnly)(half_of_force)
shear_rate.of(ShearOnly)(molecular_rate)
collide_partial.of(ShearOnly, EddyShearOnly)(collide_then_add)


@collide.of(ShearOnly, EddyShearOnly)
def _collide(f, m, rate, law):
    return relax_halves(f, m, rate, rate, law)


OPERATOR = Operator("shear-only", "for a test", ShearOnly, EddyShearOnly, lambda law: float(law.rate))
''',
    "coupling/solid/half_bounce.py": '''
"""SC3 at half of its weight, by another name."""
from typing import NamedTuple

import numpy as np

from porescale.coupling.solid.entry import SolidOperator
from porescale.coupling.solid.law import (
    blend, collide_then_blend, collide_with_solid, force_share, free_share, is_soft, momentum_to_solid, no_rates,
    rates, sharp,
)
from porescale.lbm.collision.law import Partial, add_partial, numbers


class HalfBounce(NamedTuple):
    k: np.floating


collide_with_solid.of(HalfBounce)(collide_then_blend)
force_share.of(HalfBounce)(free_share)
is_soft.of(HalfBounce)(sharp)
rates.of(HalfBounce)(no_rates)


@blend.of(HalfBounce)
def _blend(f, g, cell, m, rate, solid):
    c = numbers(cell.b)
    free, rho = c.one - cell.b, c.one + m.d
    px, py = cell.b * rho * cell.vx, cell.b * rho * cell.vy
    return add_partial(f, g, Partial(free, free, c.zero, px, py))


@momentum_to_solid.of(HalfBounce)
def _momentum_to_solid(cell, rho, jx, jy, rate, solid):
    return cell.b * rho, cell.b * jx, cell.b * jy


SOLID_OPERATOR = SolidOperator("half-bounce", "for a test", HalfBounce)
''',
    "coupling/weighting/square.py": '''
"""The square of the solid fraction."""
from typing import NamedTuple

import numpy as np

from porescale.coupling.weighting.entry import Weighting
from porescale.coupling.weighting.law import weight
from porescale.lbm.collision.law import numbers


class Square(NamedTuple):
    k: np.floating


@weight.of(Square)
def _weight(solid, theta, slip_x, slip_y, law):
    e = min(numbers(solid).one, solid)
    return e * e


WEIGHTING = Weighting("square", "for a test", Square)
''',
    "dem/contact/stiffening.py": '''
"""A spring that is twice as stiff where the overlap is the reduced radius: k d (1 + d/R)."""
from dataclasses import dataclass
from typing import ClassVar

from porescale.dem.contact.law import (
    CN, CR, CT, KN, KernelLaw, history_scaling, stiffness, stiffness_scale, stored_normal,
)
from porescale.dem.contact.linear import Linear


class StiffeningKernel(KernelLaw):
    """The law as kernels take it."""


@stiffness.of(StiffeningKernel)
def _stiffness(overlap, radius, mass, p, law):
    return p[KN] * overlap * (1.0 + overlap / radius), p[CN], 1.0, 1.0, p[CT], p[CR]


@stiffness_scale.of(StiffeningKernel)
def _stiffness_scale(overlap, radius, law):
    return 1.0


@history_scaling.of(StiffeningKernel)
def _history_scaling(overlap, closing, dt, law):
    return 1.0


@stored_normal.of(StiffeningKernel)
def _stored_normal(overlap, radius, p, law):
    return p[KN] * overlap * overlap * (0.5 + overlap / (3.0 * radius))


@dataclass(frozen=True)
class Stiffening(Linear):
    name: ClassVar = "stiffening"
    order: ClassVar = 100
    purpose: ClassVar = "for a test"
    kernel: ClassVar = StiffeningKernel


LAW = Stiffening
''',
    "lbm/boundary/belt.py": '''
"""A wall by another name, which slides along itself."""
from porescale.lbm.boundary.wall import Wall


class Belt(Wall):
    name = "belt"
    purpose = "for a test"
    order, precedence = 100, 1


BOUNDARY = Belt()
''',
}

SCENE = """
title = "A disc held beside a belt"
[domain]
width = 0.02
height = 0.02
left = "periodic"
right = "periodic"
bottom = "wall"
top = {{ kind = "{side}", speed = 0.01 }}
[time]
end = 0.02
[output]
snapshot_interval = 0.02
series_interval = 0.01
[fluid]
spacing = 1e-3
step = 1e-3
relaxation_time = 0.8
operator = "{operator}"
solid_operator = "{solid_operator}"
weighting = "{weighting}"
[[disc]]
x = 0.01
y = 0.01
diameter = 0.006
"""
DRY = """
title = "A grain that falls on the floor"
[domain]
width = 0.01
height = 0.01
[time]
end = 0.04
[output]
snapshot_interval = 0.04
series_interval = 0.01
[grains]
density = 2500
[[grains.grain]]
x = 0.005
y = 0.0035
diameter = 0.002
[contact]
law = "{law}"
stiffness = 1e4
restitution = 0.8
"""
NAMES = {
    "operator": "shear-only", "solid_operator": "half-bounce", "weighting": "square", "side": "belt",
    "law": "stiffening",
}  # fmt: skip


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package, its cases and their fingerprints, with a file more for each law and a case more."""
    root = tmp_path_factory.mktemp("tree")
    shutil.copytree(ROOT / "porescale", root / "porescale")  # with its bytecode
    for place, text in LAWS.items():
        (root / "porescale" / place).write_text(text, encoding="utf-8")
    for place in ("cases", "tests/fingerprints"):
        shutil.copytree(ROOT / place, root / place, ignore=shutil.ignore_patterns("*.png", "__pycache__"))
    scene(root / "cases" / "bounce", DRY, law="linear")
    return root


def porescale(tree: Path, *words: object) -> subprocess.CompletedProcess[str]:
    """The command line of that tree."""
    return done([sys.executable, "-m", "porescale", *words], cwd=tree, env={**os.environ, "PYTHONPATH": str(tree)})


def scene(folder: Path, text: str = SCENE, **names: str) -> Path:
    """A scene with these laws."""
    folder.mkdir()
    (folder / "scene.toml").write_text(text.format(**{**NAMES, **names}), encoding="utf-8")
    return folder


CHECKS = """
import sys
from porescale.cli.main import commands
from porescale.common.cli.application import main
sys.stderr = sys.stdout
for scene in sys.argv[1:]:
    code = main(commands(), ["check", scene])
    print("\\0", code, "\\0", sep="", end="")
"""


def checked(tree: Path, scenes: list[Path]) -> dict[str, tuple[int, str]]:
    """Exit code of `check` of that tree, and what it says, by names of the scenes' folders; in one process."""
    ended = done([sys.executable, "-c", CHECKS, *scenes], cwd=tree, env={**os.environ, "PYTHONPATH": str(tree)})
    said, codes = ended.stdout.split("\0")[:-1:2], ended.stdout.split("\0")[1::2]
    return {it.name: (int(code), words) for it, code, words in zip(scenes, codes, said, strict=True)}


@pytest.fixture(scope="module")
def answers(tree: Path, tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, tuple[int, str]]]:
    """What `check` says of scenes that name a law there is none of, by its key: that tree's, and ours."""
    wrong = tmp_path_factory.mktemp("wrong")
    scenes = [scene(wrong / key, DRY if key == "law" else SCENE, **{key: "nonsense"}) for key in NAMES]
    return [checked(root, scenes) for root in (tree, ROOT)]


@pytest.mark.parametrize("key", NAMES)
def test_check_offers_a_law_that_was_dropped_into_its_folder(
    answers: list[dict[str, tuple[int, str]]], key: str
) -> None:
    (code, said), (_, ours) = (it[key] for it in answers)
    assert code == 2
    assert NAMES[key] in said
    assert NAMES[key] not in ours.replace(f'"{NAMES[key]}"', "")


def test_new_offers_them_too(tree: Path, tmp_path: Path) -> None:
    assert porescale(tree, "new", tmp_path / "a").returncode == 0
    text = (tmp_path / "a" / "scene.toml").read_text(encoding="utf-8")
    assert all(name in text for name in NAMES.values())


@pytest.mark.slow
def test_a_contact_law_that_was_dropped_runs(tree: Path, tmp_path: Path) -> None:
    rows = []
    for law in ("linear", NAMES["law"]):
        ended = porescale(tree, "run", scene(tmp_path / law, DRY, law=law), "--quiet")
        assert ended.returncode == 0, ended.stdout + ended.stderr
        rows.append((tree / "runs" / law / "series.csv").read_text(encoding="utf-8"))
    assert rows[0] != rows[1]  # a bounce from another spring


def test_they_run(tree: Path, tmp_path: Path) -> None:
    ended = porescale(tree, "run", scene(tmp_path / "all"), "--quiet")
    assert ended.returncode == 0, ended.stdout + ended.stderr


def test_a_case_is_a_scene_in_a_folder(tree: Path) -> None:
    assert porescale(tree, "check", "cases/bounce").returncode == 0
    ended = porescale(tree, "run", "cases/bounce", "--quiet")
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert (tree / "runs" / "bounce" / "montage.png").exists()
    words = ["write", "scene/bounce", "--threads", "1", "--record", "x.json"]
    taken = [sys.executable, "-m", "tests.fingerprints", *words]
    ended = done(taken, cwd=tree, env={**os.environ, "PYTHONPATH": str(tree)})
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert '"scene/bounce"' in (tree / "x.json").read_text(encoding="utf-8")

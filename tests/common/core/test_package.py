"""The package as it is built and installed: its files, its one version, and that it runs where no checkout is."""

import ast
import importlib.metadata
import json
import os
import re
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path

import pytest

import continuum_sph
import porescale
from porescale.common.compiled.jit import source_hash
from porescale.common.core.version import VERSION
from tests.reference.folders import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
LIMIT = 300  # seconds that any command here may take
NOT_INSTALLED = (".png", "recorded.json", ".pyc")


def tracked(*folders: str) -> set[str]:
    """Files of the checkout that git knows or would take."""
    words = ["git", "-C", str(ROOT), "ls-files", "--cached", "--others", "--exclude-standard", *folders]
    done = subprocess.run(words, capture_output=True, text=True, check=True, timeout=LIMIT)
    return {name for name in done.stdout.splitlines() if (ROOT / name).is_file()}


def expected_files() -> set[str]:
    """What a wheel must hold besides its metadata."""
    wanted = {name for name in tracked("porescale", "continuum_sph", "cases") if not name.endswith(NOT_INSTALLED)}
    return {re.sub("^cases/", "porescale_cases/", name) for name in wanted}


def build(target: str, folder: Path, source: Path = ROOT) -> Path:
    """The wheel or sdist of a source tree, built in this environment: nothing is downloaded."""
    words = [sys.executable, "-m", "hatchling", "build", "-t", target, "-d", str(folder)]
    subprocess.run(words, cwd=source, check=True, capture_output=True, timeout=LIMIT)
    (made,) = folder.iterdir()
    return made


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    return build("wheel", tmp_path_factory.mktemp("wheel"))


def files_of(wheel: Path) -> set[str]:
    with zipfile.ZipFile(wheel) as content:
        return {name for name in content.namelist() if ".dist-info/" not in name}


def test_a_wheel_holds_both_packages_and_the_cases_and_nothing_else(wheel):
    found = files_of(wheel)
    assert found == expected_files()
    assert {"porescale/py.typed", "continuum_sph/py.typed", "porescale/__init__.pyi", "continuum_sph/__init__.pyi",
            "porescale_cases/column_collapse/scene.toml", "porescale_cases/demseg_chain/pulled/in_gm.dat",
            "porescale/cli/template.toml"} <= found  # fmt: skip
    assert not [name for name in found if "tests/" in name or name.endswith(NOT_INSTALLED)]
    assert found - {"porescale/py.typed"} != expected_files()  # a wheel that lacks a file would be noticed


def test_a_wheel_is_small(wheel):
    # Text packs to 0.36, and 1100 files want 0.2 MB of names; pictures of the cases, 7 MB, do not pack: with them 0.75.
    with zipfile.ZipFile(wheel) as content:
        text = sum(it.file_size for it in content.infolist())
    assert wheel.stat().st_size < 0.5 * text


def test_an_sdist_has_what_a_wheel_needs(wheel, tmp_path):
    packed = build("sdist", tmp_path / "sdist")
    subprocess.run([sys.executable, "-m", "tarfile", "-e", str(packed), str(tmp_path)], check=True, timeout=LIMIT)
    unpacked = tmp_path / packed.name.removesuffix(".tar.gz")
    again = build("wheel", tmp_path / "wheel", unpacked)
    assert again.name == wheel.name
    assert (
        again.read_bytes() == wheel.read_bytes()
    )  # hatchling leaves out times and places: the same wheel, bit for bit


def test_a_wheel_says_what_the_project_says(wheel):
    with zipfile.ZipFile(wheel) as content:
        (name,) = (it for it in content.namelist() if it.endswith("METADATA"))
        text = content.read(name).decode()
    assert f"\nVersion: {VERSION}\n" in text
    assert "\nRequires-Python: >=3.11\n" in text
    assert "Classifier: Private :: Do Not Upload" in text  # while there is no licence
    assert "\nLicense" not in text


def test_there_is_one_version():
    assert porescale.__version__ == continuum_sph.__version__ == VERSION
    assert "version" not in PROJECT["project"]
    assert PROJECT["project"]["dynamic"] == ["version"]
    assert (ROOT / PROJECT["tool"]["hatch"]["version"]["path"]).read_text(encoding="utf-8").count(f'"{VERSION}"') == 1
    cited = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {VERSION}\n" in cited
    # an environment that was made for an older version: make it again (pip install -e '.[test]')
    assert importlib.metadata.version("porescale") == VERSION


def test_metadata_and_citation_say_the_same():
    cited = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    words = re.search(r"^keywords:\n((?:  - .+\n)+)", cited, re.MULTILINE)
    assert words is not None
    assert PROJECT["project"]["keywords"] == [line.strip("- ") for line in words[1].splitlines()]
    assert [it["name"] for it in PROJECT["project"]["authors"]] == re.findall(
        r'^  - name: "(.+)"$', cited, re.MULTILINE
    )


def imported(folder: Path) -> set[str]:
    """Top names of the modules that the sources in a folder import, anywhere in them, but for Python's own."""
    found = set()
    for path in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                found |= {name.name.partition(".")[0] for name in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                found.add(node.module.partition(".")[0])
    return found - set(sys.stdlib_module_names) - {"porescale", "continuum_sph"}


def named(requirements: list[str]) -> set[str]:
    """Names of packages in a list of requirements, as they are compared."""
    return {re.split(r"[\[<>=!~ ;]", it)[0].lower().replace("_", "-") for it in requirements}


MODULES = {
    "cv2": "opencv-python-headless", "PIL": "pillow", "lazy_loader": "lazy-loader", "tomli_w": "tomli-w",
    "contourpy": "matplotlib", "pydantic_core": "pydantic",
}  # fmt: skip
"""Packages of modules that are called otherwise, or that come with them."""


def undeclared(modules: set[str]) -> set[str]:
    """Modules that no dependency and no extra for users brings (that of the manual is for its builder)."""
    extras = PROJECT["project"]["optional-dependencies"]
    declared = named(
        [
            *PROJECT["project"]["dependencies"],
            *(it for key in extras if key not in ("test", "docs") for it in extras[key]),
        ]
    )
    return {it for it in modules if MODULES.get(it, it) not in declared}


def test_whatever_is_imported_is_a_dependency():
    modules = imported(ROOT / "porescale") | imported(ROOT / "continuum_sph")
    assert {"numpy", "numba", "llvmlite", "cv2", "psutil", "filelock"} <= modules
    assert undeclared(modules) == set()
    assert undeclared({*modules, "shapely"}) == {"shapely"}  # tests alone have it


def test_whatever_is_a_dependency_is_imported():
    modules = imported(ROOT / "porescale") | imported(ROOT / "continuum_sph")
    used = {MODULES.get(it, it) for it in modules}
    assert named(PROJECT["project"]["dependencies"]) - used == set()


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """Runs Python where the wheel is installed, not the checkout: the other packages are this environment's."""
    place, folder = tmp_path_factory.mktemp("installed"), tmp_path_factory.mktemp("work")
    words = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "-q",
        "--no-index",
        "--no-deps",
        "--target",
        str(place),
        str(wheel),
    ]
    subprocess.run(words, check=True, capture_output=True, timeout=LIMIT)
    # Files *.pth of folders on PYTHONPATH are not read: an editable install of the checkout is not found there.
    paths = os.pathsep.join([str(place), sysconfig.get_path("purelib"), sysconfig.get_path("platlib")])
    environment = {**os.environ, "PYTHONPATH": paths}

    def run(*words: str) -> str:
        done = subprocess.run(
            [sys.executable, "-S", *words], cwd=folder, env=environment, capture_output=True, text=True, timeout=LIMIT
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    run.place, run.folder = place, folder
    return run


def test_an_installed_wheel_finds_its_cases(installed):
    listed = json.loads(installed("-m", "porescale", "cases", "--json"))
    assert len(listed) == len(porescale.cases())
    assert all(Path(it["path"]).is_relative_to(installed.place) for it in listed)
    assert "Underwater column collapse" in installed("-m", "porescale", "check", "column_collapse")
    assert "water" in installed("-m", "continuum_sph", "check", "collapsing_water_column")
    own = "import continuum_sph, porescale; print(continuum_sph.__file__, porescale.__file__)"
    assert installed("-c", own).count(str(installed.place)) == 2


@pytest.mark.slow
def test_an_installed_wheel_runs_a_case(installed):
    installed("-m", "porescale", "run", "column_collapse", "--quality", "draft", "--set", "time.end=0.01", "--quiet")
    card = json.loads((installed.folder / "runs" / "column_collapse" / "card.json").read_text(encoding="utf-8"))
    assert (card["outcome"], card["versions"]["porescale"]) == ("finished", VERSION)
    assert card["commit"] is None  # an installed package lies in no checkout; its sources have the checkout's hash
    assert card["sources"] == source_hash()

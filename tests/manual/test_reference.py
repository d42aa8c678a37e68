"""The reference that is made from the source lacks nothing."""

import re

import pytest

import continuum_sph
import porescale
from docs._ext.made import columns, commands, filled, gallery, messages, names, scene_keys
from docs._ext.made.columns import Column
from porescale.common.schema.messages import every_key
from tests.architecture.sources import exports
from tests.architecture.test_readme import KNOWN
from tests.reference.folders import ROOT

PACKAGES = {"porescale": porescale, "continuum_sph": continuum_sph}


@pytest.mark.parametrize("package", PACKAGES)
def test_every_key_of_a_scene_is_there(package):
    page = scene_keys.page(package)
    keys = {key[-1] for key in every_key(scene_keys.scene_of(package))} - {"own"}  # whose numbers stand in its section
    lost = {key for key in keys if f"| `{key}` |" not in page and f"[{key}]" not in page}
    assert lost == set()
    assert page.count("\n| `") > 100
    # Every key says what it is.
    silent = [line for line in page.splitlines() if line.startswith("| `") and line.count(" | ") == 5
              and not line.split(" | ")[4].strip()]  # fmt: skip
    assert silent == []


@pytest.mark.parametrize("package", PACKAGES)
def test_every_command_is_there(package):
    page = commands.page(package)
    ours = {name for name in KNOWN if name.startswith(f"{package.replace('_', '-')} ")}
    assert {name for name in ours if f"# {name}\n" not in page} == set()
    assert "`--quality`" in page


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_is_there(package):
    page = names.page(package) + names.page(f"{package}.*")
    for module, known in exports(folders=(package,)).items():
        assert [name for name in known if f"{module}.{name}" not in page] == []


def test_every_column_is_described():
    assert columns.undescribed() == []
    # The check that must fail: a column that no docstring has.
    known = [Column("front", "m", "edge"), Column("NAME pressure", "Pa", "there")]
    assert columns.is_known("front (m)", known)
    assert columns.is_known("\0 pressure (Pa)", known)
    assert not columns.is_known("front (cm)", known)
    assert not columns.is_known("fronts (m)", known)


@pytest.mark.parametrize(
    ("package", "case"), [("porescale", "settling_disc"), ("porescale", "cylinder_in_channel"),
                          ("continuum_sph", "hydrostatic_column")],
)  # fmt: skip
def test_the_columns_of_a_simulation_are_described(package, case):
    program = PACKAGES[package]
    simulation = program.build(program.load(case, quality=None))
    for table, row in {"series": simulation.series(), **simulation.tables()}.items():
        known = columns.columns(package, f"{table}.csv")
        assert [name for name in row if not columns.is_known(name, known)] == []
        assert len(row) > 1


def test_messages_are_found_with_their_repair():
    found = messages.collected()
    assert len(found) > 600
    known = {(it.text, it.repair) for it in found}
    assert ("varies nothing", "give a table, --vary section.key=a,b,c, or --repeat N") in known
    assert any(it.kind == "warning" for it in found)
    assert any(it.kind == "stop" for it in found)
    # What is known only in a run is an ellipsis, and no name of a variable is left.
    assert not [it for it in found if re.search(r"\{\w+\}", it.text) and "{ kind" not in it.text]


def test_a_page_is_filled():
    assert "porescale run" in filled("# x\n\n<!-- made: commands porescale -->\n")
    with pytest.raises(KeyError):
        filled("<!-- made: nothing at all -->\n")


def test_every_topic_of_cases_has_a_page():
    pages = [path.read_text(encoding="utf-8") for path in (ROOT / "docs" / "gallery").glob("*.md")]
    wanted = {title for page in pages for title in re.findall(r"^<!-- made: gallery (.*) -->$", page, re.MULTILINE)}
    assert wanted == set(gallery.topics())
    shown = {case for lines in gallery.topics().values() for cases, _ in lines for case in cases}
    assert shown == {path.parent.name for path in (ROOT / "cases").glob("*/README.md")}
    assert "picture.png" in gallery.entry("piston", "a piston")
    assert "porescale run cases/piston" in gallery.entry("piston", "a piston")

"""`check` warns of nothing in the scenes of cases, but where a number cannot be trusted at that resolution."""

import tomllib

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import load
from tests.reference.folders import CASES

FEW_CELLS = "cells per diameter in a bed"
"""Drag in a bed is off by a tenth or more: with the cells that would mend it a run takes twice the time at least, a
collapse at draft quality about a hundred times."""
WARNED: dict[tuple[str, str | None], str] = {
    ("column_collapse/scene.toml", "draft"): FEW_CELLS,
    ("column_collapse/scene.toml", "standard"): FEW_CELLS,
    ("column_collapse/scene.toml", "fine"): FEW_CELLS,
    ("column_collapse_tank/scene.toml", "draft"): FEW_CELLS,
    ("lifting_gate/scene.toml", "draft"): FEW_CELLS,
    ("lifting_gate/scene.toml", "standard"): FEW_CELLS,
    ("loose_and_dense_collapse/scene.toml", "draft"): FEW_CELLS,
    ("loose_and_dense_collapse/scene.toml", "standard"): FEW_CELLS,
    ("loose_and_dense_collapse/scene.toml", "fine"): FEW_CELLS,
    ("micro_to_macro/bed.toml", "draft"): FEW_CELLS,
    ("micro_to_macro/slope.toml", "draft"): FEW_CELLS,
    ("micro_to_macro/squeezed.toml", None): FEW_CELLS,
    ("permeameter/scene.toml", "draft"): FEW_CELLS,
}
"""What is warned of, by scene and quality: all of it, in one line each."""
REFUSED = "column_collapse_table1/scene.toml"
"""Saito et al., table 1, as printed: the case shows how it is refused."""


def scenes() -> list[tuple[str, str | None]]:
    """Scene files below cases, each at all of its qualities, or at None where it has none."""
    found = []
    for file in sorted(CASES.glob("*/*.toml")):
        table = tomllib.loads(file.read_text(encoding="utf-8"))
        name = file.relative_to(CASES).as_posix()
        if table.keys() & {"tank", "domain"} and name != REFUSED:
            found += [(name, quality) for quality in table.get("quality", [None])]
    return found


def warned(name: str, quality: str | None, *settings: str) -> list[str]:
    """What `check` warns of in a scene of the cases."""
    table = tomllib.loads((CASES / name).read_text(encoding="utf-8"))
    package = CONTINUUM if "tank" in table else PORESCALE
    scene = load(CASES / name, package.scene(), quality=quality, overrides=settings)
    return list(package.report_of(scene).warnings)


@pytest.mark.parametrize(("name", "quality"), scenes())
def test_check_warns_of_nothing_that_is_not_known(name, quality):
    said, known = warned(name, quality), WARNED.get((name, quality))
    if known is None:
        assert said == []
    else:
        (line,) = said
        assert known in line


def test_all_that_is_known_to_be_warned_of_is_a_scene():
    assert set(WARNED) <= set(scenes())
    with pytest.raises(InputError):
        warned(REFUSED, None)


@pytest.mark.parametrize(
    ("name", "quality", "setting", "word"),
    [
        ("bubble_in_water/scene.toml", "draft", "water.sound_speed=26.5", "Mach number"),
        ("bubble_in_water/scene.toml", "draft", "numerics.shifting=1", "swells"),
        ("dry_levee/scene.toml", "draft", "numerics.shifting=1", "fastest water"),
        ("levee_by_suction/scene.toml", "draft", "soil.stiffness=5e5", "raise soil.stiffness"),
        ("levee_by_suction/scene.toml", "draft", "numerics.spacing=0.08", "capillary height"),
        ("lid_driven_cavity/scene.toml", "draft", "fluid.step=1.5625e-3", "Mach"),
    ],
)
def test_it_still_warns_of_what_these_scenes_were_warned_of(name, quality, setting, word):
    assert any(word in text for text in warned(name, quality, setting))

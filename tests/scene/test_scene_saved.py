"""Every scene of the cases of both packages, at each of its levels: saved, loaded, pickled, shown."""

import pickle
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import continuum_sph
import porescale

CASES = Path(__file__).resolve().parents[2] / "cases"
NO_SCENES = ("expected.toml", "trade.toml", "material.toml", "rates.toml")
FILES = [file for file in sorted(CASES.glob("*/*.toml")) if file.name not in NO_SCENES]


def package(file: Path) -> ModuleType:
    """The package that the scene is of."""
    return continuum_sph if "[tank]" in file.read_text(encoding="utf-8") else porescale


def plain(scene: Any) -> dict[str, Any]:
    """The keys of a scene but for names of files, which are as seen from its folder: origin of the soil, own law."""
    found: dict[str, Any] = scene.to_dict() | {"soil": None}
    contact = found.get("contact")
    if contact and ".py:" in contact["law"]:
        found["contact"] = contact | {"law": contact["law"].rpartition("/")[2]}
    return found


@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}/{file.stem}")
def test_every_scene_is_the_same_when_saved_at_each_level(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(file.parent)  # files that a scene of Python names are looked for there
    ps = package(file)
    if file.parent.name == "column_collapse_table1":  # which contradicts itself on purpose
        with pytest.raises(ps.InputError, match="imply"):
            ps.load(file)
        return
    default = ps.load(file)
    for level in default.source.levels or (None,):
        scene = ps.load(file, quality=level)
        saved = ps.load(scene.save(tmp_path / f"{level}.toml"))
        assert saved == scene
        assert plain(saved) == plain(scene)
        assert hash(saved) == hash(scene)
        assert pickle.loads(pickle.dumps(scene)) == scene
        assert ps.Scene(**scene.to_dict()) == scene
        assert not ps.diff(scene, saved)
        longer = scene.with_({"time.end": 2.0 * scene.time.end})
        assert list(ps.diff(scene, longer)) == ["time.end"]  # the check that must fail
        assert len(repr(scene).splitlines()) <= 3
        assert scene._repr_html_().startswith("<table>")

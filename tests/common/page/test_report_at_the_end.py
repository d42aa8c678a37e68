"""A run leaves its page beside its pictures, unless its scene wants none."""

import pytest


@pytest.mark.parametrize("module", ["porescale.program", "continuum_sph.program"])
@pytest.mark.parametrize(("wanted", "pictures"), [(True, True), (False, True), (True, False)])
def test_a_run_leaves_its_page_with_its_pictures_unless_it_shall_not(monkeypatch, tmp_path, module, wanted, pictures):
    from importlib import import_module
    from types import SimpleNamespace

    program, pages, ends = import_module(module), [], []
    monkeypatch.setattr("porescale.common.page.page.write_report", lambda folder, _: pages.append(folder))
    monkeypatch.setattr(program, "show", lambda folder: [folder / "film.mp4"] if pictures else [])
    for patched in ("analysis.bed_permeability.write_permeability", "common.record.open_run.open_run"):
        monkeypatch.setattr(f"porescale.{patched}", lambda *_: None)
    monkeypatch.setattr("porescale.builders.cost.work", lambda *_: None)
    monkeypatch.setattr(program, "report", lambda _: SimpleNamespace(work=0))
    name = "porescale.common.api.run_scene.drive_scene" if module == "porescale.program" else f"{module}.drive_scene"
    monkeypatch.setattr(name, lambda *_, after, **more: ends.append(after))
    scene = SimpleNamespace(grains=None, polygon=(), run=None, output=SimpleNamespace(report=wanted))
    model = SimpleNamespace(derived=None)
    program.drive(model, tmp_path, scene, card={}, resume=False, quiet=True)
    ends[0](tmp_path)
    assert pages == ([tmp_path] if wanted and pictures else [])

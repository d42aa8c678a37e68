"""Own laws in scenes from Python: what cannot be saved, and sides that take none."""

import linecache
import pickle
from pathlib import Path
from typing import Any

import pytest

import porescale as ps
from tests.reference.flow_laws import flow_scene

CELL = "import porescale as ps\n\n\n@ps.body_force\ndef swirl(x, y):\n    return 1e-4 * y, 0.0\n"


def refused(act: Any) -> str:
    """The one line of a refusal."""
    with pytest.raises(ps.InputError) as caught:
        act()
    (only,) = caught.value.faults
    line: str = only.line()
    assert "\n" not in line
    return line


def cell() -> Any:
    """A body force of a notebook: its text stands in no file."""
    names: dict[str, Any] = {}
    linecache.cache["<cell 7>"] = (len(CELL), None, CELL.splitlines(True), "<cell 7>")
    exec(compile(CELL, "<cell 7>", "exec"), names)
    return names["swirl"]


def test_a_scene_with_a_function_of_a_notebook_is_not_saved_and_nothing_is_written(tmp_path: Path) -> None:
    scene = flow_scene(tmp_path, fluid__body_force=cell())
    said = refused(lambda: scene.save(tmp_path / "saved" / "scene.toml"))
    assert said.startswith("fluid.body_force = 'notebook:swirl': stands in no file; ")
    assert "put it into a file" in said
    assert not (tmp_path / "saved").exists()
    saved = flow_scene(tmp_path, fluid__body_force="laws.py:kolmogorov").save(tmp_path / "scene.toml")  # one of a file
    assert ps.load(saved).fluid.body_force.name == "kolmogorov"


WRONG = {
    "@ps.contact_law(keys={'k k': 'N/m'})\ndef pull(overlap, closing, radius, mass, p):":
        "laws.py, line 2: pull = 'k k': is no name for a key",
    "@ps.contact_law(keys={'k': 'N/zork'})\ndef pull(overlap, closing, radius, mass, p):":
        "laws.py, line 2: pull = 'N/zork': unit of the key 'k'",
    "@ps.contact_law(keys={'k': 'N/m'})\ndef pull(a, b):": "laws.py, line 2: pull: takes (a, b) (allowed: (overlap, ",
    "@ps.contact_law\ndef pull(overlap, closing, radius, mass, p):": "contact_law = 'pull': has no keys; write ",
}  # fmt: skip


@pytest.mark.parametrize("text", WRONG)
def test_what_a_decorator_refuses_is_said_of_the_key_that_names_the_law(tmp_path: Path, text: str) -> None:
    (tmp_path / "laws.py").write_text(f"import porescale as ps\n{text}\n    return 0.0\n")
    (tmp_path / "scene.toml").write_text('[contact]\nlaw = "laws.py:pull"\n[domain]\nwidth = 1\nheight = 1\n')
    with pytest.raises(ps.InputError) as caught:
        ps.load(tmp_path)
    said = next(fault for fault in caught.value.faults if fault.key == "contact.law")  # it was "contact.law.laws.py, …"
    assert f"contact.law = 'laws.py:pull': {WRONG[text]}" in said.line()


DRY: dict[str, Any] = {
    "time": {"end": 0.1},
    "output": {"snapshot_interval": 0.1, "series_interval": 0.1},
    "grains": {"density": 2500, "grain": [{"x": 0.005, "y": 0.005, "diameter": 0.002}]},
    "contact": {"stiffness": 1e5, "damping": 0.0},
}


def test_an_inflow_is_no_velocity_of_a_wall() -> None:
    @ps.inflow
    def pulse(s: float, t: float) -> tuple[float, float]:
        return 1e-3, 0.0

    def made(velocity: Any) -> ps.Scene:
        left = {"kind": "wall", "velocity": velocity}
        return ps.Scene(domain={"width": 0.01, "height": 0.01, "left": left}, **DRY)

    said = refused(lambda: made(pulse))
    assert said.startswith("domain.left.velocity = ")
    assert "an inflow is of the fluid, this is a wall; give two numbers" in said
    assert made([1e-3, 0.0]).domain.left.velocity == (1e-3, 0.0)  # two numbers move it


def test_a_scene_goes_to_another_process_with_a_law_of_a_file_alone(tmp_path: Path) -> None:
    scene = flow_scene(tmp_path, fluid__body_force="laws.py:kolmogorov")
    again = pickle.loads(pickle.dumps(scene))
    assert again == scene
    assert again != flow_scene(tmp_path, fluid__body_force="laws.py:uniform")
    with pytest.raises(pickle.PicklingError, match="notebook:swirl stands in no file"):
        pickle.dumps(flow_scene(tmp_path, fluid__body_force=cell()))

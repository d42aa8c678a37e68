"""The notebooks of docs run, from their first cell to their last."""

import nbformat
import pytest
from nbclient.exceptions import CellExecutionError

from tests.reference.folders import ROOT
from tests.reference.notebooks import NOTEBOOKS, executed

LONG = {"own_scene", "own_force_and_probe"}  # half a minute and more


def marked(path):
    return pytest.param(path, marks=pytest.mark.slow) if path.stem in LONG else path


def test_every_long_notebook_is_one():
    assert {path.stem for path in NOTEBOOKS} >= LONG


@pytest.mark.parametrize("path", [marked(path) for path in NOTEBOOKS], ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path):
    shown = [output for cell in executed(path, tmp_path).cells for output in cell.get("outputs", ())]
    assert sum("image/png" in output.get("data", {}) for output in shown) >= 2
    assert (tmp_path / "runs").is_dir()
    # What it shows is stored with it, for those who read it without running it.
    stored = [output for cell in nbformat.read(path, as_version=4).cells for output in cell.get("outputs", ())]
    assert len(stored) >= len(shown) - 5  # progress and warnings are shown in more or fewer pieces
    assert str(ROOT) not in path.read_text(encoding="utf-8")
    assert not [output for output in stored if output.output_type == "error"]


def test_there_are_notebooks():
    assert {"own_scene", "own_force_and_probe", "piv_of_a_film"} <= {path.stem for path in NOTEBOOKS}


def test_a_cell_that_raises_fails(tmp_path):  # the check that must fail
    notebook = nbformat.v4.new_notebook()
    notebook.cells.append(nbformat.v4.new_code_cell("import porescale as ps\nps.load('no_such_case')"))
    nbformat.write(notebook, tmp_path / "wrong.ipynb")
    with pytest.raises(CellExecutionError, match="no_such_case"):
        executed(tmp_path / "wrong.ipynb", tmp_path)

"""Run the notebooks of docs:  python -m tests.reference.notebooks [NAMES]  runs them and keeps what they show."""

import os
import re
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from nbclient import NotebookClient

from porescale.common.core.html import WIDGET
from tests.reference.folders import ROOT

FOLDER = ROOT / "docs" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
PASSING = re.compile(r"\S*ipykernel_\d+/\d+\.py:\d+: ")
"""Of a warning: the file that a kernel makes of a cell."""
LIMIT = 600
"""Seconds that a cell may take, compiling included."""


def executed(path: Path, folder: Path) -> nbformat.NotebookNode:
    """The notebook with what its cells show, run in ``folder``; CellExecutionError where a cell raises."""
    notebook = nbformat.read(path, as_version=4)
    sources = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    client = NotebookClient(
        notebook, timeout=LIMIT, kernel_name="python3", resources={"metadata": {"path": str(folder)}}
    )
    client.execute(env={**os.environ, "PYTHONPATH": sources, "NUMBA_NUM_THREADS": "1"})  # bits do not depend on it
    return notebook


def kept(notebook: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """What is stored: without times, names of passing files, widgets, and pictures where the same is shown as HTML."""
    notebook.metadata.pop("widgets", None)
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
        for output in cell.get("outputs", ()):
            if "text/html" in output.get("data", {}):
                output.data.pop("image/png", None)
                output.data.pop(WIDGET, None)
            if "text" in output:
                output.text = PASSING.sub("", output.text)
    return notebook


def main(names: list[str]) -> None:
    """Run the notebooks of these names, or all, and store them with their output."""
    for path in NOTEBOOKS:
        if not names or path.stem in names:
            with TemporaryDirectory() as folder:
                nbformat.write(kept(executed(path, Path(folder))), path)
            print(path.relative_to(ROOT))


if __name__ == "__main__":
    main(sys.argv[1:])

"""What the library logs and warns of: printed by commands, silenced and caught in Python."""

import logging
import subprocess
import sys
import warnings
from pathlib import Path

import pytest
from cyclopts import App
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from porescale.common.cli.application import main
from porescale.common.core.errors import PorescaleWarning


def app() -> App:
    made = App(result_action="return_value")

    @made.command
    def doubt() -> int:
        for _ in range(2):  # the same line twice: the filters of Python would show it once
            warnings.warn("a step too long", PorescaleWarning, stacklevel=1)
        logging.getLogger("porescale.piv.images.filmed").info("%d frames", 3)
        logging.getLogger("continuum_sph.water").debug("nobody asked")
        logging.getLogger("elsewhere").info("of another library")
        return 0

    return made


def test_a_command_prints_one_line_each_and_leaves_all_as_it_was(capsys: pytest.CaptureFixture[str]) -> None:
    logger = logging.getLogger("porescale")
    before = logger.handlers[:], logger.level, warnings.showwarning
    assert main(app(), ["doubt"]) == 0
    assert capsys.readouterr().err.splitlines() == ["warning: a step too long"] * 2 + ["3 frames"]
    assert before == (
        logging.getLogger("porescale").handlers,
        logging.getLogger("porescale").level,
        warnings.showwarning,
    )


def test_characters_that_the_font_of_pictures_lacks_are_said_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    made = App(result_action="return_value")

    @made.command
    def draw() -> int:
        figure = Figure()
        figure.text(0.1, 0.5, "測点 c, 測\u0007", parse_math=False)
        for _ in range(2):
            FigureCanvasAgg(figure).draw()
        warnings.warn("of another library", UserWarning, stacklevel=1)
        return 0

    with pytest.warns(UserWarning, match="of another library") as others:
        assert main(made, ["draw"]) == 0
    assert len(others) == 1
    assert capsys.readouterr().err == "warning: pictures show a box for what their font lacks: 測 点 U+0007\n"


def test_python_silences_and_catches_them(capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture) -> None:
    with warnings.catch_warnings(), caplog.at_level(logging.INFO, "porescale"):
        warnings.simplefilter("error", PorescaleWarning)
        with pytest.raises(PorescaleWarning, match="too long"):
            warnings.warn("a step too long", PorescaleWarning, stacklevel=1)
        logging.getLogger("porescale.piv.images.filmed").info("%d frames", 3)
    assert caplog.messages == ["3 frames"]
    assert capsys.readouterr().err == ""


def test_the_library_neither_prints_nor_configures_logging() -> None:
    """Outside of the commands; the progress of a run is what its caller asks for."""
    root = Path(__file__).resolve().parents[3]
    files = [path for package in ("porescale", "continuum_sph") for path in (root / package).rglob("*.py")]
    apart = ("cli.py", "__main__.py", "progress.py", "command.py", "serve.py")  # commands, and what they call
    ours = [path for path in files if "cli" not in path.parts and path.name not in apart]
    assert len(ours) > 300
    found = [path for path in ours if printing(path.read_text(encoding="utf-8"))]
    assert found == []
    assert printing("    print(1)\n")  # the check that must fail
    code = "import logging, porescale, continuum_sph; porescale.load; print(logging.getLogger('porescale').handlers)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=True)
    assert done.stdout == "[]\n"


def printing(text: str) -> list[str]:
    """Lines that print, or write to stderr."""
    return [line for line in text.splitlines() if line.lstrip().startswith("print(") or "sys.stderr" in line]

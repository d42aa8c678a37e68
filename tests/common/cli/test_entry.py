"""Ctrl-C before a command has begun: one line and exit code 130, wherever it falls."""

import os
import signal
import sys

import pytest

from porescale.common.cli.entry import command, ctrl_c
from tests.reference.folders import ROOT
from tests.reference.waiting import done

WAIT = "import time\n    for _ in range(3000):\n        time.sleep(0.01)\n"
"""What goes on for half a minute where nothing stops it."""
FALLS = {
    "import": "import signal\nsignal.raise_signal(signal.SIGINT)\ndef main():\n    return 0\n",
    "exec of source": "def main():\n    exec('import signal; signal.raise_signal(signal.SIGINT)')\n    return 0\n",
    "callback": "import signal\nclass Dies:\n    def __del__(self):\n        signal.raise_signal(signal.SIGINT)\n"
    f"def main():\n    Dies()\n    {WAIT}    return 0\n",
    "swallowed": "import signal\ndef main():\n    try:\n        signal.raise_signal(signal.SIGINT)\n"
    f"    except BaseException:\n        pass\n    {WAIT}    return 0\n",
    "library": "def main():\n    import signal\n    try:\n        signal.raise_signal(signal.SIGINT)\n"
    "    except KeyboardInterrupt:\n        raise ImportError('cannot be imported') from None\n",
}
"""Modules with a ``main`` into which a Ctrl-C falls."""


def ended(folder, text, line):
    """How the program ends that is ``python -m begins`` and runs ``line``, beside a module ``falls`` of that text."""
    (folder / "falls.py").write_text(text)
    caught = "import signal, sys\nsignal.signal(signal.SIGINT, signal.default_int_handler)"
    (folder / "begins.py").write_text(f"{caught}\n{line}")
    return done([sys.executable, "-m", "begins"], cwd=folder, env={**os.environ, "PYTHONPATH": str(ROOT)})


@pytest.mark.parametrize("fall", FALLS)
def test_ctrl_c_before_a_command_begins_is_one_line(tmp_path, fall):
    end = ended(tmp_path, FALLS[fall], "from porescale.common.cli.entry import command; sys.exit(command('falls'))")
    assert (end.returncode, end.stderr, end.stdout) == (130, "interrupted\n", "")


@pytest.mark.parametrize("fall", ["import", "exec of source", "library"])  # the others go on to their end
def test_without_the_entry_each_of_them_ends_otherwise(tmp_path, fall):
    # The check that must fail: what a program does that catches KeyboardInterrupt around its main alone.
    line = "from falls import main\ntry:\n    code = main()\nexcept KeyboardInterrupt:\n    code = 130\nsys.exit(code)"
    assert ended(tmp_path, FALLS[fall], line).returncode != 130


def test_what_goes_wrong_without_ctrl_c_keeps_its_traceback(tmp_path):
    line = "from porescale.common.cli.entry import command; sys.exit(command('falls'))"
    end = ended(tmp_path, "def main():\n    raise ImportError('cannot be imported')\n", line)
    assert end.returncode == 1
    assert "Traceback" in end.stderr
    assert ended(tmp_path, "def main():\n    return 3\n", line).returncode == 3


def test_ctrl_c_means_afterwards_what_it_meant_before(monkeypatch):
    before = signal.getsignal(signal.SIGINT), sys.unraisablehook
    with pytest.raises(KeyboardInterrupt), ctrl_c() as came:
        signal.raise_signal(signal.SIGINT)
    assert came == [signal.SIGINT]
    assert (signal.getsignal(signal.SIGINT), sys.unraisablehook) == before
    monkeypatch.setattr(signal, "getsignal", lambda number: signal.SIG_IGN)  # of a shell's job in the background
    with ctrl_c() as came:
        assert sys.unraisablehook is before[1]
    assert came == []
    with pytest.raises(ModuleNotFoundError):
        command("no_such_module")

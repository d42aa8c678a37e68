"""Nothing that only POSIX systems have is needed: imports, a run, its resume, locks and clean-up without it.

Children run with modules and calls taken away, as Windows lacks them, or answering as they do there: os.kill(pid, 0)
ends the process, names are not those of POSIX.  Libraries keep the calls that they make on this system.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from porescale.common.cli.application import QUOTA
from porescale.common.record import stop
from porescale.common.studies.schedulers import task
from tests.reference.folders import ROOT
from tests.reference.scenes import COLUMN, write

LIMIT = 600  # seconds that any child here may take
WITHOUT = """
import builtins, os, pathlib, signal, sys
OURS = ("porescale", "continuum_sph", "__main__")

def ours(*more):
    return sys._getframe(2).f_globals.get("__name__", "").partition(".")[0] in (*OURS, *more)

own_import = builtins.__import__

def imports(name, *rest, **options):
    # the lock of filelock does without fcntl, too; psutil on this system does not
    if name == "fcntl" and ours("filelock") or name in POSIX and ours():
        raise ModuleNotFoundError(f"No module named {name!r}")
    return own_import(name, *rest, **options)

POSIX = ("resource", "pwd", "grp", "termios", "tty", "pty", "syslog")
builtins.__import__ = imports

LACKED = ("sched_getaffinity", "sysconf", "fork", "getuid", "uname", "statvfs", "getpgid", "killpg", "getloadavg")

class Lacking(type(os)):
    # to our code, hasattr and getattr with a default included, os has none of these
    def __getattribute__(self, name):
        if name in LACKED and ours():
            raise AttributeError(f"module 'os' has no attribute {name!r}")
        return super().__getattribute__(name)

os.__class__ = Lacking
kill = os.kill

def kills(process, number):
    if ours():
        print("killed", process, number, file=sys.stderr)
        kill(process, signal.SIGKILL)
    return kill(process, number)

os.kill = kills
exists = pathlib.Path.exists
pathlib.Path.exists = lambda path, **options: not str(path).startswith("/proc") and exists(path, **options)
"""
IMPORTS = """
from importlib import import_module
from pkgutil import walk_packages
import continuum_sph, porescale
for package in (porescale, continuum_sph):
    for module in walk_packages(package.__path__, package.__name__ + "."):
        if not module.name.endswith("__main__"):
            import_module(module.name)
print(len(sys.modules))
"""
RUN = """
from porescale.cli.main import commands
from porescale.common.cli import application
sys.exit(application.main(commands(), sys.argv[1:]))
"""
HOLD = """
from pathlib import Path
from porescale.common.core.atomic import owned
with owned(Path(sys.argv[1])) as held:
    print(held, flush=True)
    sys.stdin.readline()
"""
CLEAN = """
from pathlib import Path
from porescale.common.core.atomic import MARK, clean
living, dead = int(sys.argv[2]), 2**22 + 1
for number in (living, dead):
    (Path(sys.argv[1]) / f".card.{number}{MARK}.json").touch()
print([path.name for path in clean(Path(sys.argv[1]))])
"""
MACHINE = """
from porescale.common.core.machine import machine, peak_bytes
print(machine(), peak_bytes())
assert machine()["memory"] > 2**28 and peak_bytes() > 2**23 and machine()["cores"] >= 1
"""


def child(code: str, *words: object, before: str = WITHOUT) -> subprocess.Popen[str]:
    """A Python process that lacks what POSIX has."""
    return subprocess.Popen(
        [sys.executable, "-W", "ignore::UserWarning", "-c", before + code, *map(str, words)],
        cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def ended(process: subprocess.Popen[str]) -> tuple[int, str, str]:
    """Exit code, stdout, stderr of a child."""
    out, said = process.communicate(timeout=LIMIT)
    return process.returncode, out, said


def holding(folder: Path) -> subprocess.Popen[str]:
    """A child that holds a folder until its stdin gets a line."""
    holder = child(HOLD, folder)
    assert holder.stdout is not None
    assert holder.stdout.readline() == "True\n"
    return holder


def test_every_module_imports():
    code, _, said = ended(child(IMPORTS))
    assert (code, said) == (0, "")


def test_a_module_that_needs_posix_would_be_found():
    assert ended(child("import resource"))[0] == 1
    assert "no attribute" in ended(child("os.sysconf('SC_PAGE_SIZE')"))[2]
    assert ended(child("os.kill(os.getpid(), 0)"))[0] == -9


def test_the_machine_is_known():
    code, _, said = ended(child(MACHINE))
    assert (code, said) == (0, "")


def test_a_folder_has_one_writer_and_a_dead_ones_folder_can_be_taken(tmp_path):
    holder = holding(tmp_path)
    assert ended(child(HOLD, tmp_path))[1] == "False\n"
    holder.kill()
    holder.wait(LIMIT)
    assert ended(child(HOLD, tmp_path))[1] == "True\n"


def test_what_living_processes_write_is_left_to_them(tmp_path):
    code, out, said = ended(child(CLEAN, tmp_path, os.getpid()))
    assert (code, out.strip(), said) == (0, f"['.card.{2**22 + 1}.writing.json']", "")
    assert [path.name for path in tmp_path.iterdir()] == [f".card.{os.getpid()}.writing.json"]


@pytest.mark.slow
def test_a_run_is_resumed_to_the_same_end(tmp_path):
    scene = write(tmp_path / "column.toml", COLUMN)
    for folder, ends in (("whole", ("0.002",)), ("halves", ("0.001", "0.002"))):
        for k, end in enumerate(ends):
            words = ["run", scene, "--out", tmp_path / folder, "--quiet", "--set", f"time.end={end}"]
            code, _, said = ended(child(RUN, *words, *(["--resume"] if k else [])))
            assert code == 0, said
    assert (tmp_path / "halves" / "series.csv").read_bytes() == (tmp_path / "whole" / "series.csv").read_bytes()
    holder = holding(tmp_path / "whole")
    code, _, said = ended(child(RUN, "run", scene, "--out", tmp_path / "whole", "--quiet", "--overwrite"))
    assert code == 2
    assert "another run is writing here" in said
    holder.kill()
    holder.wait(LIMIT)


def test_windows_stops_runs_by_its_own_signal(monkeypatch):
    assert task.OWN_GROUP == 0  # here; there a group for each process, to which its signal can be sent
    assert [number.name for number in stop.polite_signals()] == ["SIGINT", "SIGTERM"]
    monkeypatch.setattr(stop, "POLITE", (*stop.POLITE, "SIGUSR1"))  # stands for one more, as Windows has
    assert len(stop.polite_signals()) == 3


def test_the_systems_errors_have_numbers_everywhere():
    assert isinstance(QUOTA, int)

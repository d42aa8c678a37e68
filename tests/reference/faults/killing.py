"""Runs of both packages killed in phases chosen by dice: python -m tests.reference.faults.killing --kills 1000

A run's process says through shared memory what it does, and how often it began that.  The dice choose a phase, which of
its beginnings, and how long after it SIGKILL comes; then what lies in the folder is read, and the run is resumed, or
killed while it resumes.  In the end it must be, to the bit, the run that nobody killed.  Processes are forked from one
that has the kernels; a share of them (--cold) starts without packings and with few kernels kept from before, at first
with none, and is killed above all while it compiles a kernel or keeps one.  Every fifth run makes pictures and film,
which take longer than all else.
SIGINT and SIGTERM come in the same way (--stops): for them it is said how long a saved run takes to end.
"""

import argparse
import faulthandler
import json
import math
import mmap
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import Any
from unittest.mock import patch

# Numba's other layers of threads do not survive a fork; read when it is first imported.
os.environ.setdefault("NUMBA_THREADING_LAYER", "workqueue")

from porescale.common.record.checkpoint import read_header
from porescale.common.schema.sections import load
from tests.reference.faults import campaigns, kill_rounds
from tests.reference.faults.failing_disk import whole
from tests.reference.folders import ROOT
from tests.reference.same_run import differences
from tests.reference.scenes import COLUMN, grain, table, write
from tests.reference.waiting import ended, given_up

PHASES = ("starting", "building", "first steps", "stepping", "row", "snapshot", "checkpoint", "joining", "pictures",
          "ending", "compiling", "keeping a kernel")  # fmt: skip
COLD = ("starting", "compiling", "compiling", "compiling", "keeping a kernel", "keeping a kernel")
"""What is killed of a process without kernels: the more often, the longer it takes or the more it can spoil."""
PATIENCE, COLD_PATIENCE = 240.0, 1800.0
"""Seconds after which a child that neither ends nor begins what is waited for counts as hanging: one that has the
kernels, and one that has not."""
LOOK = 5e-4
"""Seconds between looks at what a child does."""

SEEPING: dict[str, Any] = {
    "tank": {"width": 0.3, "height": 0.5, "lid": False},
    "water": {"column": [{"width": 0.3, "height": 0.4}], "sound_speed": 80.0},
    "soil": {"stiffness": 1e6, "permeability": 1e-3, "body": [{"outline": [[0, 0], [0.3, 0], [0.3, 0.2], [0, 0.2]]}]},
    "numerics": {"spacing": 0.025, "artificial_viscosity": 0.1},
    "probe": [{"x": 0.15, "y": 0.1}], "level": [{"x": 0.15}],
    "time": {"end": 0.08}, "output": {"snapshot_interval": 0.016, "series_interval": 0.004,
                                      "checkpoint_seconds": 0.1},
}  # fmt: skip
TANK: dict[str, Any] = {
    "tank": {"width": 0.4, "height": 0.3},
    "water": {"viscosity": 1e-3, "column": [{"width": 0.2, "height": 0.2}]},
    "numerics": {"spacing": 0.0125}, "time": {"end": 0.3},
    "output": {"snapshot_interval": 0.05, "series_interval": 0.01, "checkpoint_seconds": 0.05},
}  # fmt: skip
ASLEEP = table(
    gate=None, domain__width=0.004, domain__height=0.010, grains__packing__left=0.0,
    grains__grain=[grain(0.002, 0.0066, 0.0008)], sleep={"share": 0.05, "after": 0.002},
)  # fmt: skip
"""A grain sinks onto others that sleep under water."""
DRY = table(
    fluid=None, grains__hydraulic_radius_ratio=None, grains__packing__settle=False, output__energy=True,
    gate=None, bonds=[{"at": 0.012}],
    polygon=[{"sides": 4, "diameter": 0.0015, "thickness": 1e-4, "at": [[0.002, 0.007]], "density": 2500.0}],
    control=[{"polygon": 0, "y": {"velocity": -0.05}, "record": True}],
)  # fmt: skip
"""Many contact steps are done at once here, but where what touches is bonded."""
SCENES: dict[str, tuple[str, dict[str, Any]]] = {
    "column": ("porescale", COLUMN), "asleep": ("porescale", ASLEEP), "dry": ("porescale", DRY),
    "tank": ("continuum_sph", TANK), "seeping": ("continuum_sph", SEEPING),
}  # fmt: skip


class Marks:
    """What a child does now, by number of PHASES, and how often it began each: shared memory of 8 bytes a number."""

    def __init__(self, file: Path) -> None:
        if not file.exists():
            file.write_bytes(bytes(8 * (1 + len(PHASES))))
        with file.open("r+b") as opened:
            self.memory = mmap.mmap(opened.fileno(), 0)

    def now(self) -> int:
        """The phase."""
        return int(struct.unpack_from("q", self.memory)[0])

    def begun(self, phase: int) -> int:
        """How often it was begun."""
        return int(struct.unpack_from("q", self.memory, 8 * (1 + phase))[0])

    def clear(self) -> None:
        """As before a start."""
        self.memory[:] = bytes(len(self.memory))

    def begin(self, phase: int) -> None:
        """The phase is now this."""
        struct.pack_into("q", self.memory, 8 * (1 + phase), self.begun(phase) + 1)
        struct.pack_into("q", self.memory, 0, phase)

    @contextmanager
    def within(self, name: str) -> Iterator[None]:
        """The phase is ``name`` while it lasts, then what it was."""
        before = self.now()
        self.begin(PHASES.index(name))
        try:
            yield
        finally:
            struct.pack_into("q", self.memory, 0, before)


def marked(marks: Marks, name: str, real: Callable[..., Any]) -> Callable[..., Any]:
    """``real``, which says that it runs."""

    def call(*args: Any, **named: Any) -> Any:
        with marks.within(name):
            return real(*args, **named)

    return call


def hooks() -> list[tuple[Any, str, str]]:
    """What is called in a phase: where it stands, its name, and the phase."""
    from numba.core import caching, dispatcher

    from porescale.common.record import record, snapshots

    return [(record.Record, "row", "row"), (record.Record, "snapshot", "snapshot"), (record.Record, "save",
            "checkpoint"), (snapshots, "assemble", "joining"), (dispatcher._FunctionCompiler, "compile", "compiling"),
            (caching.IndexDataCacheFile, "_save_data", "keeping a kernel")]  # fmt: skip


def run(package_name: str, words: list[str], marks: Marks, pictured: bool = True) -> int:
    """Exit code of a command line, which says what it does."""
    from porescale.common.cli.application import application, main

    package = _package(package_name)

    def build(scene: Any) -> Any:
        with marks.within("building"):
            model = package.build(scene)
        advance, first = model.advance, [True]

        def steps(count: int) -> None:
            with marks.within("first steps" if first else "stepping"):
                advance(count)
            first.clear()

        model.advance = steps
        return model

    def drive(*args: Any, **named: Any) -> Any:
        marks.begin(PHASES.index("ending"))  # between the others: reading a checkpoint, ending a run
        return package.drive(*args, **named)

    patches = [patch.object(where, name, marked(marks, phase, getattr(where, name))) for where, name, phase in hooks()]
    for each in patches:
        each.start()
    shown = marked(marks, "pictures", package.show) if pictured else lambda folder: []
    with patch.object(sys.modules[package.show.__module__], "show", shown):
        return main(application(replace(package, build=build, drive=drive)), words)


def _package(name: str) -> Any:
    if name == "porescale":
        from porescale.cli.main import PACKAGE
    else:
        from continuum_sph.cli import PACKAGE
    return PACKAGE


@dataclass
class Child:
    """A process that runs a scene into ``folder``, resuming if there is a run.

    patience : PATIENCE of its kind;  said : the file of what it says
    """

    number: int
    marks: Marks
    began: float
    said: Path
    patience: float = PATIENCE

    def wait(self) -> int:
        """Its exit code, -n if signal n ended it."""
        return ended(self.number, self.patience, self.said, LOOK)

    def wait_for(self, phase: int, nth: int) -> bool:
        """Whether ``phase`` was begun ``nth`` times before the process ended."""
        while self.marks.begun(phase) < nth:
            if os.waitid(os.P_PID, self.number, os.WEXITED | os.WNOHANG | os.WNOWAIT):
                return False
            if time.monotonic() - self.began > self.patience:
                words = given_up(self.number, self.said)
                raise AssertionError(f"a run hangs while {PHASES[self.marks.now()]}: {words}")
            time.sleep(LOOK)
        return True


class Campaign:
    """Kills runs of ``scene`` in ``place``, by the dice of ``seed``."""

    def __init__(self, name: str, place: Path, seed: int) -> None:
        self.package, values = SCENES[name]
        self.place, self.dice = place, random.Random(f"{name} {seed}")
        place.mkdir(parents=True, exist_ok=True)
        self.scene = write(place / f"{name}.toml", values)
        self.marks = Marks(place / "marks")
        self.untouched = {True: place / "untouched", False: place / "without_pictures"}
        self.kills: Counter[str] = Counter()
        self.finals, self.pictured = 0, True
        self.warm()
        for pictured, folder in self.untouched.items():
            self.pictured = pictured
            shutil.rmtree(folder, ignore_errors=True)
            assert self.child(folder).wait() == 0
        self.often = [self.marks.begun(phase) for phase in range(len(PHASES))]
        self.steps = read_header(self.untouched[True] / "checkpoint.h5")["step"]

    def warm(self) -> None:
        """Load what all children need, in this process: kernels, and matplotlib, a third of a child's time."""
        import_module("porescale.common.page.page")
        package = _package(self.package)
        model = package.build(load(self.scene, package.scene()))
        model.advance(2)
        model.check()
        model.series()

    def words(self, folder: Path) -> list[str]:
        """The command line of a run into ``folder``."""
        given = ["run", str(self.scene), "--out", str(folder), "--quiet", "--threads", "1"]
        if (folder / "card.json").exists():
            return [*given, "--resume"]
        return [*given, "--overwrite"] if folder.exists() else given

    def child(self, folder: Path, cold: Path | None = None) -> Child:
        """A process that runs the scene into ``folder``.  cold : a folder of kernels and packings for it alone."""
        self.marks.clear()
        words, began, said = self.words(folder), time.monotonic(), self.place / "said"
        if cold is not None:
            code = ("import sys; from pathlib import Path; from tests.reference.faults.killing import Marks, run; "
                    "sys.exit(run(sys.argv[1], sys.argv[3:], Marks(Path(sys.argv[2]))))")  # fmt: skip
            given = os.environ | {
                "NUMBA_CACHE_DIR": str(cold / "kernels"),
                "XDG_CACHE_HOME": str(cold),
                "PYTHONFAULTHANDLER": "1",
            }
            command = [sys.executable, "-c", code, self.package, str(self.place / "marks"), *words]
            with said.open("ab") as file:
                started = subprocess.Popen(command, cwd=ROOT, env=given, stdout=subprocess.DEVNULL, stderr=file)
            started.returncode = 0  # waited for by number
            return Child(started.pid, self.marks, began, said, COLD_PATIENCE)
        number = os.fork()
        if number == 0:
            code = 1
            try:
                os.dup2(os.open(said, os.O_WRONLY | os.O_CREAT | os.O_APPEND), 2)
                faulthandler.enable()
                code = run(self.package, words, self.marks, self.pictured)
            finally:
                os._exit(code)
        return Child(number, self.marks, began, said)

    def aim(self, folder: Path) -> tuple[int, int, float]:
        """A phase, which of its beginnings, of those that are left, and seconds after that."""
        left, checkpoint = 1.0, folder / "checkpoint.h5"
        if checkpoint.exists():
            left = 1.0 - read_header(checkpoint)["step"] / self.steps
        known = [0, *(k for k in range(1, len(PHASES)) if self.often[k] and (PHASES[k] != "pictures" or self.pictured))]
        phase = self.dice.choice(known)
        nth = self.dice.randint(1, max(1, int(left * self.often[phase]))) if phase else 0
        longest = {"starting": 0.5, "building": 0.2, "first steps": 2.0, "pictures": 3.0}.get(PHASES[phase], 0.03)
        return phase, nth, self.dice.uniform(0.0, longest)

    def forget(self, cold: Path) -> None:
        """Remove a share of the kernels, and what else was kept."""
        share = self.dice.random()
        for kept in sorted((cold / "kernels").rglob("*.nbc")):
            if self.dice.random() < share:
                kept.unlink()
        shutil.rmtree(cold / "porescale", ignore_errors=True)

    def aim_cold(self) -> tuple[int, int, float]:
        """The same for a process that has no kernels but those that its forerunners kept."""
        phase = PHASES.index(self.dice.choice(COLD))
        longest = {"starting": 4.0, "compiling": 2.0}.get(PHASES[phase], 0.004)
        return phase, self.dice.randint(1, 6) if phase else 0, self.dice.uniform(0.0, longest)

    def kill(self, folder: Path, cold: Path | None = None) -> str | None:
        """Kill a run; what it was doing, None if it had ended before."""
        phase, nth, later = self.aim(folder) if cold is None else self.aim_cold()
        child = self.child(folder, cold)
        child.wait_for(phase, nth)
        time.sleep(later)
        os.kill(child.number, signal.SIGKILL)
        doing = PHASES[self.marks.now()]
        code = child.wait()
        assert code in (0, -signal.SIGKILL), f"a run ended by itself with {code} while {doing}"
        return doing if code else None

    def round(self, number: int, most: int, cold: Path | None = None, until: float = math.inf) -> None:
        """A run killed one to sixteen times, at most ``most``, none after ``until``, then resumed to its end."""
        folder = self.place / f"run{number}"
        shutil.rmtree(folder, ignore_errors=True)
        if cold is not None:
            self.forget(cold)
        self.pictured = self.dice.random() < 0.2 or cold is not None
        for _ in range(min(most, self.dice.randint(1, 16))):
            doing = self.kill(folder, cold) if time.monotonic() < until else None
            if doing is None:
                break
            self.kills[("cold: " if cold else "") + doing] += 1
            whole(folder)
        code = self.child(folder, cold).wait()
        assert code == 0, f"resumed, a run ended with {code}: {folder}"
        found = differences(folder, self.untouched[self.pictured])
        assert found == [], f"{folder} differs in {found[:5]}"
        assert not list(folder.rglob(".*writing*"))
        self.finals += 1
        shutil.rmtree(folder)

    def stop(self, number: int) -> tuple[str, str, float, float] | None:
        """A run asked to stop while it steps: signal, phase, seconds until its state was saved, until it had ended."""
        folder, name = self.place / f"stop{number}", self.dice.choice(["SIGINT", "SIGTERM"])
        shutil.rmtree(folder, ignore_errors=True)
        self.pictured = False
        child = self.child(folder)
        child.wait_for(PHASES.index("stepping"), self.dice.randint(1, self.often[PHASES.index("stepping")]))
        time.sleep(self.dice.uniform(0.0, 0.05))
        begun, doing = time.time(), PHASES[self.marks.now()]
        os.kill(child.number, getattr(signal, name))
        code = child.wait()
        ended = time.time() - begun
        saved = (folder / "checkpoint.h5").stat().st_mtime - begun
        outcome = json.loads((folder / "card.json").read_text())["outcome"]
        whole(folder)
        shutil.rmtree(folder)
        if outcome != "interrupted":  # the run was past its last step
            return None
        assert code == 130, (name, doing, code, outcome)
        return name, doing, saved, ended


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=1000)
    parser.add_argument("--cold", type=int, default=0, help="of these from nothing")
    parser.add_argument("--stops", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=1e9, help="of all; no kill comes later, its run still ends")
    parser.add_argument("--record", action="store_true", help="keep what it came to in docs/develop")
    parser.add_argument("--out", type=Path, default=Path("runs/kills"))
    parser.add_argument("scenes", nargs="*", default=list(SCENES))
    options = parser.parse_args()
    goal = kill_rounds.Goal(options.kills, options.cold, time.monotonic(), options.seconds, options.seed)
    all_of = {name: Campaign(name, options.out / name, options.seed) for name in options.scenes}

    def tell(said: dict[str, Any]) -> None:
        """Say and record what it came to so far."""
        kill_rounds.report(said, goal)
        if options.record:
            name = f"kills of {', '.join(options.scenes)}"
            campaigns.record(name, options.seed, kill_rounds.kinds(said), len(said["wrong"]))

    said = kill_rounds.rounds(all_of, goal, options.out, tell)
    stops = []
    while len(stops) < options.stops:
        found = all_of[options.scenes[len(stops) % len(options.scenes)]].stop(len(stops))
        stops += [found] if found else []
        (options.out / "stops.json").write_text(json.dumps(stops))
    if stops:
        print(f"{len(stops)} stops: saved within {max(it[2] for it in stops):.2f} s, ended within "
              f"{max(it[3] for it in stops):.2f} s")  # fmt: skip
    return 1 if said["wrong"] else 0


if __name__ == "__main__":
    sys.exit(main())

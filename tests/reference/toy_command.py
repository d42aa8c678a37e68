"""The toy model as a package whose runs step, save and resume: python -m tests.reference.toy_command COMMAND ...

A run is slow until a file called "go" lies beside its run folder.  Each of its processes writes a line to "begun"
there.  `run` itself is read here, not by the command line of packages: tests start many of them.
"""

import os
import sys
import time
import tomllib
from argparse import ArgumentParser
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from porescale.common.compiled import jit
from porescale.common.core.errors import PorescaleError
from porescale.common.record.drive import drive
from tests.reference.toy_model import Toy

if TYPE_CHECKING:
    from porescale.common.cli.package import Package

SCENE = "[time]\nend = 0.1\n"
"""100 steps, which take 20 s while they are slow."""
CLOCK = "TOY_CLOCK"
"""Variable: how many seconds the clock of a run's machine is ahead."""


@dataclass
class Beads:
    """[toy] of the scene.

    slow : seconds of a step;  breaks_at : step;  disk_fails_at : number of a call to it;  packs : whether there is no
    card before the runs are fast.
    """

    beads: int = 7
    slow: float = 0.2
    breaks_at: int = 1 << 40
    disk_fails_at: int = -1
    packs: bool = False


class Stepping(Toy):
    """A toy that is slow until there is a file "go" beside its folder."""

    def __init__(self, toy: Beads, folder: Path) -> None:
        super().__init__(toy.beads, breaks_at=toy.breaks_at)
        self.slow, self.go = toy.slow, folder.parent / "go"

    def advance(self, steps: int) -> None:
        for _ in range(steps):
            self.pause = 0.0 if self.go.exists() else self.slow
            super().advance(1)


def run(scene: Path, folder: Path, settings: list[str], *, resume: bool, overwrite: bool) -> None:
    """Run the scene."""
    tables = tomllib.loads(scene.read_text())
    tables.setdefault("toy", {})
    for text in settings:
        key, _, value = text.partition("=")
        section, _, name = key.partition(".")
        tables[section][name] = tomllib.loads(f"value = {value}")["value"]
    toy = Beads(**tables["toy"])
    folder.parent.mkdir(parents=True, exist_ok=True)
    with open(folder.parent / "begun", "a") as file:
        file.write(f"{folder.name} {os.getpid()} {'resumed' if resume else 'fresh'}\n")
    while toy.packs and not (folder.parent / "go").exists():
        time.sleep(0.01)
    disk = nullcontext()
    if toy.disk_fails_at >= 0:
        from tests.reference.faults.failing_disk import Disk, failing

        disk = failing(Disk(folder.absolute(), toy.disk_fails_at, sticky=True))
    card = {"package": "stepping", "name": folder.name, "scene": tables, "settings": settings}
    with disk:
        drive(
            Stepping(toy, folder), folder.absolute(), tables["time"]["end"], snapshot_interval=0.05,
            series_interval=0.005, checkpoint_seconds=0.1, card=card, resume=resume, overwrite=overwrite, quiet=True,
        )  # fmt: skip


def run_words(words: list[str]) -> int:
    """`run` as packages have it, as far as campaigns use it; exit code."""
    parser = ArgumentParser()
    parser.add_argument("scene", type=Path)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--threads")
    for name in ("--quiet", "--resume", "--overwrite"):
        parser.add_argument(name, action="store_true")
    given = parser.parse_args(words)
    try:
        run(given.scene, given.out, given.set, resume=given.resume, overwrite=given.overwrite)
    except PorescaleError as error:
        print(error, file=sys.stderr)
        return error.code
    except OSError as error:
        print(f"{error.filename}: {error.strerror}", file=sys.stderr)
        return 1
    return 0


def run_alone(beads: int, folder: Path) -> Path:
    """A run without a scheduler, undisturbed and fast; its folder."""
    folder.mkdir(parents=True)
    (folder / "go").touch()
    (folder / "scene.toml").write_text(SCENE)
    run(folder / "scene.toml", folder / "run", [f"toy.beads={beads}"], resume=False, overwrite=False)
    return folder / "run"


def begun(folder: Path) -> list[list[str]]:
    """Name, process and "fresh" or "resumed" of each process that has driven a run in ``folder``."""
    file = folder / "begun"
    return [line.split() for line in file.read_text().splitlines()] if file.exists() else []


def stepping() -> "Package":
    """The package."""
    from porescale.common.api.report import Report
    from porescale.common.schema.scene import SceneBase
    from porescale.common.schema.sections import Section, quantity
    from tests.reference.toy_package import TOY

    class Time(Section):
        """[time]"""

        end: float = quantity("s", 0.1, gt=0)

    class ToyTable(Section):
        """[toy]"""

        beads: int = 7
        slow: float = 0.2
        breaks_at: int = 1 << 40
        disk_fails_at: int = -1
        packs: bool = False

    class SteppingScene(SceneBase):
        """A scene."""

        time: Time
        toy: ToyTable = ToyTable()

    return replace(
        TOY, name="stepping", module="tests.reference.toy_command", scene=lambda: SteppingScene,
        report=lambda scene: Report("stepping"),
    )  # fmt: skip


def call(words: list[str]) -> int:
    """Any command of the package, with looks at queues that follow each other at once; exit code."""
    from porescale.common.cli.application import application, main
    from porescale.common.studies.schedulers import slurm

    slurm.FIRST_LOOK = slurm.LAST_LOOK = slurm.SECOND_LOOK = slurm.ABSENT_SECONDS = 0.05
    return main(application(stepping()), words)


if __name__ == "__main__":
    jit.threads = lambda: 1  # no kernel runs: the compiler need not be imported to count its threads
    ahead, clock = float(os.environ.get(CLOCK, "0")), time.time
    time.time = lambda: clock() + ahead
    sys.exit(run_words(sys.argv[2:]) if sys.argv[1] == "run" else call(sys.argv[1:]))

"""How long a run is expected to take, phase by phase: learnt from this machine's last runs.

A scene says what its phases take at nominal rates (`Work`).  What runs took over that is kept, in seconds of a quiet
machine (quiet.py), and the median of the last runs of the same scene, or of its kind where it has not been run, is how
much slower than nominal this machine is.  Kernels count where they are not on disk.
"""

import contextlib
import json
import math
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from porescale.common.compiled.cache import USED, cache_root
from porescale.common.compiled.jit import cache_folder, threads
from porescale.common.compiled.turns import TURNS
from porescale.common.core.atomic import write_bytes
from porescale.common.core.machine import cores
from porescale.common.duration.quiet import Moment, moment, share

START, COMPILING, BUILDING = "start", "compiling", "building"
STEPS, RECORDING, FINISHING = "steps", "recording", "finishing"
LEARNT = BUILDING, STEPS, RECORDING, FINISHING
"""Phases that differ from scene to scene.  Building: particles are placed, a packing settles;  recording: rows,
snapshots and checkpoints;  finishing: pictures, film and page."""
BEGIN = 2.0
"""Seconds until a scene is read and all is imported."""
LAST, KEPT = 5, 50
"""Runs whose median counts, and runs that are remembered."""
NAME, KERNEL = "times2.json", ".nbc"
"""The file of runs, named anew when nominal rates change: what runs took is kept over them;  ending of kernels."""
GUESS = "a guess until this machine has done such a run"


@dataclass(frozen=True)
class Work:
    """What a run has to do.

    scene : its name;  kind : of scenes whose phases cost alike;  seconds : of compiling all its kernels and of each
    phase in `LEARNT`, at nominal rates.
    """

    scene: str
    kind: str
    seconds: Mapping[str, float]


@dataclass(frozen=True)
class Expected:
    """Seconds of each phase on a quiet machine.  measured : whether this machine has done such a run."""

    seconds: Mapping[str, float]
    measured: bool

    @property
    def total(self) -> float:
        """All of it, from the command to its end."""
        return sum(self.seconds.values())

    @property
    def known(self) -> str:
        """Where it is known from, in words."""
        return "by this machine's last runs of such scenes" if self.measured else GUESS


def expected(work: Work) -> Expected:
    """What a run will take."""
    like = _like(work)
    seconds = {START: BEGIN, COMPILING: _compiling(like, work.seconds[COMPILING])}
    for phase in LEARNT:
        slower = [run["slower"][phase] for run in like if phase in run["slower"]][-LAST:]
        seconds[phase] = work.seconds[phase] * (median(slower) if slower else 1.0)
    return Expected(seconds, bool(like))


def besides(work: Work | None) -> float | None:
    """Seconds of what follows the start of a run and is no step; None where nothing says what it has to do."""
    if work is None:
        return None
    seconds = expected(work).seconds
    return seconds[RECORDING] + seconds[FINISHING]


def _like(work: Work) -> list[dict[str, Any]]:
    """The runs of the same scene on as many threads; where there is none, on others; and else, of its kind."""
    kind = [run for run in _runs() if run["kind"] == work.kind]
    scene = [run for run in kind if run["scene"] == work.scene]
    return [run for run in scene if run["threads"] == threads_of_run()] or scene or kind


def threads_of_run() -> int:
    """Threads of kernels, all cores where none was called yet: numba takes long to import."""
    return threads() if "numba" in sys.modules else cores()


def _compiling(like: list[dict[str, Any]], nominal: float) -> float:
    """Seconds of compiling what is not on disk: as a share of the kernels of the run that compiled most."""
    most = max(reversed(like), key=lambda run: run["compiled"], default=None)
    if most is None:
        return nominal
    folder = cache_folder()
    missing = sum(not (folder / name).exists() for name in like[-1]["kernels"])
    seconds = most["compiling"] if most["compiled"] else nominal
    return float(seconds) * missing / max(len(like[-1]["kernels"]), 1)


def remember(work: Work, taken: Mapping[str, float], began: Moment) -> None:
    """Note what a run took, for the next one, if the cache can be written.

    taken : seconds of the phases in `LEARNT` on a quiet machine;  began : when it did.
    """
    both = [phase for phase in LEARNT if taken.get(phase, 0.0) > 0.0 and work.seconds[phase] > 0.0]
    slower = {phase: taken[phase] / work.seconds[phase] for phase in both}
    now, kernels = moment(), [name for name in USED if name.endswith(KERNEL)] + [f"{it}{KERNEL}" for it in TURNS.kept]
    run = {"scene": work.scene, "kind": work.kind, "threads": threads_of_run(), "slower": slower,
           "kernels": list(dict.fromkeys(kernels)), "compiled": now.compiled - began.compiled,
           "compiling": (now.compiling - began.compiling) * share(began, now)}  # fmt: skip
    with contextlib.suppress(OSError):  # no room or no right to write: the next check guesses again
        write_bytes(_file(), json.dumps([*_runs(), run][-KEPT:]).encode())


def _file() -> Path:
    return cache_root() / NAME


def _runs() -> list[dict[str, Any]]:
    """The runs that are remembered, oldest first; what is spoiled is left out."""
    try:
        runs = json.loads(_file().read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return []
    return [run for run in runs if _whole(run)] if isinstance(runs, list) else []


_MADE_OF: dict[str, Callable[[Any], bool]] = {
    "scene": lambda it: isinstance(it, str),
    "kind": lambda it: isinstance(it, str),
    "threads": lambda it: isinstance(it, int),
    "slower": lambda it: isinstance(it, dict) and all(_number(value) and value > 0 for value in it.values()),
    "kernels": lambda it: isinstance(it, list) and all(isinstance(name, str) for name in it),
    "compiled": lambda it: _number(it) and it >= 0,
    "compiling": lambda it: _number(it) and it >= 0,
}


def _whole(run: Any) -> bool:
    """Whether a run has all that `remember` noted."""
    return isinstance(run, dict) and all(key in run and fits(run[key]) for key, fits in _MADE_OF.items())


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)

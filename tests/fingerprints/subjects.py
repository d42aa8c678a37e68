"""Kinds of things that have a fingerprint: a scene after some steps, a script stopped after some, files of commands."""

import contextlib
import csv
import functools
import inspect
import os
import runpy
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Protocol

import h5py
import numpy as np
from PIL import Image

from tests.fingerprints import places

ROOT = Path(__file__).resolve().parents[2]
CASES = ROOT / "cases"
VOLATILE = ("seconds", "steps per second", "milliseconds")
"""Words of numbers that are measured with a clock."""


class Subject(Protocol):
    """Something with a fingerprint."""

    def take(self, threads: int) -> tuple[Any, int]:
        """The nested value to be hashed, made anew on so many threads, and the steps done."""


@dataclass(frozen=True)
class Scene:
    """A scene of ``package`` ("porescale" or "continuum-sph"), its state and record after ``steps``.

    file : below cases, or none where ``text`` is the scene itself;  settings : "section.key=value".
    """

    package: str
    steps: int
    file: str = ""
    text: str = ""
    quality: str | None = None
    settings: tuple[str, ...] = ()

    def take(self, threads: int) -> tuple[Any, int]:
        """See Subject."""
        make = places.grains_and_fluid if self.package == "porescale" else places.continuum
        with TemporaryDirectory() as folder:
            path = CASES / self.file
            if self.text:
                path = Path(folder) / "scene.toml"
                path.write_text(self.text, encoding="utf-8")
            model = make(path, self.quality, self.settings)
        start = places.plain_state(model)
        made = {"start": _copied(start)}
        model.advance(self.steps)
        return {**made, "state": places.plain_state(model), **places.look(model)}, self.steps


class Enough(BaseException):
    """A script has done its steps."""


@dataclass
class Watch:
    """Counts the steps of whatever a script steps, and stops it after ``most``; or after so many pairs of pictures."""

    most: int
    done: int = 0
    inside: bool = False
    value: dict[str, Any] = field(default_factory=dict)

    def stepping(self, method: Any, state_of: Any) -> Any:
        """``method``, counted."""
        counts = inspect.signature(method)

        @functools.wraps(method)
        def counted(own: Any, *given: Any, **named: Any) -> Any:
            if self.inside:
                return method(own, *given, **named)
            bound = counts.bind(own, *given, **named)
            if "count" in counts.parameters:
                bound.arguments["count"] = min(bound.arguments.get("count", 1), self.most - self.done)
            self.inside = True
            try:
                returned = method(*bound.args, **bound.kwargs)
            finally:
                self.inside = False
            self.done += bound.arguments.get("count", 1)
            self.value["state"] = functools.partial(state_of, own)
            if self.done >= self.most:
                raise Enough
            return returned

        return counted

    def measuring(self, function: Any) -> Any:
        """``function``, counted, and its results kept."""

        @functools.wraps(function)
        def counted(*given: Any, **named: Any) -> Any:
            result = function(*given, **named)
            self.value[f"pair {self.done:03d}"] = result
            self.done += 1
            if self.done >= self.most:
                raise Enough
            return result

        return counted

    def concluding(self, folder: Path, numbers: Any, *rest: Any, **more: Any) -> int:
        """In place of the end of a script: keeps its numbers, less those measured with a clock."""
        self.value["numbers"] = {
            name: value for name, value in numbers.items() if not any(word in name for word in VOLATILE)
        }
        return 0


@dataclass(frozen=True)
class Script:
    """A script of cases, stopped after ``steps`` steps of what it steps, or ``pairs`` measured.

    One that ends before has the numbers that it judges.
    """

    file: str
    steps: int = 300
    pairs: int = 0
    arguments: tuple[str, ...] = ()

    def take(self, threads: int) -> tuple[Any, int]:
        """See Subject."""
        watch, path = Watch(self.pairs or self.steps), CASES / self.file
        with contextlib.ExitStack() as stack:
            folder = stack.enter_context(TemporaryDirectory())
            stack.enter_context(contextlib.chdir(folder))
            if self.pairs:
                stack.enter_context(swapped(places.MEASURE, watch.measuring))
            else:
                for place, state_of in places.STEPPERS.items():
                    stack.enter_context(swapped(place, functools.partial(watch.stepping, state_of=state_of)))
            stack.enter_context(swapped(places.CONCLUDE, lambda _: watch.concluding))
            stack.enter_context(swapped(places.SET_THREADS, lambda _: lambda count=None: threads))
            with _as_program(path, self.arguments), contextlib.suppress(Enough, SystemExit):
                runpy.run_path(str(path), run_name="__main__")
            if "state" in watch.value:
                watch.value["state"] = watch.value["state"]()
        if not watch.value:
            raise RuntimeError(f"{self.file} neither stepped nor concluded")
        return watch.value, watch.done


@dataclass(frozen=True)
class Commands:
    """Commands one after another in one folder, {cases} and {threads} filled in; the files they leave, by ending.

    A line is a package and its arguments: "porescale run {cases}/piston --out run".  read : patterns of files.
    """

    lines: tuple[str, ...]
    read: tuple[str, ...]
    steps: int = 0

    def take(self, threads: int) -> tuple[Any, int]:
        """See Subject."""
        with TemporaryDirectory() as folder:
            for line in self.lines:
                words = [word.format(cases=CASES, threads=threads) for word in line.split()]
                command = [sys.executable, "-m", *words]
                told = {**os.environ, "PYTHONPATH": str(ROOT), "NUMBA_NUM_THREADS": str(threads)}
                ended = subprocess.run(command, cwd=folder, env=told, capture_output=True, text=True, check=False)
                if ended.returncode:
                    raise RuntimeError(f"{line}: {ended.returncode}: {ended.stderr[-800:]}")
            paths = sorted({it for pattern in self.read for it in Path(folder).glob(pattern)})
            if not paths:
                raise RuntimeError(f"{self.lines[-1]}: left nothing")
            return {path.relative_to(folder).as_posix(): content(path) for path in paths}, self.steps


def content(path: Path) -> Any:
    """What a file says: arrays of an .h5 or .vtkhdf, values of a .png, rows of a .csv, else its text."""
    if path.suffix == ".png":
        return np.asarray(Image.open(path))
    if path.suffix in (".h5", ".vtkhdf"):
        found: dict[str, Any] = {}
        with h5py.File(path) as file:
            file.visititems(lambda name, it: found.update({name: it[()]}) if isinstance(it, h5py.Dataset) else None)
        return {name: it.astype("S") if isinstance(it, np.ndarray) and it.dtype == object else it
                for name, it in found.items()}  # fmt: skip
    text = path.read_text(encoding="utf-8")
    return list(csv.reader(text.splitlines())) if path.suffix == ".csv" else text


@contextlib.contextmanager
def swapped(place: str, change: Any) -> Iterator[None]:
    """Put ``change`` of what lies at a place there, for a while."""
    holder, name = places.owner(place)
    was = vars(holder)[name]
    setattr(holder, name, change(was))
    try:
        yield
    finally:
        setattr(holder, name, was)


@contextlib.contextmanager
def _as_program(path: Path, arguments: Sequence[str]) -> Iterator[None]:
    """Command line and search path of a script."""
    argv, search = sys.argv, list(sys.path)
    sys.argv, sys.path[:0] = [str(path), *arguments], [str(path.parent)]
    try:
        yield
    finally:
        sys.argv, sys.path[:] = argv, search


def _copied(value: Any) -> Any:
    """Nested values whose arrays later steps leave alone."""
    if isinstance(value, dict):
        return {key: _copied(it) for key, it in value.items()}
    return value.copy() if isinstance(value, np.ndarray) else value

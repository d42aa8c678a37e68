"""The functions of a package for Python, the same in both: what each says is in its docstring."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

from porescale.common.api.program import Program

if TYPE_CHECKING:
    import pandas

    from porescale.common.api.load_scene import Settings
    from porescale.common.api.open_run import Run
    from porescale.common.api.report import Report
    from porescale.common.api.sweep import Vary
    from porescale.common.schema.diff import Diff

S = TypeVar("S")
M = TypeVar("M")


class Interface(Generic[S, M]):
    """What a package offers to Python, of a program with scenes of type S and simulations of type M."""

    def __init__(self, program: Program) -> None:
        self._program = program

    def load(self, scene: str | Path, *, quality: str | None = None, settings: Settings = ()) -> S:
        """The scene at a path, a TOML file or a folder with scene.toml; else that of a shipped case, by its name.

        quality : level "draft", "standard" or "fine"; None: the file's own default;  settings : ``section.key=value``
        each, or a mapping, ``{"fluid.spacing": "0.3 mm"}``.  Raises InputError with every fault of the file.
        """
        from porescale.common.api.load_scene import load_scene

        made: S = load_scene(self._program, scene, quality, settings)
        return made

    def diff(self, a: S | Run, b: S | Run) -> Diff:
        """What differs between two scenes, or those of two runs: a mapping, key -> (value in a, value in b), SI.

        None where one has no such key; empty where they are equal.  Raises InputError for anything else.
        """
        from porescale.common.schema.diff import diff

        return diff(a, b, self._program.scene())

    def build(self, scene: S) -> M:
        """The simulation of ``scene`` at time 0; raises InputError for what the scene must not request.

        A packing of grains is settled first, or read from the cache; that can take seconds.
        """
        made: M = self._program.build(self._program.required(scene))
        return made

    def check(self, scene: S) -> Report:
        """What `check` says of a scene: every number that follows from it, the cost, and warnings; prints as a table.

        Raises InputError with all that a scene must not request.
        """
        return self._program.report(self._program.required(scene))

    def run(
        self,
        scene: S | M,
        out: str | Path | None = None,
        *,
        resume: bool = False,
        overwrite: bool = False,
        threads: int | None = None,
        progress: bool = True,
    ) -> Run:
        """Run a scene to its end, write the run folder that the command ``run`` writes, and open it.

        scene : a scene, or a simulation of one at time 0, with its hooks;  out : the folder, runs/ and the scene's name
        if not given;  resume : go on with the run there, bit for bit as if it had not stopped;  overwrite : replace it;
        threads : of all that is computed from now on;  progress : a bar with the time left.

        Warnings of `check` are given as `PorescaleWarning`.  Raises InputError for what the scene must not request, for
        a folder that is in use, and for a run that is another's; Unstable, with the last valid state kept in the
        folder; and Interrupted after Ctrl-C, with the state saved.
        """
        from porescale.common.api.run import run

        return run(
            self._program, scene, out, resume=resume, overwrite=overwrite, threads=threads, progress=progress,
        )  # fmt: skip

    def open_run(self, folder: str | Path) -> Run:
        """Open the folder of a run, finished, running or killed.

        One of another package is read, but not painted.  InputError where it holds none, or a damaged one.
        """
        from porescale.common.api.open_run import open_run

        return open_run(folder, self._program)

    def sweep(
        self,
        scene: S | str | Path,
        vary: Vary | None = None,
        out: str | Path | None = None,
        *,
        repeat: int | None = None,
        over: str | None = None,
        quality: str | None = None,
        settings: Settings = (),
        jobs: int = 1,
        threads: int = 1,
        again: bool = False,
    ) -> pandas.DataFrame:
        """Run a scene with keys varied, as the command ``sweep`` does, and compare the runs; needs pandas.

        scene : a scene, its path, or the name of a case;  vary : ``{"contact.friction": [0.2, 0.5]}``, every
        combination of all values; or a mapping key -> value for each run; or a CSV or TOML file;  out : folder, runs/,
        the scene's name and _sweep if not given;  repeat : how often each is repeated, on other seeds;  over : what
        repeats differ in, in place of the scene's seeds, "section.key" (counted up) or "section.key=a,b,c";  quality,
        settings : as of `load`, of all runs;  jobs : runs at a time;  threads : of each;  again : retry what went
        unstable or failed.

        A row for each run, in the order of ``vary``: its name, the values varied, how it ended, what it cost, and the
        quantities of expected.toml beside the scene, else how every column of its series ends.  The run folders,
        sweep.csv, .md and .png lie in the folder, ``table.attrs["folder"]``; a sweep that was stopped goes on when
        called again.  Of repeats ``table.attrs["ensembles"]`` has the lines of ensemble.csv, means with intervals:
        ``pandas.DataFrame`` makes a table of them.  Runs that do not finish give a PorescaleWarning.  Raises InputError
        with what is wrong with any run before one starts.
        """
        from porescale.common.api.sweep import sweep

        return sweep(
            self._program, scene, vary, out,
            repeat=repeat, over=over, quality=quality, settings=settings, jobs=jobs, threads=threads, again=again,
        )  # fmt: skip

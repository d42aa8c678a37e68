"""A run in Python: its snapshots by number, its tables, and both as pandas, xarray, VTK, plots, pictures and films."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from functools import cached_property
from pathlib import Path
from textwrap import shorten
from typing import TYPE_CHECKING, Any, Unpack, cast, overload

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.extras import installed
from porescale.common.core.given_file import path_of
from porescale.common.core.html import Html, data_url, html_table, in_kernel, widget_bundle
from porescale.common.record import open_run as record
from porescale.common.record.columns import TIME, WIDE, Columns, missing
from porescale.common.record.model import Snapshot
from porescale.common.record.read_card import read_card, short_commit
from porescale.common.record.series import WORDS
from porescale.common.record.vtkhdf import Readers

if TYPE_CHECKING:
    import pyvista
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from porescale.common.api.program import Program
    from porescale.common.pictures.choose import FigureWords, LookWords, Wanted
    from porescale.common.pictures.picture import Painter
    from porescale.common.pictures.shown import Film, Picture


MAIN = ("fields", "grains", "particles")
"""Grids and clouds that come before others where arrays are looked for by name."""


class RunSnapshot(Snapshot):
    """A snapshot of a run, which notebooks show as a picture."""

    run: Run

    def picture(self) -> Picture:
        """The snapshot as `show` paints it, in colours that suit the whole run."""
        return self.run._painted(self)

    def _repr_png_(self) -> bytes | None:
        return self.picture()._repr_png_() if self.run.own else None


class Run(record.Run):
    """A run folder: what the run recorded, read on access.

    ``run[k]`` is snapshot k (from the end where negative) and reads no other; ``run[2:5]`` is a list of snapshots, all
    in memory; ``for snapshot in run`` reads one after the other; ``len(run)`` counts them.  ``run.times`` (s) and
    ``run.steps`` say when they were taken.  Arrays and units: ``run[-1]["velocity"]``, ``run[-1].grids``, ``.clouds``.
    """

    def __init__(self, folder: Path, card: dict[str, Any], frames: Any, program: Program) -> None:
        super().__init__(folder, card, frames)
        self.program = program

    def __getstate__(self) -> dict[str, Any]:
        """For pickling and copies, as other processes need them: without what paints, which is made anew."""
        return {name: value for name, value in self.__dict__.items() if name != "_painter"}

    @overload
    def __getitem__(self, k: int) -> RunSnapshot: ...
    @overload
    def __getitem__(self, k: slice) -> list[RunSnapshot]: ...
    def __getitem__(self, k: int | slice) -> RunSnapshot | list[RunSnapshot]:
        if not isinstance(k, slice):
            return self.snapshot(k)
        for end in (k.start, k.stop, k.step):
            if end is not None:
                _require_number(end)
        return [self.snapshot(each) for each in range(len(self))[k]]

    def __iter__(self) -> Iterator[RunSnapshot]:
        return self.snapshots()

    def snapshots(
        self, cells: Collection[str] | None = None, numbers: Iterable[int] | None = None
    ) -> Iterator[RunSnapshot]:
        """All snapshots in time, or those of these numbers, one in memory at a time; of grids as in `snapshot`."""
        return cast(Iterator[RunSnapshot], super().snapshots(cells, numbers))

    def snapshot(self, k: int, cells: Collection[str] | None = None) -> RunSnapshot:
        """Snapshot ``k`` (negative from the end); of its grids only the arrays in ``cells``, if given.

        IndexError beyond the last, InputError for what is no whole number, and when its file is damaged.
        """
        _require_number(k)
        if not -len(self) <= k < len(self):
            there = f"0 to {len(self) - 1}" if len(self) else "none"
            raise IndexError(f"snapshot {k} is not in this run: it has {len(self)} ({there})")
        return self._read(k, cells)

    def _read(self, k: int, cells: Collection[str] | None, readers: Readers | None = None) -> RunSnapshot:
        read = super()._read(k, cells, readers)
        grids = {name: read.grids[name] for name in sorted(read.grids, key=_place)}
        clouds = {name: read.clouds[name] for name in sorted(read.clouds, key=_place)}
        found = RunSnapshot(read.time, read.step, grids, clouds)
        found.run = self
        return found

    @property
    def outcome(self) -> str:
        """How the run ended: finished, unstable, interrupted, failed; or running."""
        return str(self.card.get("outcome", ""))

    @property
    def commit(self) -> str:
        """Eight digits of the commit of the package's tree that made the run, with a + where files had changed since;
        "" where it lay in none."""
        return short_commit(self.card.get("commit"))

    @property
    def tables(self) -> list[str]:
        """Names of the tables of numbers over time in the run folder: the series first, then by name."""
        found = sorted(path.stem for path in self.folder.glob("[!.]*.csv") if _over_time(path))
        return sorted(found, key=lambda name: name != "series")

    def table(self, name: str) -> Columns:
        """Columns of <name>.csv, such as "loads" or "probes"; InputError with the nearest name where there is none."""
        if not (self.folder / f"{name}.csv").is_file():
            known = [path.stem for path in self.folder.glob("[!.]*.csv")]  # breaks.csv, too, which has names of bodies
            raise missing("table", name, known, "the run folder")
        return super().table(name)

    def xarray(self, arrays: Sequence[str] | None = None, *, of: str | None = None) -> xarray.Dataset:
        """Arrays of all snapshots as an xarray Dataset with attributes ``units``; needs xarray (extra "notebook").

        arrays : names, None: all of one grid or cloud;  of : its name (None: the first grid that has them, or else the
        first cloud).

        Of a grid (time, y, x), with the centres of cells in m as coordinates; of a cloud (time, point), with x and y of
        each point as coordinates, filled up with nan (integers become floats) where the number of points changes; point
        k is the k-th of the snapshot.  Vectors have a dimension component (x, y).

        Nothing but names and sizes is read before values are used, and of a selection (``isel(time=-1)``) only its
        snapshots; one snapshot is in memory at a time besides the result.  Values are read anew at each use:
        ``.load()`` or ``.compute()`` keeps them.
        """
        from porescale.common.api.run_arrays import dataset

        return dataset(self, arrays, of)

    def vtk(self, k: int = -1) -> pyvista.MultiBlock:
        """Snapshot ``k`` for pyvista and VTK; needs pyvista (extra "notebook").

        A MultiBlock of an ImageData for each grid (values in cells) and a PolyData for each cloud (values at points),
        by name.  ``block.user_dict["units"]`` and the information of each array hold the units; the time (s) is in
        ``field_data["TimeValue"]``.
        """
        from porescale.common.api.run_vtk import blocks

        return blocks(self.snapshot(k))

    def plot(self, *columns: str, ax: Axes | None = None, table: str = "series") -> Any:
        """Columns of a table over time as curves, with labels and units; returns the Axes.

        Columns of different units get an Axes each, one below the other, which are returned as an array; with ``ax``
        they must be of one unit.  InputError with the nearest name where there is no such column.
        """
        from porescale.common.api.run_plot import plot

        return plot(self.series if table == "series" else self.table(table), columns, ax)

    def picture(self, k: int = -1, **words: Unpack[LookWords]) -> Picture:
        """Snapshot ``k`` as `show` paints it, in colours that suit the whole run; ``.save(path)`` writes it.

        words : as the options of `show`: field, colour, limits, colour_limits, arrows, view, size, in SI or as texts
        with units.  InputError where the run has not what they ask for.
        """
        painter = self._painter_of(words)
        return self._painted(self.snapshot(k, painter.survey.look.cells), painter)

    def film(self, path: Path | str | None = None, *, rate: int | None = None, **words: Unpack[LookWords]) -> Film:
        """Write the film that `show` writes; displays in notebooks.

        path : of the file (None: film in the run folder); the ending follows from the encoder, .mp4 or .webm;
        rate : frames a second (None: so that it lasts about six seconds);  words : as of `picture`.
        """
        from porescale.common.pictures.film import film_of
        from porescale.common.pictures.shown import Film

        stem = self.folder / "film" if path is None else path_of("path", path, "name a file")
        stem = stem.with_suffix("") if stem.suffix in (".mp4", ".webm") else stem
        return Film(film_of(self, self._painter_of(words, ("rate",)), stem, rate))

    def figure(
        self, path: Path | str | None = None, *, against: Run | None = None, **words: Unpack[FigureWords]
    ) -> Figure | Path:
        """The figure of `show` with options: one panel for each of ``times``, as a figure of matplotlib.

        path : file to write instead, .png, .pdf, .svg, .mp4 or .gif; its path is returned;  against : another run, set
        beside this with the same colours;  words : those of `picture`, and times (s), every, fps, style ("paper" or
        "talk") and format.  InputError where the runs have not what they ask for, or their boxes differ.
        """
        from porescale.common.pictures.figure import figure_of, write_figure

        wanted, file = wanted_of(words), None if path is None else path_of("path", path, "name a file")
        if against is not None and not isinstance(against, Run):
            problem, repair = f"is no run ({type(against).__name__})", "give one of open_run"
            raise InputError(Fault("against", str(against), problem, repair=repair))
        runs = [self] if against is None else [self, against]
        for run in runs:
            run.require_own()
        looked = [(run, run.program.look(run)) for run in runs]
        return figure_of(looked, wanted) if file is None else write_figure(looked, wanted, file)

    def measure(self, *given: Any, out: Path | str | None = None, **sections: Any) -> dict[str, Columns]:
        """What sections of a scene measure, at every snapshot of this run, as tables by name: {"probes": Columns, …}.

        given : section objects; or a scene, or the path of a TOML file, with such sections;  sections : tables by the
        key of their section, one or a list: ``run.measure(probe={"x": 0.1, "y": 0.02})``;  out : folder to write the
        tables to as CSV files, none of which may be there (None: none are written).

        The sections are `probe`, `flux`, `line` and `region` of porescale, `probe` and `level` of continuum-sph.  Names
        and columns are those of a run that measures itself, and so are the numbers, but for the single precision of
        stored fields.  What snapshots do not hold is left out with a PorescaleWarning, or refused with InputError.
        """
        from porescale.common.api.measure import measure, write_tables

        self.require_own()
        folder = None if out is None else path_of("out", out, "name a folder")
        tables = measure(self, self.program, given, sections)
        if folder is not None:
            write_tables(tables, folder)
        return tables

    def show(self) -> list[Path]:
        """Write pictures, film and profiles into the run folder, as the command `show` does; returns their paths."""
        self.require_own()
        return [Path(path) for path in self.program.show(self.folder)]

    @property
    def own(self) -> bool:
        """Whether the run is one of the package that opened it, which paints and measures its own runs alone."""
        return self.card.get("package") in (None, self.program.name)

    def require_own(self) -> None:
        """InputError where another package must open the run, or where it is one of another command's: of no scene."""
        whose = str(self.card.get("package"))
        if whose.startswith(f"{self.program.name} "):
            problem = f"holds a run of {whose}, and so of no scene"
            repair = f"paint it with {self.program.name} show; to measure, run its scene ({whose} convert makes one)"
            raise InputError(Fault("run folder", str(self.folder), problem, repair=repair))
        read_card(self.folder, self.program.name)

    @cached_property
    def _painter(self) -> Painter:
        """What paints snapshots in colours that suit all of them."""
        from porescale.common.pictures.picture import painter_of

        self.require_own()
        return painter_of(self, self.program.look(self))

    def _painter_of(self, words: LookWords, others: Sequence[str] = ()) -> Painter:
        """What paints snapshots as ``words`` ask for;  others : what messages name as known besides."""
        from porescale.common.pictures.choose import LookWords
        from porescale.common.pictures.picture import painter_of

        wanted = wanted_of(words, (*LookWords.__annotations__, *others))
        if isinstance(wanted.size, str):
            repair = "give pixels, 200 to 8000; a width is that of run.figure"
            raise InputError(Fault("size", wanted.size, "is no number of pixels", repair=repair))
        if wanted.plain or not len(self):
            return self._painter
        self.require_own()
        return painter_of(self, wanted.look(self.program.look(self), self))

    def _painted(self, snapshot: Snapshot, painter: Painter | None = None) -> Picture:
        from porescale.common.pictures.shown import Picture

        return Picture((painter or self._painter).paint(snapshot), f"{self.name}, t = {snapshot.time:.6g} s")

    def __repr__(self) -> str:
        ended = f"{self.outcome or 'run'} at t = {float(self.card.get('time') or 0.0):.6g} s"
        if self.outcome == "running":
            ended = "running"
        first = f"Run {self.name!r} of {self.card.get('package', self.program.name)}: {ended}, in {self.folder}"
        return "\n".join((shorten(first, WIDE, placeholder=" …"), self._counted(), self._listed()))

    def _counted(self) -> str:
        """Snapshots and their times in a few words."""
        if not len(self):
            return "no snapshots"
        times = self.times
        return f"{len(self)} snapshots, t = {times[0]:.6g} to {times[-1]:.6g} s"

    def _listed(self) -> str:
        """Tables in one line."""
        return shorten(f"tables: {', '.join(self.tables) or 'none'}", WIDE, placeholder=" …")

    def widget(self) -> Any:
        """The page of `report` in a notebook, with all frames and tables; it goes on while the run is written.

        Needs anywidget (extra "widget"); with it Jupyter, VS Code and marimo show a run so by themselves.
        """
        self.require_own()
        if self.program.widget is None:
            raise InputError(Fault("widget", None, f"{self.program.name} has none", repair="take run.picture()"))
        return self.program.widget(self)

    def _has_widget(self) -> bool:
        """Whether the run shows itself as a widget where one can be shown."""
        there = self.own and bool(len(self) or self.tables)
        return there and self.program.widget is not None and installed("anywidget")

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        """The widget, besides what the other methods give, in a kernel of Jupyter."""
        return widget_bundle(self.widget()) if in_kernel() and self._has_widget() else {}

    def _display_(self) -> Any:
        """What a cell of marimo shows: the widget, or the page where its extra is not installed."""
        return self.widget() if self._has_widget() else Html(self._repr_html_())

    def _repr_png_(self) -> bytes | None:
        return self.picture()._repr_png_() if len(self) and self.own else None

    def _repr_html_(self) -> str:
        rows = [("folder", self.folder), ("snapshots", self._counted()), ("tables", ", ".join(self.tables))]
        keys = {"title": "", "outcome": "", "problem": "", "time": " s", "step": " steps", "seconds": " s of computing"}
        card = {**self.card, "title": self.card["scene"].get("title")}
        about = [(key, f"{card[key]}{unit}") for key, unit in keys.items() if card.get(key) not in (None, "")]
        text = html_table(f"Run {self.name!r} of {self.card.get('package', self.program.name)}", (), [*about, *rows])
        picture = self._repr_png_()
        return text if picture is None else f"{text}<img style='max-width:100%' src='{data_url('image/png', picture)}'>"


def wanted_of(words: Mapping[str, Any], known: Collection[str] = ()) -> Wanted:
    """Words of Python as what is wanted; InputError, with the nearest, for a word that is none.

    known : the words that there are (empty: all of `Wanted`).
    """
    from porescale.common.pictures.choose import Wanted

    known = known or [it.name for it in fields(Wanted)]
    for name in words:
        if name not in known:
            raise missing("argument", name, known, "those of pictures")
    return Wanted(**words)


def open_run(folder: Path | str, program: Program) -> Run:
    """Open a run folder; InputError where it holds no run, or a damaged one.

    One of another package or of `demseg` is read as well, but not painted or measured.
    """
    lean = record.open_run(path_of("folder", folder, "name a folder that `run` has written"))
    return Run(lean.folder, lean.card, dict(lean._frames), program)


def _place(name: str) -> tuple[bool, str]:
    """Sorts names: those of MAIN first."""
    return name not in MAIN, name


def _require_number(k: Any) -> None:
    """InputError where ``k`` is not the whole number of a snapshot."""
    if not hasattr(k, "__index__"):
        repair = "give a whole number, from the end where negative"
        raise InputError(Fault("snapshot", str(k), f"is no number of a snapshot ({type(k).__name__})", repair=repair))


def _over_time(path: Path) -> bool:
    """Whether a CSV file is a table of numbers over time, by its first two lines."""
    try:
        with open(path, encoding="utf-8") as file:
            head, row = file.readline(), file.readline()
        [float(cell) for cell in row.split(",")] if row.strip() else None
    except (OSError, ValueError):
        return False
    return head.startswith(TIME) and not WORDS.intersection(head.rstrip().split(","))  # which a table without rows has

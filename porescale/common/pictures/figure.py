"""Figures of a run for papers and talks, one panel a time, alone or beside another run with the same colours."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from porescale.common.core.atomic import whole
from porescale.common.core.errors import Fault, InputError
from porescale.common.pictures.axes import draw_inside
from porescale.common.pictures.choose import FILMS, Wanted
from porescale.common.pictures.film import rate_of, write_film, write_gif
from porescale.common.pictures.layout import Style, stage
from porescale.common.pictures.look import Look, Survey, survey, time_text
from porescale.common.pictures.picture import Sheet, surveyed
from porescale.common.record.progress import Watch

if TYPE_CHECKING:
    from porescale.common.core.types import AnyArray
    from porescale.common.record.model import Snapshot
    from porescale.common.record.open_run import Run

    Looked = Sequence[tuple[Run, Look]]

SETTINGS: Any = {
    "pdf.fonttype": 42,  # letters stay letters, which journals ask for
    "svg.fonttype": "none",
    "svg.hashsalt": "porescale",
    "axes.linewidth": 0.6,
    "font.family": "sans-serif",
    "font.sans-serif": ["Arial", "Helvetica", "Liberation Sans", "DejaVu Sans"],
    "mathtext.fontset": "dejavusans",
}
CLOSE = 1e-6
"""Boxes whose sides differ by less of their length are the same."""


def write_figure(looked: Looked, wanted: Wanted, out: Path | None = None) -> Path:
    """Write what is ``wanted`` of a run, or of two beside each other, and give the path: one file, whole or not at all.

    looked : each run with its look;  out : the file (None: figure.png, or another ending, in the first run's folder).
    """
    kind = wanted.kind(out)
    path = out or looked[0][0].folder / f"figure.{kind}"
    if not path.suffix:
        path = path.with_suffix(f".{kind}")
    if path.is_dir():
        raise InputError(Fault("out", str(path), "is a folder", repair="name a file"))
    film = kind in FILMS
    found, chosen = _surveyed(looked, wanted, film=film)
    if film:
        style = wanted.styled(len(looked), found.look)
        return _film(looked, chosen, found, replace(style, scale_bar=False, titled=True), path, wanted.fps)
    figure = _figure(looked, chosen, found, wanted)
    with rc_context(SETTINGS), whole(path) as beside:
        more: dict[str, Any] = {"metadata": {"Date": None}} if kind == "svg" else {}
        more = {"metadata": {"CreationDate": None}} if kind == "pdf" else more
        figure.savefig(beside, format=kind, dpi=figure.dpi, **more)
    return path


def figure_of(looked: Looked, wanted: Wanted) -> Figure:
    """The figure that `write_figure` writes."""
    found, chosen = _surveyed(looked, wanted, film=False)
    return _figure(looked, chosen, found, wanted)


def _surveyed(looked: Looked, wanted: Wanted, *, film: bool) -> tuple[Survey, list[list[int]]]:
    """Colours common to all runs, and what is shown, of each run as many; InputError where boxes differ."""
    require_same_box(looked)
    chosen = [wanted.chosen(looked[0][0], film=film)]
    for run, _ in looked[1:]:
        own = wanted.chosen(run, film=film)
        if film or (wanted.times is None and wanted.every is not None):
            times = looked[0][0].times[chosen[0]]
            chosen[0] = [k for k, time in zip(chosen[0], times, strict=True) if time <= run.times[-1] * (1 + CLOSE)]
            own = [int(np.abs(run.times - time).argmin()) for time in looked[0][0].times[chosen[0]]]
        chosen.append(own)
    looks = [wanted.look(look, run) for run, look in looked]
    title = looks[0].title or looked[0][0].name
    title = title if len(looked) == 1 else ""
    shown: Iterator[Snapshot] = chain.from_iterable(run.snapshots(looks[0].cells, surveyed(run)) for run, _ in looked)
    return survey(shown, replace(looks[0], title=title)), chosen


def require_same_box(looked: Looked) -> None:
    """InputError, with both sizes, unless the boxes of all runs are the same."""
    views = [look.whole for _, look in looked]
    for view in views[1:]:
        if view is None or views[0] is None:
            continue
        longest = max(views[0][1] - views[0][0], views[0][3] - views[0][2])
        if max(abs(a - b) for a, b in zip(view, views[0], strict=True)) > CLOSE * longest:
            one, other = (f"{it[1] - it[0]:g} m x {it[3] - it[2]:g} m" for it in (views[0], view))
            repair = "compare runs of one box, or make a figure of each"
            raise InputError(Fault("against", other, f"is another box than {one}", repair=repair))


def _named(looked: Looked) -> list[str]:
    """What tells the runs apart: their names, or their folders; "" of one alone."""
    if len(looked) == 1:
        return [""]
    names = [run.name for run, _ in looked]
    return names if len(set(names)) == len(names) else [run.folder.resolve().name for run, _ in looked]


def _figure(looked: Looked, chosen: list[list[int]], found: Survey, wanted: Wanted) -> Figure:
    """Panels row by row: of each time, all runs."""
    shown = [(name, run, k) for row in zip(*chosen, strict=True)
             for name, (run, _), k in zip(_named(looked), looked, row, strict=True)]  # fmt: skip
    style = wanted.styled(len(shown), found.look)
    with rc_context(SETTINGS):
        snapshots = [run.snapshot(k, found.look.cells) for _, run, k in shown]
        texts = [
            time_text(it.time, found.longest, found.look.plain).replace(" ", "\u00a0") for it in snapshots
        ]  # whole
        headers = [f"{name}, {text}" if name else text for (name, _, _), text in zip(shown, texts, strict=True)]
        if style.lettered and len(headers) > 1:
            headers = [f"({chr(97 + k)}) {text}" for k, text in enumerate(headers)]
        made = stage(found, headers, style)
        for snapshot, axes in zip(snapshots, made.panels, strict=True):
            draw_inside(snapshot, found, axes)
    return made.figure


def _film(
    looked: Looked,
    chosen: list[list[int]],
    found: Survey,
    style: Style,
    path: Path,
    fps: int | None,
) -> Path:
    """A film of the snapshots, all runs in each frame."""
    frames = list(zip(*chosen, strict=True))
    if not frames:
        raise InputError(Fault("against", None, "has no snapshot at the times of the other", repair="let it run on"))
    sheet = Sheet(found, _named(looked), style)
    rate = fps or rate_of(len(frames))
    runs = [run for run, _ in looked]
    first, last = (float(runs[0].times[frames[k][0]]) for k in (0, -1))

    def painted(watch: Watch) -> Iterator[AnyArray]:
        """The pictures of both runs at the times of ``frames``, each (height, width, 3), in order."""
        for row in frames:
            snapshots = [run.snapshot(k, found.look.cells) for run, k in zip(runs, row, strict=True)]
            watch.update(int(row[0]), snapshots[0].time)
            yield sheet.paint(snapshots)

    with Watch("film", first, last) as watch:
        watch.enter("painting")
        if path.suffix.lower() == ".gif":
            return write_gif(path, painted(watch), rate)
        return write_film(path.with_suffix(""), painted(watch), rate)

"""What a person asks pictures to show: words of `show`, of Python and of [look], checked against a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range
from porescale.common.pictures.layout import COLUMN, STYLES, Style, screen
from porescale.common.record.columns import missing
from porescale.common.schema.quantity import Quantity, Refused

if TYPE_CHECKING:
    from porescale.common.pictures.look import Look
    from porescale.common.record.open_run import Run

STILLS, FILMS = ("png", "pdf", "svg"), ("mp4", "gif")
MOST_PANELS = 12
"""Panels of a figure beyond which none can be read."""
Pair = tuple[float | str, float | str]
Box = tuple[float | str, float | str, float | str, float | str]


class LookWords(TypedDict, total=False):
    """Keywords of pictures and films in Python: those of `Wanted` that say what is shown."""

    field: str
    colour: str
    limits: Pair
    colour_limits: Pair
    arrows: int
    view: Box
    size: int | str


class FigureWords(LookWords, total=False):
    """Those of figures besides."""

    times: Sequence[float | str]
    every: int
    fps: int
    style: str
    format: str


@dataclass(frozen=True)
class Wanted:
    """What is asked for; None is as always.

    field : array of cells that is painted, or that colours points where there are no cells;  colour : array of points
    that colours them;  limits, colour_limits : of their colours, numbers in SI units or texts with a unit;  arrows :
    across the picture;  view : (left, right, bottom, top), m or texts;  size : pixels of the long side, or a width of
    the figure as "85 mm";  times : of the panels, or first and last of a film, s or texts;  every : so many snapshots;
    fps : frames a second;  style : "paper" or "talk";  format : one of STILLS and FILMS.
    """

    field: str | None = None
    colour: str | None = None
    limits: Pair | None = None
    colour_limits: Pair | None = None
    arrows: int | None = None
    view: Box | None = None
    size: int | str | None = None
    times: Sequence[float | str] | None = None
    every: int | None = None
    fps: int | None = None
    style: str | None = None
    format: str | None = None

    @property
    def plain(self) -> bool:
        """Whether nothing is asked for."""
        return all(getattr(self, it.name) is None for it in fields(self))

    def kind(self, out: Path | None) -> str:
        """The format: as asked for, that of the file's name, or that which fits; InputError where they contradict."""
        ending = out.suffix[1:].lower() if out else ""
        known = (*STILLS, *FILMS)
        for key, word in (("format", self.format), ("out", ending)):
            if word and word not in known:
                raise InputError(Fault(key, word, "is no format of pictures", allowed=", ".join(known)))
        if self.format and ending and self.format != ending:
            repair = f"name it {out.stem}.{self.format}" if out else ""
            raise InputError(Fault("format", self.format, f"contradicts the file, {ending}", repair=repair))
        chosen = self.format or ending or ("png" if self.fps is None else "mp4")
        if self.fps is not None and chosen not in FILMS:
            repair = f"choose {' or '.join(FILMS)}, or leave fps out"
            raise InputError(Fault("fps", self.fps, f"is of films, {chosen} is a still", repair=repair))
        fastest = 50 if chosen == "gif" else 120  # browsers show frames of a GIF for 20 ms at least
        for key, most in (("fps", fastest), ("every", 1_000_000)):
            _require_whole(key, getattr(self, key), 1, most)
        return chosen

    def styled(self, panels: int, look: Look) -> Style:
        """The style of the figure, of ``panels``."""
        if self.style is not None and self.style not in STYLES:
            raise InputError(Fault("style", self.style, "unknown choice", allowed=", ".join(STYLES)))
        style = STYLES[self.style] if self.style else screen(look.size, 1.0 if panels == 1 else 1.25)
        if self.style == "paper" and panels == 1:
            style = replace(style, width=COLUMN)
        if isinstance(self.size, str):
            width = _number("size", self.size, Quantity("m", ge=0.02, le=2.0, help="width of the figure")) / 0.0254
            return replace(style, width=width, height=max(style.height, width))
        if self.size is not None and self.style:
            return replace(style, dpi=max(20, round(self.size / max(style.width, style.height))))
        return style

    def look(self, look: Look, run: Run) -> Look:
        """``look`` with what is asked for; InputError where the run has it not, or it lies outside."""
        last = run.snapshot(-1)
        made = look
        if self.field is not None:
            made = self._of_field(made, run)
        if self.colour is not None:
            made = _coloured(made, self.colour, run)
        if self.limits is not None:
            grid = made.painted(last)
            unit = grid.units.get(made.field, "") if grid else _unit(made, run)
            pair = limits_of("limits", self.limits, unit)
            made = replace(made, limits=pair) if grid else replace(made, cloud_limits=pair)
        if self.colour_limits is not None:
            made = replace(made, cloud_limits=limits_of("colour_limits", self.colour_limits, _unit(made, run)))
        if self.arrows is not None:
            _require_whole("arrows", self.arrows, 0, 500)
            made = replace(made, arrows=int(self.arrows))
        if self.size is not None and not isinstance(self.size, str):
            _require_whole("size", self.size, 200, 8000, ' pixels, or "85 mm"')
            made = replace(made, size=int(self.size))
        return made if self.view is None else replace(made, view=self._view(look, run))

    def _of_field(self, look: Look, run: Run) -> Look:
        """The field painted, or the array of points where there are no cells."""
        assert self.field is not None
        last = run.snapshot(-1)
        name = next((it for it in (look.grid, *last.grids) if it in last.grids and self.field in last.grids[it]), None)
        if name is not None:
            streams = look.streamlines and name == look.grid
            return replace(look, grid=name, field=self.field, label="", limits=None, streamlines=streams)
        if not last.grids and self.colour is None:
            return _coloured(look, self.field, run, "field")
        known = [array for grid in last.grids.values() for array in grid]
        if not known:
            raise InputError(Fault("field", self.field, "this run has no cells", repair="colour points by colour"))
        raise missing("field", self.field, known, "the cells of this run")

    def _view(self, look: Look, run: Run) -> tuple[float, float, float, float]:
        """The part of the box; InputError unless it is one."""
        assert self.view is not None
        if len(self.view) != 4:
            given = ", ".join(map(str, self.view))
            raise InputError(Fault("view", given, "must be left, right, bottom, top", "m"))
        left, right, bottom, top = (_number("view", it, Quantity("m", help="sides of the view")) for it in self.view)
        edges = _around(look) or next((grid.extent for grid in run.snapshot(-1).grids.values()), None)
        allowed = f"x {edges[0]:g} to {edges[1]:g}, y {edges[2]:g} to {edges[3]:g}" if edges else ""
        given = f"{left:g}, {right:g}, {bottom:g}, {top:g}"
        if not (left < right and bottom < top):
            repair = "give sides with something between them" if left == right or bottom == top else "order them"
            raise InputError(Fault("view", given, "must be left, right, bottom, top", "m", allowed, repair))
        if edges:
            slack = 1e-9 * max(abs(it) for it in edges)
            if not (edges[0] - slack <= left and right <= edges[1] + slack
                    and edges[2] - slack <= bottom and top <= edges[3] + slack):  # fmt: skip
                raise InputError(Fault("view", given, "reaches out of the box", "m", allowed))
        return left, right, bottom, top

    def chosen(self, run: Run, *, film: bool) -> list[int]:
        """Numbers of the snapshots that are shown: at the times, every so many, or the last; of a film all."""
        times, count = run.times, len(run)
        run.require_snapshots()
        picked = list(range(count)) if film or (self.every and not self.times) else [count - 1]
        if self.times is not None:
            asked = [_number("times", it, Quantity("s", help="times")) for it in self.times]
            slack = 1e-9 * float(np.abs(times).max())
            for it in asked:
                if not times[0] - slack <= it <= times[-1] + slack:
                    between = f"{times[0]:g} to {times[-1]:g}"
                    raise InputError(Fault("times", it, "is beyond the run", "s", between))
            picked = [int(np.abs(times - it).argmin()) for it in asked]
            if film and len(picked) != 2:
                raise InputError(Fault("times", len(picked), "of a film are the first and the last", "", "2"))
            if film:
                first, last = sorted(picked)
                picked = list(range(first, last + 1))
        if self.every and (film or not self.times):
            picked = picked[:: self.every]
        if not film and len(picked) > MOST_PANELS:
            repair = "name fewer times, more snapshots between them (every), or a film"
            raise InputError(Fault("times", len(picked), "are too many panels", "", f"<= {MOST_PANELS}", repair))
        return picked


def with_section(look: Look, section: Mapping[str, Any] | None, *, cells: bool = True) -> Look:
    """``look`` with what the table [look] of a scene says, as on a run card.

    cells : whether the scene has any; without them the field and its limits are those of the points, as of `Wanted`.
    """
    if not section:
        return look
    given = {key: value for key, value in section.items() if value}
    if not cells:
        for key, of_points in (("field", "colour"), ("limits", "colour_limits")):
            if key in given:
                given.setdefault(of_points, given.pop(key))
    names = {"colour_limits": "cloud_limits"}
    made = replace(look, box=look.whole, **{names.get(key, key): _tuples(value) for key, value in given.items()})
    if "field" in given:
        made = replace(made, label="")
    return replace(made, kinds={}) if "colour" in given else made


def _around(look: Look) -> tuple[float, float, float, float] | None:
    """What a view may show, m: the box, and what is seen beside it; None where neither is known."""
    if look.view is None or look.whole is None:
        return None
    (left, right, bottom, top), (a, b, c, d) = look.view, look.whole
    return min(left, a), max(right, b), min(bottom, c), max(top, d)


def _tuples(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


def _coloured(look: Look, name: str, run: Run, key: str = "colour") -> Look:
    """Points coloured by an array; InputError, with the nearest name, where they have none of that name."""
    last = run.snapshot(-1)
    known = [array for cloud in (look.drawn(last), look.shaped(last)) if cloud is not None for array in cloud.data]
    if name not in known:
        raise missing(key, name, known, "the points of this run")
    return replace(look, colour=name, kinds={}, cloud_limits=None)


def _unit(look: Look, run: Run) -> str:
    """Unit of the array that colours points."""
    last = run.snapshot(-1)
    clouds = (it for it in (look.drawn(last), look.shaped(last)) if it is not None)
    return next((cloud.units.get(look.colouring(cloud), "") for cloud in clouds if look.colouring(cloud)), "")


def _require_whole(key: str, value: Any, least: int, most: int, more: str = "") -> None:
    """InputError unless ``value`` is None or a whole number within the range;  more : what else is allowed."""
    if value is not None and Range(ge=least, le=most, whole=True).fault_of(key, value) is not None:
        shown = value if isinstance(value, int | float) else str(value)
        raise InputError(Fault(key, shown, "is out of range", allowed=f"whole, {least} to {most}{more}"))


def limits_of(key: str, pair: Pair, unit: str) -> tuple[float, float]:
    """The limits of colours: two numbers in ``unit``, or texts with one, the lower first; InputError for others."""
    if not hasattr(pair, "__len__") or isinstance(pair, str) or len(pair) != 2:
        shown = ", ".join(map(str, pair)) if hasattr(pair, "__len__") and not isinstance(pair, str) else str(pair)
        raise InputError(Fault(key, shown, "must be two numbers, low and high", unit, repair="give (low, high)"))
    own = Quantity("" if unit == "1" else unit, help="range of the colours")
    low, high = _number(key, pair[0], own), _number(key, pair[1], own)
    if not low < high:
        repair = "give two that differ" if low == high else "exchange them"
        raise InputError(Fault(key, f"{low:g}, {high:g}", "must be low and high", unit, repair=repair))
    return low, high


def _number(key: str, value: float | str, quantity: Quantity) -> float:
    """A number in SI; InputError where it is none."""
    try:
        return float(quantity.convert(value, key))
    except Refused as refused:
        raise InputError(list(refused.faults)) from None

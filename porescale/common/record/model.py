"""Interface of a model that is run and recorded, and of its fields for output.  Independent of the physics.

A model is anything that steps through time, can check whether its state is valid, and can return its whole
state.  Grids and clouds are all that the record, the pictures and ParaView need.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from textwrap import shorten
from typing import Any, Protocol, runtime_checkable

from porescale.common.core.html import html_table
from porescale.common.core.types import AnyArray
from porescale.common.record.columns import WIDE, missing


@dataclass(repr=False)
class Grid:
    """Values in the cells of a regular grid.

    origin : (x, y) of the lower left corner, m;  spacing : (dx, dy), m;
    cells : name -> (ny, nx) or (ny, nx, 3) array of any real type, row 0 lowest;  units : name -> unit, "" or
    missing when dimensionless.  Names must not hold "/" or ".".
    """

    origin: tuple[float, float]
    spacing: tuple[float, float]
    cells: dict[str, AnyArray]
    units: dict[str, str] = field(default_factory=dict)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns: (ny, nx)."""
        ny, nx = next(iter(self.cells.values())).shape[:2]
        return int(ny), int(nx)

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """(left, right, bottom, top), m."""
        ny, nx = self.shape
        left, bottom = self.origin
        return left, left + nx * self.spacing[0], bottom, bottom + ny * self.spacing[1]

    def __getitem__(self, name: str) -> AnyArray:
        array: AnyArray = _named(self.cells, name, "this grid")
        return array

    def __iter__(self) -> Iterator[str]:
        return iter(self.cells)

    def __repr__(self) -> str:
        left, right, bottom, top = self.extent
        ny, nx = self.shape
        where = f"x {left:.6g} to {right:.6g} m, y {bottom:.6g} to {top:.6g} m"
        return f"Grid of {ny} x {nx} cells (rows x columns), {where}\n{_listed(self.cells, self.units)}"

    def _repr_html_(self) -> str:
        return _table(repr(self).partition("\n")[0], self.cells, self.units)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.cells)


@dataclass(repr=False)
class Cloud:
    """Values at points: grains, particles, tracers.

    position : (n, 2) m;  data : name -> (n,) or (n, 3) array;  units : name -> unit.
    Discs carry "radius" (m) in ``data``, and "angle" (rad) when they turn.  n may change from one snapshot
    to the next, the names may not.

    Points may be ends of ``lines`` (m, 2), and corners of ``polygons``, (offsets (p + 1,), numbers of points): then
    these are what is to be seen, with "radius" the half of what they measure across.  Both or neither in all snapshots.
    """

    position: AnyArray
    data: dict[str, AnyArray] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    lines: AnyArray | None = None
    polygons: tuple[AnyArray, AnyArray] | None = None

    def __getitem__(self, name: str) -> AnyArray:
        array: AnyArray = _named({"position": self.position, **self.data}, name, "this cloud")
        return array

    def __iter__(self) -> Iterator[str]:
        return iter(("position", *self.data))

    def __repr__(self) -> str:
        shown = {"position": self.position, **self.data}
        return f"Cloud of {len(self.position)} points\n{_listed(shown, {'position': 'm', **self.units})}"

    def _repr_html_(self) -> str:
        shown = {"position": self.position, **self.data}
        return _table(repr(self).partition("\n")[0], shown, {"position": "m", **self.units})

    def _ipython_key_completions_(self) -> list[str]:
        return ["position", *self.data]


@dataclass(repr=False)
class Snapshot:
    """A model at one instant: ``time`` (s), ``step`` (steps done) and its grids and clouds by name.

    Each name becomes a file <name>.vtkhdf; names, array names, types and grid geometry stay the same over a
    run.  ``snapshot["grains"]`` is the grid or cloud of that name, ``snapshot["velocity"]`` the array of the first
    grid, or else cloud, that has it.
    """

    time: float
    step: int
    grids: dict[str, Grid] = field(default_factory=dict)
    clouds: dict[str, Cloud] = field(default_factory=dict)

    def blocks(self) -> Iterator[tuple[str, str, Grid | Cloud]]:
        """Every grid and cloud as (kind, name, block), kind "grids" or "clouds"."""
        for name, grid in self.grids.items():
            yield "grids", name, grid
        for name, cloud in self.clouds.items():
            yield "clouds", name, cloud

    __iter__ = None  # else Python would try numbers for names

    def __getitem__(self, name: str) -> Any:
        found: dict[str, Any] = {key: block for _, key, block in self.blocks()}
        for _, _, block in self.blocks():
            found = (block.cells if isinstance(block, Grid) else block.data) | found
        return _named(found, name, "this snapshot")

    def __repr__(self) -> str:
        lines = [f"Snapshot at t = {self.time:.6g} s, step {self.step}"]
        grids = {name: (" x ".join(map(str, it.shape)), it.cells) for name, it in self.grids.items()}
        clouds = {name: (f"{len(it.position)} points", it.data) for name, it in self.clouds.items()}
        for kind, found in (("grids", grids), ("clouds", clouds)):
            sizes = [f"{name} {size}" for name, (size, _) in found.items()]
            whole = [f"{name} {size} ({', '.join(arrays)})" for name, (size, arrays) in found.items()]
            text = f"{kind}: {'; '.join(whole)}"
            text = text if len(text) <= WIDE else f"{kind}: {'; '.join(sizes)}"
            lines += [shorten(text, WIDE, placeholder=" …")] if found else []
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        return repr(self).partition("\n")[0] + "".join(
            _table(f"{name}: {repr(it).partition(chr(10))[0]}", it.cells if isinstance(it, Grid) else it.data, it.units)
            for _, name, it in self.blocks()
        )

    def _ipython_key_completions_(self) -> list[str]:
        arrays = (it.cells if isinstance(it, Grid) else it.data for _, _, it in self.blocks())
        return list(dict.fromkeys([*self.grids, *self.clouds, *(name for each in arrays for name in each)]))


def _named(found: Mapping[str, Any], name: str, where: str) -> Any:
    """The entry of that name; MissingColumn with the nearest where there is none."""
    if name in found:
        return found[name]
    raise missing("array", name, found, where)


def _listed(arrays: Mapping[str, AnyArray], units: Mapping[str, str]) -> str:
    """Names with units in one line."""
    return shorten(", ".join(f"{name} ({_unit(units, name)})" for name in arrays), WIDE, placeholder=" …")


def _unit(units: Mapping[str, str], name: str) -> str:
    """The unit of an array, "" where it has none; files have "1" there."""
    unit = units.get(name, "")
    return "" if unit == "1" else unit


def _table(caption: str, arrays: Mapping[str, AnyArray], units: Mapping[str, str]) -> str:
    """Arrays with unit, shape, type, least and largest value, as HTML."""
    rows = [
        [name, _unit(units, name), " x ".join(map(str, it.shape)), it.dtype, *((f"{it.min():.4g}", f"{it.max():.4g}") if
         it.size else ("", ""))]
        for name, it in arrays.items()
    ]  # fmt: skip
    return html_table(caption, ["array", "unit", "shape", "type", "least", "largest"], rows)


@runtime_checkable
class Model(Protocol):
    """What :func:`porescale.common.record.drive.drive` drives.

    ``advance(a)`` then ``advance(b)`` must give the same bits as ``advance(a + b)``, and ``series``,
    ``snapshot``, ``check`` and ``state`` must leave the state as it is: output then never changes the
    physics.

    A model whose step varies in time sets the class attribute ``variable_step = True`` (absent means
    False): it is then advanced one step at a time, ``time`` is the authority, and events are recorded at
    the first step at or after their time.

    A model that measures more than its series holds has a method ``tables()`` that gives a row for each further
    file: {"loads": {"time (s)": …, …}} goes to loads.csv, at the same times as the series and cut back like it.
    """

    @property
    def step(self) -> int:
        """Number of steps done."""

    @property
    def time(self) -> float:
        """Simulated time reached, s."""

    @property
    def step_seconds(self) -> float:
        """Length of a step, s (of the next one, if it varies)."""

    def advance(self, steps: int) -> None:
        """Do ``steps`` steps.  May raise Unstable."""

    def check(self) -> None:
        """Raise Unstable when the state is not finite or out of bounds (called every 100 steps and before records)."""

    def series(self) -> dict[str, float]:
        """One row of the series; the same keys every time, with units: "time (s)", "front (m)"."""

    def snapshot(self) -> Snapshot:
        """Grids and clouds now; arrays may be views, they are written before the model moves on."""

    def state(self) -> dict[str, Any]:
        """Nested dicts of arrays, numbers, strings, booleans, None: all it takes to go on bit for bit."""

    def restore(self, state: dict[str, Any]) -> None:
        """Take over a state made by :meth:`state` of a model built from the same scene."""


def variable_step(model: Model) -> bool:
    """Whether the length of the model's step varies in time."""
    return bool(getattr(model, "variable_step", False))


def tables_of(model: Model) -> dict[str, dict[str, float]]:
    """Rows of the model's further time series by file name without suffix; none if it has no ``tables``."""
    rows: dict[str, dict[str, float]] = getattr(model, "tables", dict)()
    return rows

"""A measured field as people keep it: in pixels with y down, or in metres and metres a second with y up."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from porescale.common.core.atomic import write_text
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.extras import extra
from porescale.common.core.given_file import given_text
from porescale.common.core.types import Flags, Floats
from porescale.piv.estimate.measure import Vectors

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

COLUMNS = ("x", "y", "u", "v", "valid", "replaced", "solid", "correlation", "uncertainty")
OPENPIV = ("x", "y", "u", "v", "flags", "mask")
"""Columns of OpenPIV's text files; flags: 0 valid, 1 not;  mask: 1 in a solid."""


@dataclass(frozen=True, repr=False)
class Field:
    """Vectors on a grid, rows from the top of the picture down.

    x (nx,), y (ny,) : px, whole numbers at the middles of pixels, y down, or m from the lower left corner of the
    picture, y up;  u, v (ny, nx) : px a frame or m/s, nan in solids, finite elsewhere;  valid, replaced,
    solid (ny, nx) : flags;  correlation, uncertainty (ny, nx) : the latter as u, infinite where replaced;  upwards :
    whether y points up, as it does in metres;  time : in the middle between the two pictures, s (frames where their
    interval is not given), None where it is not known.
    """

    x: Floats
    y: Floats
    u: Floats
    v: Floats
    valid: Flags
    replaced: Flags
    solid: Flags
    correlation: Floats
    uncertainty: Floats
    upwards: bool = False
    time: float | None = None

    def vorticity(self) -> Floats:
        """dv/dx - du/dy with y up, so that a vortex turning against the clock counts as positive; nan at solids."""
        across = np.gradient(self.v, self.x, axis=1) if len(self.x) > 1 else np.zeros_like(self.v)
        down = np.gradient(self.u, self.y, axis=0) if len(self.y) > 1 else np.zeros_like(self.u)
        turning = across - down
        return turning if self.upwards else -turning

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each grid point, with the columns of the CSV file; needs pandas (extra "notebook")."""
        x, y = np.meshgrid(self.x, self.y)
        columns = {"x": x, "y": y, **{name: getattr(self, name) for name in COLUMNS[2:]}}
        return extra("pandas").DataFrame({name: values.ravel() for name, values in columns.items()})

    def plot(self, ax: Axes | None = None) -> Axes:
        """Arrows, replaced vectors in another colour, with labels and units; returns the Axes."""
        from porescale.piv.fields.arrows import draw_arrows

        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.subplots(layout="constrained")[1]
        fast = draw_arrows(ax, self, over_image=False)
        length, speed = ("m", "m/s") if self.upwards else ("px", "px a frame")
        ax.set(aspect="equal", xlabel=f"x ({length})", ylabel=f"y ({length})")
        ax.set_title(f"longest arrows {fast:.3g} {speed}")
        if not self.upwards and ax.get_ylim()[0] < ax.get_ylim()[1]:
            ax.invert_yaxis()
        return ax

    def __repr__(self) -> str:
        length, speed = ("m", "m/s") if self.upwards else ("px", "px a frame")
        fluid = int((~self.solid).sum())
        when = "" if self.time is None else f" at t = {self.time:.6g}"
        size = np.hypot(self.u, self.v)[~self.solid]
        fast = f"largest {size.max():.4g} {speed}" if size.size else "all solid"
        return (
            f"Field of {' x '.join(map(str, self.u.shape))} vectors (rows x columns){when}\n"
            f"x {self.x.min():.6g} to {self.x.max():.6g}, y {self.y.min():.6g} to {self.y.max():.6g} {length}\n"
            f"{int(self.valid.sum())} of {fluid} in the fluid valid, {int(self.replaced.sum())} replaced, {fast}"
        )

    def _repr_png_(self) -> bytes:
        from matplotlib.figure import Figure

        figure, kept = Figure(layout="constrained"), io.BytesIO()
        self.plot(figure.add_subplot())
        figure.savefig(kept, format="png", dpi=100)
        return kept.getvalue()


def in_pixels(vectors: Vectors, corner: tuple[int, int] = (0, 0)) -> Field:
    """Vectors as they were measured.  corner : column and row of the region's first pixel in the whole picture."""
    u, v, uncertainty = (np.where(vectors.solid, np.nan, it) for it in (vectors.u, vectors.v, vectors.uncertainty))
    return Field(
        vectors.x + corner[0], vectors.y + corner[1], u, v, vectors.valid, vectors.replaced, vectors.solid,
        vectors.correlation, uncertainty,
    )  # fmt: skip


def in_metres(field: Field, rows: int, scale: float, interval: float) -> Field:
    """A field in pixels as metres and m/s, y up from the picture's lower edge.

    rows : of the whole picture;  scale : m a pixel;  interval : s between the pictures of a pair.
    """
    speed = scale / interval
    return replace(
        field, x=(field.x + 0.5) * scale, y=(rows - 0.5 - field.y) * scale, u=field.u * speed, v=-field.v * speed,
        uncertainty=field.uncertainty * speed, upwards=True,
    )  # fmt: skip


def on_picture(field: Field, rows: int, scale: float, interval: float, corner: tuple[int, int] = (0, 0)) -> Field:
    """A field as it lies on the pictures of its region, in pixels: the inverse of ``in_pixels`` and ``in_metres``.

    Places are rounded to a millionth of a pixel, so that whole ones are whole again.
    """
    if field.upwards:
        speed = scale / interval
        field = replace(
            field, x=field.x / scale - 0.5, y=rows - 0.5 - field.y / scale, u=field.u / speed, v=-field.v / speed,
            uncertainty=field.uncertainty / speed, upwards=False,
        )  # fmt: skip
    return replace(field, x=np.round(field.x - corner[0], 6), y=np.round(field.y - corner[1], 6))


def write_csv(field: Field, path: Path) -> None:
    """Every grid point, a row each, with the columns of COLUMNS; flags 0 or 1."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(COLUMNS)
    x, y = np.meshgrid(field.x, field.y)
    numbers = (
        (x, y, field.u, field.v),
        (field.valid, field.replaced, field.solid),
        (field.correlation, field.uncertainty),
    )
    lists = [
        [f"{value:.10g}" for value in it.ravel().tolist()] if k != 1 else it.ravel().astype(int).tolist()
        for k, group in enumerate(numbers)
        for it in group
    ]
    rows.writerows(zip(*lists, strict=True))
    write_text(path, text.getvalue())


def write_openpiv(field: Field, path: Path) -> None:
    """OpenPIV's text format: tab-separated x, y, u, v, flags, mask, y and v upwards; zeros in solids.

    Pixels are turned as OpenPIV does (openpiv.tools.transform_coordinates): the rows' y in reverse order.
    """
    field = field if field.upwards else _turned(field)
    x, y = np.meshgrid(field.x, field.y)
    flags = (~field.valid & ~field.solid).astype(float)
    u, v = (np.where(field.solid, 0.0, it) for it in (field.u, field.v))
    table = np.column_stack([it.ravel() for it in (x, y, u, v, flags, field.solid.astype(float))])
    text = io.StringIO()
    np.savetxt(text, table, fmt="%.8e", delimiter="\t", header="\t".join(OPENPIV))
    write_text(path, text.getvalue())


def _turned(field: Field) -> Field:
    """The same field with y counted the other way on the same grid; done twice it is as it was."""
    return replace(field, y=field.y[::-1].copy(), v=-field.v, upwards=not field.upwards)


def read(path: Path) -> Field:
    """A field from our CSV or OpenPIV's text, distinguished by their first line.

    y points up where it falls from row to row.  OpenPIV's fields whose points are a unit and more apart are taken for
    pixels, and turned.  InputError for files that are neither, or whose points are no grid.
    """
    try:
        text = given_text(Path(path))
    except (OSError, UnicodeDecodeError) as error:
        problem = getattr(error, "strerror", None) or "is no text"
        raise InputError(Fault("field", str(path), f"cannot be read ({problem})")) from error
    lines = text.splitlines()
    first = lines[0].strip() if lines else ""
    try:
        if not any(line.split("#")[0].split() for line in lines):  # which numpy warns of
            raise ValueError("empty")
        if first.startswith("x,"):
            names = first.split(",")
            table = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:] if line.strip()])
        else:
            table = np.loadtxt(lines, comments="#", ndmin=2)
            names = list(OPENPIV[: table.shape[1]])
        if table.ndim != 2 or table.shape[1] != len(names) or table.shape[1] < 4 or len(table) < 2:
            raise ValueError("not a table of x, y, u, v and more")
        found = _gridded(dict(zip(names, table.T, strict=True)))
        pixels = found.upwards and names[4:] == list(OPENPIV[4 : len(names)]) and found.x[1] - found.x[0] >= 1
        return _turned(found) if pixels else found
    except (ValueError, KeyError) as error:
        reason = " ".join(str(error).split())[:80]
        repair = "give a file of piv measure --csv, or OpenPIV's text"
        raise InputError(Fault("field", str(path), f"is no field ({reason})", repair=repair)) from error


def _gridded(columns: dict[str, Floats]) -> Field:
    """A field from columns; ValueError where the points are no grid."""
    across = int(np.argmax(columns["y"] != columns["y"][0])) or len(columns["y"])
    if len(columns["x"]) % across:
        raise ValueError("rows of different length")
    grid = {name: it.reshape(-1, across) for name, it in columns.items()}
    x, y = grid["x"][0], grid["y"][:, 0]
    near = 1e-6 * max(1e-300, float(np.abs(columns["x"]).max()))
    if not (np.allclose(grid["x"], x, atol=near, rtol=0) and np.allclose(grid["y"].T, y, atol=near, rtol=0)):
        raise ValueError("points on no grid")
    solid = grid.get("solid", grid.get("mask", np.zeros_like(grid["u"]))) > 0.5
    valid = grid["valid"] > 0.5 if "valid" in grid else (grid.get("flags", np.zeros_like(grid["u"])) < 0.5) & ~solid
    replaced = grid["replaced"] > 0.5 if "replaced" in grid else ~valid & ~solid
    known = np.full(grid["u"].shape, np.nan)
    up = len(y) > 1 and bool(y[1] < y[0])
    u, v = (np.where(solid, np.nan, grid[name]) for name in ("u", "v"))
    rest = (grid.get("correlation", known), grid.get("uncertainty", known))
    return Field(x, y, u, v, valid, replaced, solid, *rest, upwards=up)

"""Pictures of fields: arrows over the image, vorticity, and two fields side by side."""

import io
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from porescale.common.core.atomic import write_bytes
from porescale.common.core.types import Floats
from porescale.piv.fields.arrows import draw_arrows
from porescale.piv.fields.compare import Comparison
from porescale.piv.fields.field import Field
from porescale.piv.fields.vortices import Vortex, vortices


def quiver(
    field: Field, path: Path, image: NDArray[Any] | None = None, extent: tuple[float, ...] | None = None
) -> Path:
    """Arrows, replaced ones in another colour, over ``image`` (rows, columns), which spans ``extent`` (l, r, b, t)."""
    figure, axes = _axes(field)
    if image is not None:
        high = float(np.percentile(image, 99.5)) or 1.0
        whole: Any = extent
        axes.imshow(image, cmap="gray", vmin=0, vmax=1.3 * high, extent=whole, aspect="equal", interpolation="nearest")
    fast = draw_arrows(axes, field, over_image=image is not None)
    unit = "m/s" if field.upwards else "px a frame"
    axes.set_title(f"{'velocity' if field.upwards else 'displacement'}; longest arrows {fast:.3g} {unit}")
    return _saved(figure, path)


def vorticity(field: Field, path: Path) -> Path:
    """Vorticity in colour, with the vortices found."""
    figure, axes = _axes(field)
    _painted(figure, axes, field, field.vorticity(), _of_vorticity(field), centred=True)
    _marked(axes, vortices(field))
    return _saved(figure, path)


def comparison(reference: Field, other: Field, found: Comparison, path: Path, titles: tuple[str, str]) -> Path:
    """Vorticity of both fields with their vortices, the size of the difference over the reference's rms speed, and the
    surfaces of both piles where there are any.
    """
    count = 3 if found.surfaces is None else 4
    figure = Figure(figsize=(5 * count, 5), layout="constrained")
    panels = figure.subplots(1, count)
    top = max(_largest(reference.vorticity()), _largest(other.vorticity()))
    both = (found.reference_vortices, found.other_vortices)
    for axes, field, cores, title in zip(panels[:2], (reference, other), both, titles, strict=True):
        _dressed(axes, field)
        _painted(figure, axes, field, field.vorticity(), _of_vorticity(field), centred=True, top=top)
        _marked(axes, cores)
        axes.set_title(title)
    _dressed(panels[2], reference)
    size = np.hypot(found.difference_u, found.difference_v) / found.speed
    _painted(figure, panels[2], reference, size, "difference over rms speed", centred=False)
    panels[2].set_title(f"rms {found.rms:.3g}, largest {found.largest:.3g}")
    if found.surfaces is not None:
        for surface, title, style in zip(found.surfaces, titles, ("k-", "--"), strict=True):
            panels[3].plot(surface.x, surface.height, style, label=title)
        unit = "m" if reference.upwards else "px"
        panels[3].set(xlabel=f"x, {unit}", ylabel=f"height of the pile, {unit}", ylim=(0, None))
        panels[3].legend()
        if found.surface is not None:
            panels[3].set_title(f"rms {found.surface.rms:.3g}, mean {found.surface.mean:.3g} {unit}")
    return _saved(figure, path)


def _of_vorticity(field: Field) -> str:
    """What the colours of a vorticity are, with its unit."""
    return f"vorticity, {'1/s' if field.upwards else 'a frame'}"


def _axes(field: Field) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(9, 8), layout="constrained")
    axes = figure.add_subplot()
    _dressed(axes, field)
    return figure, axes


def _dressed(axes: Axes, field: Field) -> None:
    """Labels, equal scales, y as the field counts it."""
    unit = "m" if field.upwards else "px"
    axes.set_xlabel(f"x, {unit}")
    axes.set_ylabel(f"y, {unit}")
    axes.set_aspect("equal")
    axes.xaxis.set_major_locator(MaxNLocator(4))  # numbers of five digits fit side by side in the narrowest panel
    half = 0.5 * abs(field.x[1] - field.x[0]) if len(field.x) > 1 else 0.5
    low, high = float(field.y.min()) - half, float(field.y.max()) + half
    axes.set_xlim(float(field.x.min()) - half, float(field.x.max()) + half)
    axes.set_ylim((low, high) if field.upwards else (high, low))
    axes.set_facecolor("#8c8c8c")


def _painted(
    figure: Figure, axes: Axes, field: Field, values: Floats, label: str, *, centred: bool, top: float | None = None
) -> None:
    """Values as coloured cells with a bar."""
    top = top or _largest(values)
    low, colours = (-top, "RdBu_r") if centred else (0.0, "viridis")
    drawn = axes.pcolormesh(
        field.x, field.y, np.ma.masked_invalid(values), cmap=colours, vmin=low, vmax=top, shading="nearest"
    )
    figure.colorbar(drawn, ax=axes, label=label, shrink=0.8)


def _largest(values: Floats) -> float:
    """Size that 99 % of the values stay below."""
    known = np.abs(values[np.isfinite(values)])
    return float(np.percentile(known, 99)) or 1e-300 if known.size else 1.0


def _marked(axes: Axes, found: list[Vortex]) -> None:
    """Vortices as circles of their cores, signed; the 20 strongest."""
    for vortex in found[:20]:
        around = np.linspace(0, 2 * np.pi, 60)
        axes.plot(vortex.x + vortex.radius * np.cos(around), vortex.y + vortex.radius * np.sin(around), "k-", lw=1)
        axes.text(vortex.x, vortex.y, "+" if vortex.circulation > 0 else "−", ha="center", va="center")


def _saved(figure: Figure, path: Path) -> Path:
    content = io.BytesIO()
    FigureCanvasAgg(figure).print_figure(content, dpi=110)
    write_bytes(path, content.getvalue())
    return path

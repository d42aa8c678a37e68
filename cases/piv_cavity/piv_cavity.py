"""The lid-driven cavity at a Reynolds number of 1000, filmed by the virtual camera and measured."""

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import porescale as ps
from porescale.output import conclude, options, stage
from porescale.piv.estimate import Settings, measure
from porescale.piv.fields import Comparison, Field, Vortex, compare, field_of_run, in_metres, in_pixels, vortices
from porescale.piv.images import Camera, Frame, Shooting, frames, shooting

HERE = Path(__file__).resolve().parent
PIXELS = 512
"""A side of the picture."""
WINDOW = 16
FAST, SLOW = 8.0, 40.0
"""px that the lid goes from frame to frame: for all of the cavity, and for its corners."""
NEAR = 16
"""px: vectors nearer to a wall are judged with all, but not with the rest."""
CORNERS = {"lower left": (0.0, 0.25, 0.0, 0.25), "lower right": (0.7, 1.0, 0.0, 0.35)}
"""Where the corner vortices are looked for: left, right, bottom, top, m."""


def cavity(out: Path, quality: str = "standard") -> Path:
    """The run of cases/lid_driven_cavity in ``out``, made if it is not there."""
    settings = {"output.snapshot_interval": 30}
    scene = ps.load(HERE.parent / "lid_driven_cavity", quality=quality, settings=settings)
    ps.run(scene, out, resume=out.is_dir(), progress=False)
    return out


def filmed(folder: Path, lid: float, pairs: int, camera: Camera | None = None) -> tuple[list[Frame], float]:
    """Frames of the last moments of a run and the seconds between them; the lid goes ``lid`` px in each."""
    run, scale = ps.open_run(folder), 1 / PIXELS
    interval = lid * scale
    end = float(run.times[-1])
    shot = Shooting(camera or Camera(), scale, interval, end - (pairs + 0.5) * interval, end)
    return list(frames(run, shooting(run, shot))), interval


def fields(film: Iterable[Frame], interval: float, settings: Settings) -> list[Field]:
    """A field for each pair of frames, m and m/s."""
    pictures = [frame.picture for frame in film]
    return [
        in_metres(in_pixels(measure(first, second, None, settings)), PIXELS, 1 / PIXELS, interval)
        for first, second in pairwise(pictures)
    ]


def part(field: Field, box: tuple[float, float, float, float]) -> Field:
    """The vectors of a field in a box: left, right, bottom, top."""
    columns = (field.x > box[0]) & (field.x < box[1])
    rows = (field.y > box[2]) & (field.y < box[3])
    both = np.ix_(rows, columns)
    names = ("u", "v", "valid", "replaced", "solid", "correlation", "uncertainty")
    return replace(field, x=field.x[columns], y=field.y[rows], **{name: getattr(field, name)[both] for name in names})


def as_lattice(field: Field, against: Comparison) -> Field:
    """The lattice's velocity at the vectors of a field that was compared with it: exact, so without uncertainty."""
    u, v = field.u + against.difference_u, field.v + against.difference_v
    return replace(field, u=u, v=v, uncertainty=np.zeros(u.shape))


def errors(found: Comparison, field: Field, scale: float) -> dict[str, float]:
    """Rms difference over the rms speed, of all vectors and of those farther than NEAR px from the walls, and in px."""
    away = NEAR / PIXELS
    inner = np.ix_((field.y > away) & (field.y < 1 - away), (field.x > away) & (field.x < 1 - away))
    size = np.hypot(found.difference_u, found.difference_v)
    off = float(np.sqrt(np.mean(size[inner] ** 2)))
    return {"all": found.rms, "inside": off / found.speed, "inside, px": off / scale / np.sqrt(2)}


def strongest(field: Field, sign: int) -> Vortex | None:
    """The strongest vortex of a sign, None if there is none."""
    return next((it for it in vortices(field) if it.circulation * sign > 0), None)


def beside(measured: Field, lattice: Field, sign: int) -> tuple[float, float]:
    """Distance of the strongest vortices of a sign, and their circulations' ratio less 1; infinite where one lacks."""
    own, theirs = strongest(measured, sign), strongest(lattice, sign)
    if own is None or theirs is None:
        return np.inf, np.inf
    return float(np.hypot(own.x - theirs.x, own.y - theirs.y)), own.circulation / theirs.circulation - 1


def judged(
    folder: Path, pairs: int, camera: Camera | None = None, window: int = WINDOW
) -> tuple[dict[str, float], Field, Comparison]:
    """The numbers of expected.toml, means over the pairs, and the first field with its difference."""
    truth, settings = field_of_run(folder), Settings(window=window)
    film, interval = filmed(folder, FAST, pairs, camera)
    rows, first = [], None
    for field in fields(film, interval, settings):
        found = compare(field, truth)
        first = first or (field, found)
        place, strength = beside(field, as_lattice(field, found), -1)
        rows.append({
            **errors(found, field, 1 / PIXELS / interval), "main vortex, place": place,
            "main vortex, circulation": strength,
        })  # fmt: skip
    film, interval = filmed(folder, SLOW, pairs, camera)
    for k, field in enumerate(fields(film, interval, replace(settings, search=round(SLOW)))):
        exact = as_lattice(field, compare(field, truth))
        for name, box in CORNERS.items():
            place, strength = beside(part(field, box), part(exact, box), 1)
            rows[k] |= {f"{name}, place": place, f"{name}, circulation": strength}
    assert first
    return {name: float(np.mean([row[name] for row in rows])) for name in rows[0]}, *first


def main() -> int:
    """Run the cavity, film it, measure the film, judge and draw."""
    given = options(__doc__ or "", HERE, pairs=(int, 3, "pairs of each film", 1))
    ps.set_threads(1)
    numbers, field, found = judged(cavity(given.out / "run"), given.pairs)
    return conclude(HERE, numbers, drawn(given.out / "run", field, found), given.out)


def drawn(folder: Path, field: Field, found: Comparison) -> Figure:
    """A frame, the measured field, and how far it is from the lattice's."""
    figure, (left, middle, right) = stage(3, 13.0, 4.4)
    picture = filmed(folder, FAST, 1)[0][0].picture
    left.imshow(picture, cmap="gray", extent=(0, 1, 0, 1))
    left.set_title("a frame", fontsize=10)
    arrows(middle, field)
    middle.set_title("measured from two frames", fontsize=10)
    size = np.hypot(found.difference_u, found.difference_v) / found.speed
    shown = right.pcolormesh(field.x, field.y, 100 * size, cmap="magma_r", vmin=0, vmax=10)
    figure.colorbar(shown, ax=right, label="difference from the lattice, % of the rms speed", extend="max")
    for axes in (left, middle, right):
        axes.set(aspect="equal", xlim=(0, 1), ylim=(0, 1), xlabel="x, m")
    left.set_ylabel("y, m")
    return figure


def arrows(axes: Axes, field: Field) -> None:
    """Directions, every third, coloured by speed, and the main vortex."""
    every = (slice(None, None, 3), slice(None, None, 3))
    x, y = np.meshgrid(field.x, field.y)
    speed = np.hypot(field.u, field.v)
    share = np.maximum(speed, 1e-9) ** -0.6  # slow ones longer than to scale, or corners look empty
    u, v = field.u * share, field.v * share
    axes.quiver(x[every], y[every], u[every], v[every], speed[every], cmap="viridis", scale=18, width=0.003)
    eddy = strongest(field, -1)
    if eddy:
        axes.plot(eddy.x, eddy.y, "x", color="#a50f15", ms=9, mew=2)


if __name__ == "__main__":
    raise SystemExit(main())

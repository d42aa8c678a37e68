"""``porescale piv measure``: displacements from pictures and films."""

from __future__ import annotations

import json as json_text
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from porescale.cli.piv_quantity import quantity
from porescale.common.cli.folders import require_writable
from porescale.common.cli.options import Json, Threads, use_threads
from porescale.common.core.errors import Fault, InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from porescale.piv.estimate.measure import Vectors
    from porescale.piv.estimate.series import Shots
    from porescale.piv.fields.field import Field

CHANCE = 0.05
"""Share of vectors of the fluid that passes validation by chance where two pictures have nothing in common (measured:
up to 0.04 of small ones)."""
STRANGERS = Fault("pictures", None, "do not show the same tracers: hardly a vector passes validation")
PATIENCE = 10.0
"""Seconds between lines of progress."""


def measure(
    *films: Annotated[str, Parameter(help="two pictures; or a film, a folder or pattern of pictures, many pictures")],
    out: Annotated[Path | None, Parameter(help="folder for fields and pictures")] = None,
    csv: Annotated[Path | None, Parameter(help="table of the field (of the first pair, or the average)")] = None,
    openpiv: Annotated[Path | None, Parameter(help="the same in OpenPIV's text format")] = None,
    window: Annotated[int, Parameter(help="of the last pass, px: 64, 32, 16 or 8")] = 16,
    overlap: Annotated[float, Parameter(help="of neighbouring windows")] = 0.5,
    search: Annotated[int, Parameter(help="largest displacement looked for, px")] = 16,
    smooth: Annotated[bool, Parameter(help="no more than the noise asks for", negative="--no-smooth")] = True,
    no_slip: Annotated[bool, Parameter(help="the flow stands still at rims of solids that do", negative="")] = False,
    mask: Annotated[
        str | None, Parameter(help="bitmap or film of bitmaps, solid white; or bright, dark: segment")
    ] = None,
    polygon: Annotated[list[str] | None, Parameter(help='"x,y x,y x,y …", px: solid; repeatable')] = None,
    background: Annotated[Literal["none", "mean", "least"], Parameter(help="taken off every frame")] = "none",
    average: Annotated[bool, Parameter(help="one field from all pairs of a steady flow")] = False,
    start: Annotated[int, Parameter(help="first frame")] = 0,
    end: Annotated[int | None, Parameter(help="frame after the last")] = None,
    step: Annotated[int, Parameter(help="frames from one used to the next")] = 1,
    region: Annotated[str | None, Parameter(help="left,top,right,bottom, px")] = None,
    scale: Annotated[str | None, Parameter(help='length of a pixel: "0.1 mm"; the field is in m and m/s then')] = None,
    interval: Annotated[str | None, Parameter(help='time between two frames: "5 ms"; a film may say it itself')] = None,
    time_: Annotated[str | None, Parameter(name="--time", help="of frame 0, as the fields' times count from")] = None,
    overlay: Annotated[bool, Parameter(help="a film of the pictures with arrows on them, too")] = False,
    threads: Threads = None,
    json: Json = False,
) -> int:
    """Measure displacements between pictures, with validity, correlation and uncertainty for every vector."""
    from porescale.piv.estimate.measure import Settings
    from porescale.piv.estimate.series import Shots, averaged, corner, measured, whole_rows
    from porescale.piv.fields.field import in_metres, in_pixels
    from porescale.piv.images.film import open_film

    if not films:
        raise InputError(Fault("films", None, "none given", repair="give two pictures, or a film"))
    for path, key in ((csv, "--csv"), (openpiv, "--openpiv")):
        if path is not None:
            require_writable(path.parent, key)
    folder = out if out or ((csv or openpiv) and not overlay) else Path("runs") / f"piv_{_stem(films[0])}"
    if folder is not None:
        require_writable(folder, "--out")
    if no_slip and not (mask or polygon):
        raise InputError(Fault("--no-slip", None, "there are no solids", repair="give --mask or --polygon"))
    use_threads(threads)
    settings = Settings(window=window, overlap=overlap, search=search, smooth=smooth, no_slip=no_slip)
    film = open_film(films, start=start, end=end, step=step, region=_box(region))
    pixel, seconds = _scales(scale, interval, film.rate)
    shots = Shots(film, mask, tuple(polygon or ()), background)
    rows = whole_rows(film) if pixel is not None else 0

    def finished(vectors: Vectors) -> Field:
        """Vectors as a field of the whole picture, in pixels, or in m and m/s where their scales are known."""
        field = in_pixels(vectors, corner(film))
        return field if pixel is None or seconds is None else in_metres(field, rows, pixel, seconds * step)

    pairs = max(0, film.count() - 1)
    total = 1 if average else pairs
    if average:
        found: Iterable[Vectors] = (averaged(shots, settings, _passes(pairs)) for _ in range(1))
    else:
        found = measured(shots, settings, _aside if pairs > 1 else None)
    fields = (finished(it) for it in found)

    def span(shape: tuple[int, ...]) -> tuple[float, ...]:
        """Where a picture of a shape lies, in the units of the fields."""
        return _span(shape, corner(film), rows, pixel)

    zero = 0.0 if time_ is None else quantity("--time", time_, "s")
    times = (zero + (seconds or 1.0) * (start + 0.5 * step), (seconds or 1.0) * step)
    said = _written(_progress(fields, total), shots, folder, csv, openpiv, times, span, total == 1)
    if overlay and folder is not None and not average:
        from porescale.piv.fields.overlay import overlay_film

        shape = next(iter(film)).shape
        said["files"].append(str(overlay_film(folder, film, span(shape))))
    _say(said, json)
    return 0


def _stem(name: str) -> str:
    """What a folder is called after."""
    stem = Path(name).stem.strip("*?_ ")
    return stem or "film"


def _box(text: str | None) -> tuple[int, int, int, int] | None:
    """A region from "left,top,right,bottom"."""
    if text is None:
        return None
    try:
        left, top, right, bottom = (int(part) for part in text.split(","))
    except ValueError as error:
        raise InputError(Fault("--region", text, "is no region", allowed="left,top,right,bottom, whole px")) from error
    return left, top, right, bottom


def _scales(scale: str | None, interval: str | None, rate: float | None) -> tuple[float | None, float | None]:
    """Metres a pixel and seconds a frame; InputError for a scale without an interval."""
    pixel = None if scale is None else quantity("--scale", scale, "m")
    seconds = None if interval is None else quantity("--interval", interval, "s")
    if seconds is None and rate:
        seconds = 1 / rate
    if pixel is not None and seconds is None:
        raise InputError(
            Fault("--interval", None, "is needed with --scale", repair='give the time between frames: "5 ms"')
        )
    return pixel, seconds


def _aside(text: str) -> None:
    """Tell something beside the outcome."""
    print(text, file=sys.stderr, flush=True)


def _passes(pairs: int) -> Callable[[], None]:
    """Counts the pairs that passes over a film go through, and prints so now and then."""
    done, last = 0, time.perf_counter()

    def tell() -> None:
        """Count one pair more, and print the progress."""
        nonlocal done, last
        done += 1
        if time.perf_counter() - last > PATIENCE:
            last = time.perf_counter()
            _aside(f"pass {(done - 1) // max(1, pairs) + 1}: {(done - 1) % max(1, pairs) + 1} of {pairs} pairs")

    return tell


def _progress(fields: Iterable[Field], total: int) -> Iterator[tuple[Field, int]]:
    """Fields as they come, with a line on stderr now and then."""
    start = last = time.perf_counter()
    for number, field in enumerate(fields, 1):
        yield field, number
        now = time.perf_counter()
        if now - last > PATIENCE and number < total:
            left = (now - start) / number * (total - number)
            print(f"{number} of {total} pairs, about {left:.0f} s left", file=sys.stderr, flush=True)
            last = now


def _written(
    fields: Iterator[tuple[Field, int]],
    shots: Shots,
    folder: Path | None,
    csv: Path | None,
    openpiv: Path | None,
    times: tuple[float, float],
    span: Callable[[tuple[int, ...]], tuple[float, ...]],
    alone: bool,
) -> dict[str, Any]:
    """Write each field as it comes; gives what was measured and written.  InputError for one field without vectors.

    times : of the first field, and from one to the next, s.
    """
    from porescale.common.record import snapshots
    from porescale.common.record.model import Snapshot
    from porescale.piv.estimate.series import as_grid
    from porescale.piv.fields.field import write_csv, write_openpiv
    from porescale.piv.fields.pictures import quiver, vorticity

    counts = {"pairs": 0, "vectors": 0, "valid": 0, "replaced": 0, "solid": 0}
    files: list[Path] = []
    last = None
    if folder is not None:
        snapshots.clear(folder)
    for field, number in fields:
        if alone and field.valid.sum() < CHANCE * (~field.solid).sum():
            raise InputError(STRANGERS)
        last = field
        counts["pairs"] += 1
        counts["vectors"] += field.u.size
        for name in ("valid", "replaced", "solid"):
            counts[name] += int(getattr(field, name).sum())
        if number == 1:
            for path, write in ((csv, write_csv), (openpiv, write_openpiv)):
                if path is not None:
                    write(field, path)
                    files.append(path)
        if folder is not None:
            table = folder / f"vectors_{number - 1:04d}.csv"
            write_csv(field, table)
            files += [table] if number == 1 else []
            moment = times[0] + (number - 1) * times[1]
            snapshots.write_part(folder, Snapshot(moment, number - 1, grids={"piv": as_grid(field)}))
    if not alone and counts["valid"] < CHANCE * (counts["vectors"] - counts["solid"]):
        if folder is not None:
            snapshots.clear(folder)
        raise InputError(STRANGERS)
    if folder is not None and last is not None:
        snapshots.assemble(folder)
        image = next(iter(shots.film))
        files += [folder / "piv.vtkhdf", quiver(last, folder / "quiver.png", image, span(image.shape))]
        files.append(vorticity(last, folder / "vorticity.png"))
    return {**counts, "files": [str(path) for path in files]}


def _span(shape: tuple[int, ...], corner: tuple[int, int], rows: int, pixel: float | None) -> tuple[float, ...]:
    """Left, right, bottom, top of the measured region, in the field's units."""
    left, top = corner
    if pixel is None:
        return left - 0.5, left + shape[1] - 0.5, top + shape[0] - 0.5, top - 0.5
    return left * pixel, (left + shape[1]) * pixel, (rows - top - shape[0]) * pixel, (rows - top) * pixel


def _say(said: dict[str, Any], json: bool) -> None:
    """What was measured, for people or scripts."""
    if json:
        print(json_text.dumps(said, indent=1))
        return
    fluid = said["vectors"] - said["solid"]
    share = 100 * said["valid"] / fluid if fluid else 0.0
    print(f"{said['pairs']} pairs, {fluid} vectors in the fluid, {share:.1f} % valid, {said['replaced']} replaced")
    for path in said["files"]:
        print(path)

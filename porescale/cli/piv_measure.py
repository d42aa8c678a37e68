"""``porescale piv measure``: displacements from pictures and films."""

from __future__ import annotations

import json as json_text
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from porescale.common.api.folders import require_file, require_writable
from porescale.common.cli.options import Json, Threads, say, use_threads
from porescale.common.core.errors import Fault, InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from porescale.piv.fields.field import Field

PATIENCE = 10.0
"""Seconds between lines of progress."""


def measure(
    *films: Annotated[str, Parameter(help="two pictures; or a film, a folder or pattern of pictures, many pictures")],
    out: Annotated[Path | None, Parameter(help="folder for fields and pictures")] = None,
    csv: Annotated[Path | None, Parameter(help="table of the field (of the first pair, or the average)")] = None,
    openpiv: Annotated[Path | None, Parameter(help="the same in OpenPIV's text format")] = None,
    window: Annotated[int, Parameter(help="of the last pass, px: even, 4 to the smaller side of the pictures")] = 16,
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
    review: Annotated[
        bool, Parameter(help="a page with both pictures, to look at vectors and take wrong ones out", negative="")
    ] = False,
    reject: Annotated[
        str | None, Parameter(help="bitmap that the page of --review saves: vectors at white pixels are wrong")
    ] = None,
    threads: Threads = None,
    json: Json = False,
) -> int:
    """Measure displacements between pictures, with validity, correlation and uncertainty for every vector."""
    from porescale.piv import given
    from porescale.piv.estimate.measure import Settings
    from porescale.piv.estimate.series import Shots
    from porescale.piv.images.film import open_film
    from porescale.piv.pipeline import Measurement, write_fields

    if not films:
        raise InputError(Fault("films", None, "none given", repair="give two pictures, or a film"))
    for path, key in ((csv, "--csv"), (openpiv, "--openpiv")):
        if path is not None:
            require_file(path, key)
    if csv is not None and openpiv is not None and csv.resolve() == openpiv.resolve():
        raise InputError(Fault("--openpiv", str(openpiv), "is the file of --csv, too", repair="give them two names"))
    folder = (
        out
        if out or ((csv or openpiv) and not (overlay or review))
        else Path("runs") / f"piv_{Path(films[0]).stem.strip('*?_ ') or 'film'}"
    )
    if folder is not None:
        require_writable(folder, "--out")
    given.refuse(given.solids(no_slip=no_slip, there=bool(mask or polygon)))
    use_threads(threads)
    settings = Settings(window=window, overlap=overlap, search=search, smooth=smooth, no_slip=no_slip)
    film = open_film(films, start=start, end=end, step=step, region=_box(region))
    pixel, seconds = given.scales(scale, interval, film.rate, bare=True)
    shots = Shots(film, mask, tuple(polygon or ()), background)
    zero = given.amount("--time", time_, "s", bare=True) or 0.0
    measurement = Measurement(shots, settings, average, pixel, seconds, zero, reject)
    fields = measurement.fields(say, _passes(measurement.pairs))
    found = write_fields(
        measurement, _progress(fields, measurement.total), folder, csv=csv, openpiv=openpiv, overlay=overlay,
        review=review,
    )  # fmt: skip
    for doubt in found["doubts"]:
        say(f"warning: {doubt}")
    _print(found, json)
    return 0


def _box(text: str | None) -> tuple[int, int, int, int] | None:
    """A region from "left,top,right,bottom"."""
    if text is None:
        return None
    try:
        left, top, right, bottom = (int(part) for part in text.split(","))
    except ValueError:
        allowed = "left,top,right,bottom, whole px"
        raise InputError(Fault("--region", text, "is not a region", allowed=allowed)) from None
    return left, top, right, bottom


def _passes(pairs: int) -> Callable[[], None]:
    """A function that counts the pairs of passes over a film, with a line on stderr now and then."""
    done, last = 0, time.perf_counter()

    def count() -> None:
        """Count one more pair, and report progress at intervals."""
        nonlocal done, last
        done += 1
        if time.perf_counter() - last > PATIENCE:
            last = time.perf_counter()
            say(f"pass {(done - 1) // max(1, pairs) + 1}: {(done - 1) % max(1, pairs) + 1} of {pairs} pairs")

    return count


def _progress(fields: Iterable[Field], total: int) -> Iterator[Field]:
    """Fields as they come, with a line on stderr now and then."""
    start = last = time.perf_counter()
    for number, field in enumerate(fields, 1):
        yield field
        now = time.perf_counter()
        if now - last > PATIENCE and number < total:
            left = (now - start) / number * (total - number)
            say(f"{number} of {total} pairs, about {left:.0f} s left")
            last = now


def _print(found: dict[str, Any], json: bool) -> None:
    """Print what was measured, as text or as JSON."""
    if json:
        print(json_text.dumps(found, indent=1))
        return
    fluid = found["vectors"] - found["solid"]
    share = 100 * found["valid"] / fluid if fluid else 0.0
    print(f"{found['pairs']} pairs, {fluid} vectors in the fluid, {share:.1f} % valid, {found['replaced']} replaced")
    for path in found["files"]:
        print(path)

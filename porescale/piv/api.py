"""Measuring a flow from pictures in Python: what the commands of `piv` do, with arrays and files alike."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from porescale.common.core.errors import Fault, InputError, warn
from porescale.common.core.types import AnyArray
from porescale.piv import given

if TYPE_CHECKING:
    from porescale.common.record.open_run import Run
    from porescale.piv.fields.field import Field
    from porescale.piv.images.film import Film

Path_ = str | Path
Films = Path_ | Sequence[Path_] | Sequence[AnyArray] | AnyArray


def measure(
    film: Films,
    second: Path_ | AnyArray | None = None,
    *,
    window: int = 16,
    overlap: float = 0.5,
    search: int = 16,
    smooth: bool = True,
    no_slip: bool = False,
    mask: Path_ | AnyArray | None = None,
    polygon: Sequence[str] = (),
    background: Literal["none", "mean", "least"] = "none",
    average: bool = False,
    start: int = 0,
    end: int | None = None,
    step: int = 1,
    region: tuple[int, int, int, int] | None = None,
    scale: float | str | None = None,
    interval: float | str | None = None,
    time: float | str = 0.0,
    out: Path_ | None = None,
    overlay: bool = False,
    review: bool = False,
    reject: Path_ | AnyArray | None = None,
) -> Field | list[Field]:
    """Displacements between pictures, with validity, correlation and uncertainty for every vector.

    film : a film, a stack of pictures in one TIFF file, a folder or pattern of pictures; or files, or arrays (rows,
    columns), grey, of 8 or 16 bits or floating, in their order;  second : the second picture of a pair.

    window : px, of the last pass, even, 4 to the smaller side of the pictures;  overlap : of neighbouring windows;
    search : px, the largest displacement looked for;  smooth : no more than the noise asks for;  no_slip : no flow at
    rims of solids at rest;  mask : file of a bitmap (solid white), film or stack of them, "bright" or "dark" to
    segment, or an array, True in solids;  polygon : "x,y x,y x,y …" px, solid;  background : what every frame is taken
    less by;  average : one field from all pairs of a steady flow;  start, end, step : which frames;  region : left,
    top, right, bottom px;  scale : length of a pixel (m or "0.1 mm"), with which the field is in m and m/s, y up;
    interval : time between two frames (s or "5 ms"; a film may say it itself);  time : of frame 0;  out : folder for
    the files that `piv measure` writes;  overlay : a film with arrows among them;  review : a page among them to look
    at vectors and take wrong ones out;  reject : the bitmap that it saves, or an array, True where vectors are wrong.

    Two pictures, or all averaged, give a `Field`; a film of more gives a list of them, in time.  Pairs in a film that
    show nothing give a PorescaleWarning and no valid vector; fewer than 70 % valid vectors give some too, with what to
    try; so do pictures whose errors are known to be larger than the stated uncertainty (narrow particle images, noise).
    Raises InputError for what cannot be read or measured.
    """
    from porescale.piv.estimate.measure import Settings
    from porescale.piv.estimate.series import Shots
    from porescale.piv.pipeline import Measurement, write_fields

    try:
        given.refuse(
            given.folder("out", out),
            given.bitmap("--mask", mask),
            given.bitmap("--reject", reject),
            given.polygons("--polygon", polygon),
            given.region("--region", region),
        )
        for key, wanted in (("overlay", overlay), ("review", review)):
            if wanted and out is None:
                raise InputError(Fault(key, None, "has no folder to be written to", repair="give out"))
        given.refuse(given.solids(no_slip=no_slip, there=mask is not None or bool(polygon)))
        if background not in ("none", "mean", "least"):
            raise InputError(Fault("background", str(background), "is unknown", allowed="none, mean, least"))
        box = None if region is None else tuple(map(int, region))
        frames = _film(film, second, start=start, end=end, step=step, region=box)
        pixel, seconds = given.scales(scale, interval, frames.rate)
        solid, gone = (it if it is None or isinstance(it, np.ndarray) else str(it) for it in (mask, reject))
        shots = Shots(frames, solid, tuple(polygon), background)
        settings = Settings(window=window, overlap=overlap, search=search, smooth=smooth, no_slip=no_slip)
        zero = given.amount("--time", time, "s") or 0.0
        work = Measurement(shots, settings, average, pixel, seconds, zero, gone)
        fields: list[Field] = []

        def kept() -> Iterator[Field]:
            """Fields as they come, kept with their times."""
            for number, field in enumerate(work.fields(_warn)):
                middle = None if average else work.time(number)
                fields.append(replace(field, time=middle))
                yield field

        written = write_fields(work, kept(), None if out is None else Path(out), overlay=overlay, review=review)
        for doubt in written["doubts"]:
            _warn(doubt)
    except InputError as error:
        raise _in_python(error) from None
    return fields[0] if work.total == 1 else fields


def render(
    run: Run | Path_,
    out: Path_ | None = None,
    *,
    scale: float | str | None = None,
    interval: float | str | None = None,
    start: float | str | None = None,
    end: float | str | None = None,
    exposure: float = 0.0,
    density: float = 0.05,
    diameter: float = 2.8,
    noise: float = 3.0,
    grains: Literal["bright", "dark"] = "bright",
    seed: int = 0,
) -> Path:
    """Film a run with a virtual camera: tracers carried by its flow, as pictures, masks and a film.

    run : with fluid, or its folder;  out : folder for frames, masks, film and shooting.json (None: piv in the run
    folder);  scale : length of a pixel, m or "0.1 mm" (None: 1024 px the longer side);  interval : between frames, s or
    "5 ms" (None: 4 px of the fastest flow);  start, end : times of the run;  exposure : share of the interval that the
    shutter is open;  density : tracers a pixel;  diameter : of one, px;  noise : grey levels;  grains : look of solids.

    Gives the folder of the frames, for `measure`; the masks are beside it.  Raises InputError.
    """
    from porescale.common.record.open_run import open_run
    from porescale.piv.images.camera import GREYS, shot_of
    from porescale.piv.images.filmed import write_frames
    from porescale.piv.images.synth import Camera

    opened = open_run(run) if isinstance(run, str | Path) else run
    folder = opened.folder / "piv" if out is None else Path(out)
    if grains not in ("bright", "dark"):
        raise InputError(Fault("grains", str(grains), "is unknown", allowed="bright, dark"))
    try:
        shot = shot_of(
            opened,
            Camera(density=density, diameter=diameter, noise=noise, disc=GREYS[grains]),
            scale=given.amount("--scale", scale, "m"),
            interval=given.amount("--interval", interval, "s"),
            start=given.amount("--start", start, "s"),
            end=given.amount("--end", end, "s"),
            exposure=exposure,
            seed=seed,
        )
        write_frames(opened, shot, folder)
    except InputError as error:
        raise _in_python(error) from None
    return folder / "frames"


def _film(film: Films, second: Path_ | AnyArray | None, **chosen: Any) -> Film:
    """Files or arrays as a film."""
    from porescale.piv.images.film import Held, open_film, opened

    if second is None and (film is None or getattr(film, "ndim", 3) < 3):
        raise InputError(Fault("film", None, "is a single picture", repair="give two, or a film"))
    if second is None and not isinstance(film, Path | Iterable):
        raise InputError(Fault("film", str(film), f"is no film but {type(film).__name__}", repair="give a path"))
    many = film if second is None else [film, second]
    items: list[Any] = [many] if isinstance(many, str | Path) else list(many)
    if not all(isinstance(it, np.ndarray) for it in items):
        if not all(isinstance(it, str | Path) for it in items):
            problem, repair = "is neither files nor arrays", "give paths alone, or arrays alone"
            raise InputError(Fault("film", ", ".join(type(it).__name__ for it in items), problem, repair=repair))
        return open_film(items, **chosen)
    given.refuse(*(given.grey("film", it, f"picture {number}: ") for number, it in enumerate(items)))
    if not items:
        raise InputError(Fault("film", None, "holds no pictures", repair="give two or more"))
    opened(["-", "-"], **chosen)  # checks start, end, step and region
    return Held((), pictures=tuple(items), **chosen)


def _warn(text: str) -> None:
    """A doubt of a command as a warning in Python: at the caller's line, under the names of arguments."""
    warn(_words(text))


def _in_python(error: InputError) -> InputError:
    """The faults of a command under the names of arguments: "--no-slip" is no_slip here."""
    return InputError(
        [replace(it, key=_words(it.key), problem=_words(it.problem), repair=_words(it.repair)) for it in error.faults]
    )


def _words(text: str) -> str:
    return re.sub(r"--([a-z]+(?:-[a-z]+)*)", lambda found: found.group(1).replace("-", "_"), text)

"""``porescale piv``: synthetic pairs, displacement fields from pictures and films, fields compared."""

from __future__ import annotations

import json as json_text
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import App, Parameter

from porescale.ground.check import Fault, InputError
from porescale.workbench.commands.options import Json, Threads, use_threads
from porescale.workbench.folders import refuse_unwritable

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from porescale.piv.field import Field
    from porescale.piv.measure import Vectors
    from porescale.piv.series import Shots

CHANCE = 0.05
"""Share of vectors of the fluid that passes validation by chance where two pictures have nothing in common (measured:
up to 0.04 of small ones)."""
PATIENCE = 10.0
"""Seconds between lines of progress."""


def command() -> App:
    """The `piv` command with its own commands."""
    app = App(
        name="piv", help="Measure a flow from pictures of it; the same way for a laboratory film and a simulation."
    )
    app.command(synth)
    app.command(render)
    app.command(measure)
    app.command(compare)
    return app


def synth(
    flow: Annotated[
        str,
        Parameter(help="uniform, shear, stagnation, rotation, rankine, lamb_oseen, taylor_green or discs"),
    ],
    /,
    *,
    out: Annotated[Path | None, Parameter(help="folder; runs/piv_FLOW if not given")] = None,
    size: Annotated[int, Parameter(help="px a side")] = 512,
    peak: Annotated[float, Parameter(help="largest displacement, px")] = 4.0,
    length: Annotated[float | None, Parameter(help="px: radius of a vortex's core, wavelength")] = None,
    density: Annotated[float, Parameter(help="tracers a pixel")] = 0.05,
    diameter: Annotated[float, Parameter(help="of a tracer, px")] = 2.8,
    noise: Annotated[float, Parameter(help="grey levels")] = 3.0,
    lost: Annotated[float, Parameter(help="share of tracers seen in one picture only")] = 0.05,
    disc: Annotated[float, Parameter(help="grey level of discs, bright or dark")] = 180.0,
    seed: int = 0,
    window: Annotated[int, Parameter(help="of the grid that exact.csv is given on, px")] = 16,
    overlap: Annotated[float, Parameter(help="of its windows")] = 0.5,
) -> int:
    """Write a pair of pictures whose displacement is known exactly: a.png, b.png, mask.png, exact.csv, pair.json."""
    import cv2
    import numpy as np

    from porescale.piv import flows
    from porescale.piv.field import write_csv
    from porescale.piv.measure import Settings
    from porescale.piv.synth import Camera, exact, pair
    from porescale.runs.atomic import write_bytes, write_text

    folder = out or Path("runs") / f"piv_{flow}"
    refuse_unwritable(folder, "--out")
    if not 16 <= size <= 8192:
        raise InputError(Fault("--size", size, "is out of range", "px", "16 to 8192"))
    camera = Camera((size, size), density, diameter, noise=noise, lost=lost, disc=disc)
    settings = Settings(window=window, overlap=overlap)
    settings.check((size, size))
    made = pair(flows.by_name(flow, (size, size), peak, length), camera, seed)
    pictures = {"a": made.first, "b": made.second, "mask": np.where(made.solid, 255, 0).astype(np.uint8)}
    for name, image in pictures.items():
        write_bytes(folder / f"{name}.png", cv2.imencode(".png", image)[1].tobytes())
    write_csv(exact(made, settings.window, settings.step), folder / "exact.csv")
    card = {
        "flow": flow, "size": size, "peak": peak, "length": length, "density": density, "diameter": diameter,
        "noise": noise, "lost": lost, "disc": disc, "seed": seed,
    }  # fmt: skip
    write_text(folder / "pair.json", json_text.dumps(card, indent=1) + "\n")
    for name in ("a.png", "b.png", "mask.png", "exact.csv", "pair.json"):
        print(folder / name)
    return 0


def render(
    run: Annotated[Path, Parameter(help="run folder, of a run with fluid")],
    /,
    *,
    out: Annotated[Path | None, Parameter(help="folder; RUN/piv if not given")] = None,
    scale: Annotated[
        str | None, Parameter(help='length of a pixel, "0.1 mm"; 1024 px the longer side if not given')
    ] = None,
    interval: Annotated[
        str | None, Parameter(help='between frames, "5 ms"; 4 px of the fastest flow if not given')
    ] = None,
    start: Annotated[str | None, Parameter(help='time of the run, "0.1 s"')] = None,
    end: Annotated[str | None, Parameter(help="time of the run")] = None,
    exposure: Annotated[float, Parameter(help="share of the interval that the shutter is open")] = 0.0,
    density: Annotated[float, Parameter(help="tracers a pixel")] = 0.05,
    diameter: Annotated[float, Parameter(help="of a tracer, px")] = 2.8,
    noise: Annotated[float, Parameter(help="grey levels")] = 3.0,
    grains: Annotated[Literal["bright", "dark"], Parameter(help="how solids look")] = "bright",
    seed: int = 0,
) -> int:
    """Film a run with a virtual camera: tracers carried by its flow, as pictures, masks and a film."""
    from porescale.piv.camera import GREYS, Shooting, fastest, shooting
    from porescale.piv.filmed import write_frames
    from porescale.piv.synth import Camera
    from porescale.runs.open_run import open_run

    folder = out or run / "piv"
    opened = open_run(run)
    refuse_unwritable(folder, "--out")
    first, last = (float(it) for it in opened.times[[0, -1]]) if len(opened) else (0.0, 0.0)
    begin = first if start is None else _quantity("--start", start, "s")
    stop = last if end is None else _quantity("--end", end, "s")
    if not first <= begin < stop <= last:
        text = f"{begin:g} to {stop:g}"
        raise InputError(Fault("--start, --end", text, "is no part of the run", "s", f"{first:g} to {last:g}"))
    pixel, speed = fastest(opened, begin, stop)
    pixel = pixel if scale is None else _quantity("--scale", scale, "m")
    pause = 4 * pixel / speed if interval is None else _quantity("--interval", interval, "s")
    camera = Camera(density=density, diameter=diameter, noise=noise, disc=GREYS[grains])
    shot = shooting(opened, Shooting(camera, pixel, pause, begin, stop, exposure, seed))
    count = write_frames(opened, shot, folder)
    rows, columns = shot.camera.size
    print(f"{count} frames of {columns} x {rows} px, {pixel:.4g} m a pixel, {pause:.4g} s apart")
    options = f"--mask {folder}/masks --scale {pixel:.6g} --interval {pause:.6g} --time {begin:g}"
    print(f"measure with: porescale piv measure {folder}/frames {options}")
    return 0


def measure(
    *films: Annotated[str, Parameter(help="two pictures; or a film, a folder or pattern of pictures, many pictures")],
    out: Annotated[Path | None, Parameter(help="folder for fields and pictures")] = None,
    csv: Annotated[Path | None, Parameter(help="table of the field (of the first pair, or the average)")] = None,
    openpiv: Annotated[Path | None, Parameter(help="the same in OpenPIV's text format")] = None,
    window: Annotated[int, Parameter(help="of the last pass, px: 64, 32, 16 or 8")] = 16,
    overlap: Annotated[float, Parameter(help="of neighbouring windows")] = 0.5,
    search: Annotated[int, Parameter(help="largest displacement looked for, px")] = 16,
    smooth: Annotated[bool, Parameter(help="no more than the noise asks for", negative="--no-smooth")] = True,
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
    from porescale.piv.field import in_metres, in_pixels
    from porescale.piv.film import open_film
    from porescale.piv.measure import Settings
    from porescale.piv.series import Shots, averaged, corner, measured, whole_rows

    if not films:
        raise InputError(Fault("films", None, "none given", repair="give two pictures, or a film"))
    for path, key in ((csv, "--csv"), (openpiv, "--openpiv")):
        if path is not None:
            refuse_unwritable(path.parent, key)
    folder = out if out or ((csv or openpiv) and not overlay) else Path("runs") / f"piv_{_stem(films[0])}"
    if folder is not None:
        refuse_unwritable(folder, "--out")
    use_threads(threads)
    settings = Settings(window=window, overlap=overlap, search=search, smooth=smooth)
    film = open_film(films, start=start, end=end, step=step, region=_box(region))
    pixel, seconds = _scales(scale, interval, film.rate)
    shots = Shots(film, mask, tuple(polygon or ()), background)
    rows = whole_rows(film) if pixel is not None else 0

    def finished(vectors: Vectors) -> Field:
        field = in_pixels(vectors, corner(film))
        return field if pixel is None or seconds is None else in_metres(field, rows, pixel, seconds * step)

    fields = (finished(it) for it in ([averaged(shots, settings)] if average else measured(shots, settings)))
    total = 1 if average else max(0, film.count() - 1)

    def span(shape: tuple[int, ...]) -> tuple[float, ...]:
        return _span(shape, corner(film), rows, pixel)

    zero = 0.0 if time_ is None else _quantity("--time", time_, "s")
    times = (zero + (seconds or 1.0) * (start + 0.5 * step), (seconds or 1.0) * step)
    said = _written(_progress(fields, total), shots, folder, csv, openpiv, times, span, total == 1)
    if overlay and folder is not None and not average:
        from porescale.piv.overlay import overlay_film

        shape = next(iter(film)).shape
        said["files"].append(str(overlay_film(folder, film, span(shape))))
    _say(said, json)
    return 0


def compare(
    reference: Annotated[Path, Parameter(help="field (our CSV, OpenPIV's text) or run folder")],
    other: Annotated[Path, Parameter(help="the same, held against the first")],
    /,
    *,
    out: Annotated[
        Path | None, Parameter(help="folder of compare.json and compare.png; none written if not given")
    ] = None,
    at: Annotated[str | None, Parameter(name="--time", help='of a run: the snapshot nearest to it; "0.5 s"')] = None,
    within: Annotated[float | None, Parameter(help="largest distance of vortices that match, px or m")] = None,
    json: Json = False,
) -> int:
    """Compare two fields: differences over the reference's rms speed, directions, vortices by place and sign."""
    from porescale.piv import compare as comparing
    from porescale.piv.pictures import comparison
    from porescale.runs.atomic import write_text

    if out is not None:
        refuse_unwritable(out, "--out")
    moment = None if at is None else _quantity("--time", at, "s")
    first, second = _field(reference, moment), _field(other, moment)
    found = comparing.compare(first, second, within)
    text = json_text.dumps(_finite(found.as_dict()), indent=1, allow_nan=False)
    if out is not None:
        write_text(out / "compare.json", text + "\n")
        print(comparison(first, second, found, out / "compare.png", (reference.name, other.name)), file=sys.stderr)
    if json:
        print(text)
        return 0
    unit, area = ("m/s", "m²/s") if first.upwards else ("px a frame", "px² a frame")
    print(f"{found.points} points, rms speed of the reference {found.speed:.4g} {unit}")
    print(f"difference over it: rms {found.rms:.4g}, largest {found.largest:.4g}")
    print(f"bias over it: u {found.bias_u:.3g}, v {found.bias_v:.3g}")
    print(f"mean cosine between directions {found.direction:.5g}, correlation {found.correlation:.5g}")
    for row in found.as_dict()["vortices"]:
        told = [_vortex(row[key], area) for key in ("reference", "other")]
        print(f"vortex: {told[0]} | {told[1]}")
    return 0


def _vortex(row: dict[str, Any] | None, area: str) -> str:
    """A vortex in a few words."""
    if row is None:
        return "none"
    return f"({row['x']:.4g}, {row['y']:.4g}), circulation {row['circulation']:.4g} {area}, radius {row['radius']:.3g}"


def _field(path: Path, moment: float | None) -> Field:
    """A field from a file, or the velocity of a run's snapshot (the last if no time is given)."""
    from porescale.piv.field import read
    from porescale.piv.of_run import field_of_run

    return field_of_run(path, moment) if path.is_dir() else read(path)


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


def _quantity(key: str, text: str, unit: str) -> float:
    """A number with or without unit, in ``unit``, positive (or zero for a time)."""
    from porescale.ground.units import to_si

    try:
        value = to_si(float(text), unit)
    except ValueError:
        try:
            value = to_si(text, unit)
        except ValueError as error:
            raise InputError(Fault(key, text, str(error), unit)) from error
    if value < 0 or (value == 0 and key not in ("--time", "--start", "--end")):
        raise InputError(Fault(key, text, "is out of range", unit, "> 0"))
    return value


def _scales(scale: str | None, interval: str | None, rate: float | None) -> tuple[float | None, float | None]:
    """Metres a pixel and seconds a frame; InputError for a scale without an interval."""
    pixel = None if scale is None else _quantity("--scale", scale, "m")
    seconds = None if interval is None else _quantity("--interval", interval, "s")
    if seconds is None and rate:
        seconds = 1 / rate
    if pixel is not None and seconds is None:
        raise InputError(
            Fault("--interval", None, "is needed with --scale", repair='give the time between frames: "5 ms"')
        )
    return pixel, seconds


def _progress(fields: Iterable[Field], total: int) -> Iterator[tuple[Field, int]]:
    """Fields as they come, with a line on stderr now and then."""
    start = last = time.perf_counter()
    for number, field in enumerate(fields, 1):
        yield field, number
        now = time.perf_counter()
        if now - last > PATIENCE:
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
    from porescale.piv.field import write_csv, write_openpiv
    from porescale.piv.pictures import quiver, vorticity
    from porescale.piv.series import as_grid
    from porescale.runs import snapshots
    from porescale.runs.model import Snapshot

    counts = {"pairs": 0, "vectors": 0, "valid": 0, "replaced": 0, "solid": 0}
    files: list[Path] = []
    last = None
    if folder is not None:
        snapshots.clear(folder)
    for field, number in fields:
        if alone and field.valid.sum() < CHANCE * (~field.solid).sum():
            raise InputError(Fault("pictures", None, "do not show the same tracers: hardly a vector passes validation"))
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


def _finite(value: Any) -> Any:
    """``value`` with numbers that are not finite as None."""
    if isinstance(value, dict):
        return {key: _finite(it) for key, it in value.items()}
    if isinstance(value, list):
        return [_finite(it) for it in value]
    return None if isinstance(value, float) and value - value != 0 else value

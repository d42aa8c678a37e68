"""``porescale piv``: synthetic pairs, displacement fields from pictures and films, fields compared."""

from __future__ import annotations

import json as json_text
import sys
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import App, Parameter

from porescale.cli.piv_measure import measure
from porescale.common.api.folders import require_writable
from porescale.common.cli.options import Json
from porescale.common.core.errors import Fault, InputError

if TYPE_CHECKING:
    from porescale.piv.fields.field import Field


FILMS = (".mp4", ".avi", ".mov", ".mkv", ".webm", ".tif", ".tiff")
"""File name endings that are read as films."""


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
        str, Parameter(help="uniform, shear, stagnation, rotation, rankine, lamb_oseen, taylor_green or discs")
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
    """Write a pair of pictures of exact displacement: a.png, b.png, mask.png, exact.csv, pair.json."""
    import cv2
    import numpy as np

    from porescale.common.core.atomic import write_bytes, write_text
    from porescale.piv.estimate.measure import Settings
    from porescale.piv.fields.field import write_csv
    from porescale.piv.images import flows
    from porescale.piv.images.synth import Camera, exact, pair

    folder = out or Path("runs") / f"piv_{flow}"
    require_writable(folder, "--out")
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
    from porescale.common.record.open_run import open_run
    from porescale.piv import given
    from porescale.piv.images.camera import GREYS, shot_of
    from porescale.piv.images.filmed import write_frames
    from porescale.piv.images.rendered import measured_with
    from porescale.piv.images.synth import Camera

    folder = out or run / "piv"
    opened = open_run(run)
    require_writable(folder, "--out")
    shot = shot_of(
        opened,
        Camera(density=density, diameter=diameter, noise=noise, disc=GREYS[grains]),
        scale=given.amount("--scale", scale, "m", bare=True),
        interval=given.amount("--interval", interval, "s", bare=True),
        start=given.amount("--start", start, "s", bare=True),
        end=given.amount("--end", end, "s", bare=True),
        exposure=exposure,
        seed=seed,
    )
    count = write_frames(opened, shot, folder)
    rows, columns = shot.camera.size
    print(f"{count} frames of {columns} x {rows} px, {shot.scale:.4g} m a pixel, {shot.interval:.4g} s apart")
    print(f"measure with: porescale piv measure {measured_with(folder)}")
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
    factor: Annotated[float, Parameter(help="most between circulations of vortices that match")] = 2.0,
    error: Annotated[
        float | None,
        Parameter(help="of a component, px or m/s, in fields that state none; without it they have no vortices"),
    ] = None,
    json: Json = False,
) -> int:
    """Compare two fields: differences over the reference's rms speed, directions, vortices by place, sign and
    circulation, surfaces of piles.
    """
    from porescale.common.core.atomic import write_text
    from porescale.common.core.ranges import Range
    from porescale.common.evidence.files import finite
    from porescale.piv import given
    from porescale.piv.fields.compare import ALIGNED
    from porescale.piv.fields.compare import compare as compare_fields
    from porescale.piv.fields.of_run import moment_of_run, surface_of_run
    from porescale.piv.fields.pictures import comparison

    if out is not None:
        require_writable(out, "--out")
    moment = given.amount("--time", at, "s", bare=True)
    bounds = (("--factor", factor, 1.0), ("--within", within, 0.0), ("--error", error, 0.0))
    given.refuse(*(given.within(key, it, Range(gt=least)) for key, it, least in bounds if it is not None))
    first, second = _field(reference, moment), _field(other, moment)
    moments = [moment_of_run(path, moment) if path.is_dir() else None for path in (reference, other)]
    one, two = (surface_of_run(path, first.x, moment) if path.is_dir() else None for path in (reference, other))
    found = compare_fields(first, second, within, factor, (one, two), error)
    if moment is None and None not in moments and moments[0] != moments[1]:
        print(f"warning: the last fields are of {moments[0]:g} and {moments[1]:g} s; --time picks one moment of both",
              file=sys.stderr)  # fmt: skip
    text = json_text.dumps(finite(found.as_dict()), indent=1, allow_nan=False)
    if out is not None:
        write_text(out / "compare.json", text + "\n")
        print(comparison(first, second, found, out / "compare.png", (reference.name, other.name)), file=sys.stderr)
    if json:
        print(text)
        return 0
    unit, area = ("m/s", "m²/s") if first.upwards else ("px a frame", "px² a frame")
    if said := [f"{path} at {it:g} s" for path, it in zip((reference, other), moments, strict=True) if it is not None]:
        print(", ".join(said))
    print(f"{found.points} points, rms speed of the reference {found.speed:.4g} {unit}")
    print(f"difference over it: rms {found.rms:.4g}, largest {found.largest:.4g}")
    print(f"bias over it: u {found.bias_u:.3g}, v {found.bias_v:.3g}")
    print(f"mean cosine between directions {found.direction:.5g}, correlation {found.correlation:.5g}")
    print(f"{100 * found.aligned:.1f} % of the directions within {ALIGNED:g} degrees")
    if found.surface is not None:
        rms, largest, mean, highest = found.surface
        unit = unit.split("/")[0].split(" ")[0]
        print(f"surface of the pile, {highest:.4g} {unit} high: rms {rms:.4g}, largest {largest:.4g}, mean {mean:.4g}")
    for row in found.as_dict()["vortices"]:
        print(f"vortex: {_vortex(row['reference'], area)} | {_vortex(row['other'], area)}")
    return 0


def _vortex(row: dict[str, Any] | None, area: str) -> str:
    """A vortex in a few words."""
    if row is None:
        return "none"
    return f"({row['x']:.4g}, {row['y']:.4g}), circulation {row['circulation']:.4g} {area}, radius {row['radius']:.3g}"


def _field(path: Path, moment: float | None) -> Field:
    """A field from a file, or the velocity of a run's snapshot (the last if no time is given)."""
    from porescale.piv.fields.field import read
    from porescale.piv.fields.of_run import field_of_run

    if path.suffix.lower() in FILMS or (path.is_dir() and any(path.glob("*.png")) and not any(path.glob("*.vtkhdf"))):
        repair = f"porescale piv measure {quote(str(path))} --out FOLDER, then compare FOLDER"
        raise InputError(Fault("field", str(path), "is a film that has not been measured", repair=repair))
    return field_of_run(path, moment) if path.is_dir() else read(path)

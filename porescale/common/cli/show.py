"""`show RUN`: pictures and a film of a run, or the figure that is asked for."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from porescale.common.api.folders import require_file, require_writable
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card

Text = str | None
Count = int | None


@Parameter(name="*")
@dataclass(frozen=True)
class Asked:
    """Options of `show`: with any of them one figure or film is written."""

    field: Annotated[Text, Parameter(help="array of the cells to paint, or of particles")] = None
    colour: Annotated[Text, Parameter(help="array that colours grains or particles")] = None
    limits: Annotated[Text, Parameter(help='range of the colours, LOW,HIGH as 0,"5 mm/s"')] = None
    colour_limits: Annotated[Text, Parameter(help="the same of grains in a fluid")] = None
    arrows: Annotated[Count, Parameter(help="arrows of the velocity across the picture")] = None
    view: Annotated[Text, Parameter(help="part of the box, LEFT,RIGHT,BOTTOM,TOP")] = None
    size: Annotated[Text, Parameter(help='long side in pixels, or width of the figure as "85 mm"')] = None
    times: Annotated[Text, Parameter(help="T,T,… of the panels; of a film the first and the last")] = None
    every: Annotated[Count, Parameter(help="show every so many snapshots")] = None
    fps: Annotated[Count, Parameter(help="frames a second of a film")] = None
    style: Annotated[Text, Parameter(help="paper or talk")] = None
    format: Annotated[Text, Parameter(help="png, pdf, svg, mp4 or gif")] = None
    against: Annotated[Path | None, Parameter(help="another run, beside it with the same colours")] = None
    out: Annotated[Path | None, Parameter(help="file to write; figure.png in the run folder if not given")] = None


def command(package: Package) -> Callable[..., int]:
    """The `show` command of a package."""

    def show(run: Annotated[Path, Parameter(help="run folder")], /, *, asked: Asked | None = None) -> int:
        """Make pictures and a film of a run, finished or not; with options one figure or film of what they say."""
        if asked is not None and asked != Asked():
            _say([_figure(package, run, asked)])
            return 0
        also = package.also.get(str(read_card(run).get("package")))
        if also is not None:
            _require_room(run)
            _say(also(run))
            return 0
        _require_own(package, run)
        _require_room(run)
        _say(package.show(run))
        return 0

    return show


def _figure(package: Package, folder: Path, asked: Asked) -> Path:
    """The figure or film that is asked for."""
    from porescale.common.pictures.choose import Wanted
    from porescale.common.pictures.figure import write_figure
    from porescale.common.record.open_run import open_run

    wanted = Wanted(
        asked.field, asked.colour, _parts(asked.limits), _parts(asked.colour_limits), asked.arrows, _parts(asked.view),
        int(asked.size) if asked.size and asked.size.isdecimal() else asked.size,
        _parts(asked.times), asked.every, asked.fps, asked.style, asked.format,
    )  # fmt: skip
    wanted.kind(asked.out)
    if asked.out is not None:
        require_file(asked.out, "--out")
    else:
        _require_room(folder)
    runs = [folder, *([asked.against] if asked.against is not None else [])]
    looked = []
    for each in runs:
        if str(read_card(each).get("package")) not in package.also:
            _require_own(package, each)
        opened = open_run(each)
        looked.append((opened, package.look(opened)))
    return write_figure(looked, wanted, asked.out)


def _parts(text: str | None) -> Any:
    """The parts of a list with commas: numbers, and texts with a unit."""
    return None if text is None else tuple(_part(part) for part in text.split(","))


def _part(text: str) -> float | str:
    """A number, or a text with a unit, which may stand in quotes as in a scene."""
    text = text.strip().strip("\"'")
    try:
        return float(text)
    except ValueError:
        return text


def _require_own(package: Package, run: Path) -> None:
    """InputError unless the run is one of a scene of this package."""
    scene, needed = read_card(run, package.name)["scene"], package.scene().model_fields
    missing = [name for name, field in needed.items() if field.is_required() and name not in scene]
    if missing:
        problem = f"{CARD} is damaged or not that of {package.name} (its scene has no {', '.join(missing)})"
        raise InputError(Fault("run folder", str(run), problem, repair="name another folder"))


def _require_room(run: Path) -> None:
    """InputError unless pictures can be written into the run folder; says how to have one elsewhere."""
    try:
        require_writable(run, "run folder")
    except InputError as error:
        repair = "write one figure or film elsewhere, with --out FILE"
        raise InputError([replace(fault, repair=repair) for fault in error.faults]) from None


def _say(paths: Iterable[Path]) -> None:
    for path in paths:
        print(path)

"""`sweep` from Python: a scene with keys varied, run as the command does it, as a DataFrame."""

from __future__ import annotations

import logging
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from porescale.common.api.folders import IN_PYTHON, output_folder
from porescale.common.api.load_scene import Settings, setting_texts
from porescale.common.api.shipped import scene_path
from porescale.common.core.errors import Fault, InputError, warn
from porescale.common.core.extras import extra
from porescale.common.core.ranges import Range
from porescale.common.schema import scene_file
from porescale.common.schema.save import placed

if TYPE_CHECKING:
    import pandas

    from porescale.common.api.program import Program
    from porescale.common.studies.ensemble import Repeats
    from porescale.common.studies.parameter_table import Point

Vary = Mapping[str, Sequence[Any]] | Sequence[Mapping[str, Any]] | str | Path
"""Key -> values, of which every combination is run; or a mapping key -> value for each run; or a CSV or TOML file."""
log = logging.getLogger(__name__)


def sweep(
    program: Program,
    scene: Any,
    vary: Vary | None,
    out: str | Path | None,
    *,
    repeat: int | None = None,
    over: str | None = None,
    quality: str | None = None,
    settings: Settings = (),
    jobs: int = 1,
    threads: int = 1,
    again: bool = False,
) -> pandas.DataFrame:
    """The runs of a sweep as a DataFrame; see ``sweep`` of the packages."""
    from porescale.common.record.series import run_table
    from porescale.common.studies.ensemble import Repeats, ensembles, repeated
    from porescale.common.studies.runner import FINISHED, Campaign
    from porescale.common.studies.sweep import check_points, columns_at_end, expected, require_folder, run_points
    from porescale.common.studies.sweep_files import ensemble_lines, keys_of, lines_of

    pd = extra("pandas")
    for name, value in (("jobs", jobs), ("threads", threads), ("repeat", 1 if repeat is None else repeat)):
        if (fault := Range(ge=1, whole=True).fault_of(name, value)) is not None:
            raise InputError(fault)
    if over is not None and not isinstance(over, str):
        raise InputError(Fault("over", str(over), "is no text", repair='give "section.key", or "section.key=a,b,c"'))
    asked = Repeats(repeat, over, ("repeat", "over", "vary"))
    points, texts = points_of(vary, asked), setting_texts(settings)
    if isinstance(scene, program.scene()):  # whose files are not looked for where the sweep keeps it
        kind, beside = type(scene), scene.source.folder or Path()
        points = [replace(it, settings=tuple(placed(text, kind, beside) for text in it.settings)) for it in points]
        texts = tuple(placed(text, kind, beside) for text in texts)
    with _as_file(program, scene, quality) as start:
        combined = "vary" if isinstance(vary, Mapping) and vary else ""
        file, name = check_points(program, start, points, quality, texts, combined)
        if asked:
            single, points = len(points), repeated(program, start, points, asked, quality, texts)
            check_points(program, start, points, quality, texts, "over", len(points) // single)
        folder = output_folder(out, f"{name}_sweep", IN_PYTHON)
        given = scene if isinstance(scene, program.scene()) else None
        if given is not None:
            file = _kept(program, given, folder / start.name)
    beside = file if given is None else scene.source.file
    rows = expected(beside) if beside is not None else []
    campaign = Campaign(program.module, file, folder, texts, quality, threads, again)
    require_folder(program, file, campaign, points, IN_PYTHON)
    command = f"{program.module}.sweep"
    ends = run_points(campaign, points, jobs, rows, command, log.info)
    for ended in ends:
        if ended.outcome != FINISHED:
            warn(f"{ended.point.name}: {ended.outcome}: {ended.problem}")
    rows = rows or columns_at_end(ends)
    made = pd.DataFrame(lines_of(ends, rows, run_table))
    for key in keys_of(ends):
        made[key] = [_value(text) for text in made[key]]
    made.attrs["folder"] = str(folder)
    if asked:
        lines = ensemble_lines(ensembles(points, ends), rows, run_table)
        made.attrs["ensembles"] = [dict(line.cells) for line in lines]
    found: pandas.DataFrame = made
    return found


def points_of(vary: Vary | None, asked: Repeats | None = None) -> list[Point]:
    """The points of a sweep; InputError where nothing is varied, and nothing repeated."""
    from porescale.common.studies.parameter_table import AS_IT_IS, Point, combinations, named, read_points

    if isinstance(vary, str | Path):
        return read_points(Path(vary))
    if vary is not None and not isinstance(vary, Mapping | Sequence):
        repair = 'give {"contact.friction": [0.2, 0.5]}; of a DataFrame, its to_dict("records")'
        raise InputError(Fault("vary", type(vary).__name__, "is neither a mapping nor a list of them", repair=repair))
    if not vary:
        if asked:
            return [Point(AS_IT_IS, ())]
        repair = 'give {"contact.friction": [0.2, 0.5]}, or repeat=N'
        raise InputError(Fault("sweep", None, "varies nothing", repair=repair))
    if not isinstance(vary, Mapping):
        return named([Point("", setting_texts(each)) for each in vary])
    faults, choices = [], []
    for key, values in vary.items():
        if isinstance(values, str | Mapping) or not (
            isinstance(values, Sequence) or len(getattr(values, "shape", ())) == 1
        ):
            faults.append(Fault(f"vary.{key}", str(values), "is not a list of values"))
        elif not len(values):
            faults.append(Fault(f"vary.{key}", "[]", "holds no value", repair="leave the key out"))
        else:
            choices.append([setting_texts({key: value})[0] for value in values])
    if faults:
        raise InputError(faults)
    return named(combinations(choices, "vary"))


@contextmanager
def _as_file(program: Program, scene: Any, quality: str | None) -> Iterator[Path]:
    """The file of a scene that is named; a file of one that is an object, there as long as this lasts."""
    if not isinstance(scene, program.scene()):
        if not isinstance(scene, str | Path):
            problem, repair = f"is no scene of {program.name}", "give a scene, its path, or the name of a case"
            raise InputError(Fault("scene", type(scene).__name__, problem, repair=repair))
        yield scene_file.find(scene_path(scene, program.name))
        return
    if quality is not None:
        raise InputError(Fault("quality", quality, "is for scenes by path or name", repair="give it to load"))
    with TemporaryDirectory() as place:
        named = str(getattr(scene, "name", "")) or "scene"
        file: Path = scene.save(Path(place) / f"{named}.toml")
        try:
            yield file
        except InputError as error:
            raise InputError([replace(it, file=it.file.replace(str(file), named)) for it in error.faults]) from None


def _kept(program: Program, scene: Any, file: Path) -> Path:
    """The scene's file in the folder of the sweep, written if it is not there; InputError where another's is."""
    from porescale.common.schema.sections import load

    if not file.exists():
        scene.save(file)
        return file
    if load(file, program.scene()) != scene:
        problem = "holds a sweep of another scene"
        raise InputError(Fault(IN_PYTHON.out, str(file.parent), problem, repair="name another folder"))
    return file


def _value(text: str) -> Any:
    """What a point sets a key to: a number, truth or list where it is one, else the text; None where nothing."""
    if not text:
        return None
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text

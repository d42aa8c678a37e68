"""A sweep: a scene with keys varied, every point checked before any runs, the runs compared as they end."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.api.folders import TYPED, Words
from porescale.common.core.errors import Fault, InputError
from porescale.common.record.read_card import NAME as CARD

if TYPE_CHECKING:
    from porescale.common.api.program import Program
    from porescale.common.studies.parameter_table import Point
    from porescale.common.studies.runner import Campaign, Ended

TABLES = 512
"""Tables of run folders that are kept in memory."""
SAID = 3
"""Runs of other points that are named, at most."""
ELSEWHERE = "name another folder, or remove what is there"
"""What helps where runs are in the way."""
SELDOM = 5.0
"""Files of a sweep are written again after so many times what writing them took."""
TAKES = 1.0
"""Seconds for which writing them is reckoned with before it was done: little more than their picture takes."""


def run_points(
    campaign: Campaign,
    points: Sequence[Point],
    jobs: int | None,
    rows: Sequence[dict[str, Any]],
    command: str,
    say: Callable[[str], object],
) -> list[Ended]:
    """Run all points, and write the files of the sweep as they end, and at the end; in the order of the points.

    rows : what is compared, as `expected` gives it; none: how every column of the series ends;  command : that the
    files name;  say : as of `Campaign.all`.
    """
    from porescale.common.record.series import run_table
    from porescale.common.studies import sweep_files

    ends: list[Ended] = []
    order = {point.name: at for at, point in enumerate(points)}
    tables = lru_cache(TABLES)(run_table)
    before, took, written = 0.0, TAKES, 0

    def write() -> None:
        """Write the files of what has ended so far."""
        nonlocal before, took, written
        begun = time.monotonic()
        ends.sort(key=lambda one: order[one.point.name])
        sweep_files.write(campaign.folder, command, ends, rows or columns_at_end(ends), tables, points)
        before = time.monotonic()
        if ends:
            took, written = before - begun, len(ends)

    for point in points:  # another's runs are found before anything is written beside them
        campaign.before(point)
    write()
    try:
        for ended in campaign.all(points, jobs, say):
            ends.append(ended)
            if time.monotonic() - before > SELDOM * took:
                write()
    finally:
        if len(ends) > written:
            write()
    return ends


def check_points(
    program: Program,
    scene: Path,
    points: Sequence[Point],
    quality: str | None,
    settings: Sequence[str],
    vary: str = "",
    each: int = 0,
) -> tuple[Path, str]:
    """File and name of the scene; InputError with what is wrong with any of the points, before any of them runs, and
    where one of the ``settings`` has no effect, since every point has its own.

    vary : what messages call the options of which the points are all combinations: none of them is another's scene;
    each : so many points follow one another for each row of a table, whose rows may say what they want (0: no table).
    """
    from porescale.common.schema.scene_file import find
    from porescale.common.schema.sections import load

    own = [{text.partition("=")[0] for text in (point.of or point).settings} for point in points]
    for text in settings:
        key, _, value = text.partition("=")
        if all(key in keys for keys in own):
            raise InputError(
                Fault(key, value, "is set by every run of the sweep, too", repair="leave one out", file="--set")
            )
    faults: dict[str, Fault] = {}  # by what they say: what is wrong with every point is said of the first
    first: dict[tuple[int, bytes], Point] = {}
    for at, point in enumerate(points):
        try:
            overrides = (*settings, *point.settings)
            read = load(scene, program.scene(), quality=point.quality or quality, overrides=overrides)
            program.report_of(read)
        except InputError as error:
            for fault in error.faults:
                place = f"{point.name}, {fault.file}" if fault.file else point.name
                faults.setdefault(fault.line(), replace(fault, file=place))
            continue
        row = at // each if each else 0
        if vary and (same := first.setdefault((row, _digest(read, point)), point)) is not point:
            fault = _twice(same, point)
            faults.setdefault(fault.line(), replace(fault, file=vary))
    if faults:
        raise InputError(list(faults.values()))
    return find(scene), read.name


def _digest(scene: Any, point: Point) -> bytes:
    """Of a scene, of the level of its ``point``, and of settings that it does not keep, as the name of a file it read.

    Two such files may say the same.
    """
    from porescale.common.schema.scene_file import holds, parse_setting
    from porescale.common.schema.sections import scene_as_dict

    kept = scene_as_dict(scene)
    lost = [text for text in point.settings if not holds(kept, parse_setting(text)[0])]
    return sha256(repr((kept, point.quality, lost)).encode()).digest()


def _twice(one: Point, other: Point) -> Fault:
    """What is wrong with two points of one scene: the first value that they write in two ways."""
    pairs = zip(one.settings, other.settings, strict=True)
    before, again = next(((a, b) for a, b in pairs if a != b), (one.settings[-1], other.settings[-1]))
    key, _, value = again.partition("=")
    return Fault(key, value, f"is {before.partition('=')[2]}, which is given, too", repair="leave one out")


def require_folder(
    program: Program, scene: Path, campaign: Campaign, points: Sequence[Point], words: Words = TYPED
) -> None:
    """InputError where the folder of a campaign holds runs that are none of this ``scene`` at these ``points``."""
    require_alone(campaign, points, words)
    require_same(program, scene, campaign, points)


def require_alone(campaign: Campaign, points: Sequence[Point], words: Words) -> None:
    """InputError where the folder of a campaign holds runs that are none of its ``points``."""
    names = {point.name for point in points}
    others = sorted(it.parent.name for it in campaign.folder.glob(f"*/{CARD}") if it.parent.name not in names)
    if others:
        more = f" and {len(others) - SAID} more" if len(others) > SAID else ""
        problem = f"holds runs of other points: {' '.join(others[:SAID])}{more}"
        raise InputError(Fault(words.out, str(campaign.folder), problem, repair=ELSEWHERE))


def require_same(program: Program, scene: Path, campaign: Campaign, points: Sequence[Point]) -> None:
    """InputError where a point has a run of another scene in its folder, as that of a scene's file before a change."""
    from porescale.common.api.run_scene import card_of, check_same_scene
    from porescale.common.record.check_state import CHECKPOINT
    from porescale.common.schema.sections import load

    for point in points:
        place = campaign.place(point)
        if not ((place / CARD).exists() and (place / CHECKPOINT).exists()):
            continue
        overrides = (*campaign.settings, *point.settings)
        read = load(scene, program.scene(), quality=point.quality or campaign.quality, overrides=overrides)
        try:
            check_same_scene(program, place, card_of(program, read))
        except InputError as error:
            raise InputError([replace(it, file=str(place), repair=ELSEWHERE) for it in error.faults]) from None


def expected(scene: Path) -> list[dict[str, Any]]:
    """The rows of expected.toml beside the scene file that name a number to read, none where there is none.

    Raises InputError with what is wrong with any of them.
    """
    from porescale.common.schema.scene_file import read
    from porescale.common.studies.quantities import wrong

    file = scene.parent / "expected.toml"
    if not file.is_file():
        return []
    rows = read(file).get("expected", [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        repair = "write [[expected]]"
        raise InputError(Fault("expected", None, "is not a list of tables", repair=repair, file=str(file)))
    readable = [row for row in rows if {"name", "column", "at"} <= row.keys()]
    faults = [Fault(f"expected {row['name']!r}", None, it, file=str(file)) for row in readable if (it := wrong(row))]
    if faults:
        raise InputError(faults)
    return readable


def columns_at_end(ends: Sequence[Ended]) -> list[dict[str, Any]]:
    """How every column of the series ends, in the first point that has one."""
    from porescale.common.record.series import run_table

    for ended in ends:
        if ended.outcome == "finished":
            names = list(run_table(ended.folder, "series"))[1:]
            return [{"name": name, "column": name, "at": "end"} for name in names]
    return []

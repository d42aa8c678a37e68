"""What `run --error` and `run --budget` pick from the front of a scene."""

from __future__ import annotations

import math
import shlex
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError

if TYPE_CHECKING:
    from porescale.common.studies.front import Choice, Front, FrontPoint, Here


FREE = "title", "output.", "quality_default"
"""Keys that change neither errors nor what steps cost."""


def pick(
    package: Package, scene: Path, error: str | None, budget: str | None, settings: Sequence[str], *, quiet: bool
) -> Choice:
    """The point, printed on stderr with expected cost and error; InputError on wrong
    options, no front, or nothing that fits."""
    from porescale.common.core.machine import age
    from porescale.common.duration.expected import besides
    from porescale.common.schema.scene_file import find
    from porescale.common.schema.sections import load
    from porescale.common.studies.front import begun, choose, read_front

    allowed = None if error is None else share("--error", error)
    seconds = None if budget is None else _seconds(budget)
    file = find(scene)
    front = read_front(file, _end(load(file, package.scene(), overrides=settings)))

    def here(point: FrontPoint) -> Here:
        """The beginning of the point's scene, and the time it is to simulate, s, where its scene says that."""
        scene = load(file, package.scene(), quality=point.quality, overrides=(*point.settings, *settings))
        more = besides(package.report_of(scene).work)  # what contradicts itself is refused
        return begun(lambda: package.build(scene), _end(scene), more)

    try:
        choice = choose(front, allowed, seconds, here, age)
    except InputError as refused:  # said with what was given
        given = {"--error": error, "--budget": budget}
        faults = [replace(it, value=given.get(it.key) or it.value) for it in refused.faults]
        level = "" if allowed is None else better_level(package, file, front, allowed)
        more = [replace(it, repair=f"{it.repair}; {level}") if level and it.key == "--error" else it for it in faults]
        raise InputError(more) from None
    if not quiet:
        for doubt in beyond(package, file, front, choice.point, settings):
            print(f"warning: {doubt}", file=sys.stderr)
        print(choice.line(front), file=sys.stderr, flush=True)
    return choice


def _end(scene: Any) -> float | None:
    """Time that a scene is to simulate, s, where it says so."""
    end = getattr(getattr(scene, "time", None), "end", None)
    return None if end is None else float(end)


def beyond(package: Package, file: Path, front: Front, point: FrontPoint, settings: Sequence[str]) -> list[str]:
    """In what a run of a point leaves what its front was measured with: scene, settings, range of time."""
    from porescale.common.api.run_scene import completing
    from porescale.common.studies.parameter_table import changed, flat, values_of
    from porescale.common.studies.trade_plan import read_plan

    over = front.over
    if over is None and (file.parent / "trade.toml").is_file():
        plan = read_plan(file, None)
        over = plan.over.key if plan.over else None
    now, then = (values_of(package, file, (*point.settings, *it), point.quality) for it in (settings, front.settings))
    if front.scene is not None:  # the file may have changed since
        base, today = dict(flat(completing(package.scene())(front.scene))), values_of(package, file, front.settings)
        then |= {key: base.get(key) for key in changed(base, today)}
    keys = [key for key in changed(now, then) if not key.startswith(FREE) and key not in ("time.end", over)]
    made = []
    if keys:
        few = ", ".join(f"{key} = {now.get(key)}, there {then.get(key)}" for key in keys[:3])
        more = f" and {len(keys) - 3} more" if len(keys) > 3 else ""
        made.append(f"{front.file} was measured with another scene: {few}{more}; its errors are not those of this run")
    end = now.get("time.end")
    if isinstance(end, float) and end > 1.01 * point.time:
        made.append(f"{front.file} was measured until {point.time:.3g} s, the run goes on to {end:.3g} s: its errors "
                    "say nothing of later")  # fmt: skip
    return made


def better_level(package: Package, file: Path, front: Front, error: float) -> str:
    """The cheapest quality of a scene whose error is at most ``error``, as text; "" where there is none."""
    from porescale.common.schema import scene_file
    from porescale.common.studies.parameter_table import values_of

    levels = {name: values_of(package, file, (), name) for name in scene_file.read(file).get("quality") or ()}
    good = [point for point in front.every if point.error <= error]
    for point in sorted([*good, *([front.reference] if front.reference else [])], key=lambda one: one.core_seconds):
        its = values_of(package, file, point.settings, point.quality)
        name = next((name for name, level in levels.items() if level == its), None)
        held = point is front.reference
        what = "what errors are held against" if held else f"error {point.error:.2%}; but {point.but}"
        if name or held:
            words = f"--quality {name}" if name else " ".join(f"--set {shlex.quote(it)}" for it in point.settings)
            return f"{words} is {what}, {point.core_seconds:.3g} core-seconds"
    return ""


def share(option: str, text: str) -> float:
    """ "5%", "5 %" or "0.05" of an option as a share; a number beyond 1 was meant in per cent, and is refused."""
    number, sign, rest = text.partition("%")
    try:
        found = float(number) / (100 if sign else 1)
    except ValueError:
        found = math.nan
    if not text.strip():
        raise InputError(Fault(option, None, "has no share", "", "> 0", "write one, as 5% or 0.05"))
    if rest.strip() or not 0 < found < math.inf:
        raise InputError(Fault(option, text, "is not a positive share", "", "> 0", "write it as 5% or 0.05"))
    if found > 1 and not sign:
        raise InputError(Fault(option, text, f"is {100 * found:g} %", "", "<= 1", f"write it as {text.strip()}%"))
    return found


def _seconds(text: str) -> float:
    """ "3min", "90 s", "2 h" as seconds."""
    from porescale.common.core.units import to_si

    try:
        found = to_si(text, "s") if not text.replace(".", "").isdigit() else float(text)
    except ValueError as error:
        raise InputError(Fault("--budget", text, str(error), "s", "> 0", "write it as 3min, 90s or 2h")) from None
    if not 0 < found < math.inf:
        raise InputError(Fault("--budget", text, "is not a positive time", "s", "> 0", "write it as 3min, 90s or 2h"))
    return found

"""What `run --error` and `run --budget` pick from the front of a scene."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError

if TYPE_CHECKING:
    from porescale.common.studies.front import Choice, FrontPoint, Here


def pick(
    package: Package, scene: Path, error: str | None, budget: str | None, settings: Sequence[str], *, quiet: bool
) -> Choice:
    """The point, printed on stderr with expected cost and error; InputError on wrong
    options, no front, or nothing that fits."""
    from porescale.common.schema.scene_file import find
    from porescale.common.schema.sections import open_scene
    from porescale.common.studies.front import begun, choose, read_front

    allowed = None if error is None else share("--error", error)
    seconds = None if budget is None else _seconds(budget)
    front = read_front(find(scene))

    def here(point: FrontPoint) -> Here:
        """The beginning of the point's scene, and the time it is to simulate, s, where its scene says that."""
        overrides = (*point.settings, *settings)
        opened = open_scene(scene, package.scene(), quality=point.quality, overrides=overrides)
        package.report(opened.scene)  # what contradicts itself is refused
        end = getattr(getattr(opened.scene, "time", None), "end", None)
        return begun(lambda: package.build(opened.scene), end)

    try:
        choice = choose(front, allowed, seconds, here)
    except InputError as refused:  # said with what was given
        given = {"--error": error, "--budget": budget}
        raise InputError([replace(it, value=given.get(it.key) or it.value) for it in refused.faults]) from None
    if settings and not quiet:
        print(f"warning: {front.file} was measured without --set {' '.join(settings)}", file=sys.stderr)
    if not quiet:
        print(choice.line(front), file=sys.stderr, flush=True)
    return choice


def share(option: str, text: str) -> float:
    """ "5%", "5 %" or "0.05" of an option as a share."""
    number, sign, rest = text.partition("%")
    try:
        found = float(number) / (100 if sign else 1)
    except ValueError:
        found = math.nan
    if rest.strip() or not 0 < found < math.inf:
        raise InputError(Fault(option, text, "is not a positive share", "", "> 0", "write it as 5% or 0.05"))
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

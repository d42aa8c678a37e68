"""Quality levels as points of a front: which ones the rule picks, and whether a scene's levels are those.

draft     the cheapest point with an error the front allows for drafts: ``draft`` of trade.toml, or the error of
          another repeat of the reference
standard  the most accurate point that was tried, the cheapest of them if there are several
fine      the reference that all were compared with

Points of which trade.toml says a ``but`` are left out: they are accurate in the requested quantities only.
`study levels SCENE` says so, and fails where the scene's [quality.…] tables are something else.
"""

import json
from dataclasses import dataclass
from pathlib import Path

from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError
from porescale.common.studies.front import Front, FrontPoint, point_of, read_front
from porescale.common.studies.parameter_table import changed, values_of
from porescale.common.studies.trade import rms
from porescale.common.studies.trade_files import percent

APART = 20.0
"""A fine run costs at least so many times the core-seconds of a draft."""


@dataclass(frozen=True)
class Picked:
    """A level and the point that the rule picks for it.  wrong : keys of the scene that differ, with both values."""

    level: str
    point: FrontPoint
    wrong: tuple[str, ...] = ()

    def line(self) -> str:
        """The level as one line for the terminal."""
        error = "what others are held against" if self.level == "fine" else f"error {percent(self.point.error)}"
        said = f"{self.level}: {self.point.label}, {self.point.core_seconds:.3g} core-seconds, {error}"
        return said + "".join(f"\n  the scene has {it}" for it in self.wrong)


def picked(front: Front) -> dict[str, FrontPoint]:
    """The points of draft, standard and fine; InputError where the front has none for a level."""
    table = json.loads(front.file.read_text(encoding="utf-8"))
    packings = table.get("packings") or {}
    allowed = float(table["draft"]) if "draft" in table else rms(list(packings.values())) if packings else 0.0
    rows = [row for row in table["points"] if row["error"] is not None and not row["but"]]
    points = sorted(map(point_of, rows), key=lambda point: point.core_seconds)
    good = [point for point in points if point.error <= allowed]
    if not good or not table.get("reference"):
        problem = f"has no reference, or no point off by at most {percent(allowed)}"
        raise InputError(Fault(str(front.file), None, problem, repair="set draft in trade.toml, and measure it anew"))
    best = min(points, key=lambda point: (point.error, point.core_seconds))
    return {"draft": good[0], "standard": best, "fine": point_of(table["reference"])}


def compared(package: Package, scene: Path) -> list[Picked]:
    """What the rule picks from the front beside the scene file, and where the levels of the scene differ from it."""
    made = []
    for level, point in picked(read_front(scene)).items():
        has, should = values_of(package, scene, (), level), values_of(package, scene, point.settings, point.quality)
        wrong = (f"{key} = {has.get(key)}, the point {should.get(key)}" for key in changed(has, should))
        made.append(Picked(level, point, tuple(wrong)))
    return made


def apart(rows: list[Picked]) -> float:
    """Core-seconds of fine over those of draft."""
    return rows[-1].point.core_seconds / rows[0].point.core_seconds

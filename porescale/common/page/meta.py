"""What a page knows of a run before it reads a frame: names, times, units, ranges of colours, how it is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from porescale.common.api.fields import scalars
from porescale.common.core.picked import every_so_many, spread
from porescale.common.page.frames import FINE, colour_maps
from porescale.common.page.quantise import Precision
from porescale.common.page.tables import names
from porescale.common.page.texts import again, check, verdicts
from porescale.common.pictures.look import Look, scale, survey
from porescale.common.record.card import plain
from porescale.common.record.model import Grid, Snapshot

if TYPE_CHECKING:
    from porescale.common.api.open_run import Run
    from porescale.common.core.types import AnyArray

FORMAT = 1
SAMPLED = 9
"""Snapshots from which ranges of colours are taken, spread over the run."""
MOST_VALUES = 20000
"""Values of each array of each of them."""


def meta(run: Run, precision: Precision = FINE) -> dict[str, Any]:
    """All that a page shows of a run besides its frames and tables, JSON-able.

    "times" (s) and "steps" of the frames that `frame` gives;  "view": (left, right, bottom, top) m;  "look": what is
    shown at first;  "quantities": of each grid and cloud its arrays and the parts of vectors, with unit and the range
    and map of their colours;  "tables": names;  "verdicts", "check", "again", "card";  "maps": colour maps.
    """
    card = run.card
    found: dict[str, Any] = {
        "format": FORMAT, "name": run.name, "folder": run.folder.resolve().name,
        "title": str(card["scene"].get("title") or run.name), "package": str(card.get("package", run.program.name)),
        "outcome": run.outcome, "problem": str(card.get("problem") or ""), "tables": names(run),
        "verdicts": verdicts(run), "check": check(run), "again": again(run), "card": card, "maps": colour_maps(),
        "precision": {"bits": precision.bits, "every": precision.every, "thin": precision.thin,
                      "full": precision.full, "snapshots": len(run)},
    }  # fmt: skip
    found |= frames_of(run, precision) | shown(run)
    checked: dict[str, Any] = plain(found)
    return checked


def frames_of(run: Run, precision: Precision = FINE) -> dict[str, Any]:
    """Times (s) and steps of the frames."""
    at = every_so_many(len(run), precision.thin)
    return {"times": run.times[at].tolist() if at else [], "steps": run.steps[at].tolist()}


def shown(run: Run) -> dict[str, Any]:
    """Quantities with their ranges, the view, and what is shown at first; from a few snapshots."""
    look = run.program.look(run)
    if not len(run):
        return {"quantities": {"grids": {}, "clouds": {}}, "view": list(look.view or (0, 1, 0, 1)), "look": {}}
    sample: list[Snapshot] = list(run.snapshots(None, spread(len(run), SAMPLED)))
    everything = survey(sample, look)
    first = sample[0]
    quantities: dict[str, dict[str, Any]] = {"grids": {}, "clouds": {}}
    for kind, name, block in first.blocks():
        quantities[kind][name] = {
            key: _range(sample, kind, name, key, look, block.units)
            for key in _scalars(block)
        }  # fmt: skip
    return {"quantities": quantities, "view": list(everything.view), "look": _look(look, first, everything.dot)}


def _scalars(block: Any) -> dict[str, AnyArray]:
    """Arrays of a grid or cloud, vectors as their length and components."""
    arrays = block.cells if isinstance(block, Grid) else block.data
    return {name: field.values for name, field in scalars(arrays, block.units).items()}


def _range(
    sample: list[Snapshot], kind: str, block: str, name: str, look: Look, units: dict[str, str]
) -> dict[str, Any]:
    """Unit, range and map of the colours of one quantity, and whether it is whole."""
    parts = []
    for snapshot in sample:
        values = _scalars(getattr(snapshot, kind)[block])[name].ravel()
        parts.append(values[:: max(1, values.size // MOST_VALUES)])
    values = np.concatenate(parts)
    whole = values.dtype.kind in "iub"
    array = "velocity" if name == "speed" else name.removesuffix("_x").removesuffix("_y") if name not in units else name
    unit = units.get(array, "")
    limits = None
    if kind == "grids" and block == look.grid and name == ("speed" if look.field == "velocity" else look.field):
        limits = look.limits
    if kind == "clouds" and block == look.cloud and array == look.colour and array == name:
        limits = look.cloud_limits
    chosen = scale(name, unit, values.astype(float), limits, "", "")
    return {"unit": "" if unit == "1" else unit, "low": chosen.low, "high": chosen.high, "map": chosen.map_name,
            "whole": whole, "label": chosen.label.rpartition(" (")[0] or chosen.label}  # fmt: skip


def _look(look: Look, first: Snapshot, dot: float) -> dict[str, Any]:
    """What a page shows at first, as `show` does."""
    cloud = look.drawn(first)
    name = next((key for key, each in first.clouds.items() if each is cloud), "")
    colour = look.colouring(cloud) if cloud is not None else ""
    vectors = {key for each in (*first.grids.values(), *first.clouds.values()) for key in _vectors(each)}

    def quantity(key: str) -> str:
        """The scalar of an array: the length of a vector."""
        return "speed" if key == "velocity" and key in vectors else key

    return {
        "grid": look.grid if look.painted(first) is not None else "", "field": quantity(look.field), "cloud": name,
        "colour": quantity(colour), "walls": look.walls, "dot": dot, "plain": look.plain, "period": list(look.period),
        "shapes": look.shapes, "label": look.label, "title": look.title,
        "kinds": {str(key): list(value) for key, value in look.kinds.items()} if colour else {},
    }  # fmt: skip


def _vectors(block: Any) -> list[str]:
    """Names of the vectors of a grid or cloud."""
    arrays, axes = (block.cells, 2) if isinstance(block, Grid) else (block.data, 1)
    return [name for name, values in arrays.items() if values.ndim > axes]

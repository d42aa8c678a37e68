"""Scenes in a tank: what an experiment is about, and the rest that every scene needs."""

from typing import Any

from continuum_sph.scene.sections import Scene
from porescale.common.schema.sections import validate

Table = dict[str, Any]


def tank_scene(
    width: float, height: float, spacing: float, end: float = 1.0, *, every: float | None = None, lid: bool = True,
    numerics: Table | None = None, **sections: Any,
) -> Scene:  # fmt: skip
    """A scene in a tank of ``width`` by ``height`` (m) of particles at ``spacing`` (m), written ``every`` s, or at the
    end; sections are added to it, or stand in place of its own."""
    table = {
        "tank": {"width": width, "height": height, "lid": lid},
        "numerics": {"spacing": spacing} | (numerics or {}),
        "time": {"end": end},
        "output": {"snapshot_interval": every or end, "series_interval": every or end},
    }
    return validate(Scene, table | sections)


def level_ground(width: float, height: float) -> Table:
    """A piece of level ground from the left wall of a tank on, m."""
    return {"outline": [[0, 0], [width, 0], [width, height], [0, height]]}

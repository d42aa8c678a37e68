"""``porescale check``: what a scene means before it runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.builders.scene import Scene
    from porescale.common.cli.report import Report


def report(scene: Scene) -> Report:
    """Every derived number of a scene; raises InputError with all refusals."""
    from porescale.builders.report import report as scene_report

    return scene_report(scene)

"""What the picture of a scene before its run labels: walls, water, soil, reservoirs, sheet pile, what is measured."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from porescale.common.pictures.initial import Feature, Lens, Points
from porescale.common.schema.names import names_of

if TYPE_CHECKING:
    from continuum_sph.scene.sections import Scene
    from porescale.common.record.model import Snapshot

ALONE = 5
"""More probes than these share one label."""


def features_of(scene: Scene) -> list[Feature]:
    """All that is labelled in the picture of a scene."""
    return [*_tank(scene), *_ground(scene), *_water(scene), *_measured(scene)]


def lens_of(scene: Scene, snapshot: Snapshot) -> Lens:
    """The lens on particles in the middle of what is there."""
    spacing, at = scene.numerics.spacing, snapshot.clouds["particles"].position
    middle = at[int(np.hypot(*(at - np.median(at, axis=0)).T).argmin())]
    words = f"spacing {spacing:.4g} m, smoothing length {scene.numerics.smoothing_ratio * spacing:.4g} m"
    return Lens(spacing, (float(middle[0]), float(middle[1])), 0.0, words, lattice=False)


def _tank(scene: Scene) -> Iterator[Feature]:
    """Walls, with the lid where there is one."""
    tank = scene.tank
    w, h = tank.width, tank.height
    yield Feature(
        "side", f"tank, {w:g} m x {h:g} m, walls {tank.walls}", path=((0, h), (0, 0), (w, 0), (w, h)), at=(w, 0.9 * h)
    )
    if tank.lid:
        yield Feature("side", "lid", path=((0, h), (w, h)))


def _ground(scene: Scene) -> Iterator[Feature]:
    """Pieces of soil, and the sheet pile in it."""
    if scene.soil is not None:
        wet = ", pores full" if scene.soil.saturated else ", with suction" if scene.soil.suction else ""
        wet += ", held" * scene.soil.held
        for k, body in enumerate(scene.soil.body):
            name = "soil" if len(scene.soil.body) == 1 else f"soil {k}"
            yield Feature("side", f"{name}{wet}", path=(*body.outline, body.outline[0]))
        if (level := scene.soil.water_table) is not None:
            path = ((0.0, level), (scene.tank.width, level))
            yield Feature(
                "open", f"water table, {level:g} m", path=path, dashed=True, at=(0.9 * scene.tank.width, level)
            )
        for k, part in enumerate(scene.soil.watch):
            yield Feature("measures", f"watched {part.name or f'part {k}'}", area=part.outline)
    if scene.pile is not None:
        x, spacing = scene.pile.column(scene.numerics.spacing), scene.numerics.spacing
        label = f"sheet pile, tip at {scene.pile.tip:g} m, faces {scene.pile.faces}"
        yield Feature("side", label, path=((x, scene.tank.height), (x, scene.pile.lower_end(spacing))))


def _water(scene: Scene) -> Iterator[Feature]:
    """Columns of water, discs of a second fluid, reservoirs with their levels, and faces with their heads."""
    for k, it in enumerate(scene.water.column):
        name = "water" if len(scene.water.column) == 1 else f"water {k}"
        top, right = it.bottom + it.height, it.left + it.width
        yield Feature("open", f"{name}, {it.width:g} m x {it.height:g} m", path=((it.left, top), (right, top)))
    if scene.inclusion is not None:
        discs = scene.inclusion.disc
        text = (
            f"second fluid, radius {discs[0].radius:g} m" if len(discs) == 1 else f"{len(discs)} discs of second fluid"
        )
        yield Feature("open", text, marks=[(it.x, it.y) for it in discs])
    for k, basin in enumerate(scene.reservoir):
        levels = [level for _, level in basin.table]
        first, last = levels[0], levels[-1]
        text = f"kept at {first:g} m" if len(set(levels)) == 1 else f"level {first:g} m to {last:g} m"
        course: Points = ()
        if first != last:
            middle = 0.5 * (basin.left + basin.right)
            course = ((middle, first), (middle, last))
        path = ((basin.left, first), (basin.right, first))
        yield Feature("open", f"reservoir {basin.name or k}, {text}", path=path, course=course, dashed=True)
    for name, face in zip(names_of(scene.face, "face"), scene.face, strict=True):
        size = scene.tank.width, scene.tank.height
        (start, end), (at, _) = face.reach(size), face.across(size)
        heads = " to ".join(f"{head:g}" for head in dict.fromkeys((face.table[0][1], face.table[-1][1])))
        ends = ((start, at), (end, at)) if face.axis == 0 else ((at, start), (at, end))
        yield Feature("open", f"{name}, head {heads} m", path=ends)


def _measured(scene: Scene) -> Iterator[Feature]:
    """Probes and strips whose level is measured."""
    points = [it for it in scene.probe if it.width is None]
    if len(points) > ALONE:
        yield Feature("measures", f"{len(points)} probes", marks=[(it.x, it.y) for it in points])
    for k, it in enumerate(scene.probe):
        if it.width is not None and it.height is not None:
            x, y, w, h = it.x, it.y, 0.5 * it.width, 0.5 * it.height
            corners = ((x - w, y - h), (x + w, y - h), (x + w, y + h), (x - w, y + h))
            yield Feature("measures", f"mean in probe {it.name or k}", area=corners)
        elif len(points) <= ALONE:
            yield Feature("measures", f"probe {it.name or k}", marks=((it.x, it.y),))
    for k, level in enumerate(scene.level):
        path = ((level.x, 0.0), (level.x, scene.tank.height))
        text = f"level {level.name or k}" if len(scene.level) <= ALONE else f"{len(scene.level)} levels" * (k == 0)
        yield Feature("measures", text, path=path, dashed=True)

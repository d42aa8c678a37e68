"""What the picture of a scene before its run labels: sides, gate, what will move and where to, what is measured."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from porescale.common.pictures.initial import Feature, Lens, Points
from porescale.common.schema.names import names_of
from porescale.scene.time_function import Component

if TYPE_CHECKING:
    from porescale.builders.scene import Scene
    from porescale.common.core.types import AnyArray
    from porescale.common.record.model import Snapshot

STOPS = 60
"""Points of a course."""
ALONE = 4
"""More of a kind than these share one label."""


def features_of(scene: Scene) -> list[Feature]:
    """All that is labelled in the picture of a scene."""
    found = [*_sides(scene), *_gate(scene), *_rectangles(scene), *_discs(scene), *_containers(scene), *_walls(scene)]
    return [*found, *_packing(scene), *_measured(scene)]


def lens_of(scene: Scene, snapshot: Snapshot, spacing: float | None) -> Lens | None:
    """The lens on the grain of median size, or on the cells in the middle; None without a lattice."""
    if spacing is None:
        return None
    grains = snapshot.clouds.get("grains")
    size = f"cells of {_length(spacing)}"
    if grains is None or not len(grains.position):
        middle = 0.5 * scene.domain.width, 0.5 * scene.domain.height
        return Lens(spacing, middle, 0.0, size)
    radius = np.asarray(grains.data["radius"], float)
    k = int(np.argsort(radius)[len(radius) // 2])
    x, y = (float(it) for it in grains.position[k])
    diameter = 2.0 * float(radius[k])
    ratio = scene.grains.hydraulic_radius_ratio if scene.grains else None
    words = f"{diameter / spacing:.3g} cells per diameter, {size}"
    if ratio and ratio != 1.0:
        words = f"{diameter / spacing:.3g} cells per diameter, λ = {ratio:g}"
    return Lens(spacing, (x, y), diameter, words)


def _length(metres: float) -> str:
    """A length with a handy unit."""
    for bound, factor, unit in ((1e-4, 1e6, "µm"), (1e-1, 1e3, "mm"), (1.0, 1e2, "cm")):
        if abs(metres) < bound:
            return f"{metres * factor:.4g} {unit}"
    return f"{metres:.4g} m"


def _sides(scene: Scene) -> Iterator[Feature]:
    """The sides, those that are alike with one label."""
    w, h = scene.domain.width, scene.domain.height
    ends = {"left": ((0, 0), (0, h)), "right": ((w, 0), (w, h)), "bottom": ((0, 0), (w, 0)), "top": ((0, h), (w, h))}
    places = {"right": (w, 0.88 * h), "bottom": (0.8 * w, 0.0), "top": (0.95 * w, h), "left": (0.0, 0.97 * h)}
    alike: dict[str, list[str]] = {}
    for name, side in scene.domain.sides.items():
        alike.setdefault(side.text(), []).append(name)
    for text, names in alike.items():
        at = next(place for name, place in places.items() if name in names)
        for name in names:
            side = scene.domain.side(name)
            label = f"{', '.join(names)}: {text}" if name == names[0] else ""
            kind = "open" if side.open else "side"
            yield Feature(kind, label, path=ends[name], dashed=side.boundary.periodic, at=at)


def _gate(scene: Scene) -> Iterator[Feature]:
    gate, h = scene.gate, scene.domain.height
    if gate is None:
        return
    how = "vanishes" if gate.lift_speed is None else f"rises at {gate.lift_speed:g} m/s"
    course = () if gate.lift_speed is None else ((gate.x, 0.45 * h), (gate.x, 0.75 * h))
    yield Feature("moves", f"gate, {how} at {gate.opens_at:g} s", path=((gate.x, 0.0), (gate.x, h)), course=course)


def _course(scene: Scene, start: tuple[float, float], way: Callable[[float], Sequence[float]]) -> Points:
    """Points that something at ``start`` passes until the end, as far as they are within the box."""
    w, h = scene.domain.width, scene.domain.height
    points: list[tuple[float, float]] = []
    for time in np.linspace(0.0, scene.time.end, STOPS):
        x, y = (start[0] + way(float(time))[0], start[1] + way(float(time))[1])
        if points and not (0.0 <= x <= w and 0.0 <= y <= h):
            break
        points.append((x, y))
    return points if len(points) > 1 and max(math.dist(points[0], it) for it in points) > 0.0 else []


def _rectangles(scene: Scene) -> Iterator[Feature]:
    """Solid rectangles; those that move with their course."""
    w, h = scene.domain.width, scene.domain.height
    fixed: list[Points] = []
    for k, it in enumerate(scene.rectangle):
        (x0, y0), (x1, y1) = it.lower, it.upper
        x0, x1, y0, y1 = max(x0, 0.0), min(x1, w), max(y0, 0.0), min(y1, h)
        corners = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        if it.fastest == 0.0:
            fixed.append(corners)
            continue
        course = _course(scene, (0.5 * (x0 + x1), 0.5 * (y0 + y1)), it.travelled)
        when = f" from {it.starts_at:g} s" if it.starts_at else ""
        label = f"rectangle {k} moves at ({it.velocity[0]:g}, {it.velocity[1]:g}) m/s{when}"
        yield Feature("moves", label, area=corners, course=course)
    for k, edges in enumerate(fixed):
        many = f"{len(fixed)} fixed rectangles" if len(fixed) > 1 else "fixed rectangle"
        yield Feature("side", many if k == 0 else "", area=edges)


def _discs(scene: Scene) -> Iterator[Feature]:
    """Held discs; those that move with their course."""
    still = 0
    for k, it in enumerate(scene.disc):
        if it.fastest == 0.0:
            still += 1
            continue
        course = _course(scene, (it.x, it.y), lambda time, it=it: it.travelled(time)[:2])  # type: ignore[misc]
        turns = "" if course else ", turns"
        yield Feature(
            "moves", f"disc {k}, {_length(it.diameter)} across, driven{turns}", marks=((it.x, it.y),), course=course
        )
    if still:
        at = next(it for it in scene.disc if it.fastest == 0.0)
        text = f"held disc, {_length(at.diameter)} across" if still == 1 else f"{still} held discs"
        yield Feature("side", text, marks=((at.x, at.y),))
    if scene.ring is not None:
        angle = np.linspace(0.0, 2.0 * np.pi, 2 * STOPS)
        ring, r = scene.ring, 0.5 * scene.ring.diameter
        path = [(ring.x + r * math.cos(it), ring.y + r * math.sin(it)) for it in angle.tolist()]
        spin = f", turns at {ring.spin:g} rad/s" if ring.spin else ""
        yield Feature("moves" if ring.spin else "side", f"ring, {_length(ring.diameter)} across{spin}", path=path)


def _shift(component: Component, time: float) -> float:
    """How far a component has gone, m or rad; 0 where it is free or pushed."""
    if component.velocity is not None:
        return component.velocity.integral(time)
    if component.displacement is not None:
        return component.displacement.value(time) - component.displacement.value(0.0)
    return 0.0


def _containers(scene: Scene) -> Iterator[Feature]:
    """Containers, and the course of the end of one that moves."""
    for name, it in zip(names_of(scene.container, "container"), scene.container, strict=True):
        points = np.array(it.chain or [(line[0], line[1]) for line in it.ends], float)
        pivot = np.array(it.pivot or points.mean(axis=0))
        if max(part.fastest for part in (it.x, it.y, it.rotation)) == 0.0:
            yield Feature("side", name, marks=(tuple(points[0]),))
            continue
        far = points[int(np.hypot(*(points - pivot).T).argmax())]

        def way(time: float, it: Any = it, arm: AnyArray = far - pivot) -> Any:
            """How far its end has come."""
            angle = _shift(it.rotation, time)
            c, s = math.cos(angle), math.sin(angle)
            turned = np.array([c * arm[0] - s * arm[1], s * arm[0] + c * arm[1]])
            return turned - arm + np.array([_shift(it.x, time), _shift(it.y, time)])

        yield Feature("moves", f"{name}, driven", course=_course(scene, (float(far[0]), float(far[1])), way),
                      marks=(tuple(far),))  # fmt: skip
    for control in scene.control:
        kind, number = control.of
        place = next((body.at[number] for body in scene.clump if kind == "clump" and number < len(body.at)), None)
        if place is not None:
            yield Feature("moves", f"{control.called}, controlled", marks=(place,))


def _walls(scene: Scene) -> Iterator[Feature]:
    """Free walls, where they cross the box."""
    reach = math.hypot(scene.domain.width, scene.domain.height)
    for name, it in zip(names_of(scene.wall, "wall"), scene.wall, strict=True):
        length = math.hypot(*it.normal)
        along = np.array([-it.normal[1], it.normal[0]]) / length
        ends = [np.clip(np.array([it.x, it.y]) + sign * reach * along, 0.0, (scene.domain.width, scene.domain.height))
                for sign in (-1, 1)]  # fmt: skip
        pressed = "under stress" if it.stress else "under force" if it.force else "moves" if it.moves else "stands"
        kind = "side" if pressed == "stands" else "moves"
        yield Feature(kind, f"{name}, {pressed}", path=[(float(x), float(y)) for x, y in ends])


def _packing(scene: Scene) -> Iterator[Feature]:
    """Where grains are packed."""
    packing = scene.grains.packing if scene.grains else None
    box = tuple(getattr(packing, name, None) for name in ("left", "bottom", "width", "height"))
    if packing is None or any(it is None for it in box):
        return
    left, bottom, width, height = (float(it) for it in box if it is not None)
    corners = ((left, bottom), (left + width, bottom), (left + width, bottom + height), (left, bottom + height))
    label, at = f"packing, {_length(width)} wide, {_length(height)} high", (left + 0.35 * width, bottom + height)
    yield Feature("side", label, path=(*corners, corners[0]), dashed=True, at=at)


def _measured(scene: Scene) -> Iterator[Feature]:
    """Probes, lines, fluxes, regions; many probes with one label."""
    points = [it for it in scene.probe if it.corners is None]
    if len(points) > ALONE:
        yield Feature("measures", f"{len(points)} probes", marks=[(it.x, it.y) for it in points])
    for k, it in enumerate(scene.probe):
        if it.corners is not None:
            yield Feature("measures", f"mean in probe {it.name or k}", area=_box(*it.corners))
        elif len(points) <= ALONE:
            yield Feature("measures", f"probe {it.name or k}", marks=((it.x, it.y),))
    for word, sections in (("line", scene.line), ("flux", scene.flux)):
        for k, section in enumerate(sections):
            name = section.name if section.name and not section.name.isdigit() else str(section.name or k)
            label = f"{word} {name}" if len(sections) <= ALONE else f"{len(sections)} sections [[{word}]]" * (k == 0)
            yield Feature("measures", label, path=(section.start, section.end), dashed=word == "flux")
    for k, region in enumerate(scene.region):
        yield Feature("measures", f"region {region.name or k}", area=_box(region.lower, region.upper))


def _box(lower: tuple[float, float], upper: tuple[float, float]) -> Points:
    return (lower, (upper[0], lower[1]), upper, (lower[0], upper[1]))

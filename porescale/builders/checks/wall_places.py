"""What stands across free walls, walls that may hammer on their grains rather than hold a load, and a gate that stays
shut."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from porescale.common.core.errors import Fault
from porescale.dem.contact.law import ContactLaw
from porescale.scene.scene import Scene
from porescale.scene.servo import Pressed


def across_walls(
    scene: Scene, x: np.ndarray[Any, Any], r: np.ndarray[Any, Any], names: list[str], touch: float
) -> list[Fault]:
    """The first of what is placed, x (n, 2) m, r (n,) m, that stands across each free wall; packings by corners."""
    faults = []
    packing = scene.grains.packing if scene.grains else None
    for k, it in enumerate(scene.wall):
        normal = np.array(it.normal) / math.hypot(*it.normal)
        apart = (x - np.array([it.x, it.y])) @ normal
        behind = apart < r * (1 - 2 * touch)  # as deep as in another of its size: a share of the diameter
        if behind.any():
            i = int(behind.argmax())
            where = f"({x[i, 0]:g}, {x[i, 1]:g})"
            problem = f"stands across or behind wall[{k}] by {float(r[i] - apart[i]):.3g} m"
            faults.append(Fault(names[i], where, problem, "m", repair="move one of them"))
        if packing:
            ends = (packing.left, packing.left + packing.width), (packing.bottom, packing.bottom + packing.height)
            corners = np.array([(a, b) for a in ends[0] for b in ends[1]])
            deepest = float(((corners - np.array([it.x, it.y])) @ normal).min())
            if deepest < -1e-9 * scene.domain.width:
                problem = f"reaches {-deepest:.3g} m behind wall[{k}]"
                faults.append(Fault("grains.packing", None, problem, "m", repair="move one of them"))
    return faults


HAMMERS, HOLDS = 30.0, 10.0
"""Force of a grain that is hit at the wall's largest speed, over its share of the load, above which a wall that has
left its grains throws them back and loses them again, and at which it holds.

Under a lid on ten discs in a row (stiffness 1e3 N/m, restitution 0.9, 20 s of 0.9 Hz) the load in the second half of a
run is 0.96 to 1.04 of what is wanted at 10, 0.86 to 1.12 at 28, 0.5 to 3.1 at 56, 0.3 to 5.1 at 84; at 280 it stops.
"""


def hammering(scene: Scene, mass: float, diameter: float, law: ContactLaw) -> list[str]:
    """A warning for each wall under a stress or force whose ``fastest`` is too large for its load.

    mass (kg/m), diameter (m) : of the mean grain;  law : of a grain and a wall.  A blow of the speed V that is stopped
    within the depth d has the force m V²/d, V sqrt(k m) of a linear spring.
    """
    found = []
    for key, it, load in _loads(scene, diameter):
        if it.fastest is None or not load > 0.0:
            continue
        blow = mass * it.fastest**2 / law.impact(mass, diameter / 2, it.fastest)[0]
        if blow > HAMMERS * load:
            slower = HOLDS * load / blow * it.fastest
            found.append(
                f"{key}.fastest = {it.fastest:.3g} m/s: a grain that the wall hits so fast pushes back with {blow:.3g}"
                f" N/m, {blow / load:.2g} times its share of the load, {load:.3g} N/m: a wall that has left its grains"
                f" may hammer on them rather than hold its load; {_rounded(slower)} m/s holds it"
            )
    return found


def _rounded(value: float) -> str:
    """Two digits, not above the value."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return f"{math.floor(value / unit) * unit:.2g}"


def _loads(scene: Scene, diameter: float) -> Iterator[tuple[str, Pressed, float]]:
    """Walls under a load: key, section, largest load of one of the grains that find room along it, N/m; of a free wall
    under a force, which has no length, all of it."""
    d = scene.domain
    for name, side in d.sides.items():
        width = d.width if name in ("bottom", "top") else d.height
        room = max(1, int(width / diameter))
        if side.stress is not None:
            yield f"domain.{name}", side, side.stress.largest * width / room
        elif side.force is not None:
            yield f"domain.{name}", side, side.force.largest / room
    for k, wall in enumerate(scene.wall):
        if wall.stress is not None and wall.length:
            yield f"wall[{k}]", wall, wall.stress.largest * wall.length / max(1, int(wall.length / diameter))
        elif wall.force is not None:
            yield f"wall[{k}]", wall, wall.force.largest


def stays_shut(scene: Scene, diameter: float) -> list[str]:
    """Warnings of rectangles that have not begun to move when the run ends, and of a gate that has not risen by a mean
    grain's ``diameter`` (m; 0: there are none)."""
    gate, end = scene.gate, scene.time.end
    still = [
        f"rectangle[{k}].starts_at = {it.starts_at:g} s: the run ends before, at {end:g} s, and it stands still"
        for k, it in enumerate(scene.rectangle)
        if it.fastest and it.starts_at >= end
    ]
    if gate is None:
        return still
    if gate.opens_at >= end:
        return [
            *still,
            f"gate.opens_at = {gate.opens_at:g} s: the run ends before, at {end:g} s, and the gate stays shut",
        ]
    rise = math.inf if gate.lift_speed is None else gate.lift_speed * (end - gate.opens_at)
    if rise >= diameter:
        return still
    return [
        *still,
        f"gate.lift_speed = {gate.lift_speed:g} m/s: at the end of the run, at {end:g} s, it has risen by {rise:.2g} m,"
        f" less than a grain of {diameter:.2g} m, and lets none pass",
    ]

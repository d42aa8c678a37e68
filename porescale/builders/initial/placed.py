"""Free bodies placed by hand: grains, and the discs of clumps, with their numbers."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.builders.initial.packing import radii_of
from porescale.builders.initial.random_polygons import copies_of
from porescale.scene.bodies.clump import Clump
from porescale.scene.bodies.control import Controlled
from porescale.scene.bodies.disc import Disc
from porescale.scene.grains import Grain
from porescale.scene.scene import Scene


@dataclass(frozen=True)
class Member:
    """One disc of a clump, where it is; fields as of a grain placed by hand."""

    x: float
    y: float
    diameter: float
    velocity: tuple[float, float]
    spin: float
    material: str


def members(clumps: Sequence[Clump]) -> list[list[Member]]:
    """The discs of every clump, copy by copy."""
    return [
        [Member(*it.turned(copy, disc[:2]), 2 * disc[2], it.velocity, it.spin, it.material) for disc in it.discs]
        for it in clumps
        for copy in range(len(it.at))
    ]


def by_hand(scene: Scene) -> list[Grain | Member]:
    """All that is placed by hand and free: grains, then the discs of clumps."""
    grains = scene.grains.grain if scene.grains else ()
    return [*grains, *(disc for body in members(scene.clump) for disc in body)]


def packed_count(scene: Scene) -> int:
    """Number of discs of the packing; an estimate by their mean area where sizes are drawn as they are placed."""
    packing = scene.grains.packing if scene.grains else None
    if packing is None or (scene.rock and scene.rock.polygons):
        return 0
    radii = radii_of(packing)
    if radii is not None:
        return len(radii)
    area = math.pi / 4 * packing.diameter**2 * (1 + packing.size_spread**2 / 3)
    return max(1, round(packing.packing_fraction * packing.width * packing.height / area))


def controls_by_hand(scene: Scene) -> list[Controlled | None]:
    """The control of each of ``by_hand``, that of its clump for a member; None without one."""
    given = {it.of: it for it in scene.control}
    before, count = packed_count(scene), len(scene.grains.grain) if scene.grains else 0
    found = [given.get(("grain", before + k)) for k in range(count)]
    return found + [given.get(("clump", k)) for k, body in enumerate(members(scene.clump)) for _ in body]


def hand_names(scene: Scene) -> tuple[list[str], list[int]]:
    """Key of the section of each of ``by_hand``, and the number of its clump, -1 for none."""
    count = len(scene.grains.grain) if scene.grains else 0
    names, groups, number = [f"grains.grain[{k}]" for k in range(count)], [-1] * count, 0
    for k, it in enumerate(scene.clump):
        for _ in it.at:
            names += [f"clump[{k}]"] * len(it.discs)
            groups += [number] * len(it.discs)
            number += 1
    return names, groups


def counted(scene: Scene, kind: str) -> int:
    """How many clumps, bodies of segments or polygons a scene has."""
    if kind == "clump":
        return sum(len(it.at) for it in scene.clump)
    return sum(len(copies_of(it)) for it in (scene.segment if kind == "segment" else scene.polygon))


def placed(scene: Scene) -> tuple[list[str], NDArray[np.float64], NDArray[np.float64]]:
    """Keys, centres (n, 2) m and radii (n,) m of what is placed by hand: grains, clumps, then discs that are held."""
    names = hand_names(scene)[0] + [f"disc[{k}]" for k in range(len(scene.disc))]
    bodies: list[Grain | Member | Disc] = [*by_hand(scene), *scene.disc]
    x = np.array([(it.x, it.y) for it in bodies]).reshape(-1, 2)
    return names, x, np.array([it.diameter / 2 for it in bodies])

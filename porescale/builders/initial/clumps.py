"""Clumps of discs: bound among the grains, and what they answer like."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from porescale.builders.initial.contact_laws import MaterialPlan
from porescale.builders.initial.frames import Placed, bind_frames
from porescale.builders.initial.placed import members
from porescale.common.core.errors import Fault
from porescale.coupling.displaced import inside_of, undisplaced
from porescale.dem.bodies.clumps import Body
from porescale.dem.bodies.union import outline
from porescale.dem.contact.law import ContactLaw
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.scene.bodies.clump import Clump
from porescale.scene.scene import Scene


def least_density(plan: MaterialPlan, clumps: Iterable[Clump]) -> float:
    """Density (kg/m^3) of the lightest grain or clump of a scene with grains, of what it displaces."""
    found = plan.densities
    for it in clumps:
        discs = np.array(it.discs)
        area = outline(discs[:, :2], discs[:, 2]).area
        found.append(it.mass / area if it.mass else it.density or plan.density(it.material))
    return min(found)


def lightest(clumps: Iterable[Clump], plan: MaterialPlan, every: list[ContactLaw]) -> float:
    """Mass (kg/m) of the disc that answers as fast as the fastest clump , at least one.

    Raises InputError at a clump that no rigid body can be.
    """
    first = [replace_at(it) for it in clumps]
    discs = [disc for it in first for disc in it.discs]
    made = make_discs([disc[:2] for disc in discs], np.array([disc[2] for disc in discs]), 1.0)
    box = Box((-1.0, -1.0), (1.0, 1.0), *["open"] * 4)
    grains = Grains(made, every[0], box)
    ends = np.cumsum([0, *(len(it.discs) for it in first)])
    grains.steering.bind(*_bodies(first, [np.arange(*ends[k : k + 2]) for k in range(len(first))], plan))
    return grains.steering.lightest(every)


def undisplaced_clumps(clumps: Iterable[Clump], ratio: float) -> list[Fault]:
    """Faults of clumps whose discs, with ``ratio`` of their radii, have no shares of the fluid that they displace."""
    bodies = [np.array(it.discs) for it in clumps]
    return [undisplaced(k) for k, it in enumerate(bodies) if inside_of(it[:, :2], ratio * it[:, 2]) is None]


def replace_at(clump: Clump) -> Clump:
    """``clump`` as one body at the origin."""
    return clump.model_copy(update={"at": ((0.0, 0.0),), "angle": ()})


def _bodies(
    clumps: Iterable[Clump], numbers: list[Any], plan: MaterialPlan
) -> tuple[list[Any], list[float], list[Any]]:
    """Disc numbers, density (kg/m^3) and mass by hand of the copies of ``clumps``."""
    copies = [(it, copy) for it in clumps for copy in range(len(it.at))]
    density = [it.density or plan.density(it.material) for it, _ in copies]
    return numbers, density, [_body(it, copy) for it, copy in copies]


def add_clumps(scene: Scene, grains: Grains, placed: Sequence[Placed] = ()) -> None:
    """Bind the discs of clumps, which come after all other free grains and before those that are held, and frames of
    the corners that come last."""
    plan = MaterialPlan.of(scene)
    sizes = [len(body) for body in members(scene.clump)]
    corners = sum(len(it.frame.corners) for it in placed)
    first = grains.discs.count - corners - len(scene.disc) - sum(sizes)
    ends = first + np.cumsum([0, *sizes])
    clumps = _bodies(scene.clump, [np.arange(*ends[k : k + 2]) for k in range(len(sizes))], plan)
    if placed:
        bind_frames(grains, placed, clumps)
    else:
        grains.steering.bind(*clumps)
    c, d = grains.steering.clumps, grains.discs
    each = [it for it in scene.clump for _ in it.at]
    if each:
        c.velocity[: len(each)], c.spin[: len(each)] = [it.velocity for it in each], [it.spin for it in each]
        c.place(d)


def _body(clump: Clump, copy: int) -> Body | None:
    """What is given by hand, None where it follows from the discs."""
    if clump.mass is None or clump.inertia is None:
        return None
    centre = clump.centroid
    if centre is None:
        discs = np.array(clump.discs)
        x, y = outline(discs[:, :2], discs[:, 2]).centroid
        centre = float(x), float(y)
    return Body(clump.mass, clump.turned(copy, centre), clump.inertia)

"""What discs alone have in fluid: films, soft rims and a ratio of radii.  Said where a scene asks it of other bodies.

Why is in docs/theory/shapes.md.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from porescale.builders.initial.fluid_options import has_soft_rim
from porescale.common.core.errors import Fault
from porescale.coupling.solid.choose import SOLID_OPERATORS

if TYPE_CHECKING:
    from porescale.scene.scene import Scene


def check_beside_polygons(scene: Scene) -> list[Fault]:
    """The faults of films, soft rims and a hydraulic radius beside polygons, which have none of them."""
    faults, grains = [], scene.grains
    if scene.lubrication:
        problem = "has no films between polygons: what the lattice lacks was measured between round surfaces"
        faults.append(Fault("lubrication", None, problem, repair="leave it out, polygon.thickness keeps a gap open"))
    if scene.fluid and has_soft_rim(scene.fluid):
        problem = f"is soft with {scene.fluid.operator!r}" if scene.fluid.rim is None else "softens discs alone"
        problem += ": how far a rim is drawn in follows the radius, which a polygon has not"
        faults.append(Fault("fluid.rim", scene.fluid.rim, problem, "", "'sharp'"))
    if grains and (grains.hydraulic_radius_ratio or 1.0) < 1.0 and not free_discs(scene):
        problem = "is of discs: the fluid sees a polygon's outline, without the thickness of its sides"
        repair = "choose polygon.thickness: in the fluid sides that touch stand two of them apart"
        key = "grains.hydraulic_radius_ratio"
        faults.append(Fault(key, grains.hydraulic_radius_ratio, problem, "", "1", repair))
    return faults


def left_out(scene: Scene) -> list[str]:
    """Warnings of what a scene in fluid asks and only some of its bodies, or operators, have."""
    assert scene.fluid
    found = []
    ratio = (scene.grains.hydraulic_radius_ratio or 1.0) if scene.grains else 1.0
    if scene.polygon and ratio < 1.0:
        found.append(
            f"grains.hydraulic_radius_ratio = {ratio:g} is of the discs alone: the fluid sees polygons at their"
            " outline; polygon.thickness keeps a gap between them open"
        )
    sliding = [f"domain.{name}" for name, side in scene.domain.sides.items() if side.speed]
    if scene.contact and sliding:
        found.append(f"the speed of {', '.join(sliding)} is felt by the fluid alone: grains do not feel it move")
    bodies = {"[[rectangle]]": scene.rectangle, "[gate]": scene.gate, "[ring]": scene.ring}
    without = [name for name, it in bodies.items() if it]
    without += [f"domain.{name} ({side.kind})" for name, side in scene.domain.sides.items() if side.boundary.mirrors]
    if scene.lubrication and without:
        found.append(
            f"[lubrication] adds no film at {' and '.join(without)}: it was measured between discs and at straight"
            " walls without an end; the lattice alone bears what is there, too little below three cells"
        )
    others = {"polygon": scene.polygon, "rectangle": scene.rectangle, "ring": scene.ring}
    beside = [f"[[{name}]]" if name != "ring" else "[ring]" for name, it in others.items() if it]
    if scene.permeability and beside:
        found.append(
            f"[permeability] is that of the discs in its window: {' and '.join(beside)} are left out; where they stand"
            " in it the bed lets less through than permeability.csv says"
        )
    if scene.fluid.rim == "soft" and not (free_discs(scene) or scene.disc):
        found.append("fluid.rim = 'soft' is not used: rims of discs are softened, by their radius, and there are none")
    operator = scene.fluid.solid_operator
    if scene.lubrication and not SOLID_OPERATORS[operator].films:
        able = " or ".join(repr(name) for name, it in SOLID_OPERATORS.items() if it.films)
        found.append(
            f"[lubrication] was measured with fluid.solid_operator = {able}: with {operator!r} the forces of films"
            " may be a third off"
        )
    return found


def free_discs(scene: Scene) -> bool:
    """Whether there are discs that are not held, those of clumps among them."""
    grains = scene.grains
    return grains is not None and bool(grains.packing or grains.grain or grains.circles or scene.clump)

"""Sections that need others, keys without effect for want of them, and what must lie in the box."""

import math

from porescale.builders.checks.combinations import (
    check_bonds,
    check_cell,
    check_frame_sections,
    check_names,
    check_rock,
    check_sleep,
    check_walls,
)
from porescale.builders.checks.contact import check_contact
from porescale.builders.checks.discs_alone import free_discs
from porescale.builders.checks.held_places import check_ring
from porescale.builders.initial.placed import by_hand
from porescale.common.core.constants import EDGE
from porescale.common.core.errors import Fault
from porescale.scene.scene import Scene


def check_needed(scene: Scene) -> list[Fault]:
    """Sections that others need, or that need others."""
    faults = []
    if scene.fluid is None and scene.grains is None:
        faults.append(Fault("fluid, grains", None, "nothing to simulate", repair="add [fluid], [grains] or both"))
    if scene.grains is not None and scene.contact is None:
        repair = "add [contact] with stiffness and restitution"
        faults.append(Fault("contact", None, "grains need a contact law", repair=repair))
    if scene.grains is None and scene.contact is not None:
        faults.append(Fault("contact", None, "there are no grains to touch", repair="add [grains] or remove [contact]"))
    if scene.fluid and scene.grains and scene.grains.hydraulic_radius_ratio is None:
        faults.append(
            Fault("grains.hydraulic_radius_ratio", None, "every scene with grains in fluid states it",
                  allowed=">= 0.01 and <= 1",
                  repair="0.8 opens the pores of a dense bed; 1 seals a bed at rest, since pores in two "
                         "dimensions do not connect; 1 is right for single grains")
        )  # fmt: skip
    faults += _check_look(scene)
    if scene.fluid is None:
        given = {"probe": scene.probe, "line": scene.line, "flux": scene.flux, "loads": scene.loads,
                 "permeability": scene.permeability, "output.fields": scene.output.fields}  # fmt: skip
        faults += [Fault(name, None, "there is no fluid to measure", repair="add [fluid] or leave it out")
                   for name, section in given.items() if section]  # fmt: skip
    if scene.grains is None:
        measured = {"region": scene.region, "coarse_graining": scene.coarse_graining,
                 "output.contacts": scene.output.contacts, "output.forces": scene.output.forces,
                 "output.energy": scene.output.energy}  # fmt: skip
        faults += [Fault(name, None, "there are no grains to measure", repair="add [grains] or leave it out")
                   for name, section in measured.items() if section]  # fmt: skip
    if scene.grains and scene.grains.packing is None and not (by_hand(scene) or scene.segment or scene.polygon):
        faults.append(Fault("grains", None, "holds no grain", repair="add [grains.packing] or [[grains.grain]]"))
    of_grains = {"material": scene.material, "clump": scene.clump, "control": scene.control}
    if scene.grains is None:
        faults += [Fault(name, None, "there are no grains", repair="add [grains] or leave it out")
                   for name, section in of_grains.items() if section]  # fmt: skip
    if scene.grains and scene.contact:
        faults += check_contact(scene)
    faults += [
        *check_names(scene),
        *check_walls(scene),
        *check_cell(scene),
        *check_frame_sections(scene),
        *check_bonds(scene),
        *check_rock(scene),
    ]
    faults += check_sleep(scene)
    if scene.lubrication and not (scene.fluid and (scene.grains or scene.disc)):
        faults.append(Fault("lubrication", None, "there are no grains in fluid", repair="leave it out"))
    if scene.permeability and scene.fluid and not (free_discs(scene) or scene.disc):
        problem = "there is no bed of discs" if scene.polygon else "there is no bed"
        faults.append(Fault("permeability", None, problem, repair="add [grains] or [[disc]]"))
    if scene.permeability and scene.permeability.wanted is not None and scene.grains is None:
        problem = "is of grains, whose hydraulic_radius_ratio may differ; held discs have their full size"
        faults.append(Fault("permeability.wanted", scene.permeability.wanted, problem, repair="leave it out"))
    packing = scene.grains.packing if scene.grains else None
    if scene.permeability and (scene.grains or scene.disc) and packing is None and scene.permeability.window is None:
        repair = "add [permeability.window] with left, bottom, width, height"
        faults.append(Fault("permeability.window", None, "is needed where there is no packing", repair=repair))
    return faults + check_ring(scene)


def without_effect(scene: Scene) -> list[str]:
    """Warnings of keys that change nothing: friction where there are no grains, the radius that a fluid sees where
    there is none, the ramp of a rectangle that stands, a control that neither prescribes nor records."""
    given = {"gate": scene.gate.friction if scene.gate else 0.0}
    given |= {f"rectangle[{k}]": it.friction or 0.0 for k, it in enumerate(scene.rectangle)}
    made = []
    if scene.grains is None:
        made += [f"{key}.friction = {value:g} has no effect: there are no grains; leave it out"
                 for key, value in given.items() if value]  # fmt: skip
    elif not scene.fluid and not scene.homogenise and (ratio := scene.grains.hydraulic_radius_ratio) is not None:
        made.append(f"grains.hydraulic_radius_ratio = {ratio:g} has no effect: there is no fluid; leave it out")
    made += [f"rectangle[{k}].ramp = {it.ramp:g} s has no effect: its velocity is 0; leave it out"
             for k, it in enumerate(scene.rectangle) if it.ramp and not any(it.velocity)]  # fmt: skip
    return made + [
        f"control[{k}] has no effect: x, y and rotation are free, and nothing is recorded; prescribe one of them,"
        " or give record = true"
        for k, it in enumerate(scene.control)
        if not it.record and it.x.free and it.y.free and it.rotation.free
    ]


def in_solids(scene: Scene) -> list[str]:
    """Warnings of points of [[probe]] and [[flux]] that a solid covers for the whole run: the pressure there is no
    number, and no fluid passes.  Points on its surface are none."""
    if scene.fluid is None:
        return []
    discs = [(f"disc[{n}]", (it.x, it.y), 0.5 * it.diameter * (1 - EDGE)) for n, it in enumerate(scene.disc)
             if not it.timed and not any(it.velocity)]  # fmt: skip
    boxes = [(f"rectangle[{n}]", it.lower, it.upper) for n, it in enumerate(scene.rectangle) if not any(it.velocity)]

    def solid(*points: tuple[float, float]) -> str | None:
        """The first solid that covers all ``points``: both kinds are convex, so it covers what lies between."""
        around = [name for name, at, radius in discs if all(math.dist(at, it) < radius for it in points)]
        around += [name for name, (left, bottom), (right, top) in boxes
                   if all(left < x < right and bottom < y < top for x, y in points)]  # fmt: skip
        return around[0] if around else None

    probes = [solid(*(it.corners or [(it.x, it.y)])) for it in scene.probe]
    fluxes = [solid(it.start, it.end) for it in scene.flux]
    return [
        f"{key}[{k}] lies in {name}, where no fluid is: {what}; move it out"
        for key, what, found in (("probe", "its pressure is nan", probes), ("flux", "nothing passes", fluxes))
        for k, name in enumerate(found)
        if name
    ]


def _check_look(scene: Scene) -> list[Fault]:
    """Faults of arrays that pictures are to show and snapshots do not hold."""
    if scene.look is None:
        return []
    cells = ("velocity", "pressure", "solid_fraction", *scene.output.fields)
    grains: tuple[str, ...] = ("radius", "angle", "velocity", "spin") if scene.grains or scene.disc else ()
    grains += ("hydraulic_radius",) if scene.fluid and grains else ()
    grains += ("body", "kind", "driven") if scene.segment or scene.polygon or scene.container or scene.rock else ()
    averaged = tuple(scene.coarse_graining.fields) if scene.coarse_graining else ()  # and "stress_xx" of "stress"
    field, colour, faults = scene.look.field, scene.look.colour, []
    if scene.fluid and field and field not in cells:
        repair = "choose one of these, or record it with output.fields"
        faults.append(Fault("look.field", field, "is not recorded", "", ", ".join(cells), repair))
    if not scene.fluid and field and field not in grains and not field.startswith(averaged):
        allowed = ", ".join(dict.fromkeys((*grains, *averaged)))
        faults.append(Fault("look.field", field, "is not recorded", "", allowed, "choose one of these, or add [fluid]"))
    if colour and colour not in grains:
        allowed = ", ".join(grains) or "none: there are no grains"
        faults.append(Fault("look.colour", colour, "is not recorded", "", allowed, "choose one of these"))
    return faults


def check_places(scene: Scene) -> list[Fault]:
    """What must lie in the box, and numbers of bodies that must exist."""
    box = scene.domain.width, scene.domain.height
    points = [(f"probe[{k}]", at) for k, it in enumerate(scene.probe) for at in it.corners or [(it.x, it.y)]]
    for name, sections in (("line", scene.line), ("flux", scene.flux)):
        points += [(f"{name}[{k}].{end}", getattr(it, end)) for k, it in enumerate(sections)
                   for end in ("start", "end")]  # fmt: skip
    for k, region in enumerate(scene.region):
        corners = ("lower", region.lower), ("upper", region.upper)
        points += [(f"region[{k}].{end}", at) for end, at in corners if not any(scene.domain.periodic)]
    if scene.look and scene.look.view:
        left, right, bottom, top = scene.look.view
        points += [("look.view", (left, bottom)), ("look.view", (right, top))]
    if scene.permeability and (window := scene.permeability.window):
        points.append(("permeability.window", (window.left, window.bottom)))
        points.append(("permeability.window", (window.left + window.width, window.bottom + window.height)))
    faults = [
        Fault(key, f"({at[0]:g}, {at[1]:g})", "is outside the box", "m", repair="move it inside")
        for key, at in points
        if not all(-EDGE * size <= value <= (1 + EDGE) * size for value, size in zip(at, box, strict=True))
    ]
    if scene.gate is not None and not scene.gate.x < scene.domain.width:
        faults.append(
            Fault("gate.x", scene.gate.x, "is outside the box", "m", f"< {scene.domain.width:g}", "move it inside")
        )
    for number in scene.loads.discs if scene.loads else ():
        if not 0 <= number < len(scene.disc):
            allowed = f"0 to {len(scene.disc) - 1}" if scene.disc else "none: there is no [[disc]]"
            faults.append(Fault("loads.discs", number, "there is no such disc", "", allowed))
    if scene.loads and scene.loads.ring and scene.ring is None:
        faults.append(Fault("loads.ring", True, "there is no [ring]", repair="add it, or leave this out"))
    for number in scene.loads.rectangles if scene.loads else ():
        if not 0 <= number < len(scene.rectangle):
            allowed = f"0 to {len(scene.rectangle) - 1}" if scene.rectangle else "none: there is no [[rectangle]]"
            faults.append(Fault("loads.rectangles", number, "there is no such rectangle", "", allowed))
    return faults

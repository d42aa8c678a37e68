"""Contact laws: every number belongs to its law, nothing is missing, and what has no effect is said."""

import math

from porescale.builders.initial.contact_laws import law_class, merged
from porescale.common.core.errors import Fault
from porescale.dem.contact.choose import LAWS
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.materials import MOST
from porescale.scene.contact import DAMPED, Contact, Pair, Touch
from porescale.scene.scene import Scene

STEEP, RIGHT = 5.0, 90.0
"""Coefficients of friction between these are taken for angles in degrees: 5 is that of a slope of 79 degrees."""
SLIDING = "friction", "tangential_stiffness", "tangential_damping"
ROLLING = "rolling_friction", "rolling_stiffness", "rolling_damping"


def check_contact(scene: Scene) -> list[Fault]:
    """What is wrong with the laws of a scene that has [contact]."""
    contact = scene.contact
    assert contact
    faults = []
    for k, material in enumerate(scene.material):
        if material.name in (it.name for it in scene.material[:k]):
            faults.append(Fault(f"material[{k}].name", material.name, "is taken", repair="give each its own"))
    if len(scene.material) > MOST:
        faults.append(Fault("material", len(scene.material), "are too many", allowed=f"<= {MOST}"))
    faults += _check_names(scene, contact)
    sections: list[tuple[str, Touch]] = [("contact", contact)]
    sections += [(f"material[{k}]", it) for k, it in enumerate(scene.material)]
    sections += [(f"contact.pair[{k}]", it) for k, it in enumerate(contact.pair)]
    for key, section in sections:
        faults += _check_kind(key, section, law_class(contact))
    if faults:
        return faults
    of_surfaces = [contact.wall_friction, scene.gate.friction if scene.gate else None]
    of_surfaces += [*(it.friction for it in scene.wall), *(it.friction for it in scene.rectangle)]
    for key, section in sections[1 : 1 + len(scene.material)] or sections[:1]:
        numbers = merged(contact, section)
        most = {"friction": max(numbers.get("friction", 0.0), *(it or 0.0 for it in of_surfaces))}
        faults += _check_complete(key, numbers | most, contact)
    for k, pair in enumerate(contact.pair) if not faults else ():
        faults += _friction_faults(f"contact.pair[{k}]", _between(pair, scene), contact)
    return faults


def _between(pair: Pair, scene: Scene) -> dict[str, float]:
    """The numbers of friction and rolling of a pair: its own, above what two materials have together, where springs are
    in series and friction is the smaller one.  Rolling is left out where the pair says nothing of it."""
    assert scene.contact
    contact, own, names = scene.contact, pair.numbers(), [it.name for it in scene.material]
    one, other = (merged(contact, scene.material[names.index(name)]) for name in pair.materials)
    found = {}
    for key in (*SLIDING, *(ROLLING if any(key in own for key in ROLLING) else ())):
        both = one.get(key, 0.0), other.get(key, 0.0)
        found[key] = own.get(key, max(both) if key.endswith("damping") else min(both))
    return found


def material_doubts(scene: Scene) -> list[str]:
    """Warnings of bodies that name no material where one has to be guessed, and of a grains.density without effect."""
    if not (scene.material and scene.grains):
        return []
    grains, first = scene.grains, scene.material[0]
    named = [(f"grains.grain[{k}]", it.material) for k, it in enumerate(grains.grain)]
    named += [("grains.packing", grains.packing.material)] if grains.packing else []
    named += [(f"clump[{k}]", it.material) for k, it in enumerate(scene.clump)]
    named += [(f"segment[{k}]", it.material) for k, it in enumerate(scene.segment)]
    named += [(f"polygon[{k}]", it.material) for k, it in enumerate(scene.polygon)]
    none = [key for key, name in named if not name]
    other = first.density is not None and first.density != grains.density
    if none and (len(scene.material) > 1 or other):
        shown = ", ".join(none[:3]) + (f" and {len(none) - 3} more" if len(none) > 3 else "")
        heavy = f", of {first.density:g} kg/m^3 instead of grains.density = {grains.density:g}" if other else ""
        return [f"no material is named by {shown}: the first is taken, {first.name!r}{heavy}; name it with material"]
    densities = {it.density for it in scene.material if it.name in dict.fromkeys(name for _, name in named)}
    if densities and None not in densities and grains.density not in densities:
        return [
            f"grains.density = {grains.density:g} kg/m^3 has no effect on masses: every material that is named has a"
            " density of its own; make it one of these"
        ]
    return []


def angles_for_friction(scene: Scene) -> list[str]:
    """Warnings of coefficients of friction that look like angles in degrees: beyond that of any surface, and not as
    large as one that must never slide."""
    contact, gate = scene.contact, scene.gate
    given = {"contact.friction": contact.friction, "contact.wall_friction": contact.wall_friction} if contact else {}
    given |= {f"material[{k}].friction": it.friction for k, it in enumerate(scene.material)}
    given |= {"gate.friction": gate.friction} if gate else {}
    return [
        f"{key} = {value:g} is a coefficient; if an angle of {value:g} degrees is meant, its tangent is"
        f" {math.tan(math.radians(value)):.3g}"
        for key, value in given.items() if value is not None and STEEP < value < RIGHT
    ]  # fmt: skip


def wall_friction_doubts(scene: Scene) -> list[str]:
    """Warnings of bodies that stand or hold grains, which friction at walls passes over."""
    contact = scene.contact
    if not contact or contact.wall_friction is None or contact.wall_friction == contact.friction:
        return []
    kinds = ("disc", scene.disc), ("container", scene.container)
    named = [f"{kind}[{k}]" for kind, found in kinds for k in range(len(found))]
    frames = ("segment", scene.segment), ("polygon", scene.polygon)
    named += [f"{kind}[{k}]" for kind, found in frames for k, it in enumerate(found) if it.held]
    if not named:
        return []
    shown = ", ".join(named[:3]) + (f" and {len(named) - 3} more" if len(named) > 3 else "")
    return [
        f"contact.wall_friction = {contact.wall_friction:g} holds at sides, [[wall]] and [[rectangle]]; at {shown}"
        f" friction is contact.friction = {contact.friction:g}: a [[material]] of their own has another"
    ]


def _check_names(scene: Scene, contact: Contact) -> list[Fault]:
    """Materials that are named must be there."""
    known = [it.name for it in scene.material]
    named = [("contact.wall_material", contact.wall_material)]
    named += [(f"contact.pair[{k}].materials", name) for k, it in enumerate(contact.pair) for name in it.materials]
    named += [(f"disc[{k}].material", it.material) for k, it in enumerate(scene.disc)]
    named += [(f"clump[{k}].material", it.material) for k, it in enumerate(scene.clump)]
    if scene.grains:
        named += [(f"grains.grain[{k}].material", it.material) for k, it in enumerate(scene.grains.grain)]
        if scene.grains.packing:
            named.append(("grains.packing.material", scene.grains.packing.material))
    allowed = ", ".join(known) or "none: there is no [[material]]"
    faults = [Fault(key, name, "no such material", "", allowed) for key, name in named if name and name not in known]
    pairs = [sorted(it.materials) for it in contact.pair]
    for k, pair in enumerate(pairs):
        if pair in pairs[:k]:
            problem = f"is the pair of contact.pair[{pairs.index(pair)}], too"
            faults.append(Fault(f"contact.pair[{k}].materials", ", ".join(pair), problem, repair="put both into one"))
    if known and contact.wall_friction is not None:
        problem = "friction at walls follows from their material"
        repair = "give wall_material, or a [[contact.pair]] with it"
        faults.append(Fault("contact.wall_friction", contact.wall_friction, problem, repair=repair))
    return faults


def _check_kind(key: str, section: Touch, law: type[ContactLaw]) -> list[Fault]:
    """Every number belongs to the law."""
    plain = Contact.model_construct() if isinstance(section, Contact) else None
    faults = []
    for other in LAWS.values():
        for number in other.keys:
            value = None if number in law.keys else getattr(section, number)
            if value is not None and not (plain and value == getattr(plain, number)):
                problem = f'belongs to law = "{other.name}", this is "{law.name}"'
                repair = f'leave it out, or write law = "{other.name}"'
                faults.append(Fault(f"{key}.{number}", value, problem, repair=repair))
    if not law.damping_keys and section.restitution is not None and "restitution" not in law.keys:
        problem, repair = f"{law.name} has its own damping", "leave it out"
        faults.append(Fault(f"{key}.restitution", section.restitution, problem, repair=repair))
    if isinstance(section, Pair):
        for number in {it: None for each in LAWS.values() for it in each.of_materials}:
            if getattr(section, number) is not None:
                problem = "follows from the two materials"
                faults.append(Fault(f"{key}.{number}", getattr(section, number), problem, repair="leave it out"))
        if sum(getattr(section, number) is not None for number in DAMPED) > 1:
            problem = "at most one of the two is needed"
            faults.append(Fault(f"{key}.{', '.join(law.damping_keys)}", None, problem, repair="give one"))
    return faults


def _check_complete(key: str, numbers: dict[str, float], contact: Contact) -> list[Fault]:
    """Faults of a law's numbers: missing ones, and those without effect."""
    law, faults = law_class(contact), []
    needed, unit = law.required
    if needed and needed not in numbers:
        faults.append(Fault(f"{key}.{needed}", None, "is missing", unit, "> 0", "add it"))
    ways = law.damping_keys
    if ways and sum(way in numbers for way in ways) != 1:
        problem, repair = "exactly one of the two is needed", "give one, leave the other out"
        faults.append(Fault(f"{key}.{', '.join(ways)}", None, problem, repair=repair))
    return faults + _friction_faults(key, numbers, contact)


def _friction_faults(key: str, numbers: dict[str, float], contact: Contact) -> list[Fault]:
    """What lacks for friction and rolling to have an effect, or has none."""
    wrong = law_class(contact).friction_problem(numbers)
    return [Fault(f"{key}.{wrong[0]}", None, wrong[1], "", "> 0", wrong[2])] if wrong else []

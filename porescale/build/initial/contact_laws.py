"""Contact laws from [contact], [[material]] and [[contact.pair]]."""

from __future__ import annotations

from porescale.dem.contact.choose import LAWS
from porescale.dem.contact.materials import Law, Materials
from porescale.scene.contact import DAMPED, Contact, Touch
from porescale.scene.scene import Scene


def merged(contact: Contact, own: Touch | None = None) -> dict[str, float]:
    """The numbers of ``own`` over those of ``contact``; whichever way of damping it gives replaces the other."""
    above = contact.numbers()
    over = own.numbers() if own else {}
    if any(key in over for key in DAMPED):
        above = {key: value for key, value in above.items() if key not in DAMPED}
    return {**above, **over}


def law_of(numbers: dict[str, float], contact: Contact, mass: float) -> Law:
    """The law of ``numbers``; a restitution that depends on the mass is that of two grains of ``mass`` (kg/m)."""
    return LAWS[contact.law].from_numbers(numbers, contact.release, mass, contact.deepest)


def density_of(scene: Scene, material: str = "") -> float:
    """Density of a material by name, "" for the first, kg/m^3."""
    assert scene.grains
    for it in scene.material:
        if it.name == (material or scene.material[0].name):
            return scene.grains.density if it.density is None else it.density
    return scene.grains.density


def materials_of(scene: Scene, mass: float) -> Materials | None:
    """The materials of a scene, None where it has none; mass (kg/m): of a mean grain at the density of [grains]."""
    if not (scene.material and scene.contact and scene.grains):
        return None
    contact = scene.contact
    heavy = {it.name: mass * density_of(scene, it.name) / scene.grains.density for it in scene.material}
    laws = {it.name: law_of(merged(contact, it), contact, heavy[it.name]) for it in scene.material}
    mixing, between = Materials(laws), {}
    for pair in contact.pair:
        one, other = pair.materials
        both = heavy[one] * heavy[other] / (heavy[one] + heavy[other])
        between[one, other] = mixing.law(one, other).with_numbers(pair.numbers(), both)
    return Materials(laws, between, contact.wall_material or None)


def laws(scene: Scene, mass: float) -> tuple[Law, Law, list[Law]]:
    """Contact law of the packing, or of the first material, with itself, at walls, and all laws that there are.

    mass (kg/m): of a grain of mean diameter, whose restitution is meant where one is given.
    """
    assert scene.contact
    assert scene.grains
    materials = materials_of(scene, mass)
    if materials:
        packing = scene.grains.packing
        name = (packing.material if packing else "") or materials.names[0]
        return materials.law(name, name), materials.law(materials.wall, name), materials.all()
    contact = scene.contact
    law = law_of(contact.numbers(), contact, mass)
    wall = law.with_friction(contact.friction if contact.wall_friction is None else contact.wall_friction)
    return law, wall, [law, wall]

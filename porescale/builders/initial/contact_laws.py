"""Contact laws from [contact], [[material]] and [[contact.pair]]."""

from dataclasses import dataclass
from typing import Any

from porescale.common.compiled.own import OwnLaw
from porescale.common.compiled.own_kernel import kernel_of
from porescale.dem.contact.choose import LAWS
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.materials import Materials
from porescale.dem.contact.own import own_contact
from porescale.scene.contact import DAMPED, Contact, Material, Touch
from porescale.scene.scene import Scene


def law_class(contact: Contact) -> type[ContactLaw]:
    """The class of the law of [contact]: of the register, or made of a user's function."""
    law = contact.law
    return own_contact(law.reference, kernel_of(law.function), law.keys) if isinstance(law, OwnLaw) else LAWS[law]


def merged(contact: Contact, own: Touch | None = None) -> dict[str, float]:
    """The numbers of ``own`` over those of ``contact``; whichever way of damping it gives replaces the other."""
    above = contact.numbers()
    over = own.numbers() if own else {}
    if any(key in over for key in DAMPED):
        above = {key: value for key, value in above.items() if key not in DAMPED}
    return {**above, **over}


def law_of(numbers: dict[str, float], contact: Contact, mass: float) -> ContactLaw:
    """The law of ``numbers``; a restitution that depends on the mass is that of two grains of ``mass`` (kg/m)."""
    return law_class(contact).from_numbers(numbers, contact.release, mass, contact.deepest)


@dataclass(frozen=True)
class MaterialPlan:
    """Laws and densities of the grains of a scene, by the names of materials; "" is the first.

    density_of_grains : kg/m³, of a material that states none.
    """

    contact: Contact | None
    materials: tuple[Material, ...]
    density_of_grains: float

    @classmethod
    def of(cls, scene: Scene) -> "MaterialPlan":
        """The materials of a scene with [grains]."""
        assert scene.grains
        return cls(scene.contact, scene.material, scene.grains.density)

    @property
    def of_walls(self) -> str:
        """Name of the material of walls and of what is held."""
        return self.contact.wall_material if self.contact else ""

    def density(self, name: str = "") -> float:
        """Density of the material of this name, of the first material without a name, kg/m³."""
        for it in self.materials:
            if it.name == (name or self.materials[0].name):
                return self.density_of_grains if it.density is None else it.density
        return self.density_of_grains

    @property
    def densities(self) -> list[float]:
        """kg/m³, of all materials; that of the grains where there are none."""
        return [self.density(it.name) for it in self.materials] or [self.density_of_grains]

    def number(self, name: str, *, wall: bool = False) -> int:
        """Number of a material, "" for the first, or that of the walls; of one that is not there, 0."""
        names = [it.name for it in self.materials]
        wanted = name or (self.of_walls if wall else "")
        return names.index(wanted) if wanted in names else 0

    def laws(self, mass: float) -> Materials | None:
        """The laws of the materials, None where there are none; mass (kg/m): of a mean grain at the density of
        [grains]."""
        if not (self.materials and self.contact):
            return None
        contact = self.contact
        heavy = {it.name: mass * self.density(it.name) / self.density_of_grains for it in self.materials}
        laws = {it.name: law_of(merged(contact, it), contact, heavy[it.name]) for it in self.materials}
        mixing, between = Materials(laws), {}
        for pair in contact.pair:
            one, other = pair.materials
            both = heavy[one] * heavy[other] / (heavy[one] + heavy[other])
            between[one, other] = mixing.law(one, other).with_numbers(pair.numbers(), both)
        return Materials(laws, between, contact.wall_material or None)

    def law_and_others(self, material: str, mass: float) -> tuple[ContactLaw, ContactLaw, list[ContactLaw]]:
        """Contact law of a material with itself, its law at walls, and all laws that there are.

        mass (kg/m): of a grain of mean diameter, whose restitution is meant where one is given.
        """
        contact = self.contact
        assert contact
        materials = self.laws(mass)
        if materials:
            name = material or materials.names[0]
            return materials.law(name, name), materials.law(materials.wall, name), materials.all()
        law = law_of(contact.numbers(), contact, mass)
        wall = law.with_friction(contact.friction if contact.wall_friction is None else contact.wall_friction)
        return law, wall, [law, wall]


def density_of_packing(scene: Scene) -> float:
    """Density of the grains of the packing, kg/m³; without one that of grains that name no material."""
    assert scene.grains
    packing = scene.grains.packing
    return MaterialPlan.of(scene).density(packing.material if packing else "")


def densities_of_bodies(scene: Scene) -> list[float]:
    """Densities that free bodies have of their own or of the material that they name, kg/m³, ascending."""
    assert scene.grains
    grains, plan = scene.grains, MaterialPlan.of(scene)
    bodies: list[Any] = [
        *grains.grain,
        *scene.clump,
        *scene.segment,
        *scene.polygon,
        *([grains.packing] if grains.packing else []),
    ]
    own = {getattr(it, "density", None) or plan.density(it.material) for it in bodies}
    return sorted(own or {plan.density()})

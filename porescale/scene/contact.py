"""Contact laws as sections: [contact] for all grains, [[material]] for some, [[contact.pair]] for two materials."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.linear import Linear, damping_from_restitution
from porescale.dem.contact.materials import MOST, Law, Materials
from porescale.dem.contact.restitution import ratio_from_restitution

if TYPE_CHECKING:
    from porescale.scene.sections import Scene

FRICTION: Any = {"ge": 0, "le": 1e3}
STIFFNESS: Any = {"ge": 0, "le": 1e15}
DASHPOT: Any = {"ge": 0, "le": 1e12}
RATIO: Any = {"ge": 0, "le": 1e3}

LINEAR = ("stiffness", "damping", "tangential_stiffness", "tangential_damping", "rolling_stiffness", "rolling_damping")
HERTZ = (
    "young", "poisson", "damping_ratio", "tangential_damping_ratio", "rolling_stiffness_ratio", "rolling_damping_ratio",
)  # fmt: skip
BOTH = ("restitution", "friction", "rolling_friction")
DAMPED = ("damping", "damping_ratio", "restitution")
WAYS = {"linear": ("damping", "restitution"), "hertz": ("damping_ratio", "restitution")}
"""Keys of the two laws, and those of which exactly one damps."""


class Touch(Section):
    """Numbers of a contact law, per metre of depth.  Left out: as said above it, in [contact] or by the mixing rule."""

    stiffness: float | None = quantity("N/m", None, ge=1e-6, le=1e15, help="normal stiffness per metre of depth")
    damping: float | None = quantity("N s/m", None, **DASHPOT, help="normal damping per metre of depth")
    restitution: float | None = quantity(
        "", None, ge=1e-3, le=1, help="normal coefficient of restitution, instead of damping"
    )
    tangential_stiffness: float | None = quantity("N/m", None, **STIFFNESS, help="tangential stiffness per metre")
    tangential_damping: float | None = quantity("N s/m", None, **DASHPOT, help="tangential damping per metre of depth")
    friction: float | None = quantity("", None, **FRICTION, help="friction coefficient between grains")
    young: float | None = quantity("Pa", None, ge=1, le=1e15, help="Young's modulus of the grains")
    poisson: float | None = quantity("", None, ge=0, le=0.5, help="Poisson's ratio of the grains")
    damping_ratio: float | None = quantity("", None, **RATIO, help="normal damping ratio, instead of restitution")
    tangential_damping_ratio: float | None = quantity("", None, **RATIO, help="left out: that of the normal")
    rolling_friction: float | None = quantity(
        "", None, **FRICTION, help="largest rolling torque over reduced radius and normal force"
    )
    rolling_stiffness: float | None = quantity("N/m", None, **STIFFNESS, help="rolling stiffness per metre of depth")
    rolling_damping: float | None = quantity("N s/m", None, **DASHPOT, help="rolling damping per metre of depth")
    rolling_stiffness_ratio: float | None = quantity("", None, **RATIO, help="rolling over tangential stiffness")
    rolling_damping_ratio: float | None = quantity("", None, **RATIO, help="left out: that of the normal")

    def numbers(self) -> dict[str, float]:
        """What is given, by key."""
        values = {key: getattr(self, key) for key in (*LINEAR, *HERTZ, *BOTH)}
        return {key: value for key, value in values.items() if value is not None}


class Pair(Touch):
    """The law between two materials: the mixing rule with these numbers in place of its own."""

    materials: tuple[str, str]


class Material(Touch):
    """A material: what it says in place of [contact], and its density in place of that of [grains].

    Between unlike materials stiffnesses are in series, 2 k1 k2/(k1 + k2), the damping ratio is the mean, friction the
    smaller one; like materials have their own law.
    """

    name: str = pydantic.Field(min_length=1, description="name that grains and walls are given")
    density: float | None = quantity("kg/m^3", None, ge=1e-3, le=1e5, help="density (default: that of the grains)")


class Contact(Touch):
    """The law of contacts, per metre of depth; the same between grains and at walls.

    "linear": springs and dashpots;  "hertz": of Hertz and Mindlin, for spheres of the discs' radii, one a metre.
    """

    law: Literal["linear", "hertz"] = "linear"
    tangential_stiffness: float = quantity("N/m", 0.0, **STIFFNESS, help="tangential stiffness per metre of depth")
    tangential_damping: float = quantity("N s/m", 0.0, **DASHPOT, help="tangential damping per metre of depth")
    friction: float = quantity("", 0.0, **FRICTION, help="friction coefficient between grains")
    poisson: float = quantity("", 0.3, ge=0, le=0.5, help="Poisson's ratio of the grains")
    rolling_friction: float = quantity(
        "", 0.0, **FRICTION, help="largest rolling torque over reduced radius and normal force"
    )
    wall_friction: float | None = quantity(
        "", None, **FRICTION, help="friction coefficient at walls (default: that between grains)"
    )
    wall_material: str = pydantic.Field("", description="material of walls and held discs (default: the first)")
    release: Literal["force", "overlap"] = "force"
    step: float | None = quantity(
        "s", None, ge=1e-15, le=1e3, help="contact step (default: from the contact's stability)"
    )
    deepest: float = quantity("", 0.02, gt=0, le=0.3, help='overlap over radius that the step of "hertz" allows for')
    pair: tuple[Pair, ...] = ()


def merged(contact: Contact, own: Touch | None = None) -> dict[str, float]:
    """The numbers of ``own`` over those of ``contact``; whichever way of damping it gives replaces the other."""
    above = contact.numbers()
    over = own.numbers() if own else {}
    if any(key in over for key in DAMPED):
        above = {key: value for key, value in above.items() if key not in DAMPED}
    return {**above, **over}


def judge_contact(scene: Scene) -> list[Fault]:
    """What is wrong with the laws of a scene that has [contact]."""
    contact = scene.contact
    assert contact
    faults = []
    for k, material in enumerate(scene.material):
        if material.name in (it.name for it in scene.material[:k]):
            faults.append(Fault(f"material[{k}].name", material.name, "is taken", repair="give each its own"))
    if len(scene.material) > MOST:
        faults.append(Fault("material", len(scene.material), "are too many", allowed=f"<= {MOST}"))
    faults += _judge_names(scene, contact)
    sections: list[tuple[str, Touch]] = [("contact", contact)]
    sections += [(f"material[{k}]", it) for k, it in enumerate(scene.material)]
    sections += [(f"contact.pair[{k}]", it) for k, it in enumerate(contact.pair)]
    for key, section in sections:
        faults += _judge_kind(key, section, contact.law)
    if faults:
        return faults
    for key, section in sections[1 : 1 + len(scene.material)] or sections[:1]:
        faults += _judge_whole(key, merged(contact, section), contact)
    return faults


def _judge_names(scene: Scene, contact: Contact) -> list[Fault]:
    """Materials that are named must be there."""
    known = [it.name for it in scene.material]
    asked = [("contact.wall_material", contact.wall_material)]
    asked += [(f"contact.pair[{k}].materials", name) for k, it in enumerate(contact.pair) for name in it.materials]
    asked += [(f"disc[{k}].material", it.material) for k, it in enumerate(scene.disc)]
    asked += [(f"clump[{k}].material", it.material) for k, it in enumerate(scene.clump)]
    if scene.grains:
        asked += [(f"grains.grain[{k}].material", it.material) for k, it in enumerate(scene.grains.grain)]
        if scene.grains.packing:
            asked.append(("grains.packing.material", scene.grains.packing.material))
    allowed = ", ".join(known) or "none: there is no [[material]]"
    faults = [Fault(key, name, "no such material", "", allowed) for key, name in asked if name and name not in known]
    if known and contact.wall_friction is not None:
        problem = "friction at walls follows from their material"
        repair = "give wall_material, or a [[contact.pair]] with it"
        faults.append(Fault("contact.wall_friction", contact.wall_friction, problem, repair=repair))
    return faults


def _judge_kind(key: str, section: Touch, law: str) -> list[Fault]:
    """Every number belongs to the law."""
    others, name = (HERTZ, "hertz") if law == "linear" else (LINEAR, "linear")
    plain = Contact.model_construct() if isinstance(section, Contact) else None
    faults = []
    for other in others:
        value = getattr(section, other)
        if value is not None and not (plain and value == getattr(plain, other)):
            problem = f'belongs to law = "{name}", this is "{law}"'
            faults.append(Fault(f"{key}.{other}", value, problem, repair=f'leave it out, or write law = "{name}"'))
    if isinstance(section, Pair):
        for other in ("young", "poisson"):
            if getattr(section, other) is not None:
                problem = "follows from the two materials"
                faults.append(Fault(f"{key}.{other}", getattr(section, other), problem, repair="leave it out"))
        if sum(getattr(section, other) is not None for other in DAMPED) > 1:
            problem = "at most one of the two is needed"
            faults.append(Fault(f"{key}.{', '.join(WAYS[law])}", None, problem, repair="give one"))
    return faults


def _judge_whole(key: str, numbers: dict[str, float], contact: Contact) -> list[Fault]:
    """What a law needs is there, and what it says has an effect."""
    linear = contact.law == "linear"
    faults = []
    needed = "stiffness" if linear else "young"
    if needed not in numbers:
        faults.append(Fault(f"{key}.{needed}", None, "is missing", "N/m" if linear else "Pa", "> 0", "add it"))
    ways = WAYS[contact.law]
    if sum(way in numbers for way in ways) != 1:
        problem, repair = "exactly one of the two is needed", "give one, leave the other out"
        faults.append(Fault(f"{key}.{', '.join(ways)}", None, problem, repair=repair))
    if linear:
        resists = numbers.get("rolling_stiffness", 0.0) + numbers.get("rolling_damping", 0.0) > 0.0
        if resists != (numbers.get("rolling_friction", 0.0) > 0.0):
            one, other = ("rolling_stiffness", "rolling_friction")[:: -1 if resists else 1]
            problem = f"is needed where there is {other}" if not resists else "is needed for rolling resistance"
            faults.append(Fault(f"{key}.{one}", None, problem, "", "> 0", f"give both, or leave {other} out"))
    return faults


def law_of(numbers: dict[str, float], contact: Contact, mass: float) -> Law:
    """The law of ``numbers``; a restitution of the linear one is that of two grains of ``mass`` (kg/m)."""
    get = numbers.get
    rolling = get("rolling_friction", 0.0)
    if contact.law == "linear":
        k = numbers["stiffness"]
        damping = get("damping")
        if damping is None:
            damping = damping_from_restitution(numbers["restitution"], mass / 2, k, contact.release)
        return Linear(
            k, damping, get("tangential_stiffness", 0.0), get("tangential_damping", 0.0), get("friction", 0.0),
            contact.release, rolling, get("rolling_stiffness", 0.0), get("rolling_damping", 0.0),
        )  # fmt: skip
    plain = Hertz.of(numbers["young"], numbers["poisson"], 1.0, get("friction", 0.0), contact.release, rolling)
    ratio = get("damping_ratio")
    if ratio is None:
        ratio = ratio_from_restitution(numbers["restitution"], contact.release)
    return replace(
        plain, damping_ratio=ratio, tangential_damping_ratio=get("tangential_damping_ratio", ratio),
        rolling_stiffness=get("rolling_stiffness_ratio", 1.0),
        rolling_damping_ratio=get("rolling_damping_ratio", ratio), deepest=contact.deepest,
    )  # fmt: skip


RENAMED = {"rolling_stiffness_ratio": "rolling_stiffness"}
"""Keys of sections that the law of Hertz calls otherwise."""


def overridden(law: Law, numbers: dict[str, float], mass: float) -> Law:
    """``law`` with the numbers of a pair; ``mass`` (kg/m): effective, of two grains of mean size."""
    given = {RENAMED.get(key, key): value for key, value in numbers.items() if key != "restitution"}
    restitution = numbers.get("restitution")
    if isinstance(law, Linear):
        if restitution is not None:
            stiffness = given.get("stiffness", law.stiffness)
            given["damping"] = damping_from_restitution(restitution, mass, stiffness, law.release)
        return replace(law, **given)  # type: ignore[arg-type]
    if restitution is not None:
        given["damping_ratio"] = ratio_from_restitution(restitution, law.release)
    return replace(law, **given)  # type: ignore[arg-type]


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
        between[one, other] = overridden(mixing.law(one, other), pair.numbers(), both)
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

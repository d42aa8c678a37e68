"""[contact], [[material]] and [[contact.pair]]: contact laws for all grains, for some, for two materials."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

import pydantic

from porescale.common.compiled.own import CONTACT_LAW, OwnLaw, number_of
from porescale.common.core.errors import Fault
from porescale.common.schema.json_schema import choice, number
from porescale.common.schema.messages import nearest
from porescale.common.schema.own import OWN_LAW, OrOwn, folder_of, own_law
from porescale.common.schema.sections import Quantity, Refused, Section, quantity
from porescale.scene.ranges import FRICTION

STIFFNESS: Any = {"ge": 0, "le": 1e15}

DASHPOT: Any = {"ge": 0, "le": 1e12}

RATIO: Any = {"ge": 0, "le": 1e3}

DAMPED = ("damping", "damping_ratio", "restitution")

LAWS: list[str] = []
"""Names of contact laws: the register, put here by builders/scene.py."""


class Touch(Section):
    """Numbers of a contact law, per metre of depth.  Left out: those above it, of [contact] or the mixing rule."""

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
    tangential_damping_ratio: float | None = quantity(
        "", None, **RATIO, help="tangential damping ratio; left out, that of the normal"
    )
    rolling_friction: float | None = quantity(
        "", None, **FRICTION, help="largest rolling torque over reduced radius and normal force"
    )
    rolling_stiffness: float | None = quantity("N/m", None, **STIFFNESS, help="rolling stiffness per metre of depth")
    rolling_damping: float | None = quantity("N s/m", None, **DASHPOT, help="rolling damping per metre of depth")
    rolling_stiffness_ratio: float | None = quantity("", None, **RATIO, help="rolling over tangential stiffness")
    rolling_damping_ratio: float | None = quantity(
        "", None, **RATIO, help="rolling damping ratio; left out, that of the normal"
    )

    def numbers(self) -> dict[str, float]:
        """The numbers that are given, by key."""
        values = {key: getattr(self, key) for key in Touch.model_fields}
        return {key: value for key, value in values.items() if value is not None}


class Pair(Touch):
    """The law between two materials: the mixing rule with these numbers in place of its own."""

    materials: tuple[str, str] = pydantic.Field(description="names of both materials")


class Material(Touch):
    """A material: its values in place of those of [contact], and its density in place of that of [grains].

    Between unlike materials stiffnesses are in series, 2 k1 k2/(k1 + k2), the damping ratio is the mean, friction the
    smaller one; like materials have their own law.
    """

    name: str = pydantic.Field(min_length=1, description="name that grains and walls are given")
    density: float | None = quantity("kg/m^3", None, ge=1e-3, le=1e5, help="density (default: that of the grains)")


class Contact(Touch):
    """The law of contacts, per metre of depth; the same between grains and at walls.

    "linear": springs and dashpots;  "hertz": of Hertz and Mindlin, for spheres of the discs' radii, one a metre;
    "laws.py:NAME": a function of a user's file, whose own keys stand beside the others.
    """

    law: Annotated[str | OwnLaw, OrOwn(CONTACT_LAW)] = pydantic.Field(
        "linear", description='contact law, or "laws.py:NAME"'
    )
    own: dict[str, float] = pydantic.Field(
        {}, description="numbers of a law of a user's file, by key; in scenes they may stand in [contact] itself"
    )
    tangential_stiffness: float = quantity("N/m", 0.0, **STIFFNESS, help="tangential stiffness per metre of depth")
    tangential_damping: float = quantity("N s/m", 0.0, **DASHPOT, help="tangential damping per metre of depth")
    friction: float = quantity("", 0.0, **FRICTION, help="friction coefficient between grains")
    poisson: float = quantity("", 0.3, ge=0, le=0.5, help="Poisson's ratio of the grains")
    rolling_friction: float = quantity(
        "", 0.0, **FRICTION, help="largest rolling torque over reduced radius and normal force"
    )
    wall_friction: float | None = quantity(
        "", None, **FRICTION, help="friction coefficient at sides, walls and rectangles (default: that between grains)"
    )
    wall_material: str = pydantic.Field("", description="material of walls and held discs (default: the first)")
    release: Literal["force", "overlap"] = pydantic.Field(
        default="force", description="a contact ends where its force vanishes, or where its overlap does"
    )
    step: float | None = quantity(
        "s", None, ge=1e-15, le=1e3, help="contact step, in fluid at most this (default: from the contact's stability)"
    )
    deepest: float = quantity(
        "", 0.02, gt=0, le=0.3, help='overlap over radius that the step of "hertz" and own laws allows for'
    )
    pair: tuple[Pair, ...] = ()

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        keys, about = schema["properties"], schema["properties"]["law"]
        ours = {**schema, "properties": {**keys, "law": choice(LAWS, about)}}
        own = {**schema, "properties": {**keys, "law": {**OWN_LAW, "description": about["description"]}}}
        own |= {"required": ["law"], "additionalProperties": number()}  # its numbers, by keys that only it knows
        return {"description": schema["description"], "anyOf": [ours, own]}

    @pydantic.model_validator(mode="before")
    @classmethod
    def _own_keys(cls, table: Any, info: pydantic.ValidationInfo) -> Any:
        """The numbers of an own law, in SI, as the table ``own``."""
        if not isinstance(table, Mapping):
            return table
        try:
            law = own_law(table.get("law"), CONTACT_LAW, folder_of(info))
        except Refused:  # said of the key ``law``; whether other keys are the law's cannot be known
            return {key: value for key, value in table.items() if key in cls.model_fields and key != "own"}
        return table if law is None else {**_without(table, law), "own": _numbers(table, law)}

    def __hash__(self) -> int:
        """Equal sections have equal hashes."""
        values = (getattr(self, name) for name in type(self).model_fields if name != "own")
        return hash((*values, *sorted(self.own.items())))

    def numbers(self) -> dict[str, float]:
        """The numbers that are given, by key, those of an own law among them."""
        return {**super().numbers(), **self.own}

    def _faults(self) -> list[Fault]:
        if self.own and isinstance(self.law, str):
            return [Fault("own", None, "belongs to a law of a file", repair=f'leave it out with law = "{self.law}"')]
        return []

    @pydantic.field_validator("law")
    @classmethod
    def _known(cls, name: str | OwnLaw) -> str | OwnLaw:
        if isinstance(name, str) and name not in LAWS:
            allowed = " or ".join(repr(it) for it in LAWS)
            raise Refused(Fault("", name, "unknown choice", "", allowed, nearest(name, LAWS, "choices")))
        return name


def _without(table: Mapping[str, Any], law: OwnLaw) -> dict[str, Any]:
    """The table of [contact] without the keys that only the law has."""
    return {key: value for key, value in table.items() if key in Contact.model_fields or key not in law.keys}


def _numbers(table: Mapping[str, Any], law: OwnLaw) -> dict[str, float]:
    """The numbers of the law's keys, in SI: those that only it has.  Raises Refused with all faults."""
    own = table.get("own")
    given = own if isinstance(own, Mapping) else {}
    values = {**given, **{key: table[key] for key in law.keys if key in table}}
    found, faults = {}, []
    for key in given:
        if key not in law.keys:
            allowed = ", ".join(law.keys) or "none"
            faults.append(Fault(f"own.{key}", None, f"is no key of {law.reference}", "", allowed))
    for key, unit in law.keys.items():
        if key in Touch.model_fields:
            has = next(it.unit for it in Touch.model_fields[key].metadata if isinstance(it, Quantity))
            if has != unit:
                problem = f"{law.reference} gives it the unit {unit!r}, [contact] has it in {has!r}"
                faults.append(Fault(key, None, problem, repair="give it the same unit, or another name"))
            elif values.get(key) is None and Contact.model_fields[key].default is None:
                faults.append(_missing(key, law))
        elif key not in values:
            faults.append(_missing(key, law))
        else:
            try:
                found[key] = number_of(law, key, values[key])
            except ValueError as error:
                repair = f"give it in {unit}" if unit else "give it as a number"
                shown = values[key] if isinstance(values[key], int | float | str) else None
                faults.append(Fault(key, shown, str(error), unit, repair=repair))
    if faults:
        raise Refused(*faults)
    return found


def _missing(key: str, law: OwnLaw) -> Fault:
    """What is said of a key that an own law needs."""
    return Fault(key, None, f"is missing, {law.reference} needs it", law.keys[key], repair="add it to [contact]")

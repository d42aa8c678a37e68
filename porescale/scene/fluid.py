"""[fluid]: its numbers, its lattice, and the choice of operators by name."""

from collections.abc import Collection
from typing import Any, Literal

import pydantic

from porescale.common.compiled.own import BODY_FORCE, OwnLaw
from porescale.common.core.errors import Fault
from porescale.common.schema.json_schema import choice
from porescale.common.schema.messages import nearest
from porescale.common.schema.own import or_own
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.scales import NAMES

CHOICES: dict[str, Collection[str]] = {}
"""Keys of the section that name a law, and the names there are: the registers, put here by builders/scene.py."""


class Fluid(Section):
    """The fluid and its lattice.  Any three of spacing, step, relaxation_time and viscosity give the fourth.

    Whether four agree is checked by the scene, which has the box.
    """

    density: float = quantity("kg/m^3", 1000.0, ge=1e-3, le=1e5, help="density of the fluid")
    viscosity: float | None = quantity("m^2/s", None, ge=1e-12, le=1e3, help="kinematic viscosity")
    spacing: float | None = quantity("m", None, ge=1e-9, le=1e3, help="lattice spacing")
    step: float | None = quantity("s", None, ge=1e-12, le=1e3, help="time step of the lattice")
    relaxation_time: float | None = quantity("", None, gt=0.5, le=1e3, help="relaxation time in steps")
    operator: str = pydantic.Field("trt", description="collision operator")
    magic: float = quantity("", MAGIC_MIDWAY_WALL, ge=1e-6, le=1e3, help="magic parameter; 0.0417 for narrow gaps")
    smagorinsky: float | None = quantity(
        "", None, gt=0, le=1, help="Smagorinsky constant of an eddy viscosity (left out: none)"
    )
    solid_operator: str = pydantic.Field("exact-wall", description="operator of cells that grains lie in")
    weighting: str | None = pydantic.Field(
        None, description="weight of cells that grains lie in (left out: the one that goes with solid_operator)"
    )
    rim: Literal["sharp", "soft"] | None = pydantic.Field(
        None, description="soft: for grains that the fluid passes fast (left out: with the operator central)"
    )
    precision: Literal["float64", "float32"] = pydantic.Field("float64", description="precision of the populations")
    body_force: tuple[float, float] | OwnLaw = or_own(
        BODY_FORCE,
        quantity(
            "N/m^3", (0.0, 0.0), ge=-1e9, le=1e9, help="force per volume on the fluid (a pressure gradient, reversed)"
        ),
    )
    velocity: tuple[float, float] = quantity(
        "m/s", (0.0, 0.0), ge=-1e4, le=1e4, help="velocity of all of the fluid at the start"
    )

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        keys = schema["properties"]
        return {**schema, "properties": keys | {key: choice(names, keys[key]) for key, names in CHOICES.items()}}

    @pydantic.field_validator("operator", "solid_operator", "weighting")
    @classmethod
    def _known(cls, name: str | None, info: pydantic.ValidationInfo) -> str | None:
        known = CHOICES[str(info.field_name)]
        if name is not None and name not in known:
            alike = [it for it in known if it.lower() == name.lower()]
            repair = nearest(alike[0] if alike else name, known, "choices")
            raise Refused(Fault("", name, "unknown choice", "", ", ".join(known), repair))
        return name

    def _faults(self) -> list[Fault]:
        given = {name: getattr(self, name) for name in NAMES if getattr(self, name) is not None}
        if len(given) < 3:
            missing = [name for name in NAMES if name not in given]
            have = ", ".join(given) or "none"
            return [
                Fault(", ".join(missing), None, f"three of {', '.join(NAMES)} are needed, given: {have}",
                      repair=f"add {'one' if len(given) == 2 else str(3 - len(given))} of them")
            ]  # fmt: skip
        return []

"""The fluid as a section: its numbers, its lattice, and the choice of operators by name."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, Literal

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.messages import nearest
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.coupling.weighting.choose import WEIGHTINGS, fitting_weight, fitting_weights
from porescale.lbm.collision.choose import OPERATORS
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.scales import NAMES

CHOICES: dict[str, Collection[str]] = {
    "operator": OPERATORS, "solid_operator": SOLID_OPERATORS, "weighting": WEIGHTINGS,
}  # fmt: skip
"""Keys of the section that name a law, and the names there are: the registers of lbm and coupling."""
SOFT = [name for name, operator in SOLID_OPERATORS.items() if operator.soft_law]
"""Solid operators that have soft rims."""


class Fluid(Section):
    """The fluid and its lattice.  Any three of spacing, step, relaxation_time and viscosity give the fourth.

    Whether four agree is for the scene to say, which knows the box.
    """

    density: float = quantity("kg/m^3", 1000.0, ge=1e-3, le=1e5, help="density of the fluid")
    viscosity: float | None = quantity("m^2/s", None, ge=1e-12, le=1e3, help="kinematic viscosity")
    spacing: float | None = quantity("m", None, ge=1e-9, le=1e3, help="lattice spacing")
    step: float | None = quantity("s", None, ge=1e-12, le=1e3, help="time step of the lattice")
    relaxation_time: float | None = quantity("", None, gt=0.5, le=1e3, help="relaxation time in steps")
    operator: str = pydantic.Field("trt", description="collision operator")
    magic: float = quantity("", MAGIC_MIDWAY_WALL, ge=1e-6, le=1e3, help="magic parameter of operators that have one")
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
    body_force: tuple[float, float] = quantity(
        "N/m^3", (0.0, 0.0), ge=-1e9, le=1e9, help="force per volume on the fluid (a pressure gradient, reversed)"
    )
    velocity: tuple[float, float] = quantity(
        "m/s", (0.0, 0.0), ge=-1e4, le=1e4, help="velocity of all of the fluid at the start"
    )

    @pydantic.field_validator(*CHOICES)
    @classmethod
    def _known(cls, name: str | None, info: pydantic.ValidationInfo) -> str | None:
        known = CHOICES[str(info.field_name)]
        if name is not None and name not in known:
            alike = [it for it in known if it.lower() == name.lower()]
            repair = nearest(alike[0] if alike else name, known, "choices")
            raise Refused(Fault("", name, "unknown choice", "", ", ".join(known), repair))
        return name

    @pydantic.model_validator(mode="after")
    def _three_of_four(self) -> Fluid:
        given = {name: getattr(self, name) for name in NAMES if getattr(self, name) is not None}
        if len(given) < 3:
            missing = [name for name in NAMES if name not in given]
            have = ", ".join(given) or "none"
            raise Refused(
                Fault(", ".join(missing), None, f"three of {', '.join(NAMES)} are needed, given: {have}",
                      repair=f"add {'one' if len(given) == 2 else str(3 - len(given))} of them")
            )  # fmt: skip
        return self

    @pydantic.model_validator(mode="after")
    def _weight_fits(self) -> Fluid:
        try:
            fitting_weight(self.solid_operator, self.weighting)
        except ValueError:
            fits = " or ".join(map(repr, fitting_weights(self.solid_operator)))
            problem = f"does not go with the solid operator {self.solid_operator!r}"
            raise Refused(Fault("weighting", self.weighting, problem, "", fits, "leave it out")) from None
        return self

    @pydantic.model_validator(mode="after")
    def _rim_fits(self) -> Fluid:
        if self.rim == "soft" and self.solid_operator not in SOFT:
            problem = f"does not go with the solid operator {self.solid_operator!r}"
            repair = f"leave it out, or take {' or '.join(map(repr, SOFT))}"
            raise Refused(Fault("rim", self.rim, problem, "", "'sharp'", repair))
        return self

    @property
    def laws(self) -> dict[str, Any]:
        """What the operator is chosen by: keyword arguments of ``Fluid`` of the lattice."""
        return {"operator": self.operator, "magic": self.magic, "smagorinsky": self.smagorinsky or 0.0}

    @property
    def weight(self) -> str:
        """Name of the weight that is used."""
        return fitting_weight(self.solid_operator, self.weighting)

    @property
    def soft_rim(self) -> bool:
        """Whether grains have soft rims."""
        by_default = OPERATORS[self.operator].soft_rim and self.solid_operator in SOFT
        return self.rim == "soft" or (self.rim is None and by_default)

    @property
    def solid_laws(self) -> dict[str, Any]:
        """The same of cells that grains lie in: keyword arguments of ``Saturated`` and ``Coupled``."""
        return {"solid_operator": self.solid_operator, "weighting": self.weight, "soft_rim": self.soft_rim}

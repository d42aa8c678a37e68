"""[domain]: the box and its sides: a word where a side has no numbers, a table where it has."""

from typing import Any, Literal

import pydantic

from porescale.common.compiled.own import INFLOW, OwnLaw
from porescale.common.core.errors import Fault
from porescale.common.schema.json_schema import with_units, word_or
from porescale.common.schema.messages import nearest
from porescale.common.schema.own import or_own
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.lbm.boundary.choose import boundaries, boundary
from porescale.lbm.boundary.law import Boundary
from porescale.scene.ranges import SPEED
from porescale.scene.servo import SERVO, check_servo
from porescale.scene.time_function import TimeFunction, with_time_functions

KINDS: tuple[str, ...] = tuple(boundaries())
Kind: Any = Literal[KINDS]
SIDES = ("left", "right", "bottom", "top")
PARABOLA_PEAK = 1.5
"""Largest over mean velocity of a parabola between two walls."""


class Side(Section):
    """One side, as ``top = "slip"`` or ``left = { kind = "velocity", velocity = ["1 cm/s", 0] }``.

    "wall" holds the fluid, and may slide along itself with ``speed``, for the fluid alone;  "slip" lets it slide (a
    flat water surface);  "periodic" joins opposite sides;  "velocity" lets it in or out with a mean ``velocity``,
    uniform or as the parabola between two walls, or as the function (s, t) of a user's file, "laws.py:NAME";
    "pressure" holds the reduced ``pressure`` (what is above hydrostatic) and lets it in or out.
    A "wall" of a dry scene may also move, with ``velocity``, or so that the grains press on it with a ``stress`` or
    ``force``, > 0 for compression, no faster than ``fastest``.
    For grains every side but a periodic one is solid: an inlet or outlet is a screen.
    """

    kind: Kind = pydantic.Field(default="wall", description="what the side is")
    speed: float = quantity("m/s", 0.0, **SPEED, help="speed of a wall along itself, to the right or up")
    velocity: tuple[float, float] | OwnLaw | None = or_own(
        INFLOW, quantity("m/s", None, **SPEED, help="mean velocity of the fluid at the side")
    )
    profile: Literal["uniform", "parabola"] = pydantic.Field(
        default="uniform", description="how the velocity is spread over the side"
    )
    pressure: float | None = quantity("Pa", None, ge=-1e9, le=1e9, help="pressure above hydrostatic")
    stress: TimeFunction | None = None
    force: TimeFunction | None = None
    fastest: float | None = quantity("m/s", None, gt=0, le=1e4, help="largest speed under stress or force")

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        return word_or(KINDS, with_units(schema, SERVO))

    @pydantic.model_validator(mode="before")
    @classmethod
    def _from_word(cls, value: Any) -> Any:
        """A word stands for a side of that kind without numbers."""
        if not isinstance(value, str):
            return with_time_functions(value, SERVO)
        if value not in KINDS:
            allowed = ", ".join(KINDS)
            raise Refused(Fault("", value, "unknown choice", "", allowed, nearest(value, KINDS, "choices")))
        return {"kind": value}

    def _faults(self) -> list[Fault]:
        """Every number belongs to a kind of side."""
        faults = []
        for key, given in (
            ("speed", self.speed != 0), ("velocity", self.velocity is not None and not self.boundary.movable),
            ("stress", self.stress is not None), ("force", self.force is not None),
            ("profile", self.profile != "uniform"), ("pressure", self.pressure is not None),
        ):  # fmt: skip
            takes = [it.name for it in boundaries().values() if (it.movable if key in SERVO else key in it.numbers)]
            if given and self.kind not in takes:
                owner = takes[0]
                repair = f'leave it out, or write kind = "{owner}"'
                faults.append(Fault(key, None, f'belongs to a side of kind "{owner}", this is a {self.kind}',
                                    repair=repair))  # fmt: skip
        if "velocity" in self.boundary.required and self.velocity is None:
            repair = f'write {{ kind = "{self.kind}", velocity = [0.01, 0] }}'
            faults.append(Fault("velocity", None, "is missing", "m/s", repair=repair))
        if isinstance(self.velocity, OwnLaw) and self.boundary.movable:
            repair = "give two numbers"
            faults.append(
                Fault("velocity", self.velocity.reference, "an inflow is of the fluid, this is a wall", repair=repair)
            )
        if isinstance(self.velocity, OwnLaw) and self.profile != "uniform":
            faults.append(Fault("profile", self.profile, f"{self.velocity} has its own", repair="leave it out"))
        if self.boundary.movable:
            faults += check_servo(self, self.velocity is not None)
        return faults

    @property
    def open(self) -> bool:
        """Whether fluid passes through the side."""
        return self.boundary.passes

    @property
    def boundary(self) -> Boundary:
        """The boundary condition of the side's kind."""
        return boundary(self.kind)

    @property
    def peak(self) -> float:
        """Largest speed that the side gives the fluid, m/s."""
        if self.velocity is None or isinstance(self.velocity, OwnLaw):  # whose peak is sampled, where time is known
            return abs(self.speed)
        mean = float((self.velocity[0] ** 2 + self.velocity[1] ** 2) ** 0.5)
        return mean * (PARABOLA_PEAK if self.profile == "parabola" else 1.0)

    def text(self) -> str:
        """The side in words, for a report."""
        if self.speed:
            return f"{self.kind} moving at {self.speed:g} m/s"
        if self.stress or self.force:
            return f"{self.kind} under {'stress' if self.stress else 'force'}"
        if isinstance(self.velocity, OwnLaw):
            return f"velocity of {self.velocity}"
        if self.velocity is not None:
            u, v = self.velocity
            return (
                f"velocity ({u:g}, {v:g}) m/s, {self.profile}"
                if self.open
                else f"{self.kind} moving at ({u:g}, {v:g}) m/s"
            )
        return f"{self.kind} {self.pressure or 0.0:g} Pa" if "pressure" in self.boundary.numbers else self.kind


class Domain(Section):
    """The box, lower left corner at the origin, and what each of its sides is."""

    width: float = quantity("m", ge=1e-9, le=1e3, help="width of the box")
    height: float = quantity("m", ge=1e-9, le=1e3, help="height of the box")
    left: Side = Side()
    right: Side = Side()
    bottom: Side = Side()
    top: Side = Side()

    def _faults(self) -> list[Fault]:
        for name, other_name in (("left", "right"), ("bottom", "top")):
            one, other = self.side(name).boundary, self.side(other_name).boundary
            if one is not other and (one.periodic or other.periodic):
                repair = f"make both sides {(one if one.periodic else other).name}, or none"
                return [Fault(name, one.name, f"but {other_name} is {other.name}", repair=repair)]
        return []

    def side(self, name: str) -> Side:
        """The side called left, right, bottom or top."""
        side: Side = getattr(self, name)
        return side

    @property
    def periodic(self) -> tuple[bool, bool]:
        """Whether x and y are periodic."""
        return self.left.boundary.periodic, self.bottom.boundary.periodic

    @property
    def sides(self) -> dict[str, Side]:
        """The four sides by name."""
        return {name: self.side(name) for name in SIDES}

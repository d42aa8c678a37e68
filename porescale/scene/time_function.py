"""Numbers that change with time: constant, a sine, a table; and what they prescribe of a component."""

import bisect
import itertools
import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.json_schema import number, with_units, word_or
from porescale.common.schema.sections import Quantity, Refused, Section, quantity

LARGEST = 1e12
"""SI, of any number that changes with time: what lies beyond is a slip of the exponent."""


class TimeFunction(Section):
    """A number over time: ``3``, ``{ amplitude = 1, frequency = 2, phase = 0, mean = 3 }`` or pairs
    ``[[time, value], …]``, straight between them and constant before and after.
    """

    mean: float = 0.0
    amplitude: float = 0.0
    frequency: float = quantity("1/s", 0.0, ge=0, le=1e9, help="frequency of the sine")
    phase: float = quantity("rad", 0.0, ge=-1e3, le=1e3, help="phase of the sine at time 0")
    times: tuple[float, ...] = quantity("s", (), ge=0, le=1e9, help="times of the table")
    values: tuple[float, ...] = ()

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        for key, about in (("mean", "mean value"), ("amplitude", "amplitude of the sine")):
            schema["properties"][key] = {**number(), "default": 0.0, "description": about}
        schema["properties"]["values"] |= {"items": number(), "description": "values at these times"}
        pair = {"type": "array", "prefixItems": [number(), number()], "minItems": 2, "maxItems": 2}
        return {"anyOf": [number(), {"type": "array", "items": pair}, schema]}

    def _faults(self) -> list[Fault]:
        if len(self.times) != len(self.values):
            return [Fault("values", len(self.values), "are not as many as times", "", str(len(self.times)))]
        if any(not later > earlier for earlier, later in zip(self.times, self.times[1:], strict=False)):
            return [Fault("times", None, "must ascend", "s", repair="sort the pairs by time")]
        if self.times and (self.mean or self.amplitude or self.frequency or self.phase):
            return [Fault("times", None, "a course is a table or a sine", "s", repair="leave one of them out")]
        if (self.amplitude != 0.0) != (self.frequency != 0.0):
            key = "frequency" if self.amplitude else "amplitude"
            return [Fault(key, 0, "is needed for a sine", repair="give amplitude and frequency")]
        if self.phase and not self.amplitude:
            return [Fault("phase", self.phase, "is of a sine", "rad", repair="give amplitude and frequency, too")]
        return []

    @property
    def largest(self) -> float:
        """The largest magnitude that it reaches."""
        return max([abs(value) for value in self.values] or [abs(self.mean) + abs(self.amplitude)])

    @property
    def least(self) -> float:
        """The smallest value that it reaches."""
        return min(self.values, default=self.mean - abs(self.amplitude))

    @property
    def most(self) -> float:
        """The largest value that it reaches."""
        return max(self.values, default=self.mean + abs(self.amplitude))

    @property
    def steepest(self) -> float:
        """The largest magnitude of its rate of change, 1/s of its unit."""
        pairs = list(zip(self.times, self.values, strict=True))
        slopes = [abs((b - a) / (later - time)) for (time, a), (later, b) in itertools.pairwise(pairs)]
        return max([*slopes, 2.0 * math.pi * self.frequency * abs(self.amplitude)])

    def value(self, time: float) -> float:
        """The number at ``time`` (s)."""
        if self.times:
            k = bisect.bisect_right(self.times, time)
            if k in (0, len(self.times)):
                return self.values[max(k - 1, 0)]
            share = (time - self.times[k - 1]) / (self.times[k] - self.times[k - 1])
            return self.values[k - 1] + share * (self.values[k] - self.values[k - 1])
        return self.mean + self.amplitude * math.sin(2.0 * math.pi * self.frequency * time + self.phase)

    def integral(self, time: float) -> float:
        """Its exact integral from 0 to ``time`` (s), s of its unit: the way of a velocity."""
        if self.times:
            corners = [0.0, *(it for it in self.times if 0.0 < it < time), time]
            # Straight between corners, so that the trapezoidal rule is exact.
            return sum(0.5 * (b - a) * (self.value(a) + self.value(b)) for a, b in itertools.pairwise(corners))
        if not self.amplitude:
            return self.mean * time
        pulsation = 2.0 * math.pi * self.frequency
        swung = self.amplitude / pulsation * (math.cos(self.phase) - math.cos(pulsation * time + self.phase))
        return self.mean * time + swung


def as_table(value: Any, unit: str, help: str) -> Any:
    """A function of time in ``unit``, as a scene writes it, as a table of its keys, all in SI; raises Refused."""
    if value is None or isinstance(value, TimeFunction):
        return value
    own = Quantity(unit, ge=-LARGEST, le=LARGEST, help=help)
    if isinstance(value, Mapping):
        made = dict(value)
        for key in ("mean", "amplitude", "values"):
            if key in made:
                made[key] = own.convert(made[key], key)
        return made
    if isinstance(value, list | tuple):
        pairs = [list(it) if isinstance(it, list | tuple) else [] for it in value]
        bad = [k for k, it in enumerate(pairs) if len(it) != 2]
        if bad or not pairs:
            repair = f'write [[0, 0], ["1 s", "2 {unit}"]]'
            raise Refused(Fault(f"[{bad[0]}]" if bad else "", None, "must be pairs of time and value", repair=repair))
        return {"times": [it[0] for it in pairs], "values": [own.convert(it[1], f"[{k}]")
                                                               for k, it in enumerate(pairs)]}  # fmt: skip
    return {"mean": own.convert(value)}


def with_time_functions(table: Any, units: Mapping[str, tuple[str, str]]) -> Any:
    """``table`` of a section with its functions of time as tables; units : key -> (unit, help).  Raises Refused."""
    if not isinstance(table, Mapping):
        return table
    made, faults = dict(table), []
    for key, (unit, help) in units.items():
        try:
            if key in made:
                made[key] = as_table(made[key], unit, help)
        except Refused as refused:
            faults += [_below(key, fault) for fault in refused.faults]
    if faults:
        raise Refused(*faults)
    return made


class Timed(Section):
    """A section with functions of time.  UNITS : of each, by key: unit and what it is."""

    UNITS: ClassVar[dict[str, tuple[str, str]]] = {}

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        return with_units(schema, cls.UNITS)

    @pydantic.model_validator(mode="before")
    @classmethod
    def _time_functions(cls, table: Any) -> Any:
        return with_time_functions(table, cls.UNITS)


def _below(key: str, fault: Fault) -> Fault:
    return replace(fault, key=f"{key}{'' if fault.key.startswith('[') or not fault.key else '.'}{fault.key}")


class Component(Section):
    """How one component of a body moves: "free", or a table with one of its keys.

    velocity : moved so;  displacement : since the start, only its changes matter;  force : pushed so, besides all else.
    """

    velocity: TimeFunction | None = None
    displacement: TimeFunction | None = None
    force: TimeFunction | None = None

    UNITS: ClassVar[dict[str, tuple[str, str]]] = {
        "velocity": ("m/s", "velocity"), "displacement": ("m", "displacement"), "force": ("N/m", "force"),
    }  # fmt: skip

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        return word_or(("free",), with_units(schema, cls.UNITS))

    @pydantic.model_validator(mode="before")
    @classmethod
    def _from_word(cls, value: Any) -> Any:
        if isinstance(value, str):
            if value != "free":
                repair = "write free, or { velocity = … }, { displacement = … }, { force = … }"
                raise Refused(Fault("", value, "unknown choice", "", "free, or a table", repair))
            return {}
        return with_time_functions(value, cls.UNITS)

    def _faults(self) -> list[Fault]:
        given = [key for key in self.UNITS if getattr(self, key) is not None]
        if len(given) > 1:
            return [Fault(given[1], None, f"and {given[0]} cannot both be given", repair="give one of them")]
        return []

    @property
    def free(self) -> bool:
        """Whether nothing is said of it."""
        return self.velocity is None and self.displacement is None and self.force is None

    @property
    def prescribes(self) -> bool:
        """Whether it prescribes the motion: not where the component is free or pushed."""
        return self.velocity is not None or self.displacement is not None

    @property
    def fastest(self) -> float:
        """The largest speed that it prescribes, m/s (or rad/s)."""
        if self.velocity:
            return self.velocity.largest
        return self.displacement.steepest if self.displacement else 0.0


class Turning(Component):
    """How the rotation of a body goes: as Component, with velocity in rad/s, displacement in rad, force in N m/m."""

    UNITS: ClassVar[dict[str, tuple[str, str]]] = {
        "velocity": ("rad/s", "angular velocity"), "displacement": ("rad", "angle"), "force": ("N m/m", "torque"),
    }  # fmt: skip

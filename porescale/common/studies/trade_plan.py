"""What a trade study measures and varies: trade.toml beside a scene.

draft = 0.1                         # error of a draft at most; as far as repeats of the reference are apart if absent

[base]                              # what lies under every point, so that nothing hangs on the scene's quality levels
settings = { fluid.spacing = "0.3 mm" }

[over]                              # repeats of every point, whose scatter is what another packing changes
key = "grains.packing.seed"
values = [1, 2, 3]

[reference]                         # finer than all; not needed where every quantity is exact
quality = "fine"
settings = { fluid.spacing = "0.05 mm" }

[[quantity]]                        # as rows of expected.toml; the error is a difference over ``scale``
name = "centre of mass at 0.4 s"
column = "centre of mass y (m)"
at = 0.4
scale = 0.026                       # m, SI: here how far it falls in all
# exact = 0.0555                    # where it is known without a run
# along = "x (m)", file = "profile" # a curve: the rows at that time, rms over the reference's places
# feature = "velocity field"        # what the package makes of a run's last snapshot; rms over its numbers

[[knob]]                            # what is varied, from dear to cheap; points may set several keys
name = "cells per diameter"
[[knob.point]]
label = "10"
settings = { fluid.spacing = "0.15 mm" }
"""

from pathlib import Path
from typing import Any

import pydantic

from porescale.common.core.errors import Fault, InputError
from porescale.common.schema import scene_file
from porescale.common.schema.sections import Refused, Section, quantity, validate
from porescale.common.studies.parameter_table import Point, flat, literal, named, settings_of
from porescale.common.studies.quantities import wrong

NAME = "trade.toml"


class Over(Section):
    """A key that repeats of a point differ in."""

    key: str = pydantic.Field(description="section.key")
    values: tuple[int | float | str, ...] = pydantic.Field(min_length=1, description="its values, a run for each")

    def option(self) -> str:
        """As `--over` has it."""
        return f"{self.key}={','.join(literal(value, self.key) for value in self.values)}"


class Settings(Section):
    """A quality level and settings over it."""

    quality: str | None = None
    settings: dict[str, Any] = pydantic.Field(default_factory=dict, description="keys and values, dotted or nested")


class Variant(Settings):
    """A point of a knob.  label : in tables and pictures;  but : what the requested errors do not show, so that no
    quality level is made of it, and none picks it;  but_after : simulated time from where on that is so."""

    label: str = pydantic.Field(min_length=1)
    but: str = ""
    but_after: float = quantity("s", 0.0, ge=0, help="the remark holds for runs that go on beyond this")


class Knob(Section):
    """A parameter that the study varies."""

    name: str = pydantic.Field(min_length=1)
    point: tuple[Variant, ...] = pydantic.Field(min_length=1)


class Quantity(Section):
    """A quantity that runs are compared in; see `porescale.common.studies.quantities`."""

    name: str = pydantic.Field(min_length=1)
    unit: str = ""
    column: str = ""
    at: str | float | dict[str, Any] = "end"
    file: str = "series"
    minus: str | None = None
    where: dict[str, Any] | None = None
    integral: bool = False
    along: str = ""
    feature: str = ""
    scale: float = quantity("", gt=0, help="value that an error is a share of")
    exact: float | None = quantity("", None, help="exact value")

    @pydantic.model_validator(mode="after")
    def _says_what(self) -> "Quantity":
        if bool(self.column) == bool(self.feature):  # neither or both
            raise Refused(Fault("column", self.column or None, "or feature: one of them says what is measured"))
        if self.exact is not None and (self.is_curve or self.feature):
            raise Refused(Fault("exact", self.exact, "is a number, what is measured a curve or field"))
        if self.integral and (self.is_curve or self.feature):
            raise Refused(Fault("integral", True, "is of a column over time, what is measured a curve or field"))
        if (self.is_curve or self.feature) and not (self.at == "end" or isinstance(self.at, float)):
            raise Refused(Fault("at", str(self.at), "is not when to look at a curve or field", "s", 'a time or "end"'))
        if problem := wrong(self.row()):
            raise Refused(Fault("quantity", self.name, problem))
        return self

    @property
    def is_curve(self) -> bool:
        """Whether it is a curve, not a number."""
        return bool(self.along) or "*" in self.column

    def row(self) -> dict[str, Any]:
        """The table that `measured` takes for this quantity."""
        made = {"name": self.name, "unit": self.unit, "column": self.column, "at": self.at, "file": self.file}
        return made | {key: value for key in ("minus", "where", "along", "integral")
                       if (value := getattr(self, key)) not in (None, False)}  # fmt: skip


class Plan(Section):
    """All settings that trade.toml holds, checked."""

    draft: float | None = quantity("", None, gt=0, help="error of a draft at most")
    base: Settings = pydantic.Field(default_factory=Settings, description="what lies under every point")
    over: Over | None = None
    reference: Settings | None = None
    quantity: tuple[Quantity, ...] = pydantic.Field(min_length=1)
    knob: tuple[Knob, ...] = pydantic.Field(min_length=1)

    @pydantic.model_validator(mode="after")
    def _has_reference(self) -> "Plan":
        if self.reference is None and any(it.exact is None for it in self.quantity):
            repair = "add [reference], a run finer than all, or exact values"
            raise Refused(Fault("reference", None, "is absent, and not every quantity is exact", repair=repair))
        names = [it.name for it in self.quantity]
        if len(set(names)) < len(names):
            raise Refused(Fault("quantity", ", ".join(names), "have one name twice"))
        return self

    def variants(self) -> list[tuple[str, str, Point]]:
        """(knob, label, point) in the order of the file; a point that two knobs share is there once, with both."""
        made: dict[tuple[str | None, tuple[str, ...]], tuple[str, str]] = {}
        for knob in self.knob:
            for variant in knob.point:
                key = self._over_base(variant)
                before = made.get(key)
                label = f"{knob.name} {variant.label}"
                made[key] = (f"{before[0]}; {knob.name}", f"{before[1]}; {label}") if before else (knob.name, label)
        points = named([Point(label, settings, quality) for (quality, settings), (_, label) in made.items()])
        return [(knob, label, point) for (knob, label), point in zip(made.values(), points, strict=True)]

    def caveats(self) -> dict[tuple[str | None, tuple[str, ...]], tuple[str, float]]:
        """What is to be said of points, and of runs longer than what (s), by quality and settings."""
        return {self._over_base(it): (it.but, it.but_after) for knob in self.knob for it in knob.point if it.but}

    def reference_point(self) -> Point | None:
        """The run finer than all."""
        if self.reference is None:
            return None
        quality, settings = self._over_base(self.reference)
        return Point("reference", settings, quality)

    def _over_base(self, given: Settings) -> tuple[str | None, tuple[str, ...]]:
        """Quality and settings of a point, laid over those of the base."""
        settings = dict(flat(self.base.settings)) | dict(flat(given.settings))
        return given.quality or self.base.quality, settings_of(settings)


def read_plan(scene: Path, given: Path | None) -> Plan:
    """The plan in ``given``, else in trade.toml beside the scene file.  InputError with all faults."""
    file = given if given is not None else scene.parent / NAME
    if not scene_file.is_file(file):
        repair = f"write one: [[quantity]], [[knob]], [reference]; see the other cases' {NAME}"
        raise InputError(Fault(str(file), None, "is no file", repair=repair))
    return validate(Plan, scene_file.read(file), file=str(file))

"""[grains.packing]: grains placed at random, settled or pressed; sizes uniform, given, graded or lognormal."""

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
import pydantic

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.units import to_si
from porescale.common.neighbors.grading import check_count, check_curve, check_sizes, given_radii, graded_radii
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.scene.ranges import FRICTION, LENGTH


class Packing(Section):
    """Grains placed at random without overlap, then settled dry under gravity until they fill a rectangle.  Of gravity
    that is tilted they settle under what points down, and are let go under all of it.

    Their number is packing_fraction * width * height over the mean grain area, or that of sizes; how high they stand in
    the end, friction and seed decide.  With settle = false they stay where they were placed (packing_fraction at most
    0.8); with compress = true they are grown and pressed together in the whole box until it has that fraction, or void
    ratio, to round-off.

    Around bodies in the rectangle, which are held meanwhile, there are as many grains as without them.
    """

    follows: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("number", "count", "grains"), "packing_fraction (or void_ratio), width, height and diameter, or sizes gives it"
    )

    left: float = quantity("m", ge=0, le=1e3, help="left edge of the rectangle")
    bottom: float = quantity("m", 0.0, ge=0, le=1e3, help="lower edge of the rectangle")
    width: float = quantity("m", **LENGTH, help="width of the rectangle")
    height: float = quantity("m", **LENGTH, help="height of the rectangle")
    diameter: float = quantity("m", **LENGTH, help="mean diameter of the grains")
    # s = 0.905: sizes of 1 to 20, (1 + s)/(1 - s)
    size_spread: float = quantity("", 0.1, ge=0, le=0.905, help="half width of the diameters over their mean")
    packing_fraction: float = quantity("", 0.81, ge=1e-3, le=0.84, help="grain area over the rectangle's area")
    seed: int = pydantic.Field(1, ge=0, description="seed of the random placement")
    settle: bool = pydantic.Field(True, description="let the grains settle dry before the run")
    settling_friction: float = quantity(
        "", 0.3, **FRICTION,
        help="friction while preparing: little packs densely; compressing needs springs along contacts for it",
    )  # fmt: skip
    settling_rolling_friction: float = quantity(
        "", 0.0, **FRICTION, help="friction of rolling while preparing, for looser packings; 0: that of the contact law"
    )
    # pores that the largest packing_fraction leaves, 1/0.84 - 1
    void_ratio: float | None = quantity(
        "", None, ge=0.1905, lt=1e3, help="pores over grains, instead of packing_fraction"
    )
    grading: tuple[tuple[float, float], ...] = quantity(
        "m", (), help="grading curve, [diameter, percent finer by mass] from 0 to 100, instead of diameter"
    )
    sizes: tuple[tuple[float, float], ...] = quantity(
        "m", (), help="[diameter, number of grains] of each size, instead of diameter and packing_fraction"
    )
    log_spread: float | None = quantity(
        "", None, ge=0, le=0.599, help="deviation of the logarithm of lognormal diameters, instead of size_spread"
    )
    compress: bool = pydantic.Field(False, description="grow in place to packing_fraction, without gravity")
    pressure: float | None = quantity("Pa", None, gt=0, le=1e12, help="mean stress to compress to, without gravity")
    material: str = pydantic.Field("", description="name of its material (default: the first)")

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        needed = [key for key in schema["required"] if key != "diameter"]
        return {
            **schema,
            "required": needed,
            "anyOf": [{"required": [key]} for key in ("diameter", "grading", "sizes")],
        }

    def gives(self, key: str) -> bool:
        """Whether someone wrote ``key``; not so in the full table of a run card, which has all keys and its Nones."""
        return key in self.model_fields_set and all(getattr(self, it) is not None for it in self.model_fields_set)

    def _faults(self) -> list[Fault]:
        try:
            if self.log_spread is not None or (self.compress and not (self.grading or self.sizes)):
                check_count(
                    self.packing_fraction * self.width * self.height / (np.pi / 4.0 * self.diameter**2), "diameter"
                )
        except InputError as error:
            return error.faults
        return []

    @pydantic.model_validator(mode="before")
    @classmethod
    def _consequences(cls, table: Any) -> Any:
        return with_consequences(table)

    @pydantic.field_validator("grading")
    @classmethod
    def _a_curve(cls, curve: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        return require_curve(curve)

    @pydantic.field_validator("sizes")
    @classmethod
    def _some_sizes(cls, sizes: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        return require_sizes(sizes)


LEAST, MOST = 0.7, 0.84
"""Share of a rectangle that given sizes may cover: most of any packing, and least of one that is pressed, in which they
grow or shrink until the pressure is there."""
SAME = 1e-9
"""Relative difference within which two keys of the same quantity agree."""


def with_consequences(table: Any) -> Any:
    """The section [grains.packing] with what follows from its keys: the fraction from a void ratio, the mean diameter
    from a grading curve, no settling of what is compressed.  Raises Refused where a key contradicts it."""
    if not isinstance(table, Mapping):
        return table
    made, faults = dict(table), []

    def follows(key: str, value: float, source: str, unit: str = "") -> None:
        """Take ``value`` for a key, with a fault where another one is given."""
        given = _number(made.get(key), unit)
        if given is not None and abs(given - value) > SAME * value:
            problem = f"follows from {source}: {value:.6g}"
            faults.append(Fault(key, given, problem, unit, repair=f"leave {key} or {source} out"))
        made[key] = value

    ratio = _number(made.get("void_ratio"))
    if ratio is not None and 0.0 < ratio < 1e3:
        follows("packing_fraction", 1.0 / (1.0 + ratio), "void_ratio")
    if made.get("sizes"):
        faults += _clash_with_sizes(made)
        found = _of_sizes(made)
        if found is not None and not faults:
            follows("diameter", found[0], "sizes", "m")
            follows("packing_fraction", found[1], "sizes")
    curve = made.get("grading")
    if curve:
        if made.get("log_spread") is not None:
            faults.append(Fault("log_spread", made["log_spread"], "sizes follow from grading", repair="leave one out"))
        mean = _mean_of(curve, made)
        if mean is not None:
            follows("diameter", mean, "grading", "m")
    if made.get("pressure") is not None or made.get("compress"):
        if made.get("settle"):
            problem = "a packing that is compressed does not settle under gravity"
            faults.append(Fault("settle", True, problem, repair="leave it out, or leave pressure and compress out"))
        made["settle"] = False
        made["compress"] = True
    if faults:
        raise Refused(*faults)
    return made


def require_curve(curve: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    """A grading curve; raises Refused where it is none."""
    faults = check_curve(curve, "") if curve else []
    if faults:
        raise Refused(*faults)
    return curve


def require_sizes(sizes: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    """Given sizes; raises Refused where they are none."""
    faults = check_sizes(sizes, "") if sizes else []
    if faults:
        raise Refused(*faults)
    return sizes


def _clash_with_sizes(table: Mapping[str, Any]) -> list[Fault]:
    """Faults of what given sizes leave no room for."""
    return [
        Fault(key, _number(table[key]), "sizes and numbers of grains follow from sizes", repair="leave one out")
        for key in ("grading", "log_spread", "void_ratio") if table.get(key)
    ]  # fmt: skip


def _of_sizes(table: Mapping[str, Any]) -> tuple[float, float] | None:
    """Mean diameter (m) of given sizes and the share of the rectangle of ``table`` that they cover; None where either
    is at fault, which other checks report.  Raises Refused where they cover too much or too little of it."""
    numbers = [_number(table.get(key), "m") for key in ("width", "height")]
    try:
        sizes = tuple((to_si(d, "m"), float(count)) for d, count in table["sizes"])
        if None in numbers or check_sizes(sizes):
            return None
        if not all(LENGTH["ge"] <= number <= LENGTH["le"] for number in numbers if number is not None):
            return None
    except (TypeError, ValueError):
        return None
    radii = given_radii(sizes)
    share = float(np.pi * np.sum(radii**2)) / float(np.prod(np.array(numbers, float)))
    least = LEAST if table.get("pressure") is not None else 0.0
    if not least <= share <= MOST:
        allowed = f"{least:g} to {MOST:g}" if least else f"<= {MOST:g}"
        repair = "change the numbers of grains, or the rectangle"
        raise Refused(Fault("sizes", None, f"covers {share:.3g} of the rectangle", "", allowed, repair))
    return 2.0 * float(radii.mean()), share


def _mean_of(curve: Any, table: Mapping[str, Any]) -> float | None:
    """Mean diameter of the grains of a curve in the rectangle of ``table``; None where either is at fault, which
    other checks report.  InputError where the curve has no grain in it, or far too many."""
    numbers = [_number(table.get(key), "m") for key in ("width", "height")]
    fraction = _number(table.get("packing_fraction", 0.81))
    try:
        points = tuple((to_si(d, "m"), float(p)) for d, p in curve)
        if fraction is None or None in numbers or check_curve(points):
            return None
        if not all(LENGTH["ge"] <= number <= LENGTH["le"] for number in numbers if number is not None):
            return None
        if not 0.0 < fraction <= 1.0:
            return None
        return 2.0 * float(graded_radii(points, fraction * float(np.prod(np.array(numbers, float)))).mean())
    except (TypeError, ValueError):
        return None


def _number(value: Any, unit: str = "") -> float | None:
    """A number in ``unit``, from a text with another too; None if it is none."""
    try:
        return None if value is None or isinstance(value, bool) else to_si(value, unit)
    except (TypeError, ValueError):
        return None

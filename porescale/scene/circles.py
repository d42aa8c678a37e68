"""[grains.circles]: grains at places read from a file."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar, Literal

import pydantic

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import STILLS
from porescale.common.schema.sections import Refused, Section, quantity, validate
from porescale.scene.ranges import PLACE

PRESSED = 0.02
"""Overlap over diameter with which circles of a file may start: what presses a packing together, or measures it."""
LEAST_PIXELS = 8
"""Across the smallest disc that is looked for in a picture."""


class Circles(Section):
    """Grains at places read from a file: a packing kept by an earlier run, a list of circles, a laboratory's picture.

    .csv with a header and columns x, y and diameter (or radius), .h5 with datasets x, y, radius in m, or a picture of
    discs (.png, .tif, .jpg …), which are found in it to a fraction of a pixel.
    """

    read: "ClassVar[Callable[[Circles, Path | None], list[dict[str, float | str]]] | None]" = None
    """Entries of [[grains.grain]] from the file in a folder; registered by builders/scene.py, since pictures
    need readers of their own.  Raises InputError with keys of [grains]."""

    files: ClassVar[tuple[str, ...]] = ("file",)

    file: str = pydantic.Field(description="file, beside the scene")
    unit: Literal["m", "cm", "mm", "um"] = pydantic.Field("m", description="unit of the columns")
    y: Literal["up", "down"] = pydantic.Field("up", description="direction of y: down in pictures")
    image_height: float | None = quantity(
        "m", None, ge=1e-9, le=1e3, help="height of the picture, where y is down (default: to the lowest circle)"
    )
    left: float = quantity("m", 0.0, **PLACE, help="place of x = 0 of the file")
    bottom: float = quantity("m", 0.0, **PLACE, help="place of y = 0 of the file, turned upwards")
    pixel: float | None = quantity("m", None, ge=1e-9, le=1, help="size of a pixel, of a picture")
    smallest: float | None = quantity("m", None, ge=1e-9, le=1e3, help="smallest diameter looked for in a picture")
    largest: float | None = quantity("m", None, ge=1e-9, le=1e3, help="largest diameter looked for in a picture")
    shade: Literal["light", "dark"] = pydantic.Field(
        "light", description="discs of a picture, against what is between them"
    )
    material: str = pydantic.Field("", description="name of their material (default: the first)")
    part: bool = pydantic.Field(False, description="slide circles apart that overlap, as measured ones do")

    def _faults(self) -> list[Fault]:
        pictured, faults = Path(self.file).suffix.lower() in STILLS, []
        for key in ("pixel", "smallest", "largest"):
            value = getattr(self, key)
            if (value is None) == pictured:
                problem, repair = (
                    ("is needed for a picture", "add it") if pictured else ("is for pictures", "leave it out")
                )
                faults.append(Fault(key, value, problem, "m", "> 0", repair))
        if pictured:
            plain = {"unit": "m", "y": "up", "image_height": None}
            faults += [Fault(key, getattr(self, key), "follows from the picture", repair="leave it out")
                       for key, value in plain.items() if getattr(self, key) != value]  # fmt: skip
        if not faults and pictured and not (self.smallest or 0.0) < (self.largest or 0.0):
            allowed = f"< {self.largest:g}"
            faults.append(Fault("smallest", self.smallest, "must be below the largest", "m", allowed))
        if not faults and pictured and (self.smallest or 0.0) < LEAST_PIXELS * (self.pixel or 0.0):
            problem, repair = "is too few pixels to tell a disc from noise", "take a picture with more of them"
            faults.append(Fault("smallest", self.smallest, problem, "m", f">= {LEAST_PIXELS * (self.pixel or 0.0):g}",
                                repair))  # fmt: skip
        return faults


def with_circles(table: Any, folder: Path | None) -> Any:
    """The section [grains] with the circles of its file among its grains: a run's card then holds them all."""
    if not isinstance(table, Mapping) or table.get("circles") is None:
        return table
    given = table["circles"]
    try:
        circles = given if isinstance(given, Circles) else validate(Circles, given)
    except InputError as error:
        raise Refused(*(replace(fault, key=f"circles.{fault.key}") for fault in error.faults)) from None
    assert Circles.read is not None
    grains = [*(table.get("grain") or ()), *Circles.read(circles, folder)]
    return {"overlap": PRESSED, **table, "circles": None, "grain": grains}

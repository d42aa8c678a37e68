"""Packings of a scene beyond the plain one: graded and lognormal sizes, compression, and circles from a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pydantic
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.units import to_si
from porescale.common.neighbors.grading import graded_radii, judge_curve, lognormal_radii
from porescale.common.neighbors.placement import part
from porescale.common.schema.sections import Refused, Section, quantity, validate
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Law
from porescale.dem.prepare.compaction import Compressed, Press, kept, read_circles, read_packing

if TYPE_CHECKING:
    from porescale.scene.sections import Packing, Scene

Array = NDArray[np.float64]

PLACE: Any = {"ge": -1e3, "le": 1e3}
PRESSED = 0.02
"""Overlap over diameter with which circles of a file may start: what presses a packing together, or measures it."""
STILLS = (".png", ".tif", ".tiff", ".bmp", ".jpg", ".jpeg", ".pgm", ".webp")
"""Endings of files that are pictures."""
LEAST_PIXELS = 8
"""Across the smallest disc that is looked for in a picture."""
SAME = 1e-9
"""Relative difference within which two keys that say the same agree."""


class Circles(Section):
    """Grains at places read from a file: a packing kept by an earlier run, a list of circles, a laboratory's picture.

    .csv with a header and columns x, y and diameter (or radius), .h5 with datasets x, y, radius in m, or a picture of
    discs (.png, .tif, .jpg …), which are found in it to a fraction of a pixel.
    """

    file: str = pydantic.Field(description="file, beside the scene")
    unit: Literal["m", "cm", "mm", "um"] = pydantic.Field("m", description="unit of the columns")
    y: Literal["up", "down"] = pydantic.Field("up", description="direction of y: down in pictures")
    image_height: float | None = quantity(
        "m", None, ge=1e-9, le=1e3, help="height of the picture, where y is down (default: to the lowest circle)"
    )
    left: float = quantity("m", 0.0, **PLACE, help="where x = 0 of the file comes to lie")
    bottom: float = quantity("m", 0.0, **PLACE, help="where y = 0 of the file, turned upwards, comes to lie")
    pixel: float | None = quantity("m", None, ge=1e-9, le=1, help="size of a pixel, of a picture")
    smallest: float | None = quantity("m", None, ge=1e-9, le=1e3, help="smallest diameter looked for in a picture")
    largest: float | None = quantity("m", None, ge=1e-9, le=1e3, help="largest diameter looked for in a picture")
    shade: Literal["light", "dark"] = pydantic.Field(
        "light", description="discs of a picture, against what is between them"
    )
    material: str = pydantic.Field("", description="name of their material (default: the first)")
    part: bool = pydantic.Field(False, description="slide circles apart that overlap, as measured ones do")

    def grains(self, folder: Path | None) -> list[dict[str, float | str]]:
        """Entries of [[grains.grain]] that say the same; raises InputError with keys of this section."""
        path = (folder or Path()) / self.file
        try:
            if path.suffix.lower() in STILLS:
                position, radius = self._pictured(path)
            elif path.suffix == ".h5":
                position, radius = read_packing(path)
                position = position + np.array([self.left, self.bottom])
            else:
                where = self.left, self.bottom
                position, radius = read_circles(path, self.unit, self.y, self.image_height, where)
            if self.part:
                position = part(position, radius)
        except InputError as error:
            raise InputError([replace(fault, key=f"circles.{fault.key}") for fault in error.faults]) from None
        return [
            {"x": x, "y": y, "diameter": 2.0 * r, "material": self.material}
            for (x, y), r in zip(position.tolist(), radius.tolist(), strict=True)
        ]

    @pydantic.model_validator(mode="after")
    def _of_a_picture(self) -> Circles:
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
        if faults:
            raise Refused(*faults)
        return self

    def _pictured(self, path: Path) -> tuple[Array, Array]:
        """Places (n, 2) m and radii (n,) m of the discs of a picture."""
        assert self.pixel
        assert self.smallest
        assert self.largest
        from porescale.analysis.detect_circles import circles_in
        from porescale.piv.images.film import picture  # readers of pictures and films take a while to load

        seen = picture(path)
        sizes = self.smallest / self.pixel, self.largest / self.pixel
        at, radius = circles_in(seen.astype(np.float32), *sizes, light=self.shade == "light")
        up = np.column_stack((at[:, 0], seen.shape[0] - at[:, 1]))
        return up * self.pixel + np.array([self.left, self.bottom]), radius * self.pixel


def with_circles(table: Any, folder: Path | None) -> Any:
    """The section [grains] with the circles of its file among its grains: a run's card then holds them all."""
    if not isinstance(table, Mapping) or table.get("circles") is None:
        return table
    given = table["circles"]
    try:
        circles = given if isinstance(given, Circles) else validate(Circles, given)
    except InputError as error:
        raise Refused(*(replace(fault, key=f"circles.{fault.key}") for fault in error.faults)) from None
    grains = [*(table.get("grain") or ()), *circles.grains(folder)]
    return {"overlap": PRESSED, **table, "circles": None, "grain": grains}


def with_consequences(table: Any) -> Any:
    """The section [grains.packing] with what follows from its keys: the fraction from a void ratio, the mean diameter
    from a grading curve, no settling of what is compressed.  Raises Refused where a key says otherwise."""
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


def judged_grading(curve: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    """A grading curve; raises Refused where it is none."""
    faults = judge_curve(curve, "") if curve else []
    if faults:
        raise Refused(*faults)
    return curve


def _mean_of(curve: Any, table: Mapping[str, Any]) -> float | None:
    """Mean diameter of the grains of a curve in the rectangle of ``table``; None where either is at fault, as others
    say."""
    numbers = [_number(table.get(key), "m") for key in ("width", "height")]
    fraction = _number(table.get("packing_fraction", 0.81))
    try:
        points = tuple((to_si(d, "m"), float(p)) for d, p in curve)
        if fraction is None or None in numbers or judge_curve(points):
            return None
        return 2.0 * float(graded_radii(points, fraction * float(np.prod(np.array(numbers, float)))).mean())
    except (TypeError, ValueError, InputError):
        return None


def _number(value: Any, unit: str = "") -> float | None:
    """A number in ``unit``, from a text with another too; None if it is none."""
    try:
        return None if value is None or isinstance(value, bool) else to_si(value, unit)
    except (TypeError, ValueError):
        return None


def radii_of(packing: Packing) -> Array | None:
    """Radii (n,) m of a packing with a grading, lognormal sizes or compression; None for the plain one, drawn later."""
    area = packing.packing_fraction * packing.width * packing.height
    if packing.grading:
        return graded_radii(packing.grading, area)
    if packing.log_spread is not None:
        per_grain = np.pi / 4.0 * packing.diameter**2
        relative = lognormal_radii(1000, 1.0, packing.log_spread)
        count = max(1, round(area / (per_grain * 4.0 * float(np.mean(relative**2)))))
        return lognormal_radii(count, packing.diameter, packing.log_spread)
    if packing.compress:
        spread = packing.size_spread
        count = max(1, round(area / (np.pi / 4.0 * packing.diameter**2 * (1.0 + spread**2 / 3.0))))
        even = (np.arange(count) + 0.5) / count
        return np.asarray(0.5 * packing.diameter * (1.0 + spread * (2.0 * even - 1.0)))
    return None


def judge_compressed(scene: Scene, faults: list[Fault]) -> None:
    """A compressed packing fills the box: nothing else would hold it together."""
    packing = scene.grains.packing if scene.grains else None
    if packing is None or not packing.compress or scene.rock:
        return
    if scene.contact and scene.contact.law != "linear":
        problem = "packings are compressed under the linear law only"
        faults.append(Fault("contact.law", scene.contact.law, problem, repair='let it settle, or take "linear"'))
    domain = scene.domain
    for key, start, length, size in (
        ("width", packing.left, packing.width, domain.width), ("height", packing.bottom, packing.height, domain.height),
    ):  # fmt: skip
        if abs(start) > SAME * size or abs(length - size) > SAME * size:
            problem = "a compressed packing fills the box, whose sides hold it"
            repair = "make the packing as large as the box, or let it settle"
            faults.append(Fault(f"grains.packing.{key}", length, problem, "m", f"{size:g}", repair))


def compressed(scene: Scene, packing: Packing, law: Law) -> Compressed:
    """The packing of a scene, pressed to its pressure or fraction; keys of faults are those of the scene."""
    assert scene.grains
    assert isinstance(law, Linear)  # judge_compressed has made sure
    radius = radii_of(packing)
    assert radius is not None
    box = (packing.left, packing.bottom), (packing.left + packing.width, packing.bottom + packing.height)
    periodic = (False, False) if scene.rock else scene.domain.periodic
    press = Press(*box, law, periodic, packing.settling_friction, scene.grains.density, packing.seed)
    try:
        return kept(press, radius, packing.pressure)
    except InputError as error:
        raise InputError([replace(fault, key=f"grains.packing.{fault.key}") for fault in error.faults]) from None

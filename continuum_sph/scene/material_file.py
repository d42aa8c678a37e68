"""[soil] material = "material.toml": numbers of a soil as its grains have them, from the file that measures them.

Values given in the scene take precedence; a stiffness of its own has an exponent of its own.  k is not that of the
test's own water: it follows from K of the file and the scene's own water, k = K ρ g/μ.  The card keeps where the
numbers come from, and their standard errors.
"""

import hashlib
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pydantic

from continuum_sph.scene.rate import RateSection
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import given_bytes, reason
from porescale.common.core.statistics import half_width
from porescale.common.core.units import to_si
from porescale.common.schema import scene_file
from porescale.common.schema.sections import Refused, Section, quantity, validate

FORMAT = 1
"""Of the files that are read here."""
CONDUCTING = "kozeny-carman"
"""The law of permeability that has a share of grains in the flow."""
DENSITY, VISCOSITY = 1000.0, 1.002e-3
"""Density and viscosity of the water of a scene that gives none, kg/m³ and Pa s: the defaults of [water]."""


class Known(Section):
    """A measured number.  standard_error : of the mean, deviation : of one packing;  values : one for each packing;
    interval : half of that of the mean at 95 %, systematic : what of it no packing shows."""

    mean: float
    standard_error: float = quantity("", ge=0)
    deviation: float = quantity("", ge=0)
    values: tuple[float, ...] = pydantic.Field(min_length=2)
    interval: float | None = quantity("", None, ge=0)
    systematic: float = quantity("", 0.0, ge=0)
    unit: str = ""

    def half(self) -> float | None:
        """Half of the interval of the mean at 95 %, of its values where the file does not say it; None if too few."""
        found = half_width(self.values) if self.interval is None else self.interval
        return found if math.isfinite(found) else None


class Taken(Section):
    """[soil] of the file: what goes into [soil] of a scene, with the ranges there: a fault then names this file."""

    density: float = quantity("kg/m^3", ge=1, le=1e5)
    porosity: float = quantity("", ge=0, le=0.99)
    stiffness: float | None = quantity("Pa", None, ge=1, le=1e12)
    reference: float | None = quantity("Pa", None, ge=1e-3, le=1e12)
    exponent: float | None = quantity("", None, ge=0, le=1)
    poisson: float | None = quantity("", None, ge=0, le=0.49)


class Strength(Section):
    """Friction and dilatancy angle of the soil in one state."""

    friction_angle: float = quantity("rad", ge=0, le=1.4)
    dilatancy_angle: float = quantity("rad", ge=0, le=1.4)


class Strengths(Section):
    """critical : after large strains;  peak : at failure."""

    critical: Strength
    peak: Strength


class Pores(Section):
    """permeability : K of the soil as it was packed;  hydraulic_share : of their volume that grains take up in the
    flow, λ² of discs."""

    permeability: float = quantity("m^2", gt=0)
    hydraulic_share: float = quantity("", 1.0, gt=0, le=1)


class SofteningLaw(Section):
    """[softening] of the file: what it holds of [soil.softening]; widths of shear bands no packing shows."""

    friction_angle: float = quantity("rad", ge=0, le=1.4)
    shear_strain: float = quantity("", gt=0)


class MaterialFile(Section):
    """The contents of a material file, see `porescale homogenise`."""

    format: int
    soil: Taken
    strength: Strengths
    pores: Pores | None = None
    softening: SofteningLaw | None = None
    rate: RateSection | None = None
    measured: dict[str, Known] = pydantic.Field(default_factory=dict)
    made: dict[str, Any] = pydantic.Field(default_factory=dict, description="how the file was made")


class Origin(Section):
    """Where numbers of the soil come from: file and its SHA-256, its own description, means and standard errors.

    The same file under another name, or in another place, is the same origin.
    """

    file: str = pydantic.Field(description="name of the material file")
    sha256: str = pydantic.Field(description="SHA-256 of that file")
    intrinsic_permeability: float | None = quantity("m^2", None, gt=0, help="permeability of the grains for any fluid")
    measured: dict[str, tuple[float, float]] = pydantic.Field(
        default_factory=dict, description="mean and standard error of each number"
    )
    intervals: dict[str, float] = pydantic.Field(
        default_factory=dict, description="half of the interval at 95 % of each number that has one"
    )
    made: dict[str, Any] = pydantic.Field(default_factory=dict, description="how the file was made")

    def __eq__(self, other: object) -> bool:
        """Whether all but the name of the file is equal."""
        if not isinstance(other, Origin):
            return NotImplemented
        return self.model_dump(exclude={"file"}) == other.model_dump(exclude={"file"})

    def __hash__(self) -> int:
        """Equal origins have equal hashes."""
        return hash(self.sha256)


def read_material(path: Path) -> tuple[MaterialFile, str]:
    """A material file and its SHA-256; InputError, naming the file, where it is none."""
    problem, repair = "is no file", "name one that `porescale homogenise` has written, beside the scene"
    try:
        if not path.is_file():
            raise InputError(Fault("soil.material", str(path), problem, repair=repair))
        digest = hashlib.sha256(given_bytes(path)).hexdigest()
    except (OSError, ValueError) as error:  # a name too long, or with a null in it; no right to read
        raise InputError(
            Fault("soil.material", str(path), f"cannot be read ({reason(error)})", repair=repair)
        ) from None
    table = scene_file.read(path)
    number = table.get("format")
    if number != FORMAT or isinstance(number, bool):
        newer = isinstance(number, int) and not isinstance(number, bool) and number > FORMAT
        repair = "read it with a newer version, or measure again" if newer else repair
        raise InputError(Fault("format", number, "is not that of a material file", "", str(FORMAT), repair, str(path)))
    return validate(MaterialFile, table, file=str(path)), digest


def with_material(table: Any, folder: Path | None) -> Any:
    """The tables of a scene with the numbers of the material file that its [soil] names, below its own."""
    soil = table.get("soil") if isinstance(table, Mapping) else None
    if not isinstance(soil, Mapping) or soil.get("material") is None:
        return table
    name = soil["material"]
    if not isinstance(name, str) or not name:
        raise Refused(Fault("soil.material", name, "is not the name of a file", repair="write it as a text"))
    file, digest = read_material((folder or Path()) / name)
    taken = file.soil.model_dump(exclude_none=True)
    state = file.strength.peak if soil.get("strength") == "peak" else file.strength.critical
    if soil.get("stiffness") is not None:  # how E follows the stress belongs to the E that is given
        taken.pop("exponent", None)
    taken |= state.model_dump()
    origin: dict[str, Any] = {"file": name, "sha256": digest, "made": file.made}
    origin["measured"] = {key: (it.mean, it.standard_error) for key, it in file.measured.items()}
    origin["intervals"] = {key: half for key, it in file.measured.items() if (half := it.half()) is not None}
    if file.pores is not None:
        origin["intrinsic_permeability"] = file.pores.permeability
        taken["permeability"] = speed(file.pores.permeability, table)
        if soil.get("permeability_law") == CONDUCTING:  # another law has no share
            taken["hydraulic_share"] = file.pores.hydraulic_share
    own = {key: value for key, value in soil.items() if key != "material"}
    for law, given in (("softening", file.softening), ("rate", file.rate)):
        if given is not None and isinstance(own.get(law), Mapping):  # only a scene that has the table takes it over
            own[law] = {**given.model_dump(), **own[law]}
    return {**table, "soil": {**taken, **own, "origin": origin}}


def speed(intrinsic: float, table: Mapping[str, Any]) -> float:
    """k (m/s) of K (m²) for the water of a scene's ``table``, whose numbers others judge: under 9.81 m/s², or under the
    gravity of the scene where the soil has suction, as `soil.permeability` counts."""
    water = table.get("water")

    def number(given: Any, key: str, unit: str, usual: float) -> float:
        """A quantity of a table in ``unit``, ``usual`` where it is not given or not valid."""
        try:
            found = to_si(given.get(key, usual) if isinstance(given, Mapping) else usual, unit)
        except (TypeError, ValueError):
            return usual
        return found if found > 0.0 else usual

    density, viscosity = number(water, "density", "kg/m^3", DENSITY), number(water, "viscosity", "Pa s", VISCOSITY)
    suction = isinstance(table["soil"].get("suction"), Mapping)
    gravity = number(table, "gravity", "m/s^2", GRAVITY) if suction else GRAVITY
    return intrinsic * density * gravity / viscosity

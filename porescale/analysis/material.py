"""A material file: what packings of grains show of the soil they make, with the standard error of each number.  TOML.

format          1
[soil]          numbers that a scene of the continuum takes over: density (of grains per whole volume), porosity,
                stiffness at the mean stress reference, poisson;  SI, angles in rad
[strength.critical], [strength.peak]    friction_angle, dilatancy_angle: after large strains, and at failure
[pores]         permeability: K, m², of which k = K ρ g/μ of the scene's own water
[measured.…]    mean, standard_error, deviation of one packing, values, unit, of each number
[made]          by what, of what, how: version, commit, scene, seeds, lambda, cells, grains, pressure …
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

FORMAT = 1
NAME = "material.toml"
SOLIDEST = 0.49
"""Poisson's ratio from where on an elastic soil is not one: such a ratio holds dilatancy, and is not taken over."""
UNITS = {
    "porosity": "", "peak friction angle": "rad", "peak dilatancy angle": "rad", "critical friction angle": "rad",
    "critical porosity": "", "stiffness": "Pa", "Poisson's ratio": "", "permeability": "m^2",
    "permeability over hydraulic diameter squared": "", "hydraulic solid fraction": "", "lattice error": "",
}  # fmt: skip
"""Of every number, in the order of tables."""


@dataclass(frozen=True)
class Known:
    """A number as several packings have it: values, one for each, in ``unit``."""

    values: tuple[float, ...]
    unit: str = ""

    @property
    def mean(self) -> float:
        """Mean of the values, in ``unit``."""
        return float(np.mean(self.values))

    @property
    def deviation(self) -> float:
        """Standard deviation of a single packing (n - 1), in ``unit``."""
        return float(np.std(self.values, ddof=1))

    @property
    def error(self) -> float:
        """Standard error of the mean."""
        return self.deviation / math.sqrt(len(self.values))

    def table(self) -> dict[str, Any]:
        """The number as a table of the material file."""
        return {"mean": self.mean, "standard_error": self.error, "deviation": self.deviation,
                "values": list(self.values), "unit": self.unit}  # fmt: skip


def known(rows: Sequence[Mapping[str, float]]) -> dict[str, Known]:
    """Every number over the packings, ``rows`` of name and value; left out where one of them has none."""
    names = [name for name in UNITS if all(math.isfinite(row.get(name, math.nan)) for row in rows)]
    return {name: Known(tuple(float(row[name]) for row in rows), UNITS[name]) for name in names}


def tables(found: Mapping[str, Known], density: float, pressure: float, made: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a material file.  density : of grains, kg/m³;  pressure : mean stress of the measurement, Pa."""
    mean = {name: it.mean for name, it in found.items()}
    soil = {"density": (1.0 - mean["porosity"]) * density, "porosity": mean["porosity"]}
    if "stiffness" in mean and 0.0 <= mean["Poisson's ratio"] < SOLIDEST:
        soil |= {"stiffness": mean["stiffness"], "reference": pressure, "poisson": mean["Poisson's ratio"]}
    strength = {
        "critical": {"friction_angle": mean["critical friction angle"], "dilatancy_angle": 0.0},
        "peak": {"friction_angle": mean["peak friction angle"],
                 "dilatancy_angle": max(0.0, mean["peak dilatancy angle"])},
    }  # fmt: skip
    whole: dict[str, Any] = {"format": FORMAT, "soil": soil, "strength": strength}
    if "permeability" in mean:
        whole["pores"] = {"permeability": mean["permeability"]}
    words = {name: name.replace(" ", "_").replace("'", "") for name in found}
    whole["measured"] = {words[name]: it.table() for name, it in found.items()}
    return {**whole, "made": dict(made)}


def text(found: Mapping[str, Known]) -> str:
    """The numbers as lines for people, angles in degrees: mean, standard error, deviation of one packing."""
    lines = []
    for name, it in found.items():
        scale, unit = (180.0 / math.pi, "degrees") if it.unit == "rad" else (1.0, it.unit)
        mean, error, one = (scale * value for value in (it.mean, it.error, it.deviation))
        lines.append(f"{name:<46}{mean:>11.4g} ± {error:<9.2g} {unit:<8} one packing ± {one:.2g}".rstrip())
    return "\n".join(lines)

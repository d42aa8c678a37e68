"""A material file: what packings of grains show of the soil they make, with the interval of each number.  TOML.

format          1
[soil]          numbers that a scene of the continuum takes over: density (of grains per whole volume), porosity,
                stiffness at the mean stress reference, exponent by which it grows with that stress, poisson;  SI,
                angles in rad
[strength.critical], [strength.peak]    friction_angle, dilatancy_angle: after large strains, and at failure
[pores]         permeability: K, m², of which k = K ρ g/μ of the scene's own water; hydraulic_share: of their volume
                that grains take up in the flow, λ²
[softening]     where the peak is resolved: friction_angle after large strains, shear_strain γs, see softening.py
[rate]          where homogenise.rates asks for it: grain_diameter, friction_angle of the fastest shear, inertial_number
                I0 of half the growth, see shear_rate.py
[measured.…]    mean, interval (half of that at 95 %, by Student's t, with what is systematic), systematic (lattice and
                lambda), standard_error, deviation of one packing, values, unit, of each number; values of the laws of
                [softening] and [rate] are the jackknife's
[made]          by what, of what, how: version, commit, scene, seeds, lambda, cells, grains, pressure …; doubts
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from porescale.common.core.statistics import Sample

FORMAT = 1
NAME = "material.toml"
EXPONENT = "exponent of stiffness"
SOLIDEST = 0.49
"""Poisson's ratio from where on an elastic soil is not one: such a ratio holds dilatancy, and is not taken over."""
UNITS = {
    "porosity": "", "peak friction angle": "rad", "peak dilatancy angle": "rad", "critical friction angle": "rad",
    "critical dilatancy angle": "rad", "critical porosity": "", "stiffness": "Pa", "Poisson's ratio": "",
    EXPONENT: "",
    "porosity after the test": "", "permeability": "m^2", "permeability after the test": "m^2",
    "permeability over hydraulic diameter squared": "", "hydraulic solid fraction": "", "lattice error": "",
    "exponent of lambda": "", "excess with free grains at half the cells": "", "independent critical values": "",
}  # fmt: skip
"""Of every number, in the order of tables."""
OWN_LENGTHS = {
    "permeability": 0.0,
    "permeability after the test": 0.0,
    "permeability over hydraulic diameter squared": 2.0,
}
"""Numbers that follow lambda, and the power of lambda that is divided out of them."""


@dataclass(frozen=True)
class Known(Sample):
    """A number as several packings have it, values in ``unit``;  systematic : what no packing shows."""

    unit: str = ""
    systematic: float = 0.0

    @property
    def interval(self) -> float:
        """Half of the interval of the mean at 95 %; nan where packings are too few for one."""
        return math.hypot(self.half, self.systematic)

    @property
    def resolved(self) -> bool:
        """Whether it is above zero, by more than its interval where it has one."""
        return self.mean > 0.0 and not self.interval >= self.mean

    def table(self) -> dict[str, Any]:
        """The number as a table of the material file."""
        made = {"mean": self.mean, "standard_error": self.error, "deviation": self.deviation,
                "values": list(self.values), "unit": self.unit}  # fmt: skip
        made |= {"interval": self.interval} if math.isfinite(self.interval) else {}
        return made | ({"systematic": self.systematic} if self.systematic else {})

    def text(self) -> str:
        """Mean and interval for people, angles in degrees."""
        scale, unit = (180.0 / math.pi, "degrees") if self.unit == "rad" else (1.0, self.unit)
        bar = f"± {scale * self.interval:.2g}" if math.isfinite(self.interval) else "(no interval)"
        return f"{scale * self.mean:.4g} {bar} {unit}".rstrip()


def known(rows: Sequence[Mapping[str, float]], ratio_error: float = 0.0) -> dict[str, Known]:
    """Every number over the packings, ``rows`` of name and value; left out where one of them has none.

    ratio_error : by how much lambda may be off, relative: with the lattice's own it is systematic in K.
    """
    names = [name for name in UNITS if all(math.isfinite(row.get(name, math.nan)) for row in rows)]
    made = {name: Known(tuple(float(row[name]) for row in rows), UNITS[name]) for name in names}
    for name, power in OWN_LENGTHS.items():
        if name in made and "lattice error" in made:
            exponent = made.get("exponent of lambda")  # absent where wider discs seal a packing, which is a doubt
            of_lambda = (exponent.mean - power) * ratio_error if exponent else 0.0
            share = math.hypot(made["lattice error"].mean, of_lambda)
            made[name] = Known(made[name].values, made[name].unit, abs(made[name].mean) * share)
    return made


def elastic(found: Mapping[str, Known]) -> bool:
    """Whether the contacts make an elastic soil, which a continuum can take over."""
    both = "stiffness" in found and "Poisson's ratio" in found
    return both and found["stiffness"].mean > 0.0 and 0.0 <= found["Poisson's ratio"].mean < SOLIDEST


def grows(found: Mapping[str, Known]) -> bool:
    """Whether stiffness is seen to grow with pressure, no faster than in proportion."""
    return EXPONENT in found and found[EXPONENT].resolved and found[EXPONENT].mean <= 1.0


def tables(
    found: Mapping[str, Known],
    density: float,
    pressure: float,
    made: Mapping[str, Any],
    laws: Mapping[str, Mapping[str, float]] | None = None,
) -> dict[str, Any]:
    """The tables of a material file.  density : of grains, kg/m³;  pressure : mean stress of the measurement, Pa;
    laws : the tables [softening] and [rate], of those that are handed over."""
    mean = {name: it.mean for name, it in found.items()}
    soil = {"density": (1.0 - mean["porosity"]) * density, "porosity": mean["porosity"]}
    if elastic(found):
        soil |= {"stiffness": mean["stiffness"], "reference": pressure, "poisson": mean["Poisson's ratio"]}
        if grows(found):
            soil["exponent"] = mean[EXPONENT]
    strength = {
        "critical": {"friction_angle": mean["critical friction angle"], "dilatancy_angle": 0.0},
        "peak": {"friction_angle": mean["peak friction angle"],
                 "dilatancy_angle": max(0.0, mean["peak dilatancy angle"])},
    }  # fmt: skip
    whole: dict[str, Any] = {"format": FORMAT, "soil": soil, "strength": strength}
    if "permeability" in mean:
        whole["pores"] = {"permeability": mean["permeability"]}
        if "hydraulic solid fraction" in mean:
            whole["pores"]["hydraulic_share"] = mean["hydraulic solid fraction"] / (1.0 - mean["porosity"])
    whole |= {name: dict(law) for name, law in (laws or {}).items()}
    words = {name: name.replace(" ", "_").replace("'", "") for name in found}
    whole["measured"] = {words[name]: it.table() for name, it in found.items()}
    return {**whole, "made": dict(made)}


def text(found: Mapping[str, Known]) -> str:
    """The numbers as lines for people, angles in degrees: mean, interval, deviation of one packing."""
    lines = []
    for name, it in found.items():
        scale = 180.0 / math.pi if it.unit == "rad" else 1.0
        lines.append(f"{name:<46}{it.text():<32}one packing ± {scale * it.deviation:.2g}")
    return "\n".join(lines)

"""A contact law of a user: any normal force F(overlap, closing speed, radius, mass), with numbers of its own.

Friction, rolling resistance and the rule for the end of a contact are those of the linear law.  What others state
follows here from the function alone: the stable step from its steepest tangents dF/dd and dF/dd' over the overlaps
that [contact] ``deepest`` allows and the speeds of impacts that reach them; contact time and restitution from a
collision, integrated; elastic energy from the force at rest, by Gauss's rule.
"""

import math
import sys
from collections import namedtuple
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from porescale.common.compiled.jit import Kernel
from porescale.common.compiled.kernel_key import Unknown, key_of
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.contact.collision import Collision, Force, collide, impact_speed, samples, steepest
from porescale.dem.contact.law import (
    COLUMNS,
    CR,
    CT,
    KernelLaw,
    Springs,
    history_scaling,
    normal_force,
    row_numbers,
    stiffness,
    stiffness_scale,
    stored_normal,
)
from porescale.dem.contact.linear import Linear, series
from porescale.dem.contact.restitution import ratio_from_restitution

FRAME = (
    "tangential_stiffness", "tangential_damping", "friction", "rolling_friction", "rolling_stiffness",
    "rolling_damping",
)  # fmt: skip
"""Keys of [contact] that every own law takes besides its own."""
STIFF = ("N/m", "Pa")
"""Units of numbers that are in series between unlike materials; of others the mean is taken."""
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(12)
HALVES, SHARES = 0.5 * (POINTS + 1.0), 0.5 * WEIGHTS
"""Gauss's rule on (0, 1), in the root of the overlap: exact for d^(3/2), and for polynomials up to the tenth degree."""
NOTHING = 1e-9
"""Force over the largest one below which a force is none."""


class OwnKernel(KernelLaw):
    """A user's law as kernels take it; each law has a class derived from it.  Its rows have a column more for each of
    its keys."""


@stiffness_scale.of(OwnKernel)
def _stiffness_scale(overlap, radius, law):
    """Factor on tangential and rolling stiffness: 1 at every overlap."""
    return 1.0


@history_scaling.of(OwnKernel)
def _history_scaling(overlap, closing, dt, law):
    """Factor on the springs as the overlap changes: 1, they keep their length."""
    return 1.0


_BODIES = """
def stiffness(overlap, radius, mass, p, law):
    return force(overlap, 0.0, radius, mass, Numbers({columns})), 0.0, 1.0, 1.0, p[CT], p[CR]


def normal_force(elastic, damping, seen, mass, p, law):
    return force(seen.overlap, seen.closing, seen.radius, mass, Numbers({columns}))


def stored_normal(overlap, radius, p, law):
    total = 0.0
    for k in range(HALVES.shape[0]):
        z = HALVES[k]
        total += SHARES[k] * 2.0 * z * force(overlap * z * z, 0.0, radius, 1.0, Numbers({columns}))
    return total * overlap


def row_numbers(p, law):
    return ({row},)
"""
"""The formulas of a law of so many numbers; columns: those of its numbers, row: all."""


@dataclass(frozen=True)
class OwnContact:
    """A user's law with its numbers.

    frame : the linear law whose friction, rolling resistance and release it has;  numbers : of its keys, in their
    order;  deepest : overlap over radius up to which it is meant.  Classes derived from this one hold the function.
    """

    name: ClassVar[str]
    order: ClassVar = 1000
    purpose: ClassVar = "a law of a user's file"
    kernel: ClassVar[type[KernelLaw]]
    force: ClassVar[Kernel]
    units: ClassVar[Mapping[str, str]]
    keys: ClassVar[tuple[str, ...]]
    required: ClassVar = ("", "")
    damping_keys: ClassVar[tuple[str, ...]] = ()
    of_materials: ClassVar[tuple[str, ...]] = ()
    needs_radius: ClassVar = True
    compresses: ClassVar = False

    frame: Linear
    numbers: tuple[float, ...] = ()
    deepest: float = 0.02

    @classmethod
    def from_numbers(cls, numbers: Mapping[str, float], release: str, mass: float, deepest: float) -> "OwnContact":
        """The law of the keys of [contact], its own among them."""
        frame = Linear(1.0, 0.0, release=release, **{key: numbers[key] for key in FRAME if key in numbers})
        return cls(frame, tuple(numbers[key] for key in cls.units), deepest)

    def with_numbers(self, numbers: Mapping[str, float], mass: float) -> "OwnContact":
        """This law with other numbers, by the keys of [contact]."""
        frame = replace(self.frame, **{key: value for key, value in numbers.items() if key in FRAME})  # type: ignore[arg-type]
        own = tuple(numbers.get(key, value) for key, value in zip(self.units, self.numbers, strict=True))
        return replace(self, frame=frame, numbers=own)

    @staticmethod
    def friction_problem(numbers: Mapping[str, float]) -> tuple[str, str, str] | None:
        """As of the linear law."""
        return Linear.friction_problem(numbers)

    @property
    def friction(self) -> float:
        """Coulomb friction coefficient of the contact, -."""
        return self.frame.friction

    @property
    def rolling_friction(self) -> float:
        """Coefficient of rolling friction."""
        return self.frame.rolling_friction

    @property
    def release(self) -> str:
        """Rule for the end of a contact."""
        return self.frame.release

    @property
    def rolls(self) -> bool:
        """Whether there is rolling resistance."""
        return self.frame.rolls

    def with_friction(self, friction: float) -> "OwnContact":
        """This law with another friction coefficient."""
        return replace(self, frame=self.frame.with_friction(friction))

    def mixed(self, other: Any) -> "OwnContact":
        """Between unlike materials: numbers in N/m and Pa in series, the mean of others; friction as materials.py has
        it."""
        if type(other) is not type(self) or other.release != self.release:
            raise InputError(Fault("contact.law", f"{self} and {other}", "differ in kind or release"))
        pairs = zip(self.units.values(), self.numbers, other.numbers, strict=True)
        numbers = tuple(series(a, b) if unit in STIFF else 0.5 * (a + b) for unit, a, b in pairs)
        return type(self)(self.frame.mixed(other.frame), numbers, max(self.deepest, other.deepest))

    def row(self) -> Floats:
        """The law as kernels read it, (COLUMNS + number of keys,) float64."""
        return np.concatenate([self.frame.row(), np.array(self.numbers, float)])

    def force_at(self, mass: float, radius: float) -> Force:
        """The force (N/m) as a function of overlap (m) and closing speed (m/s), at reduced ``mass`` and ``radius``."""
        compiled, numbers = self.force.compiled, numbers_of(self.units, self.numbers)
        return lambda overlap, closing: float(compiled(float(overlap), float(closing), radius, mass, numbers))

    def stiffest(self, mass: float, radius: float) -> Springs:
        """Its steepest tangents up to ``deepest`` times ``radius`` (m), a disc of ``mass`` (kg/m) against a wall."""
        normal, damping = _tangents(self, mass, radius)
        frame = self.frame.stiffest(mass, radius)
        return Springs((normal, *frame.stiffness[1:]), (damping, *frame.damping[1:]))

    def collision(self, mass: float, radius: float, speed: float) -> Collision:
        """A collision at ``speed`` (m/s), reduced ``mass`` (kg/m) and ``radius`` (m)."""
        return _collision(self, mass, radius, speed)

    def fastest_impact(self, mass: float, radius: float) -> float:
        """Speed (m/s) of the undamped impact that reaches the overlap ``deepest`` times ``radius`` (m)."""
        return impact_speed(self.force_at(mass, radius), self.deepest * radius, mass)

    def shortest_contact(self, mass: float, radius: float) -> float:
        """Seconds of the shortest of contacts at speeds up to that which reaches ``deepest``; reduced mass, radius."""
        most = self.fastest_impact(mass, radius)
        return min(self.collision(mass, radius, share * most).seconds for share in (1.0, 0.1, 0.01))

    def restitution(self, mass: float, radius: float = 0.0) -> float:
        """Parting speed over approach speed at the speed of ``contact_report``."""
        return self.collision(mass, radius, REPORTED).restitution

    def ratio_of_damping(self, mass: float, radius: float = 0.0) -> float:
        """Damping ratio of the linear law with the same restitution; infinite where discs do not part."""
        restitution = min(self.restitution(mass, radius), 1.0)
        return ratio_from_restitution(restitution, "force") if restitution > 0.0 else math.inf

    def contact_report(self, mass: float, radius: float) -> tuple[float, str]:
        """Seconds that a contact lasts at a speed of 1 cm/s."""
        return self.collision(mass, radius, REPORTED).seconds, "at 1 cm/s"

    def impact(self, mass: float, radius: float, speed: float) -> tuple[float, float]:
        """Deepest overlap (m) of an impact at ``speed`` (m/s), and the power of the stiffness over it, of a line."""
        return self.collision(mass, radius, speed).deepest, 2.0

    def problem(self, mass: float, radius: float) -> str:
        """What makes it no contact law, with the value; "" where nothing does.  Of a disc against a wall."""
        force, most = self.force_at(mass, radius), self.deepest * radius
        found = [(d, force(d, 0.0)) for d in samples(most)]
        bad = [(d, f) for d, f in found if not math.isfinite(f)]
        if bad:
            return f"the force is {bad[0][1]} at an overlap of {bad[0][0]:.3g} m"
        largest = max(abs(f) for _, f in found)
        d, first = found[0]
        if largest == 0.0:
            return f"the force is 0 at every overlap up to {most:.3g} m"
        if abs(first) > 1e-3 * largest and first > 0.0:
            return f"pushes with {first:.4g} N/m at an overlap of {d:.3g} m: its stiffness there is not finite"
        d, least = min(found, key=lambda it: it[1])
        if least < -NOTHING * largest and self.release == "force":
            return f'pulls with {-least:.4g} N/m at an overlap of {d:.3g} m, which release = "force" cuts off'
        if found[-1][1] <= 0.0:
            return (
                f"pulls with {-found[-1][1]:.4g} N/m at the deepest overlap, {most:.3g} m: nothing holds grains apart"
            )
        normal, damping = _tangents(self, mass, radius)
        if not (math.isfinite(normal) and normal > 0.0):
            return f"its largest stiffness is {normal:.4g} N/m"
        if not math.isfinite(damping):
            return f"its largest damping is {damping:.4g} N s/m"
        speed = self.fastest_impact(mass, radius)
        gained = self.collision(mass, radius, speed).restitution
        if not gained <= 1.0 + 1e-6:
            return f"restitution {gained:.6g} at {speed:.3g} m/s: a collision gains energy"
        return ""

    def elastic_force_depends_on_mass(self, mass: float, radius: float) -> bool:
        """Whether the force at rest changes with the mass, so that it has no energy of the overlap alone."""
        d = 0.5 * self.deepest * radius
        return self.force_at(mass, radius)(d, 0.0) != self.force_at(1.0, radius)(d, 0.0)


REPORTED = 0.01
"""Speed (m/s) of the collision that is reported."""


@lru_cache(maxsize=1024)
def _tangents(law: OwnContact, mass: float, radius: float) -> tuple[float, float]:
    """Steepest slopes of a law: stiffness (N/m) and damping (N s/m)."""
    return steepest(law.force_at(mass, radius), law.deepest * radius, law.fastest_impact(mass, radius))


@lru_cache(maxsize=256)
def _collision(law: OwnContact, mass: float, radius: float, speed: float) -> Collision:
    """A collision, of a law that has tangents."""
    stiff = steepest(law.force_at(mass, radius), law.deepest * radius, 0.0)[0]
    return collide(law.force_at(mass, radius), mass, speed, stiff, law.release)


def _mark(force: Kernel, keys: tuple[str, ...]) -> str:
    """Text that all laws of this content have, and no other."""
    try:
        function: Any = force.py_func
        return key_of(function, force.options, keys, "", {})[:16]
    except Unknown:  # something that has no content, such as an object of a class: known within this process
        return f"{id(force):x}"


def _class_of_numbers(keys: tuple[str, ...]) -> Any:
    """Class of the numbers of laws with these keys, which kernels and other processes find in this module."""
    name = "_".join(("Numbers", *keys))
    here = vars(sys.modules[__name__])
    if name not in here:
        here[name] = namedtuple(name, keys or ("none",), module=__name__)
    return here[name]


def numbers_of(units: Mapping[str, str], numbers: tuple[float, ...]) -> Any:
    """The numbers of a law, in the order of its keys, as its function is given them."""
    return _class_of_numbers(tuple(units))(*(numbers or (0.0,)))


def own_contact(reference: str, force: Kernel, units: Mapping[str, str]) -> type[OwnContact]:
    """The class of the law that a scene names so: ``force`` (overlap, closing, radius, mass, numbers), with the unit of
    each of its keys.  Laws of the same content have the same class, in every process."""
    title = f"Own_{force.py_func.__name__}_{_mark(force, tuple(units))}"
    here = vars(sys.modules[__name__])
    if title in here:
        found: type[OwnContact] = here[f"{title}_law"]
        return found
    kernel = type(title, (OwnKernel,), {"__module__": __name__, "__doc__": f"The law {reference} as kernels take it."})
    here[title] = kernel
    columns = [f"p[{COLUMNS + k}]" for k in range(len(units))]
    text = _BODIES.format(
        columns=", ".join(columns) or "0.0", row=", ".join(f"p[{k}]" for k in range(COLUMNS + len(units)))
    )
    names: dict[str, Any] = {
        "force": force, "Numbers": _class_of_numbers(tuple(units)), "CT": CT, "CR": CR, "HALVES": HALVES,
        "SHARES": SHARES, "__name__": __name__,
    }  # fmt: skip
    exec(text, names)
    for name, formula in (
        ("stiffness", stiffness), ("normal_force", normal_force), ("stored_normal", stored_normal),
        ("row_numbers", row_numbers),
    ):  # fmt: skip
        formula.of(kernel)(names[name])
    keys = (*units, *(it for it in FRAME if it not in units))
    own = {
        "__module__": __name__,
        "name": reference,
        "kernel": kernel,
        "force": force,
        "units": dict(units),
        "keys": keys,
    }
    here[f"{title}_law"] = type(f"{title}_law", (OwnContact,), own)
    made: type[OwnContact] = here[f"{title}_law"]
    return made

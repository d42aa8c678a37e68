"""Laws of a user's file: whether they compile, and whether what they return can be used."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from porescale.common.compiled.own import OwnLaw
from porescale.common.compiled.own_kernel import compile_for
from porescale.common.core.errors import Fault, InputError
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.own import OwnContact, numbers_of
from porescale.scene.contact import Contact
from porescale.scene.scene import Scene

PLACES, TIMES = 16, 200
"""Places along each direction, and times, at which laws of place and time are looked at before a run: one time in each
two-hundredth of it, at random (of a fixed seed), so that no motion has the rhythm of the looks."""
MOST = {"m/s": 1e6, "N/m^3": 1e9}
"""Largest speed and force density that a law may give: what lies beyond is a slip."""


def check_own_contact(contact: Contact, laws: Sequence[ContactLaw], mass: float, radius: float) -> None:
    """InputError where [contact] names a user's law that cannot be compiled or is none, of the smallest grain.

    laws : all of the scene;  mass (kg/m), radius (m) : of the smallest grain, which touches a wall.
    """
    if not isinstance(contact.law, OwnLaw):
        return
    for law in laws:
        assert isinstance(law, OwnContact)
        try:
            compile_for(contact.law, 1e-3 * radius, 0.0, radius, mass, numbers_of(law.units, law.numbers), count=1)
        except InputError as error:
            raise InputError([_at("contact.law", fault) for fault in error.faults]) from None
        problem = law.problem(mass, radius)
        if problem:
            repair = f"correct {contact.law.name} in {contact.law.place}"
            raise InputError(Fault("contact.law", contact.law.reference, problem, repair=repair))


def energy_of_mass(scene: Scene, laws: Sequence[ContactLaw], mass: float, radius: float) -> str | None:
    """A warning where the energy budget is asked for of a user's law whose force at rest depends on the mass."""
    if not (scene.output.energy and scene.contact and isinstance(scene.contact.law, OwnLaw)):
        return None
    if not any(isinstance(law, OwnContact) and law.elastic_force_depends_on_mass(mass, radius) for law in laws):
        return None
    return (
        f"output.energy: the force of {scene.contact.law.reference} at rest depends on the mass, so contacts have no"
        " energy of the overlap alone: that of springs is reckoned with 1 kg/m, and the residual holds the difference"
    )


def inflow_peak(scene: Scene, name: str) -> float:
    """Largest speed (m/s) of the own law of a side over the run; 0 where it has none.  InputError where it is no number
    somewhere."""
    looked = _inflow(scene, name)
    return looked.largest if looked else 0.0


def inflow_rate(scene: Scene, name: str, step: float) -> float:
    """How fast that velocity changes, rad/s: see `Looked`;  step: of the fluid, s."""
    looked = _inflow(scene, name, step)
    return looked.rate if looked else 0.0


def largest_force(scene: Scene, axis: int) -> float:
    """Largest component (N/m³) along ``axis`` of an own body force over the run.  InputError where it is no number
    somewhere."""
    looked = _force(scene)
    assert looked
    return looked.parts[axis]


def impulse(scene: Scene, axis: int) -> float:
    """Largest impulse (N s/m³) along ``axis``, from the start on, that the mean of an own body force over the box
    gives."""
    looked = _force(scene)
    assert looked
    return looked.impulse[axis]


def force_rate(scene: Scene, step: float) -> float:
    """How fast that force changes, rad/s; 0 of a constant one;  step: of the fluid, s."""
    looked = _force(scene, step)
    return looked.rate if looked else 0.0


class Looked(NamedTuple):
    """What a law was seen to give: its ``largest`` length; its ``rate``, rad/s: the largest slope between two times
    that it was looked at over half the reach of what it gives at one place; and its ``impulse``: of each component, the
    largest magnitude of the integral (s of its unit) from 0 on of the mean over the places;  parts: the largest
    magnitude of each component.

    Where rates are asked for, each look is two, a step of the fluid apart: the slope between them is that of all motion
    that the fluid can follow.  What lasts less than a two-hundredth of the run may lie between the looks.
    """

    largest: float
    rate: float
    impulse: tuple[float, float]
    parts: tuple[float, float]


def _inflow(scene: Scene, name: str, step: float = 0.0) -> Looked | None:
    side, box = scene.domain.side(name), scene.domain
    if not isinstance(side.velocity, OwnLaw):
        return None
    length = box.height if name in ("left", "right") else box.width
    places = [((k + 0.5) / PLACES * length,) for k in range(PLACES)]
    return _look(f"domain.{name}.velocity", side.velocity, places, times_of_looks(scene.time.end, step), "m/s")


def _force(scene: Scene, step: float = 0.0) -> Looked | None:
    law, box = scene.fluid.body_force if scene.fluid else None, scene.domain
    if not isinstance(law, OwnLaw):
        return None
    shares = [(k + 0.5) / PLACES for k in range(PLACES)]
    places = [(x * box.width, y * box.height) for x in shares for y in shares]
    return _look("fluid.body_force", law, places, times_of_looks(scene.time.end, step), "N/m^3")


def times_of_looks(end: float, step: float) -> Sequence[float]:
    """Times (s) at which a law is looked at in a run up to ``end``, ascending; each with one a step later, if > 0."""
    shares = (np.arange(TIMES) + np.random.default_rng(0).random(TIMES)) / TIMES
    looks = shares * max(end - step, 0.0)
    found: list[float] = np.unique(np.concatenate(([0.0, end], looks, np.minimum(looks + step, end)))).tolist()
    return found


def _look(key: str, law: OwnLaw, places: Sequence[tuple[float, ...]], times: Sequence[float], unit: str) -> Looked:
    """What a law gives at some places (m) and times (s), which ascend."""
    timed = law.function.__code__.co_argcount > len(places[0])
    end, times = times[-1], times if timed else [0.0]
    try:
        compiled = compile_for(law, *places[0], *times[: 1 if timed else 0], count=2)
    except InputError as error:
        raise InputError([_at(key, fault) for fault in error.faults]) from None
    given = np.zeros((len(times), len(places), 2))
    for row, time in zip(given, times, strict=True):
        for k, place in enumerate(places):
            row[k] = u, v = compiled(*place, time) if timed else compiled(*place)
            if not math.hypot(u, v) <= MOST[unit]:
                where = ", ".join(f"{it:.4g} m" for it in place) + (f" and {time:.4g} s" if timed else "")
                problem = f"is ({u:g}, {v:g}) {unit} at {where}"
                repair = f"correct {law.name} in {law.place}"
                raise InputError(Fault(key, law.reference, problem, "", f"<= {MOST[unit]:g} {unit}", repair))
    largest = float(np.hypot(given[..., 0], given[..., 1]).max())
    mean = given.mean(axis=1)
    parts = float(np.abs(given[..., 0]).max()), float(np.abs(given[..., 1]).max())
    if not timed:
        return Looked(largest, 0.0, (abs(float(mean[0, 0])) * end, abs(float(mean[0, 1])) * end), parts)
    gained = np.abs(np.cumsum(0.5 * (mean[1:] + mean[:-1]) * np.diff(times)[:, None], axis=0)).max(axis=0)
    reach = 0.5 * float(np.ptp(given, axis=0).max())
    steepest = float((np.abs(np.diff(given, axis=0)).max(axis=(1, 2)) / np.diff(times)).max())
    rate = steepest / reach if reach > 1e-9 * largest else 0.0
    return Looked(largest, rate, (float(gained[0]), float(gained[1])), parts)


def _at(key: str, fault: Fault) -> Fault:
    """The fault, of a key."""
    return Fault(key, fault.value, fault.problem, fault.unit, fault.allowed, fault.repair)

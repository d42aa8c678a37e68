"""Walls on which a stress or force is prescribed: what sides of the box and free walls have in common."""

from typing import Protocol

from porescale.common.core.errors import Fault
from porescale.scene.time_function import TimeFunction

SERVO = {"stress": ("Pa", "stress on the wall"), "force": ("N/m", "force on the wall")}


class Pressed(Protocol):
    """The prescribed load of a servo-controlled wall, also of a side of the domain."""

    @property
    def stress(self) -> TimeFunction | None:
        """Prescribed stress on the wall, Pa; None if not given."""

    @property
    def force(self) -> TimeFunction | None:
        """Prescribed force on the wall, N/m; None if not given."""

    @property
    def fastest(self) -> float | None:
        """Upper bound of the wall's speed, m/s; None if not given."""


def check_servo(it: Pressed, moves: bool) -> list[Fault]:
    """What is wrong with the stress or force of a wall; ``moves``: it has a velocity, too."""
    given = [key for key in SERVO if getattr(it, key) is not None]
    faults = []
    if len(given) + moves > 1:
        problem = "a wall has one of velocity, stress and force"
        faults.append(Fault(given[-1], None, problem, repair="leave the others out"))
    if given and it.fastest is None:
        problem = "is missing: the largest speed of the wall"
        faults.append(Fault("fastest", None, problem, "m/s", "> 0", "add it, some diameters a second"))
    if it.fastest is not None and not given:
        problem = "belongs to a wall with stress or force"
        faults.append(Fault("fastest", it.fastest, problem, "m/s", repair="leave it out"))
    return faults

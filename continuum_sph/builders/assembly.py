"""What a scene is built into: a system that advances in time, and the parts that record it."""

from dataclasses import dataclass
from typing import Any, Protocol

from porescale.common.record.part import Part


class System(Protocol):
    """What moves in steps of its own choice: `water.step.Flow`, `soil.SoilFlow` or `seepage.Seepage`."""

    @property
    def step(self) -> int:
        """Number of steps done since time 0."""

    @property
    def time(self) -> float:
        """Time reached, in seconds."""

    @property
    def next_step(self) -> float:
        """Length of the next step, s."""

    def advance(self) -> None:
        """Advance the state by one time step."""


@dataclass
class Assembly:
    """flow : what moves (`System`);  parts : what it consists of, in the order of their columns;  repair : what helps
    when it is unstable."""

    flow: Any
    parts: list[Part]
    repair: str

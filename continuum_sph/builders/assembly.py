"""What a scene is built into: a system that advances in time, and the parts that record it."""

from dataclasses import dataclass
from typing import Protocol

from porescale.common.core.types import Floats
from porescale.common.record.model import Cloud
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


class Particles(Protocol):
    """The part whose particles a snapshot shows as the cloud "particles"."""

    def cloud(self) -> Cloud:
        """The particles with all their arrays; copies."""

    def motion(self) -> tuple[Floats, Floats]:
        """Positions (n, 2) m and velocities (n, 2) m/s in the order of the cloud, as they lie in memory or copies."""

    def masses(self) -> Floats:
        """Masses in the order of the cloud, (n,) kg/m, as they lie in memory or copies."""


@dataclass
class Assembly:
    """flow : what moves (`System`);  parts : what it consists of, in the order of their columns;  shown : that of them
    whose particles are seen;  repair : what helps when it is unstable."""

    flow: System
    parts: list[Part]
    shown: Particles
    repair: str

"""What a scene is at time 0, before parts are made of it: fluid, grains, and what is in both."""

from dataclasses import dataclass, field
from typing import TypeVar

from porescale.builders.derive import Derived
from porescale.builders.initial.frames import Placed
from porescale.builders.stepper import Clock
from porescale.common.core.types import AnyArray
from porescale.common.record.part import Part
from porescale.coupling.coverage.rectangle import Rectangle
from porescale.coupling.step import Coupled
from porescale.dem.grains import Grains
from porescale.lbm.fluid import Fluid
from porescale.scene.scene import Scene

P = TypeVar("P", bound=Part)


@dataclass
class System:
    """None, or empty, where the scene has no such thing.

    weight : (n, 2) N/m, of dry grains;  frames : bodies of segments, those of the grains, a rock's last;
    recorded : names of the bodies whose motion is recorded;  rectangles : as the lattice has them;  parts : what was
    made of it so far, the stepper first.
    """

    scene: Scene
    derived: Derived
    clock: Clock
    fluid: Fluid | None = None
    grains: Grains | None = None
    coupled: Coupled | None = None
    weight: AnyArray | None = None
    frames: list[Placed] = field(default_factory=list)
    recorded: list[str] = field(default_factory=list)
    rectangles: list[Rectangle] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)

    @property
    def held(self) -> int:
        """Number of discs that are held."""
        return len(self.scene.disc)

    def part(self, kind: type[P]) -> P:
        """The part of this class, made before."""
        return next(part for part in self.parts if isinstance(part, kind))

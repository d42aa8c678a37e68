"""Held discs that move by functions of time."""

from porescale.builders.initial.frames import disc_count
from porescale.builders.system import System
from porescale.common.record.part import Part


class DiscsPart(Part):
    """Gives held discs, before each step, the velocity and spin that take them through it.

    The mean over the step, so that a disc is where its function says to the round-off of a sum; where it is, and all
    else, is in the state of the grains.
    """

    def __init__(self, system: System) -> None:
        assert system.grains
        self.clock, self.discs = system.clock, system.grains.discs
        first = disc_count(system.grains) - system.held
        self.moved = [(first + k, it) for k, it in enumerate(system.scene.disc) if it.timed]

    def before(self) -> None:
        """Set what moves them through the next step."""
        step, seconds, d = self.clock.step, self.clock.seconds, self.discs
        for row, section in self.moved:
            here, there = section.travelled(step * seconds), section.travelled((step + 1) * seconds)
            d.velocity[row, 0], d.velocity[row, 1] = (there[0] - here[0]) / seconds, (there[1] - here[1]) / seconds
            d.spin[row] = (there[2] - here[2]) / seconds

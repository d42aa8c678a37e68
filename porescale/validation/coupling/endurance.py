"""Validations of long runs, in short: what `study endurance` does for a million steps."""

from dataclasses import replace

from porescale.benchmarks.endurance import ENDURANCES
from porescale.common.evidence.endurance import Endurance, Line, endure
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()

TINY = 1e-300
"""Tolerance where the reference is zero, so that any value other than zero exceeds it."""
SHORT = 20_000
DOWN = 60_000
"""Steps; the heap has come down by the 12th of 20 marks, 36 000 steps."""


def share(lines: list[Line]) -> Measured:
    """How much of what is allowed each quantity is off by; the largest is the error."""
    shares = [0.0 if line.off == 0.0 else line.off / max(line.allowed, TINY) for line in lines]
    return Measured.absolute([0.0] * len(shares), shares)


def settled(it: Endurance) -> Endurance:
    """The same, counted from where the heap has come down in a run of ``DOWN`` steps."""
    return replace(it, settles=12, share=1.0)


@VALIDATIONS.row(
    "coupling.long_run_of_flying_grains",
    source="mass and Newton's third law; nothing is kept from step to step",
    because="shares of what is allowed: 1e-12 of the mass, 5 eps a step of momentum, nothing found wrong, 1 MiB",
    tolerance=1.0,
    slow=True,
)
def flying() -> Measured:
    """Mass, momentum x and y, faults, memory: six grains collide in a periodic box of water for 20 000 steps."""
    return share(endure(ENDURANCES["flying grains"], SHORT))


@VALIDATIONS.row(
    "coupling.settled_heap_under_water_stays",
    source="statics: grains at rest in still water stay",
    because="shares of what is allowed: 1e-12 of the mass, 1e-3 diameters, 1e-6 cells a step, no fault, 1 MiB",
    tolerance=1.0,
    slow=True,
)
def heap_stays() -> Measured:
    """Mass, mean place, height, highest grain, fastest grain, faults, memory: fifteen grains for 60 000 steps."""
    return share(endure(settled(ENDURANCES["settled heap"]), DOWN))


@VALIDATIONS.row(
    "coupling.sleeping_heap_under_water_stays",
    source="statics: the same heap, whose grains may sleep",
    because="shares of what is allowed: 1e-12 of the mass, no place changed, nobody woken, nothing found wrong, 1 MiB",
    tolerance=1.0,
    slow=True,
)
def sleeping_heap_stays() -> Measured:
    """Mass, number asleep, mean place, height, highest, fastest grain, faults, memory: 60 000 steps."""
    return share(endure(settled(ENDURANCES["sleeping heap"]), DOWN))

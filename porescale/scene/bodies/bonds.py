"""[[bonds]]: bonds between bodies that touch at a time."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity

KINDS = ("grain", "clump", "segment", "polygon", "container", "rock", "plate")
"""Kinds of bodies, in the order of the numbers that the cloud of bonds has for them."""


class Bonds(Section):
    """Bonds between bodies that touch at a time: the force of each contact is cancelled from then on, until it is gone.

    A bond breaks in tension at k d0, with d0 the overlap when it was made.  ``factor`` makes bonds stronger than that,
    or weaker, and what stood at rest then moves; ``tension`` gives it by the mean back tension.  Never with walls.
    """

    at: float = quantity("s", 0.0, ge=0, le=1e9, help="time at which they are made")
    bodies: tuple[str, ...] = pydantic.Field(
        (), description='which: "polygon" for all of them, "clump 3" for one, numbers from 0 (default: all bodies)'
    )
    within: tuple[float, float, float, float] | None = quantity(
        "m", None, ge=-1e3, le=1e3, help="rectangle with the centres of the bodies, [left, bottom, right, top]"
    )
    factor: float = quantity("", 1.0, gt=0, le=1e6, help="back tension over the force of the contact at the time")
    tension: float | None = quantity("N/m", None, gt=0, le=1e12, help="mean back tension, instead of factor")
    known: tuple[tuple[int, int, int, float], ...] = pydantic.Field(
        (), description="bonds by number, not of contacts: disc (or corner), disc or segment, 1 of a segment, N/m"
    )

    def _faults(self) -> list[Fault]:
        faults = []
        for k, word in enumerate(self.bodies):
            kind, _, number = word.partition(" ")
            if kind not in KINDS or (number and not (number.isdecimal() and len(number) < 10)):
                allowed = ", ".join(KINDS)
                faults.append(Fault(f"bodies[{k}]", word, "names no body", "", allowed, 'write "grain", or "grain 3"'))
        if self.within and not (self.within[0] < self.within[2] and self.within[1] < self.within[3]):
            faults.append(Fault("within", None, "must be [left, bottom, right, top]", "m", repair="order them"))
        if self.known and (self.bodies or self.within or self.tension or self.factor != 1.0):
            faults.append(Fault("known", None, "says all there is to say", repair="leave the other keys out"))
        if self.tension is not None and self.factor != 1.0:
            faults.append(
                Fault("tension", self.tension, "says nothing beside factor", "N/m", repair="give one of them")
            )
        return faults

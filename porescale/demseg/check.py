"""What no run can begin with, of the bodies of a deck: one line for each, with file, line and numbers of the deck.

Bodies of segments touch a side of the domain with their corners, which then lie beyond it where thick is 0, and a body
that rests on its side lies beyond it as a whole by what it presses in.  So a segment is refused where its middle lies
outside by more than SUNK of the body's size; sides push back all that is behind them, and would throw such a body.

A run that goes on (jclid 1) is not checked: its bodies are where the run before has left them.
"""

from collections.abc import Iterator

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.bodies.frames import joined
from porescale.demseg.deck import Deck

SUNK = 0.1
"""Most that the middle of a segment may lie beyond a side, over the size of its body."""


def check_bodies(deck: Deck) -> None:
    """Raise InputError for segments outside of the domain or given twice, discs of a clump that nothing can touch, and
    discs of two bodies in one place."""
    faults = [*_places_taken(deck)]
    for number, body in enumerate(deck.bodies):
        if len(body.discs) > 1:
            faults += _hidden(deck, number)
        if body.segments:
            faults += _twice(deck, number)
            faults += () if body.long else _outside(deck, number)
    if faults:
        raise InputError(faults)


def _outside(deck: Deck, number: int) -> Iterator[Fault]:
    """Segments of a body that lie beyond a side, see module."""
    ends = np.array(deck.bodies[number].segments).reshape(-1, 2, 2)
    size = float(np.ptp(ends.reshape(-1, 2), axis=0).max())
    (x1, x2, y1, y2), middle = deck.domain, ends.mean(axis=1)
    low, high = np.array([x1, y1]), np.array([x2, y2])
    beyond = np.maximum(low - middle, middle - high) > SUNK * size
    for k in np.flatnonzero(beyond.any(axis=1)).tolist():
        x, y = middle[k].tolist()
        where = f"({x:g}, {y:g}), the middle of this segment, lies outside the domain, whose sides would throw it"
        yield deck.fault(number, where, f"move it inside: x {x1:g} to {x2:g}, y {y1:g} to {y2:g}", k)


def _twice(deck: Deck, number: int) -> Iterator[Fault]:
    """Segments of a body between the same ends as one before."""
    _, ends = joined(np.array(deck.bodies[number].segments).reshape(-1, 2, 2))
    first: dict[frozenset[int], int] = {}
    for k, pair in enumerate(ends):
        before = first.setdefault(frozenset(pair), k)
        if before != k:
            yield deck.fault(number, f"has the ends of element {before + 1}", "leave it out", k)


def _hidden(deck: Deck, number: int) -> Iterator[Fault]:
    """Discs of a clump that lie within another, or are one of them again."""
    rows = np.array(deck.bodies[number].discs)
    radius, at = rows[:, 0], rows[:, 1:3]
    for k in range(len(rows)):
        within = np.hypot(*(at - at[k]).T) + radius[k] <= radius
        within[k] = False
        within[k + 1 :] &= radius[k + 1 :] > radius[k]  # of two that are equal the later one is too many
        if within.any():
            problem = f"lies within element {int(within.argmax()) + 1}, so nothing can touch it"
            yield deck.fault(number, problem, "leave it out", k)


def _places_taken(deck: Deck) -> Iterator[Fault]:
    """Discs that have their centre where a disc of another body has it: no direction would part them."""
    body = np.repeat(np.arange(len(deck.bodies)), [len(each.discs) for each in deck.bodies])
    if not len(body):
        return
    at: Floats = np.array([disc[1:3] for each in deck.bodies for disc in each.discs])
    _, first, same = np.unique(at, axis=0, return_index=True, return_inverse=True)
    for k, before in enumerate(first[same.reshape(-1)].tolist()):
        if body[before] != body[k]:
            x, y = at[k].tolist()
            problem = f"has its centre ({x:g}, {y:g}) where body {body[before] + 1} has one: no direction parts them"
            element = int(np.count_nonzero(body[:k] == body[k]))
            yield deck.fault(int(body[k]), problem, "move one of them", element)

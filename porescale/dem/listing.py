"""The pair list of a system of grains, and the candidates of its segments: brought up to date where they are due."""

from porescale.common.core.errors import Fault, InputError
from porescale.common.neighbors.pair_list import PairList
from porescale.dem.contact.law import springs_of
from porescale.dem.finite import check_finite
from porescale.dem.state import State


def current_pairs(grains: State) -> PairList:
    """The pair list, rebuilt first if it is due, as the next step would; fetch its arrays anew after each step."""
    if grains.stale:
        rebuild(grains)
    return grains.pairs


def refresh(grains: State, anew: bool = False) -> None:
    """Bring the pair list up to date after discs were moved or resized by hand;  anew: build it in any case."""
    grains.plates_checked = False
    rebuild(grains, anew)


def list_up_to(grains: State, gap: float) -> None:
    """List all pairs with a gap below ``gap`` (m) from now on, not only those that touch.

    Raises InputError when the periodic box is too small for that, or the gap negative.
    """
    if not gap >= 0.0:
        raise InputError(Fault("gap", gap, "of listed pairs", "m", ">= 0"))
    grains.reach = grains.discs.radius + 0.5 * gap
    rebuild(grains)


def rebuild(grains: State, anew: bool = False) -> None:
    """Update the pair list, or build it ``anew``, and then the segments'.  Raises Unstable at a number that is none."""
    check_finite(grains)
    d = grains.discs
    reach = d.radius if grains.reach is None else grains.reach
    if grains.drivers is not None and grains.drivers.cell is not None:
        grains.drivers.listed(grains.pairs, reach)
        anew = True  # the list compares with where points were, not with where the strain has carried them
    if anew:
        grains.pairs.build(d.position, reach)
    else:
        grains.pairs.update(d.position, reach)
    if grains.segments is not None:
        grains.segments.update(d, springs_of(grains.contact), grains.pairs.builds)
    grains.stale, grains.static = False, None

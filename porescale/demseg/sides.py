"""Corners at the sides of the domain where every segment counts for itself (rules "each" and "printed").

A side touches a segment at its ends.  A corner at which two segments end, as those of polygons, touches it with both:
two equal contacts in one place, which are one of twice the stiffness and twice the dashpot; friction, a share of the
normal force, doubles with it.  Source: Matsushima, DEMseg tutorial II-2 (corners of polygons are twice as stiff).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from porescale.dem.bodies.frames import Frame
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Materials

SIDES = "sides"


def at_sides(law: Linear | Materials, frames: Sequence[Frame]) -> tuple[Materials, list[NDArray[np.int64]]]:
    """The materials with one more for each that has corners of several segments, and the numbers of the materials of
    all corners of each frame.

    The new ones are as the old between bodies.  The sides of the domain are of a material of their own: the first.
    """
    known = law if isinstance(law, Materials) else Materials({"1": law})
    count = [np.bincount(np.array(frame.ends).ravel(), minlength=len(frame.corners)) for frame in frames]
    met = sorted({(frame.material, int(c)) for frame, ends in zip(frames, count, strict=True) for c in ends if c > 1})
    base = dict(enumerate(known.names))
    name = {(material, c): f"{base[material]} of {c}" for material, c in met}
    made: dict[str, ContactLaw] = {**known.laws, **{each: known.laws[base[m]] for (m, _), each in name.items()}}
    like = {**{each: (each, 1) for each in known.names}, **{each: (base[m], c) for (m, c), each in name.items()}}
    made[SIDES] = known.laws[known.wall]
    between: dict[tuple[str, str], ContactLaw] = {}
    for one, (first, times) in like.items():
        between[SIDES, one] = _times(known.law(known.wall, first), times)
        between |= {(one, other): known.law(first, second) for other, (second, _) in like.items()}
    number = {each: k for k, each in enumerate(made)}
    own = [
        np.array([number[name.get((frame.material, int(c)), base[frame.material])] for c in ends])
        for frame, ends in zip(frames, count, strict=True)
    ]
    return Materials(made, between, SIDES), own


def _times(law: ContactLaw, count: int) -> ContactLaw:
    """The law of ``count`` equal contacts in one place."""
    assert isinstance(law, Linear)
    return replace(
        law,
        stiffness=count * law.stiffness,
        damping=count * law.damping,
        tangential_stiffness=count * law.tangential_stiffness,
        tangential_damping=count * law.tangential_damping,
    )

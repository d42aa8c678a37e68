"""A packing of discs made into polygons that fill its domain, as volonoi.f does: Voronoi cells, or Delaunay triangles.

The centres of the discs are the seeds; they are mirrored beyond the sides, so that the cells end there, and triangles
have corners on the sides (dem/prepare/tessellate.py).  All polygons are ``thick`` apart, as the deck has it.  In DEMseg
two segments touch where they are ``thick`` apart, and thick is raised for bonding, 0.1 to 0.108 in II-4: overlaps of
0.008.  Here thick belongs to each of two segments, as it does to one beside a disc in I-7, so the polygons get half of
what it is there: they touch, and overlap by ``pressed``.  Source: Matsushima, DEMseg tutorial II-4.2.
"""

from dataclasses import replace

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.prepare.tessellate import delaunay, shrunk, voronoi
from porescale.demseg.deck import Body, Deck

FILES = {"triangles": "in_gm_tri.dat", "cells": "in_gm_volo.dat"}
REST = (0.0, 0.0, 0.0)


def divided(deck: Deck, kind: str, pressed: float = 0.0) -> Deck:
    """The deck with polygons of a ``kind`` of FILES in place of its discs, at rest, that overlap by ``pressed``.

    Polygons have the material of the disc nearest to their middle; sides shorter than thick are left out, and what is
    smaller than that.  Raises InputError where the deck has other bodies than single discs, no thick, or too few discs.
    """
    odd = [k for k, body in enumerate(deck.bodies) if len(body.discs) != 1]
    if odd:
        problem = "is no single disc, whose centre could be a seed"
        raise InputError(deck.fault(odd[0], problem, "leave out clumps and segments"))
    if not deck.thick > 0.0:
        raise InputError(
            Fault("thick", deck.thick, "is the distance between polygons", allowed="> 0", file=str(deck.file))
        )
    if not 0.0 <= pressed < deck.thick:
        raise InputError(Fault("--pressed", pressed, "is out of range", allowed=f"0 to thick = {deck.thick:g}"))
    at = np.array([body.discs[0][1:3] for body in deck.bodies])
    x1, x2, y1, y2 = deck.domain
    try:
        parts = (delaunay if kind == "triangles" else voronoi)(at, (x1, y1), (x2, y2))
    except InputError as error:
        raise error.in_file(f"{deck.file}, centres of discs") from None
    inner = [shrunk(part, 0.5 * deck.thick, shortest=deck.thick) for part in parts]
    bodies = tuple(Body(_material(deck, at, it), REST, segments=_sides(it)) for it in inner if it is not None)
    if not bodies:
        raise InputError(Fault("thick", deck.thick, "leaves nothing of any polygon", file=str(deck.file)))
    return replace(deck, bodies=bodies, lines=(), random=None, thick=0.5 * (deck.thick + pressed))


def _material(deck: Deck, at: Floats, corners: Floats) -> int:
    """Material of the disc nearest to the middle of a polygon."""
    return deck.bodies[int(np.argmin(np.sum((at - corners.mean(axis=0)) ** 2, axis=1)))].material


def _sides(corners: Floats) -> tuple[tuple[float, float, float, float], ...]:
    """The segments from corner to corner, and back to the first."""
    points = corners.tolist()
    return tuple((*one, *other) for one, other in zip(points, [*points[1:], points[0]], strict=True))

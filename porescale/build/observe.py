"""What a collapse is measured by: front, run-out, centre of mass, surface, energies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.build.frame_build import Placed, free_rows
from porescale.build.frame_measures import coordination_of_bodies
from porescale.dem.discs import FIELDS, Discs
from porescale.dem.grains import Grains
from porescale.dem.measures.survey import centre_of_mass, coordination, kinetic_energy, max_overlap
from porescale.lbm.fields import stream_function
from porescale.lbm.fluid import Fluid
from porescale.lbm.scales import Scales
from porescale.scene.sections import Scene

Array = NDArray[np.floating]


class Watch:
    """Follows the grains from where they start.

    The front is the foremost edge of any grain on the side to which the packing can flow: left if it starts right of
    the middle of the box, right otherwise.  Run-out is how far the front has come since the start.  Discs that are held
    come after the grains and are none of them, nor are frames that move as told (``placed``).
    """

    def __init__(self, scene: Scene, grains: Grains, placed: Sequence[Placed] = ()) -> None:
        self.held, self.placed = len(scene.disc), placed
        held = self.held
        self.rows: slice | NDArray[np.int64] = slice(grains.discs.count - held)
        if placed:
            self.rows = free_rows(grains, placed, held)
        middle = 0.5 * scene.domain.width
        self.leftward = bool(centre_of_mass(self.free(grains))[0] > middle)
        self.start = self.front(grains)

    def free(self, grains: Grains) -> Discs:
        """The grains without the discs that are held; views where there are no frames."""
        return Discs(*(getattr(grains.discs, name)[self.rows] for name in FIELDS))

    def front(self, grains: Grains) -> float:
        """Position of the front, m."""
        x, r = grains.discs.position[self.rows, 0], grains.discs.radius[self.rows]
        return float((x - r).min() if self.leftward else (x + r).max())

    def row(self, grains: Grains) -> dict[str, float]:
        """Columns of the series."""
        discs, front = self.free(grains), self.front(grains)
        x, y = centre_of_mass(discs)
        return {
            "front (m)": front,
            "run-out (m)": self.start - front if self.leftward else front - self.start,
            "centre of mass x (m)": float(x),
            "centre of mass y (m)": float(y),
            "highest grain (m)": float((discs.position[:, 1] + discs.radius).max()),
            "kinetic energy of grains (J/m)": kinetic_energy(discs),
            "largest grain speed (m/s)": float(np.hypot(*discs.velocity.T).max()),
            "largest overlap over diameter ()": 0.5 * max_overlap(grains).share,
            "coordination number ()": self.coordination(grains),
        }

    def coordination(self, grains: Grains) -> float:
        """Mean number of other bodies that touch one."""
        if not self.placed:
            return coordination(grains)
        return coordination_of_bodies(grains, self.placed, self.held)

    def state(self) -> dict[str, Any]:
        """Where the front started."""
        return {"start": self.start, "leftward": self.leftward}

    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state."""
        self.start, self.leftward = float(state["start"]), bool(state["leftward"])


def fluid_row(excess: Array, ux: Array, uy: Array, solid: Array, scales: Scales | None) -> dict[str, float]:
    """Columns of the series for the fluid between the grains; arrays (ny, nx), SI."""
    assert scales
    square = ux**2 + uy**2
    energy = 0.5 * float(np.sum((scales.density + excess) * square * (1 - solid))) * scales.spacing**2
    return {
        "kinetic energy of fluid (J/m)": energy,
        "largest fluid speed (m/s)": float(np.sqrt(square.max())),
        "Mach number ()": float(np.sqrt(square.max())) / scales.sound_speed,
        "lowest relative density ()": 1 + float(excess.min()) / scales.density,
        "highest relative density ()": 1 + float(excess.max()) / scales.density,
    }


UNITS = {"vorticity": "1/s", "stream_function": "m²/s"}
"""Fields that a scene may ask for besides velocity and pressure, and their units."""


def derived_fields(
    names: Sequence[str], fluid: Fluid, ux: Array, uy: Array, scales: Scales
) -> dict[str, NDArray[np.float32]]:
    """Fields called ``names`` in the centres of cells, (ny, nx), of a velocity (ny, nx) m/s of ``fluid``.

    The stream function is the mean of the four corners of a cell (lbm/fields.py).
    """
    fields = {}
    if "vorticity" in names:
        fields["vorticity"] = vorticity(ux, uy, scales.spacing).astype(np.float32)
    if "stream_function" in names:
        psi = stream_function(fluid, ux / scales.velocity, uy / scales.velocity)
        centres = 0.25 * (psi[1:, 1:] + psi[1:, :-1] + psi[:-1, 1:] + psi[:-1, :-1])
        fields["stream_function"] = (centres * scales.velocity * scales.spacing).astype(np.float32)
    return fields


def vorticity(ux: Array, uy: Array, spacing: float) -> Array:
    """dv/dx - du/dy in every cell, (ny, nx) 1/s: central differences, one-sided at the sides."""
    along: Array = np.gradient(uy, spacing, axis=1)
    up: Array = np.gradient(ux, spacing, axis=0)
    return along - up


def surface(position: Array, radius: Array, edges: Array) -> Array:
    """Height of the pile's surface in bins between ``edges`` (b + 1,) m: top of the highest disc reaching in, (b,) m.

    Discs are taken at their true shape: over a bin, the highest point of the disc within it.
    """
    height = np.zeros(len(edges) - 1)
    for (x, y), r in zip(position, radius, strict=True):
        first = max(int(np.searchsorted(edges, x - r, side="right")) - 1, 0)
        last = min(int(np.searchsorted(edges, x + r, side="left")), len(height))
        for b in range(first, last):
            off = min(max(x, edges[b]), edges[b + 1]) - x
            height[b] = max(height[b], y + np.sqrt(max(r * r - off * off, 0.0)))
    return height

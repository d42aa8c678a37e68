"""Squeeze films too thin for the lattice: a normal force between discs, and between discs and walls.

Two cylinders that close at V_n over a gap g << R* = R1 R2/(R1 + R2) (a wall: R* = R) resist with
3 sqrt(2) pi mu (R*/g)^(3/2) V_n per metre of depth (Jeffrey & Onishi 1981; the limit of 4 pi mu V/(alpha - tanh alpha),
alpha = arccosh(1 + g/R), as alpha goes to 0).  The lattice bears the film of a gap g + d: it feels thin films as wider
by a share of a cell, and discs cover cells with the radius R + A/R, so that their gap there is narrower by
A (1/R1 + 1/R2) = A/R*.  What it lacks,

    d = (D h - A/R*)(1 - g/3h)^p, not below D h - g,      D, p: 0.37, 1 between discs, 0.48, 3 at a wall,
    dF = -3 sqrt(2) pi mu ((R*/g)^(3/2) - (R*/(g + d))^(3/2)) V_n,     0 < g < g_c,

is added here;  A: 1.5 h² times the magic parameter (solid/exact_wall.py).  D and p were measured with exact walls, on
discs 8 to 30 cells wide that close on each other at random angles and places, and 8 to 20 cells wide on a wall, which
is two outlines that end within cells, and one;  A/R* is derived.  Outlines that meet in the lattice, g < A/R*, leave a
tenth of the cells open that they share (coverage/shared.py): it bears the film of D h still.  The mean of force and
correction over angles and places is within 5 % of the exact force, at tau 0.6 to 1, too.  It acts in the contact steps
dt, velocities half a step back: stable for six films around the lighter disc (of mass m), each against a neighbour as
light, if C dt <= m/3 (integrate.packing_factor with a damping alone: 2 * 3 C/m <= 2/dt;  C is at most that of the whole
film), which sets the thinnest film

    g_min = R* (9 sqrt(2) pi mu dt/m)^(2/3);     thinner ones count as g_min, touching ones as none.

The gap is that between the hydraulic radii, or else that between the mechanical ones; never both.
"""

import math
from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors.cells import minimum_image
from porescale.dem.forces.walls import HIGH, LOW, PRESENT, X
from porescale.dem.grains import Grains

CELLS = 3.0
"""Gap in cells below which the correction acts, unless less is given: from there on the lattice lacks nothing."""
FILM = 3 * math.sqrt(2) * math.pi
"""Force over mu V_n (R*/g)^(3/2)."""


BETWEEN_DISCS, AT_A_WALL = (0.37, 1), (0.48, 3)
"""D, cells by which the thinnest films are wider to the lattice than between the outlines that it has, and p."""


class FilmLaw(NamedTuple):
    """viscosity : dynamic, Pa s;  spacing : h, m;  cut : g_c, m, at most 3 h: beyond nothing is added;  dt : contact
    step, s;  shift : A, m²: the radius that a disc covers cells with is larger by A over it."""

    viscosity: float
    spacing: float
    cut: float
    dt: float
    shift: float


@inline
def wider(gap, radius, measured, law):
    """By how much (m) the ``gap`` (m) of the film that the lattice bears is wider; 0 at 3 h.  See ``film``."""
    cells, power = measured
    lacks = cells * law.spacing
    return max(lacks - gap, max(0.0, lacks - law.shift / radius) * (1.0 - gap / (CELLS * law.spacing)) ** power)


@inline
def film(gap, radius, mass, measured, law):
    """Force over closing speed, N s/m², of a film ``gap`` thick (m) between surfaces of reduced ``radius`` (m).

    mass kg/m: of the lighter;  measured: ``BETWEEN_DISCS`` or ``AT_A_WALL``;  law: ``FilmLaw``.
    """
    if not 0.0 < gap < law.cut:
        return 0.0
    thinnest = radius * (3.0 * FILM * law.viscosity * law.dt / mass) ** (2.0 / 3.0)
    thick = max(gap, thinnest)
    whole, borne = radius / thick, radius / (thick + wider(thick, radius, measured, law))
    return FILM * law.viscosity * (whole * np.sqrt(whole) - borne * np.sqrt(borne))


@inline
def parted(x, y, dx, dy, plates):
    """Whether a plate stands between (x, y) and the point (dx, dy) from there, m."""
    for w in range(plates.shape[0]):
        along = plates[w, X] - x
        if plates[w, PRESENT] != 0.0 and along * (along - dx) < 0.0:
            height = y + dy * along / dx
            if plates[w, LOW] < height < plates[w, HIGH]:
                return True
    return False


@kernel
def add_films(position, velocity, radius, mass, start, partner, period, walls, plates, law, force):
    """Add the forces of all films to force (n, 2) N/m.

    position, velocity (n, 2) m, m/s;  radius (n,) m: those between which the gap lies;  mass (n,) kg/m;
    start (n + 1,), partner: half list in CSR of all pairs with a gap below ``cut`` (m);  period (2,) m, 0: none;
    walls (w, 4): a point and the normal into the domain;  plates (p, 5), see ``Plate.row``: no film acts through them;
    law: ``FilmLaw``.  Not checked: that centres differ.
    """
    period_x, period_y = period
    cut = law.cut
    for i in range(radius.shape[0]):
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            dx = minimum_image(position[j, 0] - position[i, 0], period_x)
            dy = minimum_image(position[j, 1] - position[i, 1], period_y)
            reach = radius[i] + radius[j]
            square = dx * dx + dy * dy
            near = reach * reach < square < (reach + cut) * (reach + cut)
            if near and not parted(position[i, 0], position[i, 1], dx, dy, plates):
                distance = np.sqrt(square)
                nx, ny = dx / distance, dy / distance
                closing = (velocity[i, 0] - velocity[j, 0]) * nx + (velocity[i, 1] - velocity[j, 1]) * ny
                lighter = min(mass[i], mass[j])
                reduced = radius[i] * radius[j] / reach
                push = closing * film(distance - reach, reduced, lighter, BETWEEN_DISCS, law)
                force[i, 0] -= push * nx
                force[i, 1] -= push * ny
                force[j, 0] += push * nx
                force[j, 1] += push * ny
        for w in range(walls.shape[0]):
            nx, ny = walls[w, 2], walls[w, 3]
            gap = (position[i, 0] - walls[w, 0]) * nx + (position[i, 1] - walls[w, 1]) * ny - radius[i]
            if 0.0 < gap < cut:
                leaving = velocity[i, 0] * nx + velocity[i, 1] * ny
                push = -leaving * film(gap, radius[i], mass[i], AT_A_WALL, law)
                force[i, 0] += push * nx
                force[i, 1] += push * ny


class Lubrication:
    """The films of a system of grains.

    radius (n,) m: those between which gaps lie;  viscosity, spacing, cut, dt, shift: as ``FilmLaw`` has them.
    force (n, 2) N/m: of the films on each disc, mean over the last call of ``step``.
    walls: those at which there are films, all of the grains' unless their owner sets others.

    Raises InputError when the contact step allows no film thinner than ``cut``.
    """

    def __init__(
        self, grains: Grains, radius: Floats, *, viscosity: float, spacing: float, cut: float, dt: float, shift: float
    ) -> None:
        cut = min(cut, CELLS * spacing)
        self.radius, self.viscosity, self.cut, self.dt = radius, viscosity, cut, dt
        self._law = FilmLaw(viscosity, spacing, cut, dt, shift)
        discs = grains.discs
        thinnest = self.thinnest(radius, discs.mass)  # at a wall, the largest R*
        worst = int(thinnest.argmax()) if discs.count else 0
        if discs.count and thinnest[worst] >= cut:
            raise InputError(
                Fault("lubrication", cut, f"the film of grain {worst} would be unstable", "m",
                      f"> {thinnest[worst]:.3g}", "take more contact steps, or leave it out")
            )  # fmt: skip
        # The list has mechanical radii: gaps between smaller ones are wider by what they lack.
        less = float((discs.radius - radius).min()) if discs.count else 0.0
        grains.list_up_to(max(0.0, cut - 2 * less))
        self.force, self._sum = np.zeros((discs.count, 2)), np.zeros((discs.count, 2))
        self.walls = grains.walls
        self._total, self._means = np.zeros((discs.count, 2)), list[Floats]()

    def thinnest(self, reduced_radius: Floats, mass: Floats) -> Floats:
        """g_min, m, of films with ``reduced_radius`` (m) whose lighter disc has ``mass`` (kg/m)."""
        return np.asarray(reduced_radius * (3 * FILM * self.viscosity * self.dt / mass) ** (2 / 3))

    def step(self, grains: Grains, force: Floats, torque: Floats, count: int) -> None:
        """``count`` contact steps with force (n, 2) N/m and torque (n,) N m/m held and films as they are in each."""
        d = grains.discs
        self._sum[:] = 0.0
        means = grains.means()
        if [it.shape for it in self._means] != [it.shape for it in means]:
            self._means = [np.zeros_like(it) for it in means]
        for it in self._means:
            it[:] = 0.0
        for _ in range(count):
            pairs = grains.current_pairs()
            self._total[:] = force
            add_films(
                d.position, d.velocity, self.radius, d.mass, pairs.start, pairs.partner, grains.box.period,
                self.walls, grains.plates, self._law, self._total,
            )  # fmt: skip
            np.add(self._sum, self._total, out=self._sum)
            grains.step(self.dt, self._total, torque)
            for it, of_step in zip(self._means, means, strict=True):
                np.add(it, of_step, out=it)
        np.divide(self._sum, count, out=self._sum)
        np.subtract(self._sum, force, out=self.force)
        for it, of_call in zip(self._means, means, strict=True):
            np.divide(it, count, out=of_call)

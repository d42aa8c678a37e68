"""Settled packings: discs placed without overlap, dropped behind walls and plates until they rest.

Settling is a means, not a simulation: it uses a stiff, well damped law of its own and a background drag
-gamma m v, both stated here and gone afterwards.  ``relax`` then finds the equilibrium under the law and
weights of the run, so that nothing jumps at its first step.
"""

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from porescale.common.core.constants import EDGE, GRAVITY
from porescale.common.core.errors import Fault, InputError, PorescaleError
from porescale.common.core.types import Floats
from porescale.common.neighbors.placement import Placement, place
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.walls import HIGH, LOW, VELOCITY, Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.measures.survey import kinetic_energy, max_overlap, unbalanced
from porescale.dem.prepare.obstacles import NOTHING, Obstacles
from porescale.dem.prepare.on_disk import once
from porescale.dem.timestep import stable_step

OVERLAP = 1e-3  # of a diameter: deepest overlap left by settling, so that the geometry is that of hard discs
SOFTER = 16.0  # grains fall this much softer first, with steps 4 times as long, and then stiffen in place
RESTITUTION = 0.5  # of the settling law: damps a bounce in a few impacts; less would shorten the stable step
SHEAR = 0.25  # tangential over normal stiffness of the settling law: more would make rotation the stiffest
CHAIN = 4.0  # strongest contact force over the weight of discs above a diameter of width (measured: 3 to 4)
DRAG = 0.3  # background damping in sqrt(g/d): grains fall at a few times their free-fall speed over d
ENERGY = 1e-8  # kinetic energy per grain over m g d that counts as rest
BALANCE = 3e-3  # mean net force over mean weight that counts as rest
CHUNK = 500  # steps between checks
PATIENCE = 400  # chunks of steps that suit the mean grain, before settling gives up; more of shorter ones
HIGHER, ROUGHLY = 50, 0.05
"""Times that a rectangle is made higher for what stands in it, and by how many diameters at least."""
WEDGED = ": gaps beside what stands there that are about as wide as a grain wedge some, so widen or close them"
"""What is said where grains do not come to rest among obstacles."""
LOOSER = (1.0, 0.9, 0.8, 0.7)
"""Of the fraction of a pile, at which it is placed among obstacles: pores at their rims are wide."""


@dataclass(frozen=True)
class Pile:
    """What is dropped: ``count`` discs of mean ``diameter`` (m) (1 ± spread) and ``density`` (kg/m^3).

    They are placed from ``corner`` (m) upwards over ``width`` (m) at ``fraction`` of area, with ``seed``,
    and settle under ``gravity`` (m/s^2) with ``friction``: little of it packs densely, much of it loosely.
    rolling : friction of rolling while they settle, which packs more loosely than friction alone can.
    given : radii (count,) m instead of those that diameter and spread say; diameter is their mean then.
    around : what stands where they settle;  ceiling : m, above which none is placed among it.
    """

    corner: tuple[float, float]
    width: float
    count: int
    diameter: float
    density: float
    spread: float = 0.1
    friction: float = 0.3
    fraction: float = 0.75
    seed: int = 0
    gravity: float = GRAVITY
    given: tuple[float, ...] = ()
    rolling: float = 0.0
    around: Obstacles = NOTHING
    ceiling: float = math.inf

    def top(self) -> float:
        """Upper edge of the rectangle in which discs are placed, m: the area that obstacles leave of it has room."""
        area = self.count * math.pi / 4.0 * self.diameter**2 * (1.0 + self.spread**2 / 3.0)
        if self.given:
            area = math.pi * math.fsum(r * r for r in self.given)
        # One diameter more: a short rectangle loses a strip of pores along each wall.
        low = self.corner[1] + self.diameter
        top = low + area / (self.fraction * self.width)
        for _ in range(HIGHER if self.around else 0):
            right = self.corner[0] + self.width
            higher = low + (area / self.fraction + self.around.area(self.corner, (right, top))) / self.width
            if higher - top < ROUGHLY * self.diameter:
                break
            top = higher
        return top

    def discs(self) -> Discs:
        """The discs as placed, at rest, numbered column by column so that neighbours lie close in memory."""
        placed = self._among() if self.around else self._placed()
        columns = np.floor(placed.position[:, 0] / (2.0 * self.diameter))
        order = np.lexsort((placed.position[:, 1], columns))
        return make_discs(placed.position[order], placed.radius[order], self.density)

    def _placed(self) -> Placement:
        """The discs without overlap in an empty rectangle."""
        return place(self.corner, (self.corner[0] + self.width, self.top()), radii=self.radii(), seed=self.seed)

    def _among(self) -> Placement:
        """The discs without overlap among the obstacles, as densely as succeeds; InputError where they do not fit."""
        reasons: list[Fault] = []
        for looser in LOOSER:
            top = dataclasses.replace(self, fraction=looser * self.fraction).top()
            if top > self.ceiling * (1.0 + EDGE):
                problem = f"grains among what stands there are placed up to {top:.4g} m before they settle"
                repair = f"make the box {top:.4g} m high"
                reasons.append(Fault("height", None, f"{problem}, above the box of {self.ceiling:g} m", repair=repair))
                break
            try:
                return self.around.place(
                    self.corner, (self.corner[0] + self.width, top), self.radii(), self.seed, (False, False)
                )
            except InputError as error:
                reasons += error.faults
        raise InputError(reasons[:1])

    def radii(self) -> Floats:
        """Radii, (n,) m, uniform in diameter (1 ± spread), or those given."""
        if self.given:
            return np.array(self.given)
        rng = np.random.default_rng([self.seed, self.count])
        return 0.5 * self.diameter * (1.0 + self.spread * rng.uniform(-1.0, 1.0, self.count))


def settling_law(pile: Pile) -> Linear:
    """Stiff enough that force chains at the foot overlap by less than OVERLAP, nearly dead on impact."""
    mass = math.pi / 4.0 * pile.diameter**2 * pile.density
    layers = max((pile.top() - pile.corner[1]) / pile.diameter, 1.0)
    stiffness = CHAIN * layers * mass * pile.gravity / (OVERLAP * pile.diameter)
    law = Linear.from_restitution(
        RESTITUTION, 0.5 * mass, stiffness, tangential_stiffness=SHEAR * stiffness, friction=pile.friction
    )
    law = dataclasses.replace(law, tangential_damping=SHEAR * law.damping)
    return law.with_rolling(pile.rolling, SHEAR * stiffness) if pile.rolling else law


def come_to_rest(
    grains: Grains, weights: Floats, gravity: float, *, energy: float = ENERGY, balance: float = BALANCE,
    free: int | None = None,
) -> None:  # fmt: skip
    """Step under ``weights`` (n, 2) N/m with drag until kinetic energy and net forces are negligible.

    energy : kinetic, per grain over m g d;  balance : mean net force over mean weight;  free : how many discs are
    grains, the first ones; the others stand (None: all are).

    Raises PorescaleError when they are not after PATIENCE chunks of steps, or the same time in the shorter steps
    that small grains among large ones take, Unstable when the state is senseless.
    """
    discs = grains.discs
    diameter = 2.0 * float(discs.radius[:free].mean())
    drag = DRAG * math.sqrt(gravity / diameter)
    dt = grains.stable_step(steps_per_contact=0.0)
    rest = energy * gravity * diameter * float(discs.mass[:free].sum())
    mean = float(discs.mass[:free].mean()), float(discs.radius[:free].mean())
    chunks = math.ceil(PATIENCE * max(stable_step(grains.laws, *mean, steps_per_contact=0.0) / dt, 1.0))
    for _ in range(chunks):
        grains.step(dt, weights, None, CHUNK, drag)
        grains.check()
        if kinetic_energy(discs) < rest and unbalanced(grains, free) < balance:
            break
    else:
        raise PorescaleError(
            f"the packing did not come to rest in {chunks * CHUNK} steps: kinetic energy "
            f"{kinetic_energy(discs) / rest * energy:.2g} m g d per grain, "
            f"net force {unbalanced(grains, free):.2g} of weight{WEDGED if free not in (None, discs.count) else ''}"
        )
    discs.velocity[:] = 0.0
    discs.spin[:] = 0.0


def settle(grains: Grains, pile: Pile) -> None:
    """Drop the discs of ``grains`` under the law of settling_law until they rest with overlaps below
    OVERLAP d.

    Plates stand still meanwhile, and as high as needed.  The law of ``grains`` afterwards is the settling
    law.
    """
    law, free = settling_law(pile), pile.count
    weights = np.zeros((grains.discs.count, 2))
    weights[:free, 1] = -pile.gravity * grains.discs.mass[:free]
    plates = grains.plates.copy()
    grains.plates[:, VELOCITY] = 0.0
    grains.plates[:, LOW] = np.minimum(plates[:, LOW], pile.corner[1])
    grains.plates[:, HIGH] = np.maximum(plates[:, HIGH], _start_top(grains, pile) + pile.diameter)
    frictions, grains.plate_frictions = grains.plate_frictions, [None] * len(plates)
    of_rectangles, grains.rectangle_frictions = grains.rectangle_frictions, [None] * len(grains.rectangles)
    law = stiffened(law, 1.0 / SOFTER)
    grains.set_law(law)
    come_to_rest(grains, weights, pile.gravity, free=free)
    stiffer = SOFTER
    while stiffer > 1.0:
        scale_springs(grains, 1.0 / stiffer)
        law = stiffened(law, stiffer)
        grains.set_law(law)
        come_to_rest(grains, weights, pile.gravity, free=free)
        # Of a diameter.  What stands may lie in a wall, out of which no stiffness takes it: that does not count.
        deepest = 0.5 * max_overlap(grains, free).share
        stiffer = 1.2 * deepest / OVERLAP if deepest >= OVERLAP else 1.0
    grains.plates[:] = plates
    grains.plate_frictions, grains.rectangle_frictions = frictions, of_rectangles
    settled_top = float((grains.discs.position[:free, 1] + grains.discs.radius[:free]).max())
    for name, high in zip(grains.plate_names, plates[:, HIGH], strict=True):
        if high < settled_top:
            raise InputError(
                Fault(f"{name}.y_high", float(high), "grains would spill over it", "m", f">= {settled_top:.4g}")
            )


def _start_top(grains: Grains, pile: Pile) -> float:
    """How high the grains of a pile were placed, m."""
    if not pile.around:
        return pile.top()
    discs = grains.discs
    return float((discs.position[: pile.count, 1] + discs.radius[: pile.count]).max())


def stiffened(law: Linear, factor: float) -> Linear:
    """``law`` with its stiffnesses times ``factor`` and the same damping ratios."""
    return dataclasses.replace(
        law,
        stiffness=factor * law.stiffness,
        damping=math.sqrt(factor) * law.damping,
        tangential_stiffness=factor * law.tangential_stiffness,
        tangential_damping=math.sqrt(factor) * law.tangential_damping,
        rolling_stiffness=factor * law.rolling_stiffness,
        rolling_damping=math.sqrt(factor) * law.rolling_damping,
    )


def scale_springs(grains: Grains, factor: float) -> None:
    """Multiply all tangential springs by ``factor``: the same friction forces under another stiffness."""
    grains.pairs.carried *= factor
    grains.wall_spring *= factor
    grains.plate_spring *= factor
    grains.rectangle_spring *= factor
    if grains.segments is not None:
        grains.segments.corner_memory *= factor
        grains.segments.near_memory *= factor


def relax(
    grains: Grains, law: ContactLaw, weights: Floats, gravity: float, *, wall_law: ContactLaw | None = None,
    free: int | None = None,
) -> None:  # fmt: skip
    """From rest under one law and weight to rest under ``law`` and ``weights`` (n, 2) N/m.

    The friction forces are carried over in proportion to the weights, so that the packing does not lose
    which way it leans; plates stand still.  ``gravity`` (m/s^2) sets the scale of drag and rest;  free: as in
    come_to_rest.  Raises as come_to_rest.
    """
    before = np.hypot(grains.external_force[:, 0], grains.external_force[:, 1]).sum()
    share = np.hypot(weights[:, 0], weights[:, 1]).sum() / before if before > 0.0 else 1.0
    smallest = float(grains.discs.mass[:free].min()), float(grains.discs.radius[:free].min())
    stiff = [each.stiffest(*smallest).stiffness[1] for each in (grains.laws[0], law)]
    if stiff[1] > 0.0:
        scale_springs(grains, float(share) * stiff[0] / stiff[1])
    grains.set_law(law, wall_law)
    rising = grains.plates[:, VELOCITY].copy()
    grains.plates[:, VELOCITY] = 0.0
    come_to_rest(grains, weights, gravity, free=free)
    grains.plates[:, VELOCITY] = rising


def prepare(
    pile: Pile,
    box: Box,
    law: ContactLaw,
    *,
    wall_law: ContactLaw | None = None,
    plates: Sequence[Plate] = (),
    weight_density: float | None = None,
    folder: Path | None = None,
) -> Grains:
    """Grains of ``pile`` at rest in ``box`` behind ``plates`` under the run's ``law`` and weights; from
    disk if known.

    weight_density (kg/m^3): weights are weight_density * area * gravity, downwards; the density of the
    grains by default, density difference to a fluid for buoyant ones.  folder: as of `once`.  Raises
    InputError when the weight is not downwards, or when no side or plate holds the pile.
    """
    assert not pile.around  # among.py prepares that
    weighs = weight_per_area(pile, weight_density)

    def start() -> Grains:
        """The grains as they are placed."""
        return Grains(pile.discs(), law, box, wall_law=wall_law, plates=plates)

    def read(state: dict[str, Any]) -> Grains:
        """The grains of a state that was kept."""
        grains = start()
        grains.restore(state)
        return grains

    def make() -> Grains:
        """The grains at rest."""
        grains = start()
        settle(grains, pile)
        weights = weights_of(grains.discs, weighs, pile.gravity)
        relax(grains, law, weights, pile.gravity * weighs / pile.density, wall_law=wall_law)
        grains.reset_clock()
        return grains

    made_of: list[Any] = [pile, box, law, wall_law or law, *plates]
    return once([*(dataclasses.asdict(part) for part in made_of), weighs], read, make, Grains.state, folder)


def weight_per_area(pile: Pile, weight_density: float | None) -> float:
    """Density (kg/m^3) by which grains weigh: their own where None is given; InputError where they do not sink."""
    weighs = pile.density if weight_density is None else weight_density
    if not weighs > 0.0:
        raise InputError(
            Fault("grains.density", pile.density, "the grains do not sink, so they do not settle", "kg/m^3",
                  f"> {pile.density - weighs:g}")
        )  # fmt: skip
    return weighs


def weights_of(discs: Discs, density: float, gravity: float = GRAVITY) -> Floats:
    """Downward weights (n, 2) N/m of bodies of ``density`` (kg/m^3; buoyant: of the difference)."""
    weights = np.zeros((discs.count, 2))
    weights[:, 1] = -density * gravity * discs.area
    return weights

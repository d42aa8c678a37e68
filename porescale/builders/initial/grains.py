"""All discs of a scene in their order."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from porescale.builders.checks.frame_places import require_frames_apart
from porescale.builders.checks.grain_places import held_alone, require_apart
from porescale.builders.checks.rectangle_places import require_free_of_rectangles
from porescale.builders.derive import Derived, grain_count
from porescale.builders.initial.apply_sections import apply_sections, names_of
from porescale.builders.initial.contact_laws import MaterialPlan, density_of_packing
from porescale.builders.initial.frames import Placed, placed_frames, with_corners
from porescale.builders.initial.obstacles import obstacles_of, rectangles_around
from porescale.builders.initial.packing import by_packing, compressed, drawn_radii, radii_of, say_void_ratio
from porescale.builders.initial.placed import by_hand, placed
from porescale.builders.initial.rectangles import stand_ins, take_over
from porescale.builders.initial.rock import rock_discs, rock_frames
from porescale.common.core.errors import InputError
from porescale.common.core.types import AnyArray
from porescale.common.duration.doing import doing
from porescale.common.neighbors.placement import place, square_lattice
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import FIELDS, Discs, make_discs
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.prepare.among import Among, MaterialOf, prepare_among
from porescale.dem.prepare.merge import joined, released, together
from porescale.dem.prepare.obstacles import Obstacles
from porescale.dem.prepare.settle import Pile, prepare
from porescale.scene.bodies.disc import Disc
from porescale.scene.domain import Domain
from porescale.scene.packing import Packing
from porescale.scene.scene import Scene

GATE = "gate"
SETTLING, PRESSING = "settling the packing", "pressing the packing"
"""What progress names it while it is done."""
SETTLED_PER_SECOND = 25e3
"""Grains times layers that settle in a second of a quiet machine (23 000 to 32 000 for 2 600 to 9 900 grains with one
thread, among obstacles and without, 2026-11-28)."""

UNTOUCHED = Linear(1.0, 0.0)
"""Contact law where all discs are held: nothing comes of it."""
NO_DISCS = make_discs(np.zeros((0, 2)), np.zeros(0), np.zeros(0))


def box_of(domain: Domain) -> Box:
    """The box of the grains: walls and periodic sides."""
    kinds = {name: "periodic" if side.boundary.periodic else "solid" for name, side in domain.sides.items()}
    return Box((0.0, 0.0), (domain.width, domain.height), **kinds)


def frames_of(scene: Scene, derived: Derived) -> list[Placed]:
    """All bodies of segments, a rock's last."""
    rock = rock_frames(scene, derived.law) if scene.rock and derived.law else []
    return [*placed_frames(scene), *rock]


def grains_of(scene: Scene, derived: Derived, frames: list[Placed], *, hasty: bool = False) -> tuple[Grains, list[str]]:
    """All discs in their order: the packing's, those placed by hand, those that are held, corners of frames; and names
    of the bodies that are recorded.

    hasty : no kernel runs: the packing's discs stand in rows, and pairs are not yet looked for.
    """
    box, law, wall_law = box_of(scene.domain), derived.law or UNTOUCHED, derived.wall_law
    plates = (
        [Plate(scene.gate.x, 0.0, scene.domain.height, friction=scene.gate.friction, name=GATE)] if scene.gate else []
    )
    packing = scene.grains.packing if scene.grains else None
    parts = [_by_hand(scene)] if by_hand(scene) else []
    parts += [_held(scene.disc, scene.fluid.density if scene.fluid else 1000.0)] if scene.disc else []
    around = obstacles_of(scene, frames)
    springs: Mapping[str, AnyArray] = {}
    if scene.rock:
        of_rock = rock_discs(scene, law)
        parts = [of_rock, *parts] if of_rock else parts
        grains = Grains(together(*parts) if parts else NO_DISCS, law, box, wall_law=wall_law)
    elif packing and packing.settle and not hasty:
        plates = [*plates, *stand_ins(scene.rectangle, packing)]
        with doing(SETTLING, settling_seconds(packing, derived.grain_count)):
            if around:
                grains, springs = prepared_among(scene, packing, derived, plates, around, frames)
            else:
                grains = prepared(scene, packing, box, derived, plates)
        say_void_ratio(packing, grains, around)
        grains = _with_parts(grains, around, parts)
    elif scene.grains and packing and packing.compress and not hasty:
        with doing(PRESSING, settling_seconds(packing, derived.grain_count)):
            grains = compressed(packing, density_of_packing(scene), scene.domain.periodic, law, around).grains
        if around:
            say_void_ratio(packing, grains, around)
        grains = _with_parts(grains, around, parts)
        grains.set_law(law, wall_law)
    else:
        if packing:
            discs_of = _in_rows if hasty else _placed
            parts = [discs_of(packing, density_of_packing(scene), around), *parts]
        grains = Grains(together(*parts) if parts else NO_DISCS, law, box, wall_law=wall_law, plates=plates)
        if packing and around and not hasty:
            say_void_ratio(packing, grains, around)
        if held_alone(scene) and any(grains.box.periodic) and _crowds_its_period(grains):
            grains.reach = np.zeros(grains.discs.count)  # no pair is looked for, so that each may touch its own image
        if grains.discs.count and not hasty:  # where bodies of segments are all there is they bring lists of their own
            grains.refresh()  # contacts count from the first row of the series on
    if scene.rectangle:
        take_over(scene.rectangle, grains, rectangles_around(scene, around) if len(grains.rectangles) else ())
        require_free_of_rectangles(scene.rectangle, grains.discs)
    discs = grains.discs
    grains = with_corners(grains, frames) if frames else grains
    if scene.disc:
        grains.hold(slice(discs.count - len(scene.disc), discs.count))
    recorded = apply_sections(scene, grains, derived.mean_mass, frames)
    if springs and grains.segments is not None:
        grains.segments.inherit(springs)
    added = len(scene.disc) + len(by_hand(scene))
    if added and not around:
        require_apart(discs, scene, discs.count - added)
    if scene.grains and frames and packing and not scene.rock and not around:
        require_frames_apart(scene.grains.overlap, frames, discs, placed(scene)[0])
    return grains, recorded


def _with_parts(grains: Grains, around: Obstacles, parts: list[Discs]) -> Grains:
    """A packing and the scene's other discs; those it was made ``around``, held, give way to these in their places."""
    if not around:
        return joined(grains, together(*parts)) if parts else grains
    count = grains.discs.count - len(around.discs)
    packed = Discs(*(getattr(grains.discs, name)[:count] for name in FIELDS))
    return released(grains, together(packed, *parts))


def _crowds_its_period(grains: Grains) -> bool:
    """Whether a periodic side is shorter than two cutoffs of the pair search."""
    least = 2 * (2 * float(grains.discs.radius.max()) + grains.pairs.skin)
    return any(0.0 < period < least for period in grains.pairs.period)


def _held(discs: Sequence[Disc], density: float) -> Discs:
    """The discs whose motion is prescribed; their mass has no effect."""
    return make_discs(
        [(it.x, it.y) for it in discs], np.array([it.diameter / 2 for it in discs]), density,
        np.array([it.motion(0.0)[:2] for it in discs]), np.array([it.motion(0.0)[2] for it in discs]),
    )  # fmt: skip


def settling_seconds(packing: Packing, count: int) -> float:
    """Seconds that ``count`` grains are expected to take to settle, or to be pressed.

    Contacts are stiffer by the number of layers and steps shorter by its root, and grains fall longer by its root: the
    work is that of all grains times the layers.
    """
    layers = max(packing.height / packing.diameter, 1.0)
    return count * layers / SETTLED_PER_SECOND


def prepared(scene: Scene, packing: Packing, box: Box, derived: Derived, plates: list[Plate]) -> Grains:
    """The packing settled dry, then at rest under the run's contact law and its weight in the fluid."""
    assert derived.law
    pile, lighter = _pile(scene, packing), scene.fluid.density if scene.fluid else 0.0
    return prepare(
        pile, box, derived.law, wall_law=derived.wall_law, plates=plates, weight_density=pile.density - lighter
    )


def prepared_among(
    scene: Scene, packing: Packing, derived: Derived, plates: list[Plate], around: Obstacles, frames: list[Placed]
) -> Among:
    """The same among what stands in its way."""
    assert derived.law
    pile = replace(_pile(scene, packing), around=around, ceiling=scene.domain.height)
    lighter, laws = scene.fluid.density if scene.fluid else 0.0, MaterialPlan.of(scene).laws(derived.mean_mass)
    of_discs = None
    if laws and len(laws.names) > 1:
        names = names_of(scene, pile.count + len(around.discs))
        names += [laws.names[it.frame.material] for it in frames for _ in it.frame.corners]
        of_discs = MaterialOf(laws, np.array([laws.names.index(name or laws.names[0]) for name in names]))
    try:
        return prepare_among(
            pile, box_of(scene.domain), derived.law, wall_law=derived.wall_law, plates=plates,
            weight_density=pile.density - lighter, material=of_discs,
        )  # fmt: skip
    except InputError as error:
        raise by_packing(error) from None


def _pile(scene: Scene, packing: Packing) -> Pile:
    """The grains of the packing before they settle, without what stands around them."""
    assert scene.grains
    placed, radii = len(by_hand(scene)) + len(scene.disc), radii_of(packing)
    return Pile(
        corner=(packing.left, packing.bottom), width=packing.width, count=grain_count(scene) - placed,
        diameter=packing.diameter, density=density_of_packing(scene), spread=packing.size_spread,
        friction=packing.settling_friction, seed=packing.seed, gravity=-scene.gravity[1],
        given=() if radii is None else tuple(radii.tolist()), rolling=packing.settling_rolling_friction,
    )  # fmt: skip


def _placed(packing: Packing, density: float, around: Obstacles) -> Discs:
    """The packing's discs where they stay: without overlap, beside what stands there."""
    radii = radii_of(packing)
    lower, upper = (packing.left, packing.bottom), (packing.left + packing.width, packing.bottom + packing.height)
    sizes: dict[str, Any] = (
        {"diameter": packing.diameter, "spread": packing.size_spread, "packing_fraction": packing.packing_fraction}
        if radii is None else {"radii": radii}
    )  # fmt: skip
    try:
        if not around:
            placed = place(lower, upper, seed=packing.seed, **sizes)
        else:
            if radii is None:
                radii = drawn_radii(packing)
            placed = around.place(lower, upper, radii, packing.seed, (False, False))
    except InputError as error:
        raise by_packing(error) from None
    return make_discs(placed.position, placed.radius, density)


def _in_rows(packing: Packing, density: float, around: Obstacles) -> Discs:
    """Discs as large as the packing's largest on a square lattice over its rectangle, a hundredth apart, beside what
    stands there."""
    radii = radii_of(packing)
    largest = packing.diameter * (1.0 + packing.size_spread) if radii is None else 2.0 * float(radii.max())
    lower = packing.left, packing.bottom
    position = square_lattice(lower, (lower[0] + packing.width, lower[1] + packing.height), 1.01 * largest)
    if around:
        position = position[around.depth(position, 0.5 * largest) < -0.5 * largest]
    return make_discs(position, np.full(len(position), 0.5 * largest), density)


def _by_hand(scene: Scene) -> Discs:
    grains, plan = by_hand(scene), MaterialPlan.of(scene)
    return make_discs(
        [(g.x, g.y) for g in grains], np.array([g.diameter / 2 for g in grains]),
        np.array([plan.density(g.material) for g in grains]),
        np.array([g.velocity for g in grains]), np.array([g.spin for g in grains]),
    )  # fmt: skip

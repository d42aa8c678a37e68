"""The grains of a packing fit its rectangle; one that is pressed together fills the box, and its friction has springs
to act on."""

import math

import numpy as np

from porescale.analysis.permeability import SHORTEST, standing, with_images
from porescale.builders.initial.contact_laws import density_of_packing, law_class, merged
from porescale.builders.initial.packing import drawn_radii, radii_of
from porescale.builders.initial.placed import placed
from porescale.common.core.errors import Fault
from porescale.common.neighbors.placement import DENSEST
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.own import OwnContact
from porescale.dem.prepare.settle import CHAIN, Pile
from porescale.scene.packing import SAME, Packing
from porescale.scene.scene import Scene

SUNK = 0.05
"""Overlap over diameter at the foot of a packing beyond which it is warned of: a tenth less pores between the grains
than of hard ones, and at three times of it a run stops."""


def check_compressed(scene: Scene, faults: list[Fault]) -> None:
    """Add faults of a compressed packing: it fills the box, since nothing else would hold it together, and friction
    given for it acts under the law of [contact], unlike that of settling, which has a law of its own."""
    packing = scene.grains.packing if scene.grains else None
    if packing is None or not packing.compress or scene.rock:
        return
    if scene.contact and not law_class(scene.contact).compresses:
        problem = "packings are compressed under the linear law only"
        faults.append(Fault("contact.law", str(scene.contact.law), problem, repair='let it settle, or take "linear"'))
    elif scene.contact:
        faults += _without_effect(scene, packing)
    domain = scene.domain
    for key, start, length, size in (
        ("width", packing.left, packing.width, domain.width), ("height", packing.bottom, packing.height, domain.height),
    ):  # fmt: skip
        if abs(start) > SAME * size or abs(length - size) > SAME * size:
            problem = "a compressed packing fills the box, whose sides hold it"
            repair = "make the packing as large as the box, or let it settle"
            faults.append(Fault(f"grains.packing.{key}", length, problem, "m", f"{size:g}", repair))


def _without_effect(scene: Scene, packing: Packing) -> list[Fault]:
    """Faults of friction that was given for compressing, and has no spring or dashpot along contacts to act on."""
    assert scene.contact
    own = next((it for it in scene.material if it.name == packing.material), next(iter(scene.material), None))
    numbers, law, faults = merged(scene.contact, own), law_class(scene.contact), []
    stiff = numbers.get("tangential_stiffness", 0.0) > 0.0
    slides = not law.friction_problem(numbers | {"friction": 1.0})  # a coefficient of rolling takes the spring alone
    for key, acts in (("settling_friction", slides), ("settling_rolling_friction", stiff)):
        value = getattr(packing, key)
        if value > 0.0 and packing.gives(key) and not acts:
            problem = "has no effect on what is compressed: contacts have no tangential_stiffness"
            repair = "give contact.tangential_stiffness, half of the normal one say, or leave it out"
            faults.append(Fault(f"grains.packing.{key}", value, problem, repair=repair))
    return faults


def check_room(packing: Packing, count: int, faults: list[Fault]) -> bool:
    """Whether each grain fits the rectangle that it is placed in; a fault that names the sizes where one does not.

    count : of the packing's grains.  A packing that settles is placed above its lower edge over its width, as high as
    it needs (`Pile.top`); any other in its rectangle.  Sizes are drawn as the run draws them, with the same seed.
    """
    radii, size = radii_of(packing), (packing.width, packing.height)
    pile = Pile((0.0, 0.0), packing.width, count, packing.diameter, 1.0, packing.size_spread, seed=packing.seed,
                given=() if radii is None else tuple(radii.tolist()))  # fmt: skip
    if packing.settle:
        size = packing.width, pile.top()
    most = packing.diameter * (1.0 + packing.size_spread)
    placed = packing.settle or packing.packing_fraction <= DENSEST
    if radii is None and placed and packing.diameter <= min(size) < most:  # drawn only where it depends on them
        radii = pile.radii() if packing.settle else drawn_radii(packing)
    largest = packing.diameter if radii is None else 2.0 * float(radii.max(initial=0.0))
    room = min(size)
    if largest <= room:
        return True
    problem = f"the largest grain, {largest:.4g} m, is wider than the {room:.4g} m across of where it is placed"
    repair = "make the grains smaller, or the rectangle larger"
    if key := next((key for key in ("sizes", "grading") if getattr(packing, key)), None):
        faults.append(Fault(f"grains.packing.{key}", None, problem, repair=repair))
    else:
        allowed = f"<= {room * packing.diameter / largest:.4g}"
        faults.append(Fault("grains.packing.diameter", packing.diameter, problem, "m", allowed, repair))
    return False


def unused_spread(scene: Scene) -> list[str]:
    """A warning of a spread of sizes that other keys take the place of, or nothing."""
    packing = scene.grains.packing if scene.grains else None
    if packing is None or packing.size_spread == type(packing).model_fields["size_spread"].default:
        return []
    given = {"sizes": packing.sizes, "grading": packing.grading, "log_spread": packing.log_spread}
    instead = next((name for name, it in given.items() if it), "")
    said = f"grains.packing.size_spread = {packing.size_spread:g} is not used: diameters follow from {instead}"
    return [f"{said}; leave one of them out"] if instead else []


def beside_the_bed(scene: Scene) -> list[str]:
    """Warnings of a window of [permeability] in which nothing is measured: no grain or held disc stands in it at the
    start, or it is too short along the flow."""
    if scene.permeability is None:
        return []
    packing = scene.grains.packing if scene.grains else None
    window = scene.permeability.window or packing
    if window is None:
        return []
    _, x, r = placed(scene)
    low = np.array((window.left, window.bottom))
    size = np.array((window.width, window.height))
    box, order = (scene.domain.width, scene.domain.height), [0, 1] if scene.permeability.direction == "x" else [1, 0]
    x, r, whole = with_images(x, r, box, scene.domain.periodic, size.tolist(), SAME * max(box))
    diameters = 2.0 * r[standing((x - low)[:, order], r, size[order].tolist(), [whole[k] for k in order])]
    if packing is not None:
        corner, wide = np.array((packing.left, packing.bottom)), np.array((packing.width, packing.height))
        if np.all((corner < low + size) & (low < corner + wide)):
            diameters = np.append(diameters, packing.diameter)
    if not len(diameters):
        return [
            "permeability.window: no grain stands in it at the start: unless some come there, permeability.csv stays "
            "empty; move it into the bed"
        ]
    ratio = scene.grains.hydraulic_radius_ratio or 1.0 if scene.grains else 1.0
    across = float(size[order[0]]) / (ratio * float(diameters.mean()))
    if whole[order[0]] or across >= SHORTEST:
        return []
    return [
        f"permeability.window: it is {across:.2g} hydraulic diameters long along the flow, and nothing is measured in "
        f"less than {SHORTEST:g}: make it longer"
    ]


def too_soft_for_weight(scene: Scene, law: ContactLaw) -> list[str]:
    """A warning where grains at the foot of a packing are pressed deep into each other by what lies on them.

    law : of two grains.  The strongest force there is CHAIN times the weight above a diameter of width, in fluid less
    buoyancy.  Of a law whose force goes as the power p - 1 of the overlap d the energy is F d/p: so the overlap follows
    from that of an impact at 1 m/s, whose power is p.  A user's law has none."""
    packing = scene.grains.packing if scene.grains else None
    if packing is None or packing.compress or scene.rock or isinstance(law, OwnContact):
        return []
    diameter, density = packing.diameter, density_of_packing(scene)
    heavier = abs(density - (scene.fluid.density if scene.fluid else 0.0))
    height = max(packing.height - diameter, 0.0)
    force = CHAIN * packing.packing_fraction * heavier * abs(scene.gravity[1]) * height * diameter
    mass = 0.5 * math.pi / 4 * density * diameter**2
    depth, power = law.impact(mass, 0.25 * diameter, 1.0)
    sunk = depth * (2.0 * force * depth / (power * mass)) ** (1.0 / (power - 1.0)) / diameter
    if sunk <= SUNK:
        return []
    return [
        f"contacts are too soft for the packing: at its foot grains are pressed into each other by up to {sunk:.2g} of"
        f" a diameter; {(sunk / SUNK) ** (power - 1.0):.2g} times as stiff ones keep it below {SUNK:g}"
    ]

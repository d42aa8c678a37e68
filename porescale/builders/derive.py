"""What a scene implies before anything is built: lattice, contact step, regime numbers; and what it must not imply.

Refusals are faults with a repair; whatever merely deserves a thought is a warning.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from porescale.builders.checks.contact import angles_for_friction, material_doubts, wall_friction_doubts
from porescale.builders.checks.discs_alone import left_out
from porescale.builders.checks.frame_places import check_frames, check_sample, strays, thin_for
from porescale.builders.checks.grain_places import check_grain_places
from porescale.builders.checks.needed import in_solids, without_effect
from porescale.builders.checks.own_laws import check_own_contact, energy_of_mass
from porescale.builders.checks.packing import beside_the_bed, check_compressed, too_soft_for_weight, unused_spread
from porescale.builders.checks.polygons_in_fluid import longest_step, too_few_cells, too_light
from porescale.builders.checks.prescribed import check_controls, check_motions
from porescale.builders.checks.regime import check_regime, expected_speed, too_soft, travel_step
from porescale.builders.checks.wall_places import hammering, stays_shut
from porescale.builders.initial.clumps import lightest, undisplaced_clumps
from porescale.builders.initial.contact_laws import MaterialPlan, densities_of_bodies, law_class
from porescale.builders.initial.frames import Placed, lightest_frame, longest_of, placed_frames, sizes_of
from porescale.builders.initial.packing import radii_of
from porescale.builders.initial.placed import by_hand, packed_count, placed
from porescale.builders.initial.rock import rock_frames
from porescale.builders.scene import Scene
from porescale.common.core.dividing import dividing
from porescale.common.core.errors import Fault, InputError
from porescale.dem.contact.law import ContactLaw
from porescale.dem.discs import make_discs
from porescale.dem.sanity import WORST_OF_TRAVELLING_CORNERS, WORST_TRAVEL
from porescale.dem.timestep import SAFETY, packing_limit, stable_step
from porescale.lbm.boundary.thin_plate import open_ends
from porescale.lbm.scales import NAMES, Scales, implied
from porescale.scene.bodies.gate import Gate
from porescale.scene.contact import Contact
from porescale.scene.domain import Domain
from porescale.scene.fluid import Fluid
from porescale.scene.lattice import WHOLE, is_whole

MANY = 1e6
"""Contact steps in a step of the fluid beyond which a unit is probably wrong."""
LEAP = 100.0
"""By how much shorter than contacts need a step is for the sake of a speed, which is then probably a slip: that of a
wave through contacts of the stiffness given, some radii in such a step, is tens of times less."""
ROUNDED = 1e-9
"""By what share a contact step is off one that goes into a step of the fluid a whole number of times, and counts as it:
numbers of a scene are written with some ten digits."""


@dataclass(frozen=True)
class Derived:
    """Numbers that follow from a scene.  None where the scene has no such part."""

    scales: Scales | None = None
    cells: tuple[int, int] | None = None
    gate_column: int | None = None
    law: ContactLaw | None = None  # of the packing, or the first material, with itself
    wall_law: ContactLaw | None = None
    contact_limit: float | None = None  # s, stability limit in a packing
    contact_step: float | None = None  # s
    contact_steps: int | None = None  # per model step
    model_step: float = 0.0  # s
    grain_count: int = 0
    diameters: tuple[float, float, float] | None = None  # smallest, mean, largest, m
    mean_mass: float = 0.0  # kg/m, of a grain of mean diameter at the density of [grains]
    speed: float = 0.0  # m/s, the largest to expect
    density_variation: float = 0.0
    warnings: tuple[str, ...] = field(default=())
    corners: int = 0  # of bodies of segments
    precision: int = 8  # bytes of a number of the fluid
    polygons: tuple[int, float] = (0, 0.0)  # in fluid, and the largest extent of them, m


def derive(scene: Scene) -> Derived:
    """All of the above; raises InputError with every refusal, each with its repair."""
    faults: list[Fault] = []
    warnings: list[str] = []
    scales = cells = column = None
    if scene.fluid:
        scales, cells, column = _lattice(scene.fluid, scene.domain, scene.gate, faults)
    if scene.gate and any(scene.domain.periodic):
        faults.append(Fault("gate", None, "stands in a periodic box", repair="give the box walls"))
    check_compressed(scene, faults)
    check_grain_places(scene, diameters(scene), faults)
    frames = _frames(scene, faults)
    sizes = diameters(scene, held=False) or diameters(scene) or _equal(sizes_of(frames))
    law = wall_law = limit = step = steps = None
    model_step, mean_mass = scales.step if scales else 0.0, 0.0
    if scene.grains and scene.contact and sizes:
        plan, packing = MaterialPlan.of(scene), scene.grains.packing
        least = min(plan.densities)
        smallest = math.pi / 4 * sizes[0] ** 2 * least, sizes[0] / 2
        mean_mass = math.pi / 4 * sizes[1] ** 2 * scene.grains.density
        law, wall_law, every = plan.law_and_others(packing.material if packing else "", mean_mass)
        warnings += [*material_doubts(scene), *wall_friction_doubts(scene), *angles_for_friction(scene)]
        check_own_contact(scene.contact, every, *smallest)
        warnings += filter(None, [energy_of_mass(scene, every, *smallest)])
        if scene.clump:
            smallest = min(smallest[0], lightest(scene.clump, plan, every)), smallest[1]
            faults += undisplaced_clumps(scene.clump, scene.grains.hydraulic_radius_ratio or 1.0) if scales else []
        if scene.rock and not faults:
            frames = [*frames, *rock_frames(scene, law)]
        if frames:
            radius = smallest[1] if grain_count(scene) else None  # of the smallest disc, where there is any
            light = lightest_frame(frames, every, radius)
            if light is not None:
                smallest = (light if radius is None else min(smallest[0], light)), smallest[1]
        limit = min(packing_limit(it, *smallest) for it in every)
        safe = stable_step(every, *smallest)
        speed = expected_speed(scene, scales, sizes, frames)
        travel = travel_step(scene, speed, sizes[0] / 2, frames)
        if scene.contact.step is None and SAFETY * travel * LEAP < safe:
            warnings.append(
                f"steps of {SAFETY * travel:.2g} s, {safe / (SAFETY * travel):.2g} times as many as contacts need: what"
                f" moves at {speed:.2g} m/s, which is to be expected, needs them; a table that leaps from one value to"
                " the next does so: let it take longer"
            )
        safe = min(safe, SAFETY * travel)
        if frames and scales:
            safe = min(safe, longest_step(frames, speed))
        step, steps = _contact_step(scene.contact, safe, limit, scales, faults)
        if scales and (scene.contact.step or 0.0) > scales.step * (1 + ROUNDED):
            warnings.append(
                f"contact.step = {scene.contact.step:.6g} s is longer than a step of the fluid, in which the grains do"
                f" at least one: {step:.6g} s is used; leave contact.step out"
            )
        if step > travel:
            warnings.append(
                f"contact.step = {step:.3g} s: at {speed:.3g} m/s, which is to be expected, a grain moves more than "
                f"{WORST_TRAVEL:g} of the smallest radius in it, or a corner {WORST_OF_TRAVELLING_CORNERS:g} of its "
                f"thickness, where a run stops; {SAFETY * travel:.2g} s is safe"
            )
        warnings += filter(None, [too_soft(scene, scales, sizes, (law, wall_law), frames)])
        warnings += [*too_soft_for_weight(scene, law), *hammering(scene, mean_mass, sizes[1], wall_law)]
        model_step = scales.step if scales else step
    warnings += stays_shut(scene, sizes[1] if sizes and scene.grains else 0.0)
    speed = expected_speed(scene, scales, sizes, frames)
    if frames and law and scene.grains:
        warnings += filter(
            None, [thin_for(frames, speed, mean_mass * densities_of_bodies(scene)[-1] / scene.grains.density, law)]
        )
    warnings += strays(scene.domain, scene.time.end, frames)
    warnings += [*unused_spread(scene), *without_effect(scene), *in_solids(scene)]
    variation = 0.0
    if scales:
        doubts = too_few_cells(frames, scales.spacing), too_light(frames, scales.spacing, scales.density)
        warnings += [*filter(None, doubts), *left_out(scene), *beside_the_bed(scene)]
        variation = check_regime(scene, scales, speed, sizes, faults, warnings)
    free = grain_count(scene) - len(scene.disc)
    for number in scene.loads.grains if scene.loads else ():
        if not 0 <= number < free:
            allowed = f"0 to {free - 1}" if free else "none: there are no grains"
            faults.append(Fault("loads.grains", number, "there is no such grain", "", allowed))
    check_controls(scene, free, faults)
    if not faults:
        check_motions(scene, frames, faults)
    if faults:
        raise InputError(faults)
    return Derived(
        scales, cells, column, law, wall_law, limit, step, steps, model_step, grain_count(scene), sizes,
        mean_mass, speed, variation, tuple(warnings), sum(len(it.frame.corners) for it in frames),
        4 if scene.fluid and scene.fluid.precision == "float32" else 8,
        (len(frames), longest_of(frames)) if scales else (0, 0.0),
    )  # fmt: skip


def _frames(scene: Scene, faults: list[Fault]) -> list[Placed]:
    """The frames placed by hand, and faults of them and of where they are; none where they are at fault."""
    if not (scene.segment or scene.polygon or scene.container or scene.rock):
        return []
    try:
        frames = placed_frames(scene)
    except InputError as error:
        faults += error.faults
        return []
    names, x, r = placed(scene)
    discs = make_discs(x, r, np.ones(len(r)))
    faults += [*check_frames(scene, frames, discs, names), *check_sample(scene, frames, discs, names)]
    return frames


def _equal(sizes: list[float]) -> tuple[float, float, float] | None:
    """Smallest, mean and largest of some diameters, None without any."""
    return (min(sizes), sum(sizes) / len(sizes), max(sizes)) if sizes else None


def fluid_scales(fluid: Fluid) -> Scales:
    """The lattice's scales from the three or four numbers given."""
    given = {name: getattr(fluid, name) for name in NAMES if getattr(fluid, name) is not None}
    full = {**implied(**given), **given}
    return Scales(full["spacing"], full["step"], full["relaxation_time"], fluid.density)


def grain_count(scene: Scene) -> int:
    """Number of grains and discs that are held."""
    return len(scene.disc) + len(by_hand(scene)) + packed_count(scene)


def diameters(scene: Scene, *, held: bool = True) -> tuple[float, float, float] | None:
    """Smallest, mean and largest diameter, m, of grains and, if ``held``, of discs that are held; None without any.

    The mean is that of a packing where there is one.
    """
    packing = scene.grains.packing if scene.grains else None
    sizes = [grain.diameter for grain in by_hand(scene)]
    sizes += [disc.diameter for disc in scene.disc] if held else []
    if packing is None and not sizes:
        return None
    mean = packing.diameter if packing else sum(sizes) / len(sizes)
    radii = radii_of(packing) if packing else None
    if radii is not None:
        sizes += [2 * float(radii.min()), 2 * float(radii.max())]
    elif packing:
        sizes += [packing.diameter * (1 - packing.size_spread), packing.diameter * (1 + packing.size_spread)]
    return min(sizes), mean, max(sizes)


def _lattice(
    fluid: Fluid, domain: Domain, gate: Gate | None, faults: list[Fault]
) -> tuple[Scales, tuple[int, int], int | None]:
    """Scales, cells, and the column that the gate stands left of."""
    scales = fluid_scales(fluid)
    h = scales.spacing
    lengths = {"domain.width": domain.width, "domain.height": domain.height} | ({"gate.x": gate.x} if gate else {})
    faults += _uneven(lengths, h)
    cells, column = (round(domain.width / h), round(domain.height / h)), round(gate.x / h) if gate else None
    if column is not None:
        faults += _open_gate(domain, column, cells[0])
    return scales, cells, column


def _open_gate(domain: Domain, column: int, columns: int) -> list[Fault]:
    """Faults of sides that fluid passes where a gate ends, left of a ``column`` of so many; periodic ones are said."""
    kinds = {name: side.boundary for name, side in domain.sides.items()}
    repair = "let it end at walls, or take the gate out"
    return [Fault(f"domain.{name}", kinds[name].name, "fluid passes where the gate ends", repair=repair)
            for name in open_ends(kinds, columns, column) if not kinds[name].periodic]  # fmt: skip


def _uneven(lengths: dict[str, float], spacing: float) -> list[Fault]:
    """A fault for each of the lengths that is no whole number of cells; names a spacing that divides all of them."""
    uneven = {key: it for key, it in lengths.items() if not is_whole(it, spacing)}
    better = dividing(list(lengths.values()), spacing, WHOLE) if uneven and min(lengths.values()) > 0.0 else None
    return [
        Fault(key, it, f"is {it / spacing:.6g} cells of {spacing:.6g} m, not a whole number", "m",
              repair=f"a spacing of {better:.9g} m divides {'them all' if len(uneven) > 1 else 'it and the rest'}"
              if better else f"{max(1, round(it / spacing)) * spacing:.9g} m would be")
        for key, it in uneven.items()
    ]  # fmt: skip


def _contact_step(
    contact: Contact, safe: float, limit: float, scales: Scales | None, faults: list[Fault]
) -> tuple[float, int]:
    """Contact step (s) and their number per model step."""
    wanted = contact.step or safe
    steps = 1 if scales is None else max(1, math.ceil(scales.step / wanted * (1 - ROUNDED)))
    step = wanted if scales is None else scales.step / steps
    if steps > MANY:
        problem = f"takes {steps:.3g} contact steps of {wanted:.3g} s"
        repair = "lower contact.stiffness, give the grains a size in metres, or shorten the step of the fluid"
        key, unit = law_class(contact).required
        what = getattr(contact, key) if key else None
        faults.append(Fault(f"contact.{key or 'law'}", what, f"{problem} in a step of the fluid", unit, repair=repair))
    if step > limit:
        faults.append(
            Fault("contact.step", step, "is beyond the stability limit of a packing", "s", f"< {limit:.3g}",
                  f"leave it out (it would be {safe:.3g} s), or lower the stiffness")
        )  # fmt: skip
    return step, steps

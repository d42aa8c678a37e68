"""The regime of a scene: the largest speed to expect, and what Mach, pore pressure and resolution then mean."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from porescale.builders.checks.flows import check_flows, forced_speed, pressed_speed
from porescale.builders.checks.held_places import narrow_gap
from porescale.builders.checks.limits import (
    CELLS_THICK,
    DENSITY_REFUSE,
    DENSITY_WARN,
    MACH_REFUSE,
    MACH_WARN,
    RING_CELLS,
    SINGLE_PRECISION,
    SMALLEST,
    coarse,
    coarse_smallest,
    light,
    slow,
    thin,
)
from porescale.builders.checks.own_laws import inflow_peak
from porescale.builders.checks.sound import check_gate, check_inflows, check_pistons, check_sound, check_start
from porescale.builders.initial.clumps import least_density
from porescale.builders.initial.contact_laws import MaterialPlan, densities_of_bodies, density_of_packing, law_class
from porescale.builders.initial.fluid_options import collision_options, weight_of
from porescale.builders.initial.frames import Placed
from porescale.builders.initial.placed import by_hand, controls_by_hand
from porescale.common.core.errors import Fault
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.own import OwnContact
from porescale.dem.sanity import WORST_OF_TRAVELLING_CORNERS, WORST_OVERLAP, WORST_TRAVEL
from porescale.lbm.collision.choose import choose
from porescale.lbm.scales import Scales
from porescale.scene.bodies.control import Controlled
from porescale.scene.bodies.rectangle import Rectangle
from porescale.scene.bodies.segments import Container
from porescale.scene.packing import Packing
from porescale.scene.scene import Scene

BLUNT = 1.2
"""Drag coefficient of a cylinder in cross flow at Reynolds numbers of 10² to 10⁵."""
ROUNDED_UP = 1.06
"""Factor after which two digits of a number are not less than it: they are off by 5 % at most."""
UNIT: dict[str, Any] = {"relaxation_time": 1.0, "force": (0.0, 0.0), "dtype": "float64"}
"""Numbers for a law that is only looked at."""
Sizes = tuple[float, float, float]


def expected_speed(scene: Scene, scales: Scales | None, sizes: Sizes | None, frames: Sequence[Placed] = ()) -> float:
    """The largest speed to expect, m/s: an upper estimate from energy, drag and what the scene starts with.

    Grains: free fall over the distance they can fall along gravity (rise against it, where they are lighter than the
    fluid), reduced by buoyancy; over a periodic side, which has no end, for as long as the run lasts.  In fluid the
    terminal speed of a grain if that is less, and for a packing that of the gravity current it can become,
    sqrt(g' H)/2 with g' = phi |s - 1| g (Benjamin 1968): grains that fall together fall faster than each alone.
    Fluid under a body force: see `forced_speed`; under a difference of pressure the parabola between the walls across
    it, or Bernoulli's speed if that is less.  Prescribed motion counts as it is.
    """
    speed = max(given_speed(scene), _framed_speed(scene.container, frames), strain_speed(scene, 0.0))
    if scene.grains and sizes:
        packing, free = scene.grains.packing, grain_speed(scene, scales, sizes, frames)
        if scales and packing:
            height = column_height(packing, scene.gravity)
            driving = abs(density_of_packing(scene) / scales.density - 1) * math.hypot(*scene.gravity)
            free = max(free, 0.5 * math.sqrt(packing.packing_fraction * driving * height))
        speed = max(speed, free)
    if scene.fluid and scales:
        speed = max(speed, forced_speed(scene, scales), pressed_speed(scene.domain, scales))
    return speed


def grain_speed(
    scene: Scene, scales: Scales | None, sizes: Sizes, frames: Sequence[Placed] = (), *, impact: bool = False
) -> float:
    """The largest speed (m/s) of a grain by itself: that which it is given, and that of its fall.

    impact : with which it comes to a contact: its fall then ends a smallest radius from a side, and a packing that lies
    already, since it has settled or was compressed, does not count.
    """
    assert scene.grains
    g = math.hypot(*scene.gravity)
    speeds = [math.hypot(*it.velocity) + abs(it.spin) * it.diameter / 2 for it in by_hand(scene)]
    speeds.append(strain_speed(scene, sizes[2]))
    for density in densities_of_bodies(scene):
        lighter = 1 - scales.density / density if scales else 1.0
        reach, unending = fall(scene, -1.0 if lighter < 0 else 1.0, frames, lying=not impact)
        reach = max(0.0, reach - sizes[0] / 2) if impact else reach
        free = abs(lighter) * g * scene.time.end if unending else math.sqrt(2 * abs(lighter) * g * reach)
        if scales:
            free = min(free, terminal_speed(sizes[2], abs(density / scales.density - 1) * g, scales.viscosity))
        speeds.append(free)
    return max(speeds)


def strain_speed(scene: Scene, diameter: float) -> float:
    """The largest speed (m/s) of what a given strain presses together: two grains of ``diameter`` (m) in a [cell], with
    velocities relative to it, and a plate of [rock] and what lies at it."""
    cell, rock, packing = scene.cell, scene.rock, scene.grains.packing if scene.grains else None
    rates = [it.largest for it in (cell.rate_xx, cell.rate_yy, cell.rate_xy) if it] if cell else []
    speed = max(rates, default=0.0) * diameter
    if rock and rock.strain and packing:
        speed = max(speed, rock.strain.steepest * (packing.width if rock.plates == "x" else packing.height))
    return speed


def given_speed(scene: Scene) -> float:
    """The largest speed that the scene itself states, m/s: of sides, of the fluid at the start, of what is towed or
    controlled."""
    speeds = [side.peak for side in scene.domain.sides.values()]
    speeds += [inflow_peak(scene, name) for name in scene.domain.sides]
    speeds += [disc.fastest for disc in scene.disc] + [it.fastest for it in scene.rectangle]
    speeds += [math.hypot(it.x.fastest, it.y.fastest) for it in scene.control]
    if scene.ring:  # what fills it turns with it up to the corners of the box
        d, at = scene.domain, scene.ring
        speeds.append(abs(at.spin) * math.hypot(max(at.x, d.width - at.x), max(at.y, d.height - at.y)))
    if scene.fluid:
        speeds.append(math.hypot(*scene.fluid.velocity))
    if scene.gate and scene.gate.lift_speed:
        speeds.append(scene.gate.lift_speed)
    return max(speeds)


def _framed_speed(containers: Sequence[Container], frames: Sequence[Placed]) -> float:
    """The largest speed that bodies of segments start with or are prescribed to have, m/s."""
    speeds = [0.0]
    for it in frames:
        size = float(np.ptp(np.array(it.frame.corners), axis=0).max())
        speeds.append(math.hypot(*it.frame.velocity) + abs(it.frame.spin) * size)
    for one in containers:
        points = np.array(one.chain or one.ends).reshape(-1, 2)
        size = float(np.ptp(points, axis=0).max())
        arm = 0.0 if one.pivot is None else float(np.hypot(*(points - one.pivot).T).max())
        speeds.append(math.hypot(one.x.fastest, one.y.fastest) + one.rotation.fastest * max(size, arm))
    return max(speeds)


def fall(scene: Scene, sense: float, frames: Sequence[Placed] = (), *, lying: bool = True) -> tuple[float, bool]:
    """How far (m) a grain can go along gravity (``sense`` 1) or against it (-1), and whether a periodic side makes
    that endless.  From a grain's centre, or the far edge of the packing, to the last corner of the box.  A body whose
    motion along gravity is prescribed does not fall, nor, unless ``lying``, a packing that lies already.
    """
    g = math.hypot(*scene.gravity)
    if g == 0 or scene.grains is None:
        return 0.0, False
    along = [sense * component / g for component in scene.gravity]
    d = scene.domain
    unending = any(component != 0 and endless for component, endless in zip(along, d.periodic, strict=True))
    held = controls_by_hand(scene)
    starts = [(it.x, it.y) for it, by in zip(by_hand(scene), held, strict=True) if not _borne(scene, by)]
    starts += [corner for it in _falling(scene, frames) for corner in it.frame.corners]
    packing = scene.grains.packing
    if packing and (lying or not (packing.settle or packing.compress)):
        right, top = packing.left + packing.width, packing.bottom + packing.height
        starts += [(x, y) for x in (packing.left, right) for y in (packing.bottom, top)]
    if not starts:
        return 0.0, False
    last = sum(max(0.0, component * size) for component, size in zip(along, (d.width, d.height), strict=True))
    return max([0.0, *(last - (along[0] * x + along[1] * y) for x, y in starts)]), unending


def _borne(scene: Scene, by: Controlled | None) -> bool:
    """Whether a control prescribes the motion of a body along gravity."""
    if by is None:
        return False
    return all(axis.prescribes for axis, pull in zip((by.x, by.y), scene.gravity, strict=True) if pull != 0.0)


def _falling(scene: Scene, frames: Sequence[Placed]) -> list[Placed]:
    """The frames that are free to move along gravity."""
    given, found = {it.of: it for it in scene.control}, []
    for kind in ("segment", "polygon", "rock"):
        same = [it for it in frames if it.kind == kind]
        found += [it for k, it in enumerate(same) if it.free and not _borne(scene, given.get((kind, k)))]
    return found


def travel_step(scene: Scene, speed: float, radius: float, frames: Sequence[Placed] = ()) -> float:
    """Contact step (s) in which nothing goes further at the ``speed`` (m/s) to expect than a run allows: WORST_TRAVEL
    of the smallest ``radius`` (m), a corner of ``frames`` WORST_OF_TRAVELLING_CORNERS of the smallest thickness.
    Infinite where nothing moves, and where the fall has no end: that speed is a bound which hardly anything reaches.
    """
    thickness = min((it.frame.thickness for it in frames if it.frame.thickness > 0.0), default=math.inf)
    way = min(WORST_TRAVEL * radius, WORST_OF_TRAVELLING_CORNERS * thickness)
    return way / speed if speed > 0.0 and not fall(scene, 1.0, frames)[1] else math.inf


def too_soft(
    scene: Scene, scales: Scales | None, sizes: Sizes, laws: Sequence[ContactLaw], frames: Sequence[Placed] = ()
) -> str:
    """A warning where grains fall so fast that a contact is pressed as deep as where a run stops; "" where not.

    laws : of two grains, and of a grain and a wall, of the smallest grains, for which Hertz's law is deepest over the
    radius, at the largest density.  A linear dashpot with the damping ratio h leaves exp(-h arccos(h)/sqrt(1 - h²)) of
    the overlap; a user's law is integrated with its damping.  A fall without an end is a bound that hardly anything
    reaches: left out.
    """
    assert scene.grains
    assert scene.contact
    if fall(scene, 1.0, frames)[1]:
        return ""
    speed, radius = grain_speed(scene, scales, sizes, frames, impact=True), sizes[0] / 2
    mass, stiffer, limit = math.pi * radius**2 * densities_of_bodies(scene)[-1], 0.0, WORST_OVERLAP * radius
    deepest = 0.0
    for law, share in zip(laws, (0.5, 1.0), strict=True):  # reduced mass and radius are half of a grain's own, or these
        depth, power = law.impact(share * mass, share * radius, speed) if speed > 0.0 else (0.0, 1.0)
        if not isinstance(law, OwnContact):
            h = min(law.ratio_of_damping(share * mass, share * radius), 1.0 - 1e-9)
            depth *= math.exp(-h * math.acos(h) / math.sqrt(1.0 - h**2))
        deepest, stiffer = max(deepest, depth), max(stiffer, (depth / limit) ** power)
    if deepest <= limit:
        return ""
    key, unit = law_class(scene.contact).required
    value = getattr(scene.contact, key) if key and not scene.material else None
    enough = f"{ROUNDED_UP * stiffer:.2g} times as stiff ones suffice"
    if value is not None:
        enough = f"contact.{key} = {ROUNDED_UP * stiffer * value:.2g} {unit} suffices"
    return (
        f"contacts are too soft: a grain at {speed:.2g} m/s, which is to be expected, presses one by {deepest:.2g} m,"
        f" and beyond {limit:.2g} m, {WORST_OVERLAP:g} of its radius, a run stops; {enough}"
    )


def column_height(packing: Packing, gravity: tuple[float, float]) -> float:
    """Extent of a packing along gravity (m/s²), m; 0 without gravity."""
    g = math.hypot(*gravity)
    return (abs(gravity[0]) * packing.width + abs(gravity[1]) * packing.height) / g if g else 0.0


def terminal_speed(diameter: float, reduced_gravity: float, viscosity: float) -> float:
    """Terminal speed (m/s) of a disc of ``diameter`` (m) in unbounded fluid of ``viscosity`` (m²/s); by bisection.

    reduced_gravity : |s - 1| g, m/s².  Balance  |s - 1| g pi d²/4 = C_D d U²/2  with C_D the sum of Lamb's
    8 pi/(Re (1/2 - 0.5772 - ln(Re/8))) (1911, for Re < 1, its logarithm held there) and 1.2: an estimate to some 20 %.
    """
    low, high = 0.0, math.sqrt(math.pi * reduced_gravity * diameter / (2 * BLUNT))
    for _ in range(60):
        mid = 0.5 * (low + high)
        reynolds = max(mid * diameter / viscosity, 1e-12)
        lamb = 8 * math.pi / (reynolds * (0.5 - 0.5772 - math.log(min(reynolds, 1.0) / 8)))
        if (lamb + BLUNT) * mid**2 / 2 < reduced_gravity * math.pi / 4 * diameter:
            low = mid
        else:
            high = mid
    return high


def check_regime(
    scene: Scene, scales: Scales, speed: float, sizes: Sizes | None, faults: list[Fault], warnings: list[str]
) -> float:
    """Judge Mach, pore pressure, relaxation time and resolution; returns the relative density variation.

    Adds refusals to ``faults`` and doubts to ``warnings``, each with its repair.
    """
    _check_mach(scales, speed, faults, warnings)
    _check_operator(scene, scales, speed, sizes, faults, warnings)
    _check_thickness(scene.rectangle, scales, warnings)
    check_sound(scene, scales, warnings)
    check_gate(scene, scales, warnings)
    check_pistons(scene, scales, warnings)
    check_inflows(scene, scales, warnings)
    check_start(scene, scales, warnings)
    check_flows(scene, scales, sizes is not None, faults, warnings)
    if scene.ring and scene.ring.diameter < RING_CELLS * scales.spacing:
        repair = f"a spacing of {scene.ring.diameter / RING_CELLS:.2g} m gives it so many"
        cells, allowed = (
            f"is {scene.ring.diameter / scales.spacing:.3g} cells wide",
            f">= {RING_CELLS * scales.spacing:g}",
        )
        faults.append(Fault("ring.diameter", scene.ring.diameter, cells, "m", allowed, repair))
    warnings += filter(None, [narrow_gap(scene, scales)])
    if sizes is None:
        return 0.0
    assert scene.fluid
    laws = scene.fluid.solid_operator, weight_of(scene.fluid)
    packing = scene.grains.packing if scene.grains else None
    ratio = (scene.grains.hydraulic_radius_ratio or 1.0) if scene.grains else 1.0
    smallest, mean = (size * ratio / scales.spacing for size in sizes[:2])
    filled = packing.packing_fraction * ratio**2 if packing else 0.0
    found = [coarse(mean, *laws, scales.spacing, filled), slow(scales.relaxation_time, laws[0])]
    if smallest < SMALLEST * mean:
        found.append(coarse_smallest(smallest, mean, scales.spacing))
    if scene.grains and scene.disc:  # the sizes are those of what is free
        held = coarse(min(it.diameter for it in scene.disc) / scales.spacing, *laws, scales.spacing)
        found.append(f"the smallest held disc has {held}" if held and held not in found else "")
    if scene.grains:
        found.append(
            light(least_density(MaterialPlan.of(scene), scene.clump) / scales.density, smallest, *laws, scales.spacing)
        )
    warnings += filter(None, found)
    if scene.grains is None or packing is None:
        return 0.0
    if ratio == 1:
        warnings.append(
            "hydraulic_radius_ratio = 1 seals a two-dimensional bed at rest, since its pores do not connect: "
            "it breaches at a rate set by numerical leak; 0.7 to 0.9 opens them"
        )
    weight = abs(density_of_packing(scene) - scales.density) * math.hypot(*scene.gravity) * packing.packing_fraction
    return _check_pore_pressure(weight, column_height(packing, scene.gravity), scales, faults, warnings)


def _check_operator(
    scene: Scene, scales: Scales, speed: float, sizes: Sizes | None, faults: list[Fault], warnings: list[str]
) -> None:
    """Where the operators that the scene names oscillate, diverge or do not suit the scene."""
    assert scene.fluid
    fluid, lid = scene.fluid, any(side.speed for side in scene.domain.sides.values())
    doubt = thin(scales, speed, fluid.operator, eddies=fluid.smagorinsky is not None, lid=lid)
    if doubt:
        warnings.append(doubt)
    if (
        fluid.magic != type(fluid).model_fields["magic"].default
        and "magic" not in choose(**collision_options(fluid), **UNIT)._fields
    ):
        warnings.append(
            f"fluid.magic = {fluid.magic:g} is not used: the operator {fluid.operator!r} has no such parameter"
        )
    default = type(fluid).model_fields["solid_operator"].default
    if sizes is None and not (scene.rectangle or scene.ring) and (fluid.solid_operator != default or fluid.weighting):
        warnings.append("fluid.solid_operator and fluid.weighting are not used: there is nothing solid in the fluid")
    made_for = SOLID_OPERATORS[fluid.solid_operator].magic
    if made_for is not None and fluid.magic != made_for:
        warnings.append(
            f"fluid.magic = {fluid.magic:g}: the solid operator {fluid.solid_operator!r} is made for {made_for:g}, and"
            " drag in dense beds is some 10 % off with another; leave it out"
        )
    slowness = speed / scales.velocity
    if fluid.precision == "float32" and 0 < slowness < SINGLE_PRECISION:
        warnings.append(
            f"fluid.precision = 'float32': speeds of {slowness:.2g} cells a step are near its round-off; take float64 "
            "or longer steps"
        )


def _check_thickness(sections: Sequence[Rectangle], scales: Scales, warnings: list[str]) -> None:
    """Rectangles that may fill no cell wholly."""
    for k, it in enumerate(sections):
        thinnest = min(it.upper[a] - it.lower[a] for a in range(2))
        if thinnest < CELLS_THICK * scales.spacing * (1 - 1e-9):
            warnings.append(
                f"rectangle {k} is {thinnest / scales.spacing:.3g} cells thick: below {CELLS_THICK:g} it may fill no"
                f" cell and lets fluid through; a spacing of {thinnest / CELLS_THICK:.2g} m fills some"
            )


def _check_mach(scales: Scales, speed: float, faults: list[Fault], warnings: list[str]) -> None:
    mach = speed / scales.sound_speed
    if mach <= MACH_WARN:
        return
    problem = f"a speed of {speed:.3g} m/s is to be expected, Mach {mach:.2g}"
    repair = f"a step of {scales.step * 0.9 * MACH_WARN / mach:.2g} s keeps it below {MACH_WARN}"
    if mach > MACH_REFUSE:
        faults.append(Fault("fluid.step", scales.step, problem, "s", repair=repair))
    else:
        warnings.append(f"{problem}: errors grow as its square; {repair}")


def _check_pore_pressure(
    weight: float, height: float, scales: Scales, faults: list[Fault], warnings: list[str]
) -> float:
    """Density variation 3 w H/(rho0 c²) when pore water takes the column's weight, c = h/dt;  weight : buoyant,
    w = |rho_s - rho0| g phi, N/m³;  height : H, m."""
    variation = 3 * weight * height / (scales.density * scales.velocity**2)
    if variation <= DENSITY_WARN:
        return variation
    problem = f"pore pressure under the packing can change the fluid's density by {variation:.2g}"
    step = scales.step * math.sqrt(0.9 * DENSITY_WARN / variation)
    repair = f"a step of {step:.2g} s keeps it below {DENSITY_WARN}"
    if variation > DENSITY_REFUSE:
        faults.append(Fault("fluid.step", scales.step, problem, "s", repair=repair))
    else:
        warnings.append(f"{problem}; {repair}")
    return variation

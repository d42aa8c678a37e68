"""The regime of a scene: the largest speed to expect, and what Mach, pore pressure and resolution then mean."""

from __future__ import annotations

import math

from porescale.ground.check import Fault
from porescale.lbm.scales import Scales
from porescale.scene.sections import Scene

DENSITY_WARN, DENSITY_REFUSE = 0.05, 0.3
"""Density variation by the weight of a column: measured runs varied by twice this estimate (0.05: 4-10 %)."""
MACH_WARN, MACH_REFUSE = 0.1, 0.3
"""Errors of compressibility grow as the square of the Mach number: 1 % and 9 %."""
TRT_FLOOR = 0.505
"""Relaxation time below which two relaxation times ring or blow up in fast flow."""
TAU_COARSE = 1.5
"""Relaxation time above which the drag at 10 cells per diameter is more than a tenth too small."""
CELLS_COARSE = 4.0
"""Cells per hydraulic diameter below which drag is off by a tenth or more."""
LIGHT, LIGHT_CELLS = 0.5, 16.0
"""Density ratio below which free grains need so many cells: 0.3 is stable at 16 and diverges at 10 (measured)."""
BLUNT = 1.2
"""Drag coefficient of a cylinder in cross flow at Reynolds numbers of 10² to 10⁵."""

Sizes = tuple[float, float, float]


def expected_speed(scene: Scene, scales: Scales | None, sizes: Sizes | None) -> float:
    """The largest speed to expect, m/s: an upper estimate from energy, drag and what the scene starts with.

    Grains: free fall over the distance they can fall along gravity (rise against it, where they are lighter than the
    fluid), reduced by buoyancy; over a periodic side, which has no end, for as long as the run lasts.  In fluid the
    terminal speed of a grain if that is less, and for a packing that of the gravity current it can become,
    sqrt(g' H)/2 with g' = phi |s - 1| g (Benjamin 1968): grains that fall together fall faster than each alone.
    Fluid under a body force: the parabola between the walls across it, which grains in its way only slow down.
    """
    g, speed = math.hypot(*scene.gravity), 0.0
    if scene.grains and sizes:
        for grain in scene.grains.grain:
            speed = max(speed, math.hypot(*grain.velocity) + abs(grain.spin) * grain.diameter / 2)
        packing = scene.grains.packing
        lighter = 1 - scales.density / scene.grains.density if scales else 1.0
        reach, unending = fall(scene, -1.0 if lighter < 0 else 1.0)
        free = abs(lighter) * g * scene.time.end if unending else math.sqrt(2 * abs(lighter) * g * reach)
        if scales:
            driving = abs(scene.grains.density / scales.density - 1) * g
            free = min(free, terminal_speed(sizes[2], driving, scales.viscosity))
            if packing:
                free = max(free, 0.5 * math.sqrt(packing.packing_fraction * driving * column_height(scene)))
        speed = max(speed, free)
    if scene.fluid and scales:
        push = math.hypot(*scene.fluid.body_force) / scales.density
        across = min(scene.domain.width, scene.domain.height)
        speed = max(speed, push * across**2 / (8 * scales.viscosity))
    return speed


def fall(scene: Scene, sense: float) -> tuple[float, bool]:
    """How far (m) a grain can go along gravity (``sense`` 1) or against it (-1), and whether a periodic side makes
    that endless.  From a grain's centre, or the far edge of the packing, to the last corner of the box.
    """
    g = math.hypot(*scene.gravity)
    if g == 0 or scene.grains is None:
        return 0.0, False
    along = [sense * component / g for component in scene.gravity]
    d = scene.domain
    unending = (along[0] != 0 and d.left == "periodic") or (along[1] != 0 and d.bottom == "periodic")
    starts = [(grain.x, grain.y) for grain in scene.grains.grain]
    if packing := scene.grains.packing:
        right, top = packing.left + packing.width, packing.bottom + packing.height
        starts += [(x, y) for x in (packing.left, right) for y in (packing.bottom, top)]
    last = sum(max(0.0, component * size) for component, size in zip(along, (d.width, d.height), strict=True))
    return max(0.0, *(last - (along[0] * x + along[1] * y) for x, y in starts)), unending


def column_height(scene: Scene) -> float:
    """Extent of the packing along gravity, m; 0 without one."""
    packing, g = scene.grains.packing if scene.grains else None, math.hypot(*scene.gravity)
    if packing is None or g == 0:
        return 0.0
    return (abs(scene.gravity[0]) * packing.width + abs(scene.gravity[1]) * packing.height) / g


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


def judge(
    scene: Scene, scales: Scales, speed: float, sizes: Sizes | None, faults: list[Fault], warnings: list[str]
) -> float:
    """Judge Mach, pore pressure, relaxation time and resolution; returns the relative density variation.

    Adds refusals to ``faults`` and doubts to ``warnings``, each with its repair.
    """
    _judge_mach(scales, speed, faults, warnings)
    if scales.relaxation_time < TRT_FLOOR:
        warnings.append(
            f"relaxation time {scales.relaxation_time:.4f}: two relaxation times ring below {TRT_FLOOR} in fast flow; "
            "refine the spacing or raise the viscosity"
        )
    if scene.grains is None or sizes is None:
        return 0.0
    ratio = scene.grains.hydraulic_radius_ratio or 1.0
    across = sizes[1] * ratio / scales.spacing
    if across < CELLS_COARSE:
        warnings.append(
            f"the fluid sees {across:.3g} cells per grain: below {CELLS_COARSE:g} the drag is off by a tenth"
        )
    lightness = scene.grains.density / scales.density
    if lightness < LIGHT and sizes[0] * ratio / scales.spacing < LIGHT_CELLS:
        warnings.append(
            f"density ratio {lightness:.3g} with {sizes[0] * ratio / scales.spacing:.3g} cells per grain: grains below "
            f"{LIGHT} were unstable with fewer than {LIGHT_CELLS:g} cells; refine the spacing"
        )
    if scales.relaxation_time > TAU_COARSE:
        warnings.append(
            f"relaxation time {scales.relaxation_time:.3g}: above {TAU_COARSE} the drag is a tenth too small or more; "
            "shorten the step"
        )
    if scene.grains.packing is None:
        return 0.0
    if ratio == 1:
        warnings.append(
            "hydraulic_radius_ratio = 1 seals a two-dimensional bed at rest, since its pores do not connect: "
            "it breaches at a rate set by numerical leak; 0.7 to 0.9 opens them"
        )
    return _judge_pore_pressure(scene, scales, faults, warnings)


def _judge_mach(scales: Scales, speed: float, faults: list[Fault], warnings: list[str]) -> None:
    mach = speed / scales.sound_speed
    if mach <= MACH_WARN:
        return
    problem = f"a speed of {speed:.3g} m/s is to be expected, Mach {mach:.2g}"
    repair = f"a step of {scales.step * 0.9 * MACH_WARN / mach:.2g} s keeps it below {MACH_WARN}"
    if mach > MACH_REFUSE:
        faults.append(Fault("fluid.step", scales.step, problem, "s", repair=repair))
    else:
        warnings.append(f"{problem}: errors grow as its square; {repair}")


def _judge_pore_pressure(scene: Scene, scales: Scales, faults: list[Fault], warnings: list[str]) -> float:
    """Density variation 3 |rho_s - rho0| g phi H/(rho0 c²) when pore water takes the column's weight, c = h/dt."""
    assert scene.grains is not None
    packing = scene.grains.packing
    assert packing is not None
    weight = abs(scene.grains.density - scales.density) * math.hypot(*scene.gravity) * packing.packing_fraction
    variation = 3 * weight * column_height(scene) / (scales.density * scales.velocity**2)
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

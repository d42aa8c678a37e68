"""The report of `check` on a scene of soil before it runs."""

import math

import numpy as np

from continuum_sph.builders.parts.material import material_of
from continuum_sph.builders.parts.soil import soil_law, soil_particles, soil_section
from continuum_sph.builders.parts.watched import watched_rows
from continuum_sph.builders.reports.time_report import AVERAGE, SOIL, STAGE, report_run, step_seconds
from continuum_sph.scene.bounds import WHOLE
from continuum_sph.scene.material_file import Origin
from continuum_sph.scene.sections import Scene
from continuum_sph.scene.soil import SoilSection
from continuum_sph.soil import SoilLaw
from continuum_sph.soil.material import Material
from continuum_sph.soil.momentum import BRAKED_BY, HELD_BACK
from continuum_sph.soil.parameters import RULES
from continuum_sph.soil.softening import band_width
from porescale.common.api.report import Report, report_output

SNAPSHOT = 80  # per particle of a snapshot on disk, about
BYTES = 900  # per particle: state, record, and about 27 partners in two lists
STEEPEST, FEWEST = math.radians(75.0), 4
"""Steepest face on which cohesive ground without tension stood (10 and 20 rows, c = γH): of 80 degrees and more it fell
within 4 s.  And rows of a face that is more than a step of particles."""
HEAVIEST = 4000.0  # kg/m³, of grains: quartz has 2650, basalt 3000, garnet up to 4300
TENTH = 0.1  # of the strength, by which damping holds a slip back that `check` names
SOFTEST = 0.02
"""Strain at the floor under its own weight above which soil is so soft that its shape is not the scene's.  It falls to
nothing at the surface, so the mean is half of it: heights and densities change by 1 % as the weight comes on or is
taken off.  Cases have up to 1.9 %."""


def soil_report(scene: Scene, bound: float = math.inf, stages: float = 0.0) -> Report:
    """Resolution, stiffness, strength, steps and cost; warns of soil too soft for its weight.

    bound : on the step, s;  stages : of the flow of water under suction in a step.
    """
    section, law = soil_section(scene), soil_law(scene)
    material, spacing = material_of(section), law.spacing
    count = len(soil_particles(scene)[0])
    out = Report(scene.title or "soil in a tank")
    out.heading("resolution")
    out.row("soil particles", count)
    out.row("particles in the soil's height", section.height / spacing)
    report_watched(scene, out)
    out.row("smoothing length", law.smoothing.length, "m", law.smoothing.name)
    out.heading("stiffness")
    pressure = 0.5 * material.density * scene.gravity * section.height * (1.0 + material.rest)
    stiffest = material.stiffness_at(pressure)
    column = material.column_modulus * stiffest / material.stiffness
    out.row("Young's modulus at the floor", stiffest, "Pa", f"mean stress {pressure:.4g} Pa")
    out.row("modulus of a column, B + G", column, "Pa", f"area modulus B: {material.modulus}")
    out.row("stress ratio at rest K0", material.rest, "", "as a column settles that cannot widen")
    report_strain(out, section, material.density * scene.gravity * section.height)
    sound = math.sqrt(column / material.density)
    out.row("sound speed at the floor", sound, "m/s")
    out.heading("strength")
    phi, psi = section.friction_angle, section.dilatancy_angle
    if section.elastic:
        out.row("never yields", 0.0)
    else:
        out.row("stress ratio at failure", (1.0 + math.sin(phi)) / (1.0 - math.sin(phi)), "", "without cohesion")
        limit = math.atan(math.sin(phi) * math.cos(psi) / (1.0 - math.sin(phi) * math.sin(psi)))
        out.row("angle at which an endless slope shears", math.degrees(limit), "degrees", "without cohesion")
    report_slip(out, section, law, material.density * scene.gravity * section.height)
    warn_of_rest(out, section, material, material.density * scene.gravity * section.height)
    warn_of_steep_faces(scene, out)
    report_softening(out, section, law, pressure)
    report_rate(out, scene, wet=section.suction is not None)
    report_side_walls(out, section, wet=section.suction is not None)
    out.heading("steps")
    limits = law.limits(2.0 * scene.gravity, sound / law.smoothing.length, math.inf)
    step = min(limits)
    out.row("longest step", step, "s", f"limited by {RULES[limits.index(step)]}")
    steps = scene.time.end / min(step, bound)
    out.row("steps", round(steps))
    out.row("memory", BYTES * count / 2**20, "MiB")
    seconds = step_seconds((SOIL, count)) + stages * step_seconds((STAGE, count)) + averaging_seconds(law, count)
    report_run(out, scene, "soil with suction" if stages else "soil", count, steps, seconds)
    report_output(out, scene.time.end, scene.output, round(steps), 1000.0 + SNAPSHOT * count)
    report_origin(out, section.origin)
    warn_of_grains(out, section)
    return out


def report_strain(out: Report, section: SoilSection, weight: float) -> None:
    """Add to a report how a ``weight`` (Pa), the most that grains bear at rest, strains soil; warn where it is soft."""
    material = material_of(section)
    stiffest = material.stiffness_at(0.5 * weight * (1.0 + material.rest))
    strain = weight / (material.column_modulus * stiffest / material.stiffness)
    out.row("strain under its own weight at the floor", strain)
    if strain > SOFTEST:
        out.warn(
            f"the soil's weight strains it by {100.0 * strain:.3g} %: raise soil.stiffness to "
            f"{math.ceil(section.stiffness * strain / SOFTEST)} Pa, which makes it {100.0 * SOFTEST:g} %"
        )


def warn_of_rest(out: Report, section: SoilSection, material: Material, weight: float) -> None:
    """Warn of stresses at the start that the soil cannot bear where it carries a ``weight``, Pa."""
    if section.rest is None or section.elastic or section.stress != "geostatic":
        return
    sine, held = material.sin_friction, 2.0 * material.cohesion_intercept / max(weight, 1e-300)
    least, most = max(0.0, (1.0 - sine - held) / (1.0 + sine)), (1.0 + sine + held) / (1.0 - sine)
    if not least * (1.0 - 1e-9) <= section.rest <= most * (1.0 + 1e-9):
        out.warn(
            f"soil.rest = {section.rest:g} is beyond the strength at the foot of the ground, which bears {least:.3g} "
            f"to {most:.3g}: it yields in the first step"
        )


def steep_faces(scene: Scene) -> list[tuple[float, float]]:
    """Inclination (rad) and height (m) of the sides of the ground that are free and steeper than STEEPEST."""
    section, spacing, found = soil_section(scene), scene.numerics.spacing, []
    for body in section.body:
        for (ax, ay), (bx, by) in zip(body.outline, (*body.outline[1:], body.outline[0]), strict=True):
            wide, high = abs(bx - ax), abs(by - ay)
            if high < FEWEST * spacing or math.atan2(high, wide) <= STEEPEST:
                continue
            beside = 0.5 * (ax + bx) + spacing * np.array([-1.0, 1.0])
            middle = np.column_stack((beside, np.full(2, 0.5 * (ay + by))))
            ground = np.any([it.holds(middle) for it in section.body], axis=0)
            open_to = ~ground & (beside > 0.0) & (beside < scene.inner[0])
            if ground.any() and open_to.any():
                found.append((math.atan2(high, wide), high))
    return found


def warn_of_steep_faces(scene: Scene, out: Report) -> None:
    """Warn of cohesive ground without tension that has a steep face.

    Nothing holds slabs of it to each other, and an upright slab of height H that is not held topples: what it leans
    grows as exp(√(3g/2H) t), however strong it is.  Seen of cuts of 1 m: by 2.9 and 3.3 of 3.8 per second with 10 and
    20 rows.
    """
    section = soil_section(scene)
    if section.elastic or section.held or section.suction or section.tension > 0.0 or section.cohesion == 0.0:
        return
    faces = steep_faces(scene)
    if faces:
        angle, high = max(faces)
        slope = math.tan(section.friction_angle)
        most = f" up to {section.cohesion / slope:.4g} Pa (c cot φ)" if slope > 0.0 else ""
        out.warn(
            f"a face of {math.degrees(angle):.3g} degrees, {high:.3g} m high, in ground without soil.tension: slabs of "
            f"it topple, however large soil.cohesion is; give soil.tension a value{most}"
        )


def report_softening(out: Report, section: SoilSection, law: SoilLaw, pressure: float) -> None:
    """Add to a report what strength falls to, and by what slip; warn where particles lose it at once.

    pressure : mean stress at the floor, Pa.
    """
    left, material = section.softening, law.materials[0]
    if left is None or material.softening is None:
        return
    out.heading("strength")
    out.row("angle of friction after large strains", math.degrees(left.friction_angle), "degrees")
    out.row("cohesion after large strains", left.cohesion, "Pa")
    slip = left.shear_strain * left.band_width
    strain = slip / (2.0 * law.spacing)  # of the two rows of a band of particles
    out.row("slip of a shear band that leaves 1/e of the difference", slip, "m", f"two rows strain by {strain:.3g}")
    width = band_width(law.smoothing, law.spacing, law.averages)
    out.row("width of a band of particles", width, "m", f"averages in a step: {law.averages}")
    if width > left.band_width * (1.0 + WHOLE):
        out.warn(
            f"a band of particles is {width / left.band_width:.3g} times as wide as soil.softening.band_width: strain "
            "that is in no band yet softens soil as much sooner, so when it fails hangs on the spacing; lower "
            "numerics.spacing, or widen the band and lower shear_strain by as much"
        )
    if left.band_width >= band_width(law.smoothing, law.spacing, law.averages + 1):
        out.warn(
            f"a band of particles is {width:.3g} m wide at most, {left.band_width / width:.3g} times less than "
            "soil.softening.band_width: strain that is in no band yet softens soil as much later; raise "
            "numerics.spacing, or narrow the band and raise shear_strain by as much"
        )
    lost = material.cohesion_intercept - material.softening.cohesion_intercept
    lost += pressure * (material.sin_friction - material.softening.sin_friction)
    elastic = lost / (material.shear_modulus * material.stiffness_at(pressure))
    if strain < elastic:
        out.warn(
            f"a band of particles softens within a shear strain of {strain:.2g}, less than the elastic one that it "
            f"gives back, {elastic:.2g}: it breaks at once; lower numerics.spacing by a factor of "
            f"{elastic / strain:.2g}, or raise soil.stiffness"
        )


def averaging_seconds(law: SoilLaw, count: int) -> float:
    """Nominal seconds of a step in which ``count`` particles of soil average what they shear, where it softens."""
    if not any(material.softening for material in law.materials):
        return 0.0
    return law.averages * step_seconds((AVERAGE, count))


def report_rate(out: Report, scene: Scene, *, wet: bool) -> None:
    """Add to a report how the friction of a soil grows with the rate of shear, and warn of ``wet`` soil."""
    section, viscosity = soil_section(scene), scene.water.viscosity
    rate = section.rate
    if rate is None:
        return
    out.heading("strength")
    fastest = math.degrees(math.atan(math.sin(rate.friction_angle)))
    out.row("angle beyond which it speeds up without end", fastest, "degrees", "without cohesion and dilatancy")
    pace, grains = math.sqrt(scene.gravity / section.height), section.density / (1.0 - section.porosity)
    # of √(g/H) under ρ g H/2: the same under any gravity
    inertial = rate.grain_diameter / section.height * math.sqrt(2.0 * grains / section.density)
    about = f"shear by √(g/H) at half of its height; I0 {rate.inertial_number:g}"
    out.row("inertial number of its own fall", inertial, "", about)
    if wet and viscosity > 0.0:
        stokes = grains * rate.grain_diameter**2 * pace / viscosity
        out.warn(f"[soil.rate] is of dry grains: in water, viscosity can brake them first (Stokes number {stokes:.2g})")


def report_slip(out: Report, section: SoilSection, law: SoilLaw, weight: float) -> None:
    """Add to a report how fast a slip may be before damping bears of it what the soil should, where grains bear
    ``weight`` (Pa) at the floor."""
    if section.elastic or section.held or law.printed_damping or not law.damping > 0.0:
        return
    if law.bounded:
        out.row("slip held back by damping", HELD_BACK, "", "of the strength, at any speed and spacing")
        return
    material = law.materials[0]
    strength = 0.5 * weight * material.sin_friction + material.cohesion_intercept
    pressure = 0.5 * weight * (1.0 + material.rest)
    sound = math.sqrt(material.column_modulus * material.stiffness_at(pressure) / material.stiffness / material.density)
    viscous = BRAKED_BY * material.density * law.damping * sound * law.smoothing.length
    speed = TENTH * strength * law.spacing / viscous
    why = f'of the strength at half height; damping_of = "bounded": {100.0 * HELD_BACK:.2g} % at any speed'
    out.row("slip held back by a tenth", speed, "m/s", why)


def report_side_walls(out: Report, section: SoilSection, *, wet: bool) -> None:
    """Add to a report how much the side walls of a soil brake it, and warn of ``wet`` soil between them."""
    walls = section.side_walls
    if walls is None:
        return
    out.heading("side walls")
    rub = math.tan(walls.friction_angle)
    if rub > 0.0:
        alike = 0.5 * walls.distance * math.sin(section.friction_angle) / rub
        out.row("depth at which they brake as its own friction does", alike, "m", "W sin φ/(2 tan δ)")
    if wet:
        out.warn("[soil.side_walls] brake the soil alone: water slides along them without friction")


def warn_of_grains(out: Report, section: SoilSection, water: float = 0.0) -> None:
    """A warning where density and porosity make grains heavier than minerals are: often it was given as theirs; or
    lighter than the ``water`` about them, kg/m³."""
    grains = section.density / (1.0 - section.porosity)
    if grains > HEAVIEST:
        out.warn(
            f"soil.density = {section.density:.4g} kg/m³ is of grains per whole volume, which at a porosity of "
            f"{section.porosity:.3g} makes grains of {grains:.4g} kg/m³: "
            "(1 - n) times theirs is meant, or a lower soil.porosity"
        )
    elif grains <= water:
        out.warn(
            f"soil.density = {section.density:.4g} kg/m³ at a porosity of {section.porosity:.3g} makes grains of "
            f"{grains:.4g} kg/m³, which do not sink in water: ground below it floats; give the dry density of the "
            "ground, or a higher soil.porosity"
        )


def report_origin(out: Report, origin: Origin | None) -> None:
    """Add to a report what a scene's soil was measured with, how well, and what is to be doubted of it."""
    if origin is None:
        return
    out.heading("measured on grains")
    out.row("file", origin.file, "", f"SHA-256 {origin.sha256[:12]}")
    for name, (mean, _) in origin.measured.items():
        scale, unit = (math.degrees(1.0), "degrees") if name.endswith("angle") else (1.0, "")
        wide = origin.intervals.get(name)
        bar = "no interval: too few packings" if wide is None else f"± {scale * wide:.2g} (95 %)"
        out.row(name.replace("_", " "), scale * mean, unit, bar)
    for key in ("command", "version", "lambda", "cells", "pressure"):
        if isinstance(value := origin.made.get(key), str | int | float):
            out.row(key, value)
    for doubt in origin.made.get("doubts") or ():
        out.warn(f"{origin.file}: {doubt}")


def report_watched(scene: Scene, out: Report) -> None:
    """Add to a report how many particles each watched part of a scene's soil has; InputError if one has none."""
    for name, rows in watched_rows(scene).items():
        out.row(f"particles of {name}", len(rows))

"""The report of `check` on a scene of soil and water before it runs."""

import math
from typing import NamedTuple

import numpy as np

from continuum_sph.builders.parts.air import air_pores, air_report
from continuum_sph.builders.parts.faces import FARTHEST
from continuum_sph.builders.parts.material import material_of
from continuum_sph.builders.parts.pore_water import buoyancy, pore_law, water_counts
from continuum_sph.builders.parts.sheet_pile import LEAST, LEAST_BARE, OPEN, closed, given_heads, ground_at, resolved
from continuum_sph.builders.parts.soil import porous_section, soil_law, soil_particles, soil_section
from continuum_sph.builders.parts.stiffness import NATURAL, STIFF, largest_modulus, sound_speed
from continuum_sph.builders.parts.water import wall_layers, water_law, water_state
from continuum_sph.builders.reports.soil_report import (
    SNAPSHOT,
    averaging_seconds,
    report_origin,
    report_rate,
    report_side_walls,
    report_slip,
    report_softening,
    report_strain,
    report_watched,
    warn_of_grains,
    warn_of_rest,
    warn_of_steep_faces,
)
from continuum_sph.builders.reports.time_report import MOVING_SOIL, OPENING, PORE_WATER, report_run, step_seconds
from continuum_sph.builders.reports.water_report import step_limits, wall_count, water_report
from continuum_sph.scene.bounds import WHOLE
from continuum_sph.scene.sections import CALM_MACH, Scene
from continuum_sph.seepage.step import SHARE
from continuum_sph.water.parameters import Law
from continuum_sph.water.smoothing import RATIO
from porescale.common.api.report import Report, report_output
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.schema.names import names_of

KIND = "soil and its water"
"""Of what runs are made, under which their times are kept; "soil and water" were estimates without open water."""
BYTES = 770  # per particle of water and walls, lists included: 3 200 of a pond
HELD_BYTES, MOVING_BYTES = 1250, 1900  # per particle of soil, its list of the water about it included
LEAST_BELOW = 1.0  # rows below a pile: discharges are within 1 % with it, 4 % low with 0.6
STEPS = 400_000  # for which water at rest over ground keeps its level with smoothing lengths of less than
STANDS = 1.35  # spacings, with which it does for two million
STEADY_AFTER = 2.0  # of L²/D, in which pressures spread: exp(-π² t/4), of a face on one side, is 0.7 % then
BROAD, APART = 6.0, 3.0  # spacings of open water in a strip that keeps its level, and from it to the ground
PIECES = 100  # of a run, to add up what passes a face whose head rises


def seepage_report(scene: Scene) -> Report:
    """The water's report, and how the two layers stand to each other; InputError for what they cannot have together."""
    if scene.inclusion is not None:
        raise InputError(Fault("inclusion", "given", "cannot be with soil", repair="take out [inclusion] or [soil]"))
    if scene.tank.wall_particles == "images":
        raise InputError(Fault("tank.wall_particles", "images", "cannot be with soil", repair='use "pressure"'))
    section = porous_section(scene)
    soil, _ = soil_particles(scene)
    water, waiting = water_counts(scene, soil)
    out = water_report(scene, water)
    law, state = pore_law(scene, soil), water_state(scene)
    out.heading("soil")
    report_watched(scene, out)
    out.row("soil particles", len(soil))
    out.heading("soil and water")
    stiff = state.density * state.sound_speed**2
    step = min(step_limits(scene, law))  # of air beside water, too
    _, most = section.permeabilities
    drag = most / (section.porosity * GRAVITY)
    if law.smoothing.length > water_law(scene).smoothing.length:
        note = "to reach the next row in pores that start empty"
        out.row("smoothing length of the water", law.smoothing.length, "m", note)
    out.row("time in which drag stops water in pores", drag, "s", "integrated exactly: no bound on the step")
    if not section.held:
        step = min(step, moving(scene, out, law, stiff))
        dry = section.density * scene.gravity * (section.surface_over(soil, 0.5 * scene.numerics.spacing) - soil[:, 1])
        borne = float((dry - buoyancy(scene, soil)).max())
        report_strain(out, section, borne)
        report_slip(out, section, soil_law(scene), borne)
    air = len(air_pores(scene, soil))
    if scene.air:
        air_report(out, scene, law, air)
    cost(scene, out, law, step, Counts(len(soil), water + air, waiting))
    table = scene.soil.water_table if scene.soil else None
    if table is not None and table > max(section.height, scene.highest) * (1.0 + WHOLE):
        out.warn(
            f"soil.water_table lies over all ground and water, {table - section.height:.3g} m over the highest ground: "
            "pores are full to their surface; water above it is that of [[water.column]] or [[reservoir]]"
        )
    warn_of_high_pores(scene, out)
    buoyant = section.density - (1.0 - section.porosity) * state.density
    pressure = 0.5 * buoyant * scene.gravity * section.height * (1.0 + material_of(section).rest)
    report_softening(out, section, soil_law(scene), pressure)
    report_rate(out, scene, wet=True)
    report_side_walls(out, section, wet=True)
    if not section.held:
        warn_of_rest(out, section, material_of(section), buoyant * scene.gravity * section.height)
    warn_of_steep_faces(scene, out)
    report_origin(out, section.origin)
    if scene.time.end / step > STEPS and scene.numerics.smoothing_ratio < STANDS:
        out.warn(
            f"water at rest over ground keeps its level for some {STEPS} steps; then its lattice gives way, and it "
            f"sinks by up to a hundredth of its depth; numerics.smoothing_ratio = {RATIO:g} mends it"
        )
    if scene.output.energy:
        out.warn(
            "energy balance (J/m) is of the water alone: what it gives to soil and takes from it, heat of drag (J/m), "
            "and water that reservoirs and faces let in or out are not in it, so it does not stay constant here"
        )
    if scene.pile:
        pile_report(scene, out)
    if scene.reservoir:
        levels(scene, out)
    if scene.face:
        faces(scene, out, soil)
    return out


def warn_of_high_pores(scene: Scene, out: Report) -> None:
    """Warn of pores full so far above all water in the open that water at their foot is compressed by over 1 %."""
    full = scene.pores_full_to
    percent = 100.0 * scene.gravity * full / sound_speed(scene) ** 2
    if full > scene.head and percent > 1.0:
        out.warn(
            f"pores are full to {full:.3g} m, above all water in the open: water at their foot is compressed by "
            f"{percent:.2g} %; water.sound_speed = {math.ceil(CALM_MACH * math.sqrt(2.0 * scene.gravity * full))} "
            "makes it 0.5 %"
        )


class Counts(NamedTuple):
    """Particles of soil, of water and air in the tank at the start, and of water that waits for reservoirs."""

    soil: int
    fluid: int
    waiting: int


def cost(scene: Scene, out: Report, law: Law, step: float, there: Counts) -> None:
    """Rows on how many steps of ``step`` (s) a run has, the memory and the time that it takes, and what it writes."""
    steps, fluid = scene.time.end / step, there.fluid + there.waiting
    walls = wall_count(scene, wall_layers(law, scene.numerics.spacing))
    out.heading("steps")
    out.row("longest step of water and soil", step, "s")
    out.row("steps", round(steps))
    of_soil = HELD_BYTES if soil_section(scene).held else MOVING_BYTES
    out.row("memory", (BYTES * (fluid + walls) + of_soil * there.soil) / 2**20, "MiB")
    if there.waiting:
        out.row("particles that wait", there.waiting, "", "for reservoirs to let them in, or to be halves of others")
    # Half of what waits is in, taken over a run.
    parts = [(PORE_WATER, there.soil + there.fluid + 0.5 * there.waiting)]
    if not soil_section(scene).held:
        parts.append((MOVING_SOIL, there.soil))
    openings = len(scene.face) + len(scene.reservoir) + (scene.pile is not None)
    seconds = step_seconds(*parts) + OPENING * openings + averaging_seconds(soil_law(scene), there.soil)
    report_run(out, scene, KIND, there.soil + fluid, steps, seconds)
    size = 1000.0 + SNAPSHOT * (there.soil + there.fluid)
    report_output(out, scene.time.end, scene.output, round(steps), size)


def moving(scene: Scene, out: Report, law: Law, stiff: float) -> float:
    """Rows on soil that moves with water of a ``law`` and a stiffness ρ c² (Pa), ``stiff``; the longest step (s) for
    their sound."""
    section, ground = soil_section(scene), soil_law(scene)
    porosity, density, modulus = section.porosity, scene.water.density, largest_modulus(scene)
    sound = (modulus / section.density) ** 0.5
    whole = porosity * density + section.density
    out.row("modulus of a column at the floor", modulus, "Pa")
    out.row("longest step for its sound", min(ground.limits(0.0, sound / ground.smoothing.length, float("inf"))), "s")
    report_stiffness(out, stiff, porosity * modulus, density)
    out.row("critical gradient", critical_gradient(scene), "", "(G_s - 1)(1 - n)")
    warn_of_grains(out, section, density)
    least, _ = section.permeabilities
    spread = least * modulus / (density * GRAVITY)
    out.row("consolidation coefficient", spread, "m2/s")
    out.row("time to consolidate", section.height**2 / spread, "s", "of the soil's height, drained at one face")
    step = float(SHARE * law.smoothing.length / ((modulus + stiff / porosity) / whole) ** 0.5)
    out.row("longest step for sound in both together", step, "s")
    return step


def report_stiffness(out: Report, stiff: float, modulus: float, density: float) -> None:
    """Row on how ``stiff`` (K_w, Pa) water is beside soil, and a warning where it stores what soil squeezes out.

    modulus : n M of the soil, Pa;  density : of the water, kg/m³.
    """
    ratio = stiff / modulus
    out.row("stiffness of the water K_w/(n M)", ratio, "", f"at least {STIFF:g}: what soil squeezes out is not stored")
    if ratio < STIFF * (1.0 - WHOLE) and stiff < NATURAL * (1.0 - WHOLE):
        speed = (min(STIFF * modulus, NATURAL) / density) ** 0.5
        out.warn(
            f"water is {ratio:.2g} times as stiff as n M: pore pressures are late by {100.0 / (1.0 + ratio):.0f} %; "
            f"raise water.sound_speed to {speed:.4g} m/s, leave it out or lower soil.stiffness"
        )


def critical_gradient(scene: Scene) -> float:
    """Gradient of upward flow that bears all the weight of the ground under water: (G_s - 1)(1 - n)."""
    section = soil_section(scene)
    return section.density / scene.water.density - (1.0 - section.porosity)


def pile_report(scene: Scene, out: Report) -> None:
    """Rows of particles beside and below the pile, and warnings where they are too few for what is measured there."""
    assert scene.pile is not None
    spacing, tip, at = scene.numerics.spacing, scene.pile.tip, scene.pile.column(scene.numerics.spacing)
    buried = ground_at(soil_section(scene), at) - tip
    out.heading("sheet pile")
    out.row("stands at", at, "m", f"the middle of the column of particles that holds pile.x = {scene.pile.x:g} m")
    for k, strip in enumerate(scene.reservoir):
        if strip.left < at < strip.right:
            out.warn(
                f"reservoir[{k}] reaches across the pile: what it keeps is the mean of both sides, whatever each of "
                f"them has; end it at {at - 0.5 * spacing:g} m, or begin it at {at + 0.5 * spacing:g} m"
            )
    for k, it in enumerate(scene.probe):
        breadth = (it.width or scene.numerics.smoothing_ratio * spacing) + spacing
        if it.y + 0.5 * (it.height or 0.0) > tip and abs(it.x - at) < (0.5 - WHOLE) * breadth:
            out.warn(
                f"probe[{k}] reaches across the pile: its pressure is that of both sides at once; move or narrow it"
            )
    if buried <= 0.0:
        out.row("rows of ground beside it", 0.0)
        out.warn("the pile does not reach into the ground at the start: exit gradient () will be nan; lower pile.tip")
        return
    side = bare_exit(scene)
    least, bare = (LEAST_BARE, f" where no water stands on the {side}") if side else (LEAST, "")
    out.row("rows of ground beside it", buried / spacing, "", f"at least {least:g} for an exit gradient{bare}")
    out.row("rows of ground below it", tip / spacing, "", f"at least {LEAST_BELOW:g}")
    if not resolved(buried, spacing, bare=bool(side)):
        out.warn(
            f"the pile is {buried / spacing:.2g} rows deep in the ground: exit gradient () will be nan, as it is fit "
            f"to what lies between the first row and the tip{', the second' + bare if side else ''}; "
            f"numerics.spacing = {buried / least:.2g} mends it"
        )
    shut = scene.tank.lid and closed(tip + buried, scene.inner[1], spacing)
    if shut and None in given_heads(scene.face, at, scene.inner, spacing):
        out.warn(
            f"the ground beside the pile ends at a closed lid, and without a face on each side within {OPEN:g} "
            "spacings: exit gradient () will be nan, as no water comes out at a lid"
        )
    if tip == 0.0:
        out.warn(
            "pile.tip = 0 does not close the ground: the column of the pile ends a row above the base, and water passes"
        )
    elif tip < LEAST_BELOW * spacing:
        out.warn(
            f"{tip / spacing:.2g} rows of ground lie below the pile, whose column ends a row higher: discharges are "
            f"too low, by 4 % with 0.6 rows; numerics.spacing = {tip / LEAST_BELOW:.2g} mends it"
        )


def bare_exit(scene: Scene) -> str:
    """The side of the pile on which no water stands on the ground at the start, "" where there is none.

    Of two that with the lower head, where water comes out: of the water on the ground beside the pile, else that of the
    ground's surface.
    """
    assert scene.pile is not None
    spacing = scene.numerics.spacing
    at, reach = scene.pile.column(spacing), OPEN * spacing
    top, given = ground_at(soil_section(scene), at), given_heads(scene.face, at, scene.inner, spacing)
    heads = []
    for side, known in zip((-1.0, 1.0), given, strict=True):
        left, right = sorted((at + side * (0.5 + WHOLE) * spacing, at + side * reach))
        tops = [it.bottom + it.height for it in scene.water.column if it.left < right and it.left + it.width > left]
        # The water of a reservoir spreads over all that lies open on its side.
        tops += [it.highest for it in scene.reservoir if side * (0.5 * (it.left + it.right) - at) > 0.0]
        heads.append(max([top, *tops]) if known is None else known)
    for side in (int(heads[1] < heads[0]), int(heads[1] >= heads[0])):
        if heads[side] <= top + 0.5 * spacing and given[side] is None:
            return ("left", "right")[side]
    return ""


def levels(scene: Scene, out: Report) -> None:
    """Rows on prescribed levels, and warnings about what keeps water from moving into soil as it should."""
    numerics, section = scene.numerics, soil_section(scene)
    spacing = numerics.spacing
    out.heading("prescribed levels")
    for name, it in zip(names_of(scene.reservoir, "reservoir"), scene.reservoir, strict=True):
        breadth = (it.right - it.left) / spacing
        out.row(name, it.table[-1][1], "m", f"{breadth:.3g} spacings broad, in the end")
        if breadth < BROAD - WHOLE:
            out.warn(
                f"the strip of {name} is {breadth:.3g} spacings broad, at least {BROAD:g} keep a level: widen it to "
                f"{BROAD * spacing:.3g} m, or lower numerics.spacing to {(it.right - it.left) / BROAD:.2g} m"
            )
        if it.ground(section, spacing, APART * spacing) > it.bottom:
            out.warn(
                f"the strip of {name} lies closer than {APART:g} spacings to the ground, and its level is disturbed: "
                f"leave {APART * spacing:.3g} m between them, or lower numerics.spacing"
            )
    for warning in scene.meeting_strips():
        out.warn(warning)
    if numerics.shifting > 0.0:
        out.warn(
            "shifting goes by the fastest water anywhere, and crowds what rests beside it: levels and discharges are "
            "5 % low; numerics.shifting = 0 mends it"
        )


def faces(scene: Scene, out: Report, soil: Floats) -> None:
    """Rows on heads at sides of the tank with ``soil`` (s, 2) m, and warnings where more water passes than there is,
    or the run ends before the flow is steady."""
    section, numerics, state = soil_section(scene), scene.numerics, water_state(scene)
    out.heading("sides that water passes")
    for name, it in zip(names_of(scene.face, "face"), scene.face, strict=True):
        start, end = it.reach(scene.inner)
        out.row(name, it.table[-1][1], "m", f"head in the end, from {start:g} to {end:g} m along the {it.side}")
    storage = section.porosity / (state.density * state.sound_speed**2)
    storage += 0.0 if section.held else 1.0 / largest_modulus(scene)
    least, most = section.permeabilities
    spread = least / (state.density * GRAVITY * storage)
    slow = STEADY_AFTER * (float(np.ptp(soil, axis=0).max()) + numerics.spacing) ** 2 / spread
    out.row("time until the flow is steady", slow, "s", "pressures have spread over the longer side of the ground")
    times, last = moments(scene), scene.time.end
    flows = gradients(scene, times)
    steep = max((float(it.steep.max()) for it in flows), default=0.0)
    lifting = max((float(it.upward.max()) for it in flows), default=0.0)
    if steep > 0.0:
        way = FARTHEST * numerics.spacing * section.porosity / (most * scene.gravity / GRAVITY)
        seconds = min(reached(times, it.steep, way) for it in flows)
        out.row("time in which water passes half a spacing", seconds, "s", "about; a run ends there")
        if last > seconds:
            out.warn(
                f"after some {seconds:.2g} s more water has passed a face than is there to pass it, and the run stops: "
                f"lower time.end, or soil.permeability"
            )
        last = min(seconds, last)
    if section.held and slow > last:
        speed = state.sound_speed * (slow / last) ** 0.5
        out.warn(
            f"flow is steady after some {slow:.2g} s, and the run ends at {last:.2g} s; "
            f"water.sound_speed = {math.ceil(speed):g} mends it"
        )
    if not section.held and lifting > 0.0:
        critical = critical_gradient(scene)
        out.row("gradient of the flow out of the ground", lifting, "", f"about; more than {critical:.2g} lifts it")
    if not section.held and steep > 0.0 and any(it.side == "lid" for it in scene.face):
        out.warn("the lid stops water and not soil: ground that flow lifts passes through it")


def moments(scene: Scene) -> Floats:
    """Times (n,) s from the start to the end of a scene, between which all heads are straight lines."""
    rows = [time for it in scene.face for time, _ in it.table if time < scene.time.end]
    return np.unique([*np.linspace(0.0, scene.time.end, PIECES + 1), *rows])


def reached(times: Floats, steep: Floats, way: float) -> float:
    """When (s) the integral of ``steep`` (n,) over the ``times`` (n,) s is ``way`` (s); it stays at its last after."""
    so_far = np.append(0.0, np.cumsum(0.5 * (steep[1:] + steep[:-1]) * np.diff(times)))
    if so_far[-1] >= way:
        return float(np.interp(way, so_far, times))
    return float(times[-1] + (way - so_far[-1]) / steep[-1]) if steep[-1] > 0.0 else float("inf")


class Gradient(NamedTuple):
    """steep (n,) : head over way of a flow from one face to another, or to the open surface of the ground, at each
    time;  upward (n,) : the same where the water leaves the ground through its surface, else 0."""

    steep: Floats
    upward: Floats


def gradients(scene: Scene, times: Floats) -> list[Gradient]:
    """About how steep flow is between the faces of a scene at ``times`` (n,) s, and from them to the surface of the
    ground where that is open: heads over the shortest way."""
    spacing, found = scene.numerics.spacing, []
    top = soil_section(scene).height
    places = [it.along(scene.inner, spacing) for it in scene.face]
    for k, (one, at) in enumerate(zip(scene.face, places, strict=True)):
        for other, beyond in zip(scene.face[:k], places[:k], strict=True):
            # Both lie along sides of a rectangle: gaps between their ends on each axis.
            gap = np.maximum(at[0] - beyond[-1], beyond[0] - at[-1])
            way = float(np.hypot(*np.maximum(gap, 0.0)))
            if scene.pile and one.side == other.side == "lid":
                way = max(way, 2.0 * (top - scene.pile.tip))
            down = (one.heads(times) - other.heads(times)) / max(way, spacing)
            leaves = (down > 0.0) & (other.side == "lid") | (down < 0.0) & (one.side == "lid")
            found.append(Gradient(np.abs(down), np.where(leaves, np.abs(down), 0.0)))
        if one.side != "lid" and not scene.tank.lid:
            down = (one.heads(times) - max(top, scene.highest)) / max(top, spacing)
            found.append(Gradient(np.abs(down), np.maximum(down, 0.0)))
    return found

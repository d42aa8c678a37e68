"""The report of `check` on the water of a scene before it runs."""

import math

import numpy as np

from continuum_sph.builders.parts.pore_water import fills
from continuum_sph.builders.parts.water import wall_layers, water_law, water_state
from continuum_sph.builders.reports.time_report import (
    SECOND_FLUID,
    WATER,
    WATER_WITH_MORE,
    report_run,
    step_seconds,
)
from continuum_sph.builders.sanity_fluids import bounds
from continuum_sph.scene.numerics import NumericsSection
from continuum_sph.scene.sections import Scene
from continuum_sph.water.parameters import RULES, Law
from continuum_sph.water.smoothing import SUPPORT
from porescale.common.api.report import Report, report_output
from porescale.common.core.errors import Fault, InputError

MACH_WARNED, MACH_REFUSED = 0.1, 0.3
GAS_WARNED = 0.3
"""The same of gas under surface tension."""
SNAPSHOT = 60  # per particle of a snapshot on disk, about
BYTES = 560  # per particle, walls included: 420 to 500 in plain columns, the small ones most, 560 with all choices


def wall_count(scene: Scene, layers: int) -> int:
    """Particles of so many ``layers`` of the walls of a scene's tank."""
    tank, spacing = scene.tank, scene.numerics.spacing
    sides = 2 if tank.lid else 1
    return round(2 * layers * tank.height / spacing + sides * layers * (tank.width / spacing + 2 * layers))


def compression(scene: Scene) -> float:
    """Share by which the water at the floor is denser than under no weight."""
    tait = water_state(scene)
    return float(tait.settled_density(scene.head, scene.gravity)) / tait.density - 1.0  # type: ignore[arg-type]


def step_limits(scene: Scene, law: Law) -> tuple[float, ...]:
    """Longest steps (s) by each of `RULES` for the fluids of a ``law`` under the highest head of a scene."""
    tait = water_state(scene)
    sound = tait.sound_speed * (1.0 + compression(scene)) ** (0.5 * (tait.exponent - 1.0))
    return law.limits(2.0 * scene.gravity, max(sound, law.quickest) / law.smoothing.length)


def water_report(scene: Scene, count: int | None = None) -> Report:
    """Resolution, sound, steps and cost; a warning above Mach 0.1, InputError above 0.3.

    count : particles of water, where soil holds some, too: steps and cost are then said with those of the soil.
    """
    law, spacing = water_law(scene), scene.numerics.spacing
    tait, h, viscosity = water_state(scene), law.smoothing.length, scene.water.viscosity
    out = Report(scene.title or "water in a tank")
    water = sum(round(c.width / spacing) * round(c.height / spacing) for c in scene.water.column)
    water = water if count is None else count
    layers = wall_layers(law, spacing)
    walls = wall_count(scene, layers)
    out.heading("resolution")
    out.row("water particles", water)
    out.row("wall particles", walls, "", f"{layers} layers")
    least = min((min(c.width, c.height) for c in scene.water.column), default=0.0)
    if least:
        out.row("particles across the narrowest water", least / spacing)
    out.row("smoothing length", h, "m", law.smoothing.name)
    out.row("partners of a particle", math.pi * (SUPPORT * h / spacing) ** 2, "", "inside the water")
    out.heading("sound")
    fall = scene.fall_speed
    mach = fall / tait.sound_speed
    out.row("sound speed", tait.sound_speed, "m/s")
    out.row("stiffness B", tait.stiffness, "Pa")
    out.row("speed of free fall from the highest water", fall, "m/s")
    out.row("Mach number", mach, "", "at most 0.1 keeps density changes below 1 %")
    out.row("compression at the floor", 100.0 * compression(scene), "%")
    if _free(scene) and not scene.soil and not law.corrected and scene.gravity > 0.0:
        deep, shallow = (100.0 * (math.sqrt(1.0 + share * law.shear) - 1.0) for share in (1.0, 2.0))
        about = f"and {deep:.2g} % where deep, until the water is stirred: its lattice bears shear"
        out.row("gentle waves are too fast by, where shallow", shallow, "%", about)
    if viscosity > 0.0:
        out.row("Reynolds number", fall * scene.head * tait.density / viscosity)
    if scene.inclusion is not None:
        second = law.fluids[1].state
        out.heading("second fluid")
        out.row("sound speed", second.sound_speed, "m/s")
        out.row("density over the water's", second.density / tait.density)
        out.row("particles across the smallest disc", 2.0 * _smallest(scene) / spacing)
        if law.tension > 0.0:
            _judge_tension(scene, law, out)
    out.heading("steps")
    limits = step_limits(scene, law)
    for rule, limit in zip(RULES, limits, strict=True):
        if math.isfinite(limit):  # of what the scene has
            out.row(f"longest step for {rule}", limit, "s")
    step = min(limits)
    out.row("limited by", RULES[limits.index(step)])
    if count is None:
        steps = scene.time.end / step
        out.row("steps", round(steps))
        out.row("memory", BYTES * (water + walls) / 2**20, "MiB")
        more = law.corrected or law.shifting > 0.0 or law.tension > 0.0
        kind, pace = ("water with more", WATER_WITH_MORE) if more else ("water", WATER)
        besides = [(SECOND_FLUID, water)] if more and scene.inclusion else []
        report_run(out, scene, kind, water + walls, steps, step_seconds((pace, water), *besides))
        report_output(out, scene.time.end, scene.output, round(steps), 1000.0 + SNAPSHOT * water)
    _warn(scene, mach, water, out)
    return out


def _smallest(scene: Scene) -> float:
    """Radius (m) of the smallest disc of the second fluid."""
    assert scene.inclusion is not None
    return min(disc.radius for disc in scene.inclusion.disc)


def _judge_tension(scene: Scene, law: Law, out: Report) -> None:
    """A warning where surface tension may tear discs of a ``law``, InputError where they would start denser than
    `bounds` allow.

    σ/R over ρ c² is the square of its Mach number √(σ/ρR)/c.  What it does depends on resolution and viscosity, so that
    nothing is refused by it: over ten √(ρ R³/σ), in water of 1 mPa s, gas 8 spacings across is torn at 0.7, 16 across
    steady at 16; drops 8 and 16 across are torn at 0.06, in fluids of 100 Pa s 16 across steady at 0.45.
    """
    assert scene.inclusion is not None
    tension, radius = scene.inclusion.surface_tension, _smallest(scene)
    first, second = (fluid.state for fluid in law.fluids)
    keys = ("water.sound_speed", "inclusion.pressure" if second.gas else "inclusion.sound_speed")
    _, (_, densest), _ = bounds(law.fluids)
    most = radius * float(second.pressure(np.array(densest)))
    if tension > most:
        problem = f"makes the smallest disc denser than {densest:.4g} kg/m³, at which a run ends, before the first step"
        repair = "lower it, or raise water.sound_speed"
        raise InputError(Fault("inclusion.surface_tension", tension, problem, "N/m", f"<= {most:.4g}", repair))
    for state, name, key in zip((first, second), ("water", "second fluid"), keys, strict=True):
        mach = (tension / (radius * state.density)) ** 0.5 / state.sound_speed
        if mach > (GAS_WARNED if state.gas else MACH_WARNED) * (1.0 + 1e-9):
            out.warn(
                f"σ/R of the smallest disc is {mach**2:.2g} times ρ c² of the {name}, which may tear discs of few "
                f"particles and little viscosity; lower inclusion.surface_tension or numerics.spacing, or raise {key}"
            )


def _warn(scene: Scene, mach: float, count: int, out: Report) -> None:
    """Warnings on so many particles of water, ``count``, and the refusal of water too soft to be water."""
    if mach > MACH_REFUSED:
        raise InputError(
            Fault(
                "water.sound_speed",
                scene.water.sound_speed,
                f"makes the fall of the water Mach {mach:.2g}",
                "m/s",
                f">= {scene.fall_speed / MACH_WARNED:.4g}",
                "raise it or leave it out",
            )
        )
    if mach > MACH_WARNED * (1 + 1e-9):
        out.warn(
            f"Mach number {mach:.2g}: the water compresses by more than 1 %; "
            f"raise water.sound_speed to {scene.fall_speed / MACH_WARNED:.4g} m/s or leave it out"
        )
    if _free(scene) and not (scene.soil and scene.numerics.gradient == "corrected"):  # which has no effect there
        _warn_of_volume(scene.numerics, out)
    if scene.numerics.kernel == "cubic" and scene.numerics.smoothing_ratio < 1.2:
        out.warn("cubic spline with few partners: pressures are noisy and particles pair up; wendland at 1.3 does not")
    # 12 rows of water at rest, 0.2 m down: 4537 Pa of 1962 after 0.5 s, beside walls that stick 2109 after 1 s
    if scene.tank.wall_particles == "images":
        out.warn(
            "image walls stir water that rests: in a second they double pressures where they slip, and raise them by "
            '7 % where they stick; tank.wall_particles = "pressure" does not'
        )
    # 8, 16, 32 rows under a lid, 0.3 m down: 3390, 3161, 3048 Pa of 2943 after 0.6 s, sound at 28 m/s;
    # with 16 and sound at 60 m/s 3238 (docs/theory/water.md, limits)
    elif scene.probe and scene.gravity > 0.0 and not scene.face and fills(scene, count):
        more = scene.water.density * scene.gravity * scene.numerics.spacing
        out.warn(
            "a lid does not pull: the pressure of water that fills the tank, and that of probes, comes to rest up to "
            f"about a spacing of water too high, {more:.3g} Pa; lower numerics.spacing, or tank.lid = false mends it"
        )


# Mean height of a column of 0.5 m by 1 m after its collapse in a tank of 1.5 m, from 2 to 4 s, spacing 0.05 m, over
# what it must be at rest: 1.04 to 1.21 with neither, 0.86 to 1.37 with both, and as stated below
def _warn_of_volume(numerics: NumericsSection, out: Report) -> None:
    """Warn of choices that let splashing water gain or lose volume."""
    corrected, shifted = numerics.gradient == "corrected", numerics.shifting > 0.0
    if shifted and not corrected:
        out.warn(
            "shifting with plain gradients: water that splashes swells, by 30 to 50 % in four sloshes of a collapse"
        )
    elif corrected and not shifted:
        out.warn("corrected gradients without shifting: water that splashes shrinks, by 12 to 24 % in four sloshes")
    elif corrected and shifted and numerics.tension == "cut":
        out.warn(
            "corrected gradients, shifting and no tension: water that splashes loses half its volume and gains energy; "
            'use tension = "kept"'
        )


def _free(scene: Scene) -> bool:
    """Whether water has a surface: it does not fill the tank."""
    width, height = scene.inner
    return sum(c.width * c.height for c in scene.water.column) < 0.999 * width * height

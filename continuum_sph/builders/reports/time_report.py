"""How long a run takes, in the report of `check`."""

from typing import NamedTuple

from continuum_sph.scene.sections import Scene
from porescale.common.api.report import Report, report_time
from porescale.common.duration.expected import (
    BUILDING,
    COMPILING,
    FINISHING,
    RECORDING,
    STEPS,
    Work,
    threads_of_run,
)
from porescale.common.record.schedule import recorded


class Pace(NamedTuple):
    """Nominal seconds of a step: ``calls`` of its kernels, whatever is in them, and each ``particle`` on one thread."""

    calls: float
    particle: float


# Measured on one thread of an AMD EPYC on 2026-11-29, beside other work, at the start of 26 runs of 160 to 13 000
# particles: said over measured is 0.86 to 1.4, and 0.56 where reservoirs let water in at nearly every step.
WATER = Pace(1.2e-4, 1.1e-7)
WATER_WITH_MORE = Pace(2.6e-4, 3.3e-7)
"""With corrected gradients, shifting or surface tension."""
SECOND_FLUID = Pace(6e-5, 1.5e-7)
"""Besides that."""
SOIL = Pace(2.1e-4, 5.7e-7)
PORE_WATER = Pace(1.8e-4, 4.3e-7)
"""Of held soil and all its water, particles of both."""
MOVING_SOIL = Pace(3e-4, 5e-7)
"""Besides, of the soil's particles."""
OPENING = 8e-5
"""Besides, of each face, reservoir and pile."""
STAGE = Pace(1e-4, 1.2e-7)
"""Of the flow of water under suction."""
AVERAGE = Pace(2e-5, 1.5e-7)
"""Of each average over neighbours where soil softens."""
PHASES = {BUILDING: (0.5, 0.0, 1e-5), RECORDING: (0.2, 0.06, 1e-6), FINISHING: (3.0, 0.07, 2e-6)}
"""Nominal seconds of what is no step: once, of each snapshot, and for each particle in it."""
KERNELS = 25.0
"""Nominal seconds of compiling all kernels of a scene."""


def step_seconds(*parts: tuple[Pace, float]) -> float:
    """Nominal seconds of a step of so many particles at each pace, on the threads of a run."""
    return sum(pace.calls + pace.particle * particles / threads_of_run() for pace, particles in parts)


def report_run(out: Report, scene: Scene, kind: str, particles: int, steps: float, step: float) -> None:
    """Add to a report what a run of so many particles and steps takes.

    kind : of what its steps are made;  step : nominal seconds of one.
    """
    snapshots = recorded(scene.time.end, scene.output.snapshot_interval, round(steps))
    seconds = {COMPILING: KERNELS, STEPS: steps * step}
    for phase, (once, each, particle) in PHASES.items():
        seconds[phase] = once + (each + particle * particles) * (1 if phase == BUILDING else snapshots)
    report_time(out, Work(scene.name, kind, seconds))

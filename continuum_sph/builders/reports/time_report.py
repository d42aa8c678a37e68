"""How long a run takes, in the report of `check`."""

from continuum_sph.scene.sections import Scene
from porescale.common.api.report import Report, report_time
from porescale.common.duration.expected import BUILDING, COMPILING, FINISHING, RECORDING, STEPS, Work
from porescale.common.record.schedule import recorded

PHASES = {BUILDING: (0.5, 0.0, 1e-5), RECORDING: (0.2, 0.06, 1e-6), FINISHING: (3.0, 0.07, 2e-6)}
"""Nominal seconds of what is no step: once, of each snapshot, and for each particle in it."""
KERNELS = 25.0
"""Nominal seconds of compiling all kernels of a scene."""


def report_run(out: Report, scene: Scene, kind: str, particles: int, steps: float, rate: float) -> None:
    """Add to a report what a run of so many particles and steps takes.

    kind : of what its steps are made;  rate : nominal particle-steps a second.
    """
    snapshots = recorded(scene.time.end, scene.output.snapshot_interval, round(steps))
    seconds = {COMPILING: KERNELS, STEPS: steps * particles / rate}
    for phase, (once, each, particle) in PHASES.items():
        seconds[phase] = once + (each + particle * particles) * (1 if phase == BUILDING else snapshots)
    report_time(out, Work(scene.name, kind, seconds))

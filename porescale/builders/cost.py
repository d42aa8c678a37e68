"""What a run will cost: memory, and the time of its phases at nominal rates."""

import math

from porescale.builders.derive import Derived
from porescale.builders.scene import Scene
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.machine import memory_bytes
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
from porescale.lbm.lattice import row_length

CELLS_PER_SECOND, COUPLED_CELLS_PER_SECOND, DISCS_PER_SECOND = 220e6, 140e6, 25e6
"""Rates of a thread that a run is first reckoned with, measured on an AMD EPYC of 2.4 GHz: of plain fluid and of fluid
with grains in numbers of 8 bytes, and of contacts; how this machine differs is learnt from its runs."""
COVERED = 8e-9
"""Seconds of a cell about a grain, which the grain may cover."""
CALLS, COUPLED_CALLS = 5e-6, 45e-6
"""Seconds of a step of a fluid that do not depend on its size, without and with coupling (measured on 2400 cells, 31
grains): without them a run of a small scene would make every machine look slow."""
PHASES = {BUILDING: (0.5, 0.0, 2e-3, 0.0), RECORDING: (0.3, 0.02, 1e-5, 5e-7), FINISHING: (3.0, 0.015, 5e-6, 7e-7)}
"""Nominal seconds of what is no step: once, of each snapshot, and for each disc and each cell in it."""
ROW = 5e-3
"""Nominal seconds of a row of series.csv and of what is measured with it."""
KERNELS = {"fluid": 6.0, "grains": 25.0, "both": 5.0}
"""Nominal seconds of compiling the kernels of fluid, of grains, and what else there is with both."""
SNAPSHOT = 1000.0
"""Bytes of a snapshot besides its numbers."""
ALWAYS = 2.0**27
"""Bytes that the compiler of kernels takes itself: any machine has them, and the question takes time to ask."""
COLUMNS = {"density": 1, "solid_fraction": 1, "velocity": 3, "strain_rate": 5, "stress": 6, "kinetic_stress": 6}
"""Numbers at a point of each field of [coarse_graining] in a snapshot: a vector has three, a tensor its invariants."""
SUMS, WORKED = 12.0, 2.0
"""Numbers of 8 bytes at a point while they are made: of sums, and for each in the snapshot (31 for 10, 54 for 22)."""
SIDE = 10
"""What a side of a polygon costs, in discs, at the most (verify measures it)."""


def points(scene: Scene) -> float:
    """Points at which [coarse_graining] takes its fields."""
    assert scene.coarse_graining
    return scene.domain.width * scene.domain.height / scene.coarse_graining.spacing**2


def columns(scene: Scene) -> int:
    """Numbers at a point that [coarse_graining] puts into a snapshot."""
    assert scene.coarse_graining
    return sum(COLUMNS[name] for name in scene.coarse_graining.fields)


def field_bytes(scene: Scene) -> float:
    """Bytes that [coarse_graining] takes while its fields are made; 0 without it."""
    return 8.0 * (SUMS + WORKED * columns(scene)) * points(scene) if scene.coarse_graining else 0.0


def memory(scene: Scene, derived: Derived) -> float:
    """Bytes that the simulation's arrays will take: populations, solid fields, patches, grains and their fields; an
    estimate."""
    total = 400.0 * derived.grain_count + field_bytes(scene)
    if derived.cells:
        nx, ny = derived.cells
        total += 9 * derived.precision * row_length(nx) * (ny + 2)
        if derived.grain_count:
            total += 3 * derived.precision * nx * ny
    return total + 8 * cells_about_grains(derived)


def cells_about_grains(derived: Derived) -> int:
    """Cells that grains may cover, counted for each."""
    if not (derived.diameters and derived.scales):
        return 0
    return derived.grain_count * (math.ceil(derived.diameters[2] / derived.scales.spacing) + 2) ** 2


def snapshot_bytes(scene: Scene, derived: Derived) -> float:
    """Bytes of a snapshot on disk, about: velocity, pressure and solid share of the cells, the grains' columns, their
    fields."""
    cells = derived.cells[0] * derived.cells[1] if derived.cells else 0
    fields = 4.0 * columns(scene) * points(scene) if scene.coarse_graining else 0.0
    return SNAPSHOT + 20.0 * cells + 100.0 * derived.grain_count + fields


def snapshot_count(end: float, interval: float) -> int:
    """Snapshots of a run to ``end`` (s), the first and the last included."""
    return 1 + (math.ceil(end / interval) if math.isfinite(interval) else 1)


def step_seconds(derived: Derived, threads: int = 1) -> float:
    """Seconds of a model step at the nominal rates."""
    cells = derived.cells[0] * derived.cells[1] if derived.cells else 0
    coupled = bool(cells and derived.grain_count)
    calls, rate = (COUPLED_CALLS, COUPLED_CELLS_PER_SECOND) if coupled else (CALLS * bool(cells), CELLS_PER_SECOND)
    fluid = cells * derived.precision / 8 / rate + COVERED * cells_about_grains(derived)
    return calls + (fluid + contact_seconds(derived)) / threads


def work(scene: Scene, derived: Derived, gpu: str = "") -> Work:
    """What a run of the scene has to do;  gpu : name of the GPU that steps its fluid, if one does."""
    cells, steps = derived.cells[0] * derived.cells[1] if derived.cells else 0, step_count(scene, derived)
    there = {"fluid": bool(cells), "grains": bool(derived.grain_count), "both": bool(cells and derived.grain_count)}
    kernels = sum(seconds for what, seconds in KERNELS.items() if there[what])
    snapshots = snapshot_count(scene.time.end, scene.output.snapshot_interval)
    seconds = {COMPILING: kernels, STEPS: steps * step_seconds(derived, threads_of_run())}
    for phase, (once, each, disc, cell) in PHASES.items():
        many = 1 if phase == BUILDING else snapshots
        seconds[phase] = once + (each + disc * derived.grain_count + cell * cells) * many
    seconds[RECORDING] += ROW * recorded(scene.time.end, scene.output.series_interval, steps)
    return Work(scene.name, _kind(derived, gpu), seconds)


def step_count(scene: Scene, derived: Derived) -> int:
    """Model steps of a run."""
    return max(1, round(scene.time.end / derived.model_step))


def contact_seconds(derived: Derived) -> float:
    """Seconds of the contacts in a model step at the nominal rate."""
    discs = derived.grain_count + SIDE * derived.corners
    return discs * (derived.contact_steps or 0) / DISCS_PER_SECOND


def seconds_on_gpu(derived: Derived, steps: int, bandwidth: float) -> float:
    """The least that ``steps`` steps take on a GPU whose memory moves so many bytes per second: nine populations
    of every cell, read and written once, and the contacts, which the CPU does."""
    nx, ny = derived.cells or (0, 0)
    return steps * (18 * derived.precision * nx * ny / bandwidth + contact_seconds(derived))


def require_memory(scene: Scene, derived: Derived) -> None:
    """Raise InputError when the arrays would not fit into this machine's memory."""
    need = memory(scene, derived)
    if need <= ALWAYS or need <= 0.9 * (have := memory_bytes()):
        return
    problem = f"needs {need / 2**30:.1f} of {have / 2**30:.1f} GiB"
    if scene.coarse_graining and field_bytes(scene) > 0.5 * need:
        wider = scene.coarse_graining.spacing * math.sqrt(need / (0.5 * have))
        repair = f"points {wider:.2g} m apart take half of the memory"
        raise InputError(Fault("coarse_graining.spacing", scene.coarse_graining.spacing, problem, "m", repair=repair))
    if derived.scales:
        coarser = derived.scales.spacing * math.sqrt(need / (0.5 * have))
        repair = f"a spacing of {coarser:.2g} m takes half of the memory"
        raise InputError(Fault("fluid.spacing", derived.scales.spacing, problem, "m", repair=repair))
    raise InputError(
        Fault("grains", None, f"{derived.grain_count:.3g} of them: {problem}", repair="take fewer or larger ones")
    )


def _kind(derived: Derived, gpu: str = "") -> str:
    """Kind of scene whose steps cost alike: what is in it, how precise, if its size or its calls count; on what."""
    what = "fluid" * bool(derived.cells), "grains" * bool(derived.grain_count), "segments" * bool(derived.corners)
    small = step_seconds(derived) < 4.0 * (COUPLED_CALLS if all(what[:2]) else CALLS)
    return " ".join(filter(None, (*what, f"{8 * derived.precision}" * bool(derived.cells), "small" * small, gpu)))

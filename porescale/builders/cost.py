"""What a run will cost: memory, and the time of its phases at nominal rates."""

import math

from porescale.builders.derive import Derived
from porescale.builders.scene import Scene
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.machine import memory_bytes
from porescale.common.duration.expected import BUILDING, COMPILING, FINISHING, RECORDING, STEPS, Work
from porescale.lbm.lattice import row_length

CELLS_PER_SECOND, COUPLED_CELLS_PER_SECOND, DISCS_PER_SECOND = 150e6, 60e6, 15e6
"""Rates that a run is first reckoned with, of plain fluid, of fluid with grains, and of contacts; how this machine
differs is learnt from its runs."""
CALLS, COUPLED_CALLS = 5e-6, 45e-6
"""Seconds of a step that do not depend on its size, without and with coupling (measured on 2400 cells, 31 grains):
without them a run of a small scene would make every machine look slow."""
PHASES = {BUILDING: (0.5, 0.0, 2e-3, 0.0), RECORDING: (0.2, 0.05, 1e-5, 1e-6), FINISHING: (6.0, 0.12, 1e-5, 1e-7)}
"""Nominal seconds of what is no step: once, of each snapshot, and for each disc and each cell in it."""
KERNELS = 30.0
"""Nominal seconds of compiling the kernels of fluid or of grains; with both it is twice that."""
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
    if derived.diameters and derived.scales:
        total += 8 * derived.grain_count * (math.ceil(derived.diameters[2] / derived.scales.spacing) + 2) ** 2
    return total


def snapshot_bytes(scene: Scene, derived: Derived) -> float:
    """Bytes of a snapshot on disk, about: velocity, pressure and solid share of the cells, the grains' columns, their
    fields."""
    cells = derived.cells[0] * derived.cells[1] if derived.cells else 0
    fields = 4.0 * columns(scene) * points(scene) if scene.coarse_graining else 0.0
    return SNAPSHOT + 20.0 * cells + 100.0 * derived.grain_count + fields


def snapshot_count(end: float, interval: float) -> int:
    """Snapshots of a run to ``end`` (s), the first and the last included."""
    return 1 + (math.ceil(end / interval) if math.isfinite(interval) else 1)


def step_seconds(derived: Derived) -> float:
    """Seconds of a model step at the nominal rates."""
    cells = derived.cells[0] * derived.cells[1] if derived.cells else 0
    if cells and derived.grain_count:
        return COUPLED_CALLS + cells / COUPLED_CELLS_PER_SECOND + contact_seconds(derived)
    return CALLS + cells / CELLS_PER_SECOND + contact_seconds(derived)


def work(scene: Scene, derived: Derived, gpu: str = "") -> Work:
    """What a run of the scene has to do;  gpu : name of the GPU that steps its fluid, if one does."""
    cells = derived.cells[0] * derived.cells[1] if derived.cells else 0
    snapshots = snapshot_count(scene.time.end, scene.output.snapshot_interval)
    kernels = KERNELS * (1 + bool(cells and derived.grain_count))
    seconds = {COMPILING: kernels, STEPS: step_count(scene, derived) * step_seconds(derived)}
    for phase, (once, each, disc, cell) in PHASES.items():
        many = 1 if phase == BUILDING else snapshots
        seconds[phase] = once + (each + disc * derived.grain_count + cell * cells) * many
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

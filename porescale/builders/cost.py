"""What a run will cost: memory, and a time from this machine's last runs."""

import contextlib
import json
import math
from pathlib import Path
from statistics import median

from porescale.builders.derive import Derived
from porescale.common.compiled.cache import cache_root
from porescale.common.core.atomic import write_bytes
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.machine import memory_bytes
from porescale.lbm.lattice import row_length

CELLS_PER_SECOND, DISCS_PER_SECOND = 150e6, 15e6
"""Rates that a run is first reckoned with (two cores, float64); how this machine differs is learnt from its runs."""
CALLS, COUPLED_CALLS = 5e-6, 45e-6
"""Seconds of a step that do not depend on its size, without and with coupling (measured on 2400 cells, 31 grains):
without them a run of a small scene would make every machine look slow."""
SNAPSHOT = 1000.0
"""Bytes of a snapshot besides its numbers."""
ALWAYS = 2.0**27
"""Bytes that the compiler of kernels takes itself: any machine has them, and the question takes time to ask."""
LAST = 5
"""Runs of a kind whose median says how this machine compares: one that shared it with others has no say."""
SIDE = 10
"""What a side of a polygon costs, in discs, at the most (verify measures it)."""


def memory(derived: Derived) -> float:
    """Bytes that the simulation's arrays will take: populations, solid fields, patches, grains; an estimate."""
    total = 400.0 * derived.grain_count
    if derived.cells:
        nx, ny = derived.cells
        total += 9 * derived.precision * row_length(nx) * (ny + 2)
        if derived.grain_count:
            total += 3 * derived.precision * nx * ny
    if derived.diameters and derived.scales:
        total += 8 * derived.grain_count * (math.ceil(derived.diameters[2] / derived.scales.spacing) + 2) ** 2
    return total


def snapshot_bytes(derived: Derived) -> float:
    """Bytes of a snapshot on disk, about: velocity, pressure and solid share of the cells, the grains' columns."""
    cells = derived.cells[0] * derived.cells[1] if derived.cells else 0
    return SNAPSHOT + 20.0 * cells + 100.0 * derived.grain_count


def step_seconds(derived: Derived) -> float:
    """Wall-clock seconds of a model step at the nominal rates."""
    cells = derived.cells[0] * derived.cells[1] if derived.cells else 0
    calls = COUPLED_CALLS if cells and derived.grain_count else CALLS
    return calls + cells / CELLS_PER_SECOND + contact_seconds(derived)


def contact_seconds(derived: Derived) -> float:
    """Wall-clock seconds of the contacts in a model step at the nominal rate."""
    discs = derived.grain_count + SIDE * derived.corners
    return discs * (derived.contact_steps or 0) / DISCS_PER_SECOND


def seconds_on_gpu(derived: Derived, steps: int, bandwidth: float) -> float:
    """The least that ``steps`` steps take on a GPU whose memory moves so many bytes per second: nine populations
    of every cell, read and written once, and the contacts, which the CPU does."""
    nx, ny = derived.cells or (0, 0)
    return steps * (18 * derived.precision * nx * ny / bandwidth + contact_seconds(derived))


def expected_seconds(derived: Derived, steps: int, gpu: str = "") -> tuple[float, bool]:
    """Wall-clock seconds of ``steps`` steps, and whether this machine has been measured;  gpu : name of the GPU
    that is to step, if one is: before it was measured nothing is known of it."""
    slowness = _slowness().get(_kind(derived, gpu), [])
    return steps * step_seconds(derived) * (median(slowness) if slowness else 1.0), bool(slowness)


def remember(derived: Derived, steps_per_second: float, gpu: str = "") -> None:
    """Note how this machine, or its GPU, compares to the nominal rates with such scenes, for the next ``check``, if the
    cache can be written: the last LAST runs of each kind."""
    if steps_per_second > 0:
        known, kind = _slowness(), _kind(derived, gpu)
        known[kind] = [*known.get(kind, []), 1 / (steps_per_second * step_seconds(derived))][-LAST:]
        with contextlib.suppress(OSError):  # no room or no right to write: the next check guesses again
            write_bytes(_file(), json.dumps({"slowness": known}).encode())


def require_memory(derived: Derived) -> None:
    """Raise InputError when the arrays would not fit into this machine's memory."""
    need = memory(derived)
    if need <= ALWAYS or need <= 0.9 * (have := memory_bytes()):
        return
    problem = f"needs {need / 2**30:.1f} of {have / 2**30:.1f} GiB"
    if derived.scales:
        coarser = derived.scales.spacing * math.sqrt(need / (0.5 * have))
        repair = f"a spacing of {coarser:.2g} m takes half of the memory"
        raise InputError(Fault("fluid.spacing", derived.scales.spacing, problem, "m", repair=repair))
    raise InputError(
        Fault("grains", None, f"{derived.grain_count:.3g} of them: {problem}", repair="take fewer or larger ones")
    )


def _file() -> Path:
    return cache_root() / "rate.json"


def _kind(derived: Derived, gpu: str = "") -> str:
    """Kind of scene whose steps cost alike: what is in it, how precise, if its size or its calls count; on what."""
    what = "fluid" * bool(derived.cells), "grains" * bool(derived.grain_count), "segments" * bool(derived.corners)
    small = step_seconds(derived) < 4.0 * (COUPLED_CALLS if all(what[:2]) else CALLS)
    return " ".join(filter(None, (*what, f"{8 * derived.precision}" * bool(derived.cells), "small" * small, gpu)))


def _slowness() -> dict[str, list[float]]:
    """How many times the nominal time the last runs of each kind took."""
    try:
        table = json.loads(_file().read_text(encoding="utf-8"))["slowness"]
        found = {str(kind): [float(value) for value in values] for kind, values in table.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}
    return {kind: it for kind, it in found.items() if it and all(math.isfinite(one) and one > 0 for one in it)}

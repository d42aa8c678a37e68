"""What a run will cost: memory, and a time from this machine's last runs."""

import contextlib
import json
import math
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from porescale.builders.derive import Derived
from porescale.common.compiled.cache import cache_root
from porescale.common.compiled.jit import cache_folder
from porescale.common.compiled.turns import TURNS
from porescale.common.core.atomic import write_bytes
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.machine import memory_bytes
from porescale.lbm.lattice import row_length

CELLS_PER_SECOND, DISCS_PER_SECOND = 150e6, 15e6
"""Rates that a run is first reckoned with (two cores, float64); how this machine differs is learnt from its runs."""
CALLS, COUPLED_CALLS = 5e-6, 45e-6
"""Seconds of a step that do not depend on its size, without and with coupling (measured on 2400 cells, 31 grains):
without them a run of a small scene would make every machine look slow."""
START = 2.0
"""Seconds until a scene is read and all is imported."""
BUILDING, RECORDING, FINISHING = "building", "recording", "finishing"
BESIDES, COMPILING = "besides", "compiling"
PARTS = {BUILDING: (0.5, 0.0, 2e-3, 0.0), RECORDING: (0.2, 0.01, 1e-5, 1e-7), FINISHING: (3.0, 0.02, 1e-5, 1e-7)}
"""Nominal seconds of what is no step: once, of each snapshot, and for each disc and each cell in it.  Building: a
packing settles, once;  recording: rows, snapshots and checkpoints;  finishing: pictures, film and page."""
KERNELS = 50.0
"""Nominal seconds of compiling all kernels of a scene."""
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


def snapshot_count(end: float, interval: float) -> int:
    """Snapshots of a run to ``end`` (s), the first and the last included."""
    return 1 + (math.ceil(end / interval) if math.isfinite(interval) else 1)


def step_seconds(derived: Derived) -> float:
    """Wall-clock seconds of a model step at the nominal rates."""
    cells = derived.cells[0] * derived.cells[1] if derived.cells else 0
    calls = COUPLED_CALLS if cells and derived.grain_count else CALLS
    return calls + cells / CELLS_PER_SECOND + contact_seconds(derived)


@dataclass(frozen=True)
class Expected:
    """Wall-clock seconds that a run is expected to take, by what takes them.

    measured : whether this machine has done such a run.
    """

    start: float
    compiling: float
    building: float
    steps: float
    recording: float
    finishing: float
    measured: bool

    @property
    def total(self) -> float:
        """All of it, from the command to its end."""
        return self.start + self.compiling + self.building + self.steps + self.recording + self.finishing


def expected(derived: Derived, steps: int, snapshots: int) -> Expected:
    """What a run of so many steps and snapshots will take."""
    seconds, measured = expected_seconds(derived, steps)
    known = _besides().get(_kind(derived), {})
    parts = {}
    for part in PARTS:
        slowness = known.get(part, [])
        parts[part] = _nominal(part, derived, snapshots) * (median(slowness) if slowness else 1.0)
    return Expected(START, _compiling(known), parts[BUILDING], seconds, parts[RECORDING], parts[FINISHING], measured)


def _nominal(part: str, derived: Derived, snapshots: int) -> float:
    """Nominal seconds of a part of a run."""
    cells = derived.cells[0] * derived.cells[1] if derived.cells else 0
    once, each, disc, cell = PARTS[part]
    return once + (each + disc * derived.grain_count + cell * cells) * (1 if part == BUILDING else snapshots)


def _compiling(known: dict[str, Any]) -> float:
    """Seconds of compiling the kernels of such scenes, those that are not on disk."""
    if "kernels" not in known:
        return KERNELS
    names, folder = known["kernels"], cache_folder()
    missing = sum(not (folder / f"{name}.nbc").exists() for name in names)
    return float(known[COMPILING][0]) * missing / max(len(names), 1)


def remember_run(
    derived: Derived, snapshots: int, seconds: dict[str, float], since: tuple[int, float] = (0, 0.0)
) -> None:
    """Note, as `remember` does, what the `PARTS` of a run took (s) and what it compiled, for the next ``check``.

    since : kernels and seconds of compiling of this process before the run.
    """
    every, kind = _besides(), _kind(derived)
    known = every.setdefault(kind, {})
    for part in PARTS:
        taken = seconds.get(part, 0.0) / _nominal(part, derived, snapshots)
        if math.isfinite(taken) and taken > 0.0:
            known[part] = [*known.get(part, []), taken][-LAST:]
    before, compiling = since
    kernels = list(dict.fromkeys(TURNS.kept[before:]))
    if kernels and len(kernels) >= len(known.get("kernels", [])):  # else a few that changed
        known |= {"kernels": kernels, COMPILING: [TURNS.seconds - compiling]}
    _write({"slowness": _slowness(), BESIDES: every})


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
        _write({"slowness": known, BESIDES: _besides()})


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


def _write(table: dict[str, Any]) -> None:
    """Keep what this machine's runs took."""
    with contextlib.suppress(OSError):  # no room or no right to write: the next check guesses again
        write_bytes(_file(), json.dumps(table).encode())


def _slowness() -> dict[str, list[float]]:
    """How many times the nominal time the steps of the last runs of each kind took."""
    return _ratios(_read("slowness"))


def _besides() -> dict[str, dict[str, Any]]:
    """The same of each of PARTS, and the kernels that were compiled, by kind of scene."""
    found = {}
    for kind, table in _read(BESIDES).items():
        known: dict[str, Any] = dict(_ratios(table)) if isinstance(table, dict) else {}
        if COMPILING in known and isinstance(table.get("kernels"), list):
            known["kernels"] = [str(it) for it in table["kernels"]]
        found[kind] = known
    return found


def _read(name: str) -> dict[str, Any]:
    """A table of the file; empty where there is none."""
    try:
        table = json.loads(_file().read_text(encoding="utf-8"))[name]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return {}
    return table if isinstance(table, dict) else {}


def _ratios(table: dict[str, Any]) -> dict[str, list[float]]:
    """The entries of a table that are lists of numbers > 0, at least one."""
    found = {}
    for name, values in table.items():
        if isinstance(values, list) and values and all(_is_ratio(it) for it in values):
            found[name] = [float(it) for it in values]
    return found


def _is_ratio(value: Any) -> bool:
    """Whether a value is a number > 0, of which a machine can be that many times slower."""
    return isinstance(value, int | float) and math.isfinite(value) and value > 0

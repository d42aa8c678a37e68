"""The one place that configures numba.

Kernels are compiled once and kept on disk.  numba stamps a cached kernel with its own file only, so an edited
contact law would survive inside a cached pair loop; the cache folder is therefore named after a hash of all
sources of both packages.  ``error_model="numpy"`` because the default division check stops vectorisation.
Fast-math is off: results must not depend on how a loop was cut into vectors.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

PACKAGES = ("porescale", "continuum_sph")


def source_hash() -> str:
    """Hash (12 hex digits) of every Python source of both packages, in a fixed order."""
    root = Path(__file__).resolve().parents[2]
    digest = hashlib.sha256()
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*.py")):
            digest.update(path.relative_to(root).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def cache_folder() -> Path:
    """Folder for compiled kernels: ``$NUMBA_CACHE_DIR`` if set, else one named after the sources' hash."""
    if "NUMBA_CACHE_DIR" in os.environ:
        return Path(os.environ["NUMBA_CACHE_DIR"])
    base = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return base / "porescale" / f"kernels-{source_hash()}-py{sys.version_info.major}{sys.version_info.minor}"


os.environ.setdefault("NUMBA_CACHE_DIR", str(cache_folder()))
# Threads that wait at the end of a loop spin for milliseconds by default.  On a machine with other work that costs a
# factor of 20 (measured, two threads beside eight busy processes); this many turns, some 10 us, cost a quiet one
# nothing.
os.environ.setdefault("GOMP_SPINCOUNT", "3000")

import llvmlite.binding as llvm  # noqa: E402  (after the cache folder is set)
import numba  # noqa: E402

# A row kernel reads and writes nine population rows: LLVM must compare 36 pairs of them before it vectorises,
# and gives up at 8 by default.
llvm.set_option("porescale", "-runtime-memory-check-threshold=256")

F = TypeVar("F", bound=Callable[..., Any])
_FLAGS: dict[str, Any] = {"error_model": "numpy", "cache": True, "nogil": True}


def kernel(function: F) -> F:
    """Compile a serial kernel over arrays and numbers."""
    compiled: F = numba.njit(**_FLAGS)(function)
    return compiled


def parallel_kernel(function: F) -> F:
    """Compile a kernel whose ``prange`` loops run over threads; it must give the same bits at any count."""
    compiled: F = numba.njit(parallel=True, **_FLAGS)(function)
    return compiled


def inline(function: F) -> F:
    """Compile a small function that LLVM merges into the kernels that call it."""
    compiled: F = numba.njit(**_FLAGS)(function)
    return compiled


prange = numba.prange


def set_threads(count: int | None) -> int:
    """Use ``count`` threads (None: all cores) in parallel kernels; returns the number in use."""
    limit = int(vars(numba.config)["NUMBA_NUM_THREADS"])
    chosen = limit if count is None else max(1, min(count, limit))
    numba.set_num_threads(chosen)
    return chosen


def threads() -> int:
    """Number of threads that parallel kernels use now."""
    return int(numba.get_num_threads())

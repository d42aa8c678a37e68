"""card.json: what was run, with what, where, and how it ended."""

import importlib.metadata
import json
import math
import platform
import subprocess
import sys
from collections.abc import Collection, Mapping
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from porescale.common.compiled import jit
from porescale.common.core.atomic import write_text
from porescale.common.core.errors import Fault
from porescale.common.core.machine import machine
from porescale.common.core.version import VERSION
from porescale.common.record.read_card import FORMAT, NAME, short_commit

RUNNING, FINISHED, INTERRUPTED, UNSTABLE, FAILED = "running", "finished", "interrupted", "unstable", "failed"
FREE = (
    "time.end",
    "duration",
    "snapshot_interval",
    "series_interval",
    "checkpoint_seconds",
    "output.forces",
    "output.report",
    "title",
    "look",
    "run",
)
"""Scene keys, dotted or by their last name, and sections that may change when a run is resumed: no physics, and nothing
of the state, of the columns of series.csv, and of what each snapshot holds, which are the same from first to last."""

DECIDING = ("numpy", "numba", "llvmlite")
"""Packages whose version may change the bits of a run."""


def new_card(given: dict[str, Any]) -> dict[str, Any]:
    """A card for a run that starts now: ``given`` ("scene", "seeds", ...) and the circumstances."""
    return {
        "format": FORMAT,
        **plain(given),
        **circumstances(),
        "command": list(sys.argv),
        "started": now(),
        "ended": None,
        "seconds": 0.0,
        "step": 0,
        "time": 0.0,
        "outcome": RUNNING,
    }


def write_card(folder: Path, card: dict[str, Any]) -> None:
    """Write the card, whole or not at all."""
    write_text(Path(folder) / NAME, json.dumps(plain(card), indent=2, ensure_ascii=False) + "\n")


def circumstances() -> dict[str, Any]:
    """What the bits of a run depend on besides its scene, and where it runs."""
    return {
        "versions": versions(),
        "sources": jit.source_hash(),
        "commit": commit(),
        "threads": jit.threads(),
        "machine": machine(),
    }


def changed_circumstances(card: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """What the run on ``card`` went on with last that differs in ``now`` (`circumstances`) and may change its bits."""
    last = {**card, **(card["resumed"][-1] if card.get("resumed") else {})}
    old, new = last.get("versions") or {}, now["versions"]
    changed = [f"{name} {old.get(name)} -> {new[name]}" for name in DECIDING if old.get(name) != new[name]]
    if last.get("sources") != now["sources"]:
        changed.insert(0, f"sources {last.get('sources')} -> {now['sources']}")
    return changed


def now() -> str:
    """The time of day, UTC, to the second."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def versions() -> dict[str, str | None]:
    """Versions of what the numbers depend on."""
    libraries = {name: _version(name) for name in ("numpy", "numba", "llvmlite", "h5py", "scipy")}
    return {"python": platform.python_version(), "porescale": VERSION, **libraries}


@cache
def _version(name: str) -> str | None:
    """That of an installed package, which a process imports once; None where there is none."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


def commit() -> dict[str, Any] | None:
    """{"hash", "changed"} of the git checkout that the package lies in, None when it lies in none."""
    root = Path(__file__).resolve().parents[3]
    if not (root / ".git").exists():
        return None
    try:
        revision = _git(root, "rev-parse", "HEAD")
        changed = bool(_git(root, "status", "--porcelain", "--untracked-files=no"))
    except (OSError, subprocess.SubprocessError):
        return None
    return {"hash": revision, "changed": changed}


def mark() -> dict[str, str]:
    """{"date", "commit"} of what is measured now, UTC; the commit as of `short_commit`."""
    return {"date": now()[:10], "commit": short_commit(commit())}


def _git(root: Path, *words: str) -> str:
    done = subprocess.run(["git", "-C", str(root), *words], capture_output=True, text=True, timeout=10, check=True)
    return done.stdout.strip()


def plain(value: Any) -> Any:
    """``value`` as JSON has it: numpy numbers as numbers, arrays as lists, paths, inf, nan as text."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | set | frozenset):
        return [plain(item) for item in value]
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return repr(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)


def changed_keys(old: Any, new: Any, free: Collection[str] = FREE, place: str = "") -> dict[str, tuple[Any, Any]]:
    """Dotted keys in which two scenes differ, with both values, but for ``free`` ones and below."""
    if place and (place in free or place.rpartition(".")[2] in free):
        return {}
    if isinstance(old, dict) and isinstance(new, dict):
        found: dict[str, tuple[Any, Any]] = {}
        for key in [*old, *(key for key in new if key not in old)]:
            below = f"{place}.{key}" if place else str(key)
            found |= changed_keys(old.get(key), new.get(key), free, below)
        return found
    if _tables(old) and _tables(new) and len(old) == len(new):
        return {
            key: both
            for k, (was, now) in enumerate(zip(old, new, strict=True))
            for key, both in changed_keys(was, now, free, f"{place}[{k}]").items()
        }
    return {} if old == new else {place: (old, new)}


def _tables(value: Any) -> bool:
    """Whether a value is a list of tables."""
    return isinstance(value, list) and bool(value) and all(isinstance(it, dict) for it in value)


def changed_laws(old: Mapping[str, Any], new: Mapping[str, Any]) -> list[Fault]:
    """Own laws of a run card that are others on a ``new`` one."""
    before, now = old.get("laws") or {}, new.get("laws") or {}
    return [
        Fault(
            key, law["law"], f"has changed since the run began (hash {before[key]['hash']}, now {law['hash']})",
            repair="start another run; the text that the run has is on its card",
        )
        for key, law in now.items() if key in before and law["hash"] != before[key]["hash"]
    ]  # fmt: skip

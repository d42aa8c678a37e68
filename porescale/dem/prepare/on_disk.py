"""Packings on disk, under a hash of all that made them."""

import contextlib
import functools
import hashlib
import io
import json
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from porescale.common.compiled.cache import cache_root, hash_of
from porescale.common.core.atomic import write_bytes
from porescale.common.core.errors import InputError

T = TypeVar("T")

UNREADABLE = (OSError, EOFError, ValueError, KeyError, TypeError, RuntimeError, zipfile.BadZipFile, InputError)
"""What reading a packing from disk raises when it is absent, cut short, not an archive, or lacks a part."""


def once(
    made_of: Sequence[Any],
    read: Callable[[dict[str, Any]], T],
    make: Callable[[], T],
    state: Callable[[T], dict[str, Any]],
    folder: Path | None = None,
) -> T:
    """What ``made_of``, JSON-able, makes: read from its state on disk, with the bits it had, or made and kept there.

    folder : None: $XDG_CACHE_HOME/porescale/packings.  A damaged file is made anew, and a folder that cannot be written
    is done without.
    """
    name = hashlib.sha256(json.dumps([*made_of, sources()]).encode()).hexdigest()[:16]
    path = (folder or cache_root() / "packings") / f"{name}.npz"
    with contextlib.suppress(*UNREADABLE):
        return read(unpack(path))
    made = make()
    with contextlib.suppress(OSError):  # no room or no right to write: the next run makes it again
        pack(path, state(made))
    return made


@functools.cache
def sources() -> str:
    """Hash (12 hex digits) of the sources a packing depends on: grains, particles and ground.

    Read once in a process, which runs what it imported.
    """
    root = Path(__file__).resolve().parents[2]
    return hash_of(root / room for room in ("dem", "common/neighbors", "common/core", "common/compiled"))


def pack(path: Path, state: dict[str, Any]) -> None:
    """Write a nested ``state`` of arrays and numbers to ``path``: whole or absent.  Raises OSError."""
    flat: dict[str, Any] = {}
    for key, value in state.items():
        for inner, part in value.items() if isinstance(value, dict) else [("", value)]:
            flat[f"{key}/{inner}" if inner else key] = np.asarray(part)
    buffer = io.BytesIO()
    np.savez(buffer, **flat)
    write_bytes(path, buffer.getvalue())


def unpack(path: Path) -> dict[str, Any]:
    """Read what ``pack`` wrote; raises one of UNREADABLE where it is not that."""
    state: dict[str, Any] = {}
    with np.load(path, allow_pickle=False) as stored:
        for name in stored.files:
            key, _, inner = name.partition("/")
            if inner:
                state.setdefault(key, {})[inner] = stored[name]
            else:
                state[key] = stored[name]
    return state

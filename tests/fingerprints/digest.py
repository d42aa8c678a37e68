"""A hash of nested values: of keys, types, shapes and bits, whatever the order of the keys."""

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

DEEP = ("state", "start")
"""First keys below which parts are told apart by a second one: "state/grains"."""
SHORT = 8
"""Hex digits of the hash of a part."""


def leaves(value: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], bytes]]:
    """Paths and bytes of everything in ``value``, in the order of its keys; TypeError at what has no bits of its own.

    Numbers of numpy count as those of Python that they are, so that a state may hold either.
    """
    if isinstance(value, Mapping):
        if not value:
            yield path, b"{}"
        for key in sorted(value, key=str):
            yield from leaves(value[key], (*path, str(key)))
    elif isinstance(value, np.ndarray) and value.dtype != object:
        head = f"{value.dtype.str}{value.shape}".encode()
        yield path, head + np.ascontiguousarray(value).tobytes()
    elif isinstance(value, np.generic):
        yield path, repr(value.item()).encode()
    elif isinstance(value, (list, tuple)):
        yield path, f"{len(value)} entries".encode()
        for index, it in enumerate(value):
            yield from leaves(it, (*path, str(index)))
    elif is_dataclass(value) and not isinstance(value, type):
        yield from leaves({it.name: getattr(value, it.name) for it in fields(value)}, path)
    elif value is None or isinstance(value, (bool, int, float, complex, str, bytes)):
        yield path, repr(value).encode()
    else:
        raise TypeError(f"{'/'.join(path)}: {type(value).__name__} has no bits to hash")


def fingerprint(value: Any) -> tuple[str, dict[str, str]]:
    """Hash (64 hex digits) of ``value``, and short ones of its parts by the first keys of their paths."""
    whole, parts = hashlib.sha256(), {}
    for path, content in leaves(value):
        part = "/".join(path[: 2 if path[:1] and path[0] in DEEP else 1])
        line = f"{'/'.join(path)}\0{len(content)}\0".encode()
        for digest in (whole, parts.setdefault(part, hashlib.sha256())):
            digest.update(line)
            digest.update(content)
    return whole.hexdigest(), {name: it.hexdigest()[:SHORT] for name, it in parts.items()}

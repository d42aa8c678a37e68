"""Registers that are read from a folder: one file, one entry, and no list kept by hand."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules
from typing import Any


def discover(package: str, attribute: str) -> dict[str, Any]:
    """What the modules of a package call ``attribute``, by its ``name``, sorted by its ``order``, then by name.

    Imports every module of the package; those without the attribute count as helpers.  ValueError where two entries
    have the same name.
    """
    found: dict[str, Any] = {}
    for module in iter_modules(import_module(package).__path__):
        entry = vars(import_module(f"{package}.{module.name}")).get(attribute)
        if entry is None:
            continue
        if entry.name in found:
            raise ValueError(f"{package}: two entries are called {entry.name!r}")
        found[entry.name] = entry
    return dict(sorted(found.items(), key=lambda item: (item[1].order, item[0])))

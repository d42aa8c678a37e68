"""Registers that are read from a folder: one file, one entry, and no list kept by hand."""

from collections.abc import Iterator
from importlib import import_module
from pkgutil import walk_packages
from typing import Any


def entries(package: str, attribute: str) -> Iterator[Any]:
    """The objects called ``attribute`` of all modules below ``package``, in the order of the modules' dotted names.

    Imports every module below the package; those without the attribute count as helpers.
    """
    modules = walk_packages(import_module(package).__path__, f"{package}.")
    for module in map(import_module, sorted(it.name for it in modules if not it.ispkg)):
        if attribute in vars(module):
            yield vars(module)[attribute]


def discover(package: str, attribute: str) -> dict[str, Any]:
    """The `entries` of a package by their ``name``, sorted by their ``order``, then by name.

    ValueError where two entries have the same name.
    """
    found: dict[str, Any] = {}
    for entry in entries(package, attribute):
        if entry.name in found:
            raise ValueError(f"{package}: two entries are called {entry.name!r}")
        found[entry.name] = entry
    return dict(sorted(found.items(), key=lambda item: (item[1].order, item[0])))

"""Registers found by looking: every module of a folder that has one, so that adding a file adds its rows."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from typing import Any


def registers(package: str, name: str) -> Iterator[Any]:
    """The objects called ``name`` of all modules below ``package``, in the order of the modules' dotted names."""
    found = import_module(package)
    modules = [it.name for it in pkgutil.walk_packages(found.__path__, f"{package}.") if not it.ispkg]
    for module in map(import_module, sorted(modules)):
        if name in vars(module):
            yield vars(module)[name]

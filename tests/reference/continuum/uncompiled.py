"""Kernels of whole modules in plain Python, which checks bounds."""

from types import ModuleType

import pytest

from continuum_sph.water import (
    bundles,
    density,
    fluids,
    image_walls,
    kernel_correction,
    leapfrog,
    parameters,
    pressure_walls,
    rates,
    rates_fluid,
    rates_walls,
    shifting,
    smoothing,
    step,
    viscosity,
)

WATER = (
    bundles, density, fluids, image_walls, kernel_correction, leapfrog, parameters, pressure_walls,
    rates, rates_fluid, rates_walls, shifting, smoothing, step, viscosity,
)  # fmt: skip
"""Modules of the kernels that a flow of water calls."""


def uncompile(monkeypatch: pytest.MonkeyPatch, *modules: ModuleType) -> None:
    """Put plain Python in place of every kernel that ``modules`` name, until the test ends."""
    for module in modules:
        for name, it in list(vars(module).items()):
            if hasattr(it, "py_func"):
                monkeypatch.setattr(module, name, it.py_func)

"""continuum_sph: soil, water and air as layers of smoothed particles, the continuum beside the grains of porescale.

from continuum_sph import Simulation, load, open_run
simulation = Simulation(load("cases/collapsing_water_column", quality="draft"))
simulation.advance(100)

Source of the method: Maeda & Sakai 2004; where its equations cannot be followed, the docstrings say so.
"""

from typing import Any

from porescale.common.core.version import VERSION

__version__ = VERSION
__all__ = ["Scene", "Simulation", "__version__", "load", "open_run"]


def __getattr__(name: str) -> Any:
    """The API of a handful of names, imported at first use, so that --help needs no compilation."""
    if name == "load":
        from continuum_sph.scene.sections import load_scene

        return load_scene
    if name == "Scene":
        from continuum_sph.scene.sections import Scene

        return Scene
    if name == "Simulation":
        from continuum_sph.builders.simulation import Simulation

        return Simulation
    if name == "open_run":
        from porescale.common.record.open_run import open_run

        return open_run
    raise AttributeError(f"continuum_sph has no {name!r}; it has {', '.join(__all__)}")

"""porescale: round grains in a viscous fluid at the scale of single pores, in two dimensions.

from porescale import build, load, open_run
simulation = build(load("cases/column_collapse", quality="draft"))
simulation.advance(100)
"""

from typing import Any

from porescale.common.core.version import VERSION

__version__ = VERSION
__all__ = ["Scene", "Simulation", "__version__", "build", "load", "open_run"]


def __getattr__(name: str) -> Any:
    """The API of a handful of names, imported when first asked for: --help must not wait for a compiler."""
    if name == "load":
        from porescale.builders.build import load_scene

        return load_scene
    if name == "build":
        from porescale.builders.build import build

        return build
    if name == "Scene":
        from porescale.builders.scene import Scene

        return Scene
    if name == "Simulation":
        from porescale.builders.simulation import Simulation

        return Simulation
    if name == "open_run":
        from porescale.common.record.open_run import open_run

        return open_run
    raise AttributeError(f"porescale has no {name!r}; it has {', '.join(__all__)}")

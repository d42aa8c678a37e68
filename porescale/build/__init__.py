"""From a scene to a simulation: the only folder that imports both sections and physics.

`porescale.build` is this folder and, as ``porescale.build(scene)``, the function of the API.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any


class _Build(ModuleType):
    """This folder, callable: Python puts a folder that is imported in the place of a function of its name."""

    def __call__(self, scene: Any) -> Any:
        """The simulation of ``scene`` at time 0: see `build.build.build`."""
        from porescale.build.build import build

        return build(scene)


sys.modules[__name__].__class__ = _Build

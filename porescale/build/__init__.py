"""From a scene to a simulation: the only folder that imports both sections and physics."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any


class _Callable(ModuleType):
    """`porescale.build` is both this folder and, called with a scene, the function of the API."""

    def __call__(self, scene: Any) -> Any:
        """The simulation of a scene: `porescale.build.build.build`."""
        from porescale.build.build import build

        return build(scene)


sys.modules[__name__].__class__ = _Callable

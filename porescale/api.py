"""The Python interface of porescale: scenes, simulations and runs, with the names that continuum_sph has too."""

from __future__ import annotations

from typing import TYPE_CHECKING

from porescale.common.api.interface import Interface
from porescale.common.api.run import set_threads as set_threads
from porescale.common.api.shipped import cases as cases
from porescale.program import PROGRAM

if TYPE_CHECKING:
    from porescale.builders.scene import Scene
    from porescale.builders.simulation import Simulation

_OF_PACKAGE: Interface[Scene, Simulation] = Interface(PROGRAM)
load, diff, build, check = _OF_PACKAGE.load, _OF_PACKAGE.diff, _OF_PACKAGE.build, _OF_PACKAGE.check
run, open_run, sweep = _OF_PACKAGE.run, _OF_PACKAGE.open_run, _OF_PACKAGE.sweep

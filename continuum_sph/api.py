"""The Python interface of continuum_sph: scenes, simulations and runs, with the names that porescale has too."""

from __future__ import annotations

from typing import TYPE_CHECKING

from continuum_sph.program import PROGRAM
from porescale.common.api.interface import Interface
from porescale.common.api.run import set_threads as set_threads
from porescale.common.api.shipped import cases as cases
from porescale.common.core.errors import InputError as InputError
from porescale.common.core.errors import PorescaleError as PorescaleError
from porescale.common.core.errors import PorescaleWarning as PorescaleWarning
from porescale.common.core.errors import Unstable as Unstable
from porescale.common.record.stop import Interrupted as Interrupted

if TYPE_CHECKING:
    from continuum_sph.builders.simulation import Simulation
    from continuum_sph.scene.sections import Scene

_OF_PACKAGE: Interface[Scene, Simulation] = Interface(PROGRAM)
load, diff, build, check = _OF_PACKAGE.load, _OF_PACKAGE.diff, _OF_PACKAGE.build, _OF_PACKAGE.check
run, open_run, sweep = _OF_PACKAGE.run, _OF_PACKAGE.open_run, _OF_PACKAGE.sweep

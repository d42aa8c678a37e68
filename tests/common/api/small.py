"""Small scenes of both packages, by name."""

import continuum_sph
import porescale
from continuum_sph.validation.seepage.levee import Levee
from tests.reference.programs import SOIL
from tests.reference.scenes import column, dry, table

TANK = {
    "tank": {"width": 0.2, "height": 0.2},
    "water": {"column": [{"width": 0.1, "height": 0.1}]},
    "numerics": {"spacing": 0.01},
    "time": {"end": 0.02},
    "output": {"snapshot_interval": 0.01, "series_interval": 0.002},
}
"""A column of 100 particles of water that falls."""


def scene_of(kind, **changes):
    """The scene of a ``kind``, changed as in `tests.reference.scenes.table`."""
    if kind in ("coupled", "dry"):
        return {"coupled": column, "dry": dry}[kind](**{"time__end": 0.004, **changes})
    base = {"tank": TANK, "soil": SOIL, "levee": Levee(rows=6).table()}[kind]
    return continuum_sph.Scene(**table(base, **changes))


def package_of(kind):
    """The package whose scene it is."""
    return porescale if kind in ("coupled", "dry") else continuum_sph


def build(scene):
    """The simulation of a scene of either package."""
    return (porescale if isinstance(scene, porescale.Scene) else continuum_sph).build(scene)

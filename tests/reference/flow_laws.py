"""A file with a user's body forces and inflows, and scenes that use them, for tests."""

from pathlib import Path
from typing import Any

from porescale.builders.scene import Scene
from porescale.common.schema.sections import validate
from tests.reference.own_laws import write_laws

FLOWS = """
import math

import porescale as ps

WIDTH, FORCE, OMEGA = 0.01, {force}, {omega}


@ps.body_force
def kolmogorov(x, y):
    return 1000.0 * FORCE * math.sin(2.0 * math.pi * y / WIDTH), 0.0


@ps.body_force
def uniform(x, y, t):
    return 1000.0 * FORCE, 250.0 * FORCE


@ps.body_force
def swinging(x, y, t):
    return 1000.0 * FORCE * math.cos(OMEGA * t), 0.0


@ps.body_force
def whirl(x, y, t):
    return FORCE * (WIDTH / 2 - y) * math.cos(OMEGA * t), FORCE * (x - WIDTH / 2)


@ps.contact_law(keys={{"stiffness": "N/m", "adhesion": "N/m"}})
def sticky(overlap, closing, radius, mass, p):
    return p.stiffness * overlap - p.adhesion


@ps.inflow
def parabola(s, t):
    return 6.0 * FORCE * s * (WIDTH - s) / WIDTH**2, 0.0


@ps.inflow
def pulse(s, t):
    return FORCE * (1.0 - math.cos(OMEGA * t)), 0.0


@ps.inflow
def unset(s, t):
    return math.nan if t > 1e-4 else 0.0, 0.0
"""


def flow_scene(folder: Path, cells: int = 16, force: float = 1e-3, omega: float = 100.0, **changes: Any) -> Scene:
    """A box of WIDTH, periodic, viscosity 1e-5 m²/s at relaxation time 0.8, with laws.py beside it."""
    write_laws(folder, FLOWS.format(force=repr(force), omega=repr(omega)))
    spacing = 0.01 / cells
    table: dict[str, Any] = {
        "gravity": [0.0, 0.0],
        "domain": {"width": 0.01, "height": 0.01, **dict.fromkeys(("left", "right", "bottom", "top"), "periodic")},
        "time": {"end": 0.2},
        "output": {"snapshot_interval": 0.1, "series_interval": 0.1},
        "fluid": {"spacing": spacing, "viscosity": 1e-5, "step": 0.1 * spacing**2 / 1e-5},
    }
    for key, value in changes.items():
        section, _, name = key.partition("__")
        if name:
            table[section] = {**table.get(section, {}), name: value}
        else:
            table[section] = value
    return validate(Scene, table, folder=folder)

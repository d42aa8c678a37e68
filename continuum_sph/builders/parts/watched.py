"""Parts of the ground whose mean displacement is recorded: the rows of `[[soil.watch]]`."""

import numpy as np
from numpy.typing import NDArray

from continuum_sph.builders.parts.soil import SoilPart, soil_particles, soil_section, unfilled
from continuum_sph.scene.sections import Scene
from porescale.common.core.errors import InputError
from porescale.common.record.part import Part
from porescale.common.schema.names import names_of


class WatchedPart(Part):
    """The watched parts of a scene's ``soil``, each the particles that were within its outline when it was placed."""

    def __init__(self, scene: Scene, soil: SoilPart) -> None:
        self.soil = soil
        self.rows = watched_rows(scene)

    def row(self) -> dict[str, float]:
        """Mean displacement of each watched part.

        NAME moved (m) : mean distance of its particles from where displacements count from
        """
        moved = self.soil.displacement()
        return {f"{name} moved (m)": float(moved[rows].mean()) for name, rows in self.rows.items()}


def watched_rows(scene: Scene) -> dict[str, NDArray[np.int64]]:
    """Numbers of the particles of soil of each watched part of a ``scene``, (k,) by name; InputError if it has none."""
    section = soil_section(scene)
    x = soil_particles(scene)[0] if section.watch else np.zeros((0, 2))
    found, names = {}, names_of(section.watch, "part")
    for number, part in enumerate(section.watch):
        rows = np.flatnonzero(part.holds(x))
        if not len(rows):
            raise InputError(unfilled(f"soil.watch[{number}].outline", part))
        found[names[number]] = rows
    return found

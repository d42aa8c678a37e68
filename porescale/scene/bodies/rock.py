"""[rock]: a pressed packing made into bonded discs, triangles or Voronoi cells between two plates."""

from typing import ClassVar, Literal

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import quantity
from porescale.scene.time_function import Timed, TimeFunction


class Rock(Timed):
    """A bonded sample made of the packing, between plates: left and right of it, or below and above.

    Polygons are shrunk to stand ``gap`` apart and get so much thickness that their sides overlap by ``pressed``.  The
    second plate moves by ``strain`` of the sample's length, > 0 away, the first stands: rock.csv.
    """

    kind: Literal["discs", "triangles", "cells"] = pydantic.Field(
        "discs", description="the packing's discs, Delaunay triangles or Voronoi cells of their centres"
    )
    gap: float | None = quantity("m", None, gt=0, le=1e3, help="distance of neighbouring polygons' lines")
    pressed: float | None = quantity("m", None, gt=0, le=1e3, help="overlap of their sides, from which they are bonded")
    plates: Literal["x", "y", "none"] = pydantic.Field("x", description="along which axis the plates press and pull")
    strain: TimeFunction | None = pydantic.Field(
        None, description="of the sample over time, > 0 pulled; left out, it stands"
    )

    UNITS: ClassVar[dict[str, tuple[str, str]]] = {"strain": ("", "strain of the sample")}

    def _faults(self) -> list[Fault]:
        faults = []
        for name in ("gap", "pressed"):
            value = getattr(self, name)
            if self.kind == "discs" and value is not None:
                faults.append(Fault(name, value, "is of polygons", "m", repair="leave it out, or take another kind"))
            if self.kind != "discs" and value is None:
                faults.append(Fault(name, None, "is missing", "m", "> 0", f"add it: {self.kind} need it"))
        if self.strain is not None and (least := self.strain.least - self.strain.value(0.0)) <= -1.0:
            problem, repair = "presses the sample to nothing", "write -0.02 for two per cent"
            faults.append(Fault("strain", least, problem, "", "> -1", repair))
        if self.plates == "none" and self.strain is not None:
            faults.append(Fault("strain", None, "needs plates", repair='write plates = "x" or "y"'))
        return faults

    @property
    def polygons(self) -> bool:
        """Whether the rock consists of polygons."""
        return self.kind != "discs"

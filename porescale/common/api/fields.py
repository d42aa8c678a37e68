"""Fields of a simulation by name: numbers in cells, or at particles."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from porescale.common.core.types import AnyArray


class Field(NamedTuple):
    """values : (ny, nx) of cells, row 0 lowest, or (n,) of particles;  unit : SI unit or ""."""

    values: AnyArray
    unit: str


def scalars(data: Mapping[str, AnyArray], units: Mapping[str, str]) -> dict[str, Field]:
    """Arrays of a grid or cloud as fields: a vector as its length ("speed" of a velocity) and its components."""
    found: dict[str, Field] = {}
    for name, values in data.items():
        unit, last = units.get(name, ""), values.shape[-1:]
        if values.ndim > 1 and last in ((2,), (3,)):
            found["speed" if name == "velocity" else name] = Field(np.hypot(values[..., 0], values[..., 1]), unit)
            found[f"{name}_x"] = Field(values[..., 0].copy(), unit)
            found[f"{name}_y"] = Field(values[..., 1].copy(), unit)
        else:
            found[name] = Field(np.array(values), unit)
    return found

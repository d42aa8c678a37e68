"""Small scenes that tests start from: a column of 31 grains behind a gate that lifts, on 60 x 40 cells."""

import copy
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from porescale import Scene
from porescale.builders.derive import derive
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate

COLUMN: dict[str, Any] = {
    "title": "A small column under water",
    "domain": {"width": 0.012, "height": 0.008, "top": "slip"},
    "time": {"end": 0.024},
    "output": {"snapshot_interval": 0.004, "series_interval": 0.0004, "checkpoint_seconds": 0.05},
    "fluid": {"viscosity": 2e-5, "spacing": 0.0002, "step": 4e-5},
    "grains": {
        "density": 2500,
        "hydraulic_radius_ratio": 0.8,
        "packing": {"left": 0.008, "width": 0.004, "height": 0.0055, "diameter": 0.0008, "packing_fraction": 0.7},
    },
    "contact": {"stiffness": 2e5, "tangential_stiffness": 5e4, "restitution": 0.9, "friction": 0.5},
    "gate": {"x": 0.008, "opens_at": 0.002, "lift_speed": 0.4, "friction": 0.05},
}
STEPS = 600
"""Steps of COLUMN: the gate opens at step 50 and has risen by 0.88 of the box at the end."""


def table(base: Mapping[str, Any] = COLUMN, **changes: Any) -> dict[str, Any]:
    """``base`` with changes: section__key=value; None removes the key or section."""
    made = copy.deepcopy(dict(base))
    for name, value in changes.items():
        *above, last = name.split("__")
        inside = made
        for part in above:
            inside = inside.setdefault(part, {})
        if value is None:
            inside.pop(last, None)
        else:
            inside[last] = value
    return made


def column(**changes: Any) -> Scene:
    """The column as a scene, changed as in :func:`table`."""
    return validate(Scene, table(**changes))


def dry(**changes: Any) -> Scene:
    """The column without water and gate, and the grains left where they were placed."""
    given = {"fluid": None, "gate": None, "grains__hydraulic_radius_ratio": None, "grains__packing__settle": False}
    return column(**{**given, **changes})


def water(**changes: Any) -> Scene:
    """A periodic channel of water under a body force, without grains."""
    given = {
        "grains": None, "contact": None, "gate": None, "fluid__body_force": [10.0, 0.0],
        "domain__left": "periodic", "domain__right": "periodic",
    }  # fmt: skip
    return column(**{**given, **changes})


def refusals(make: Callable[[], object]) -> list[str]:
    """The lines of the InputError that ``make`` raises."""
    with pytest.raises(InputError) as caught:
        make()
    return [fault.line() for fault in caught.value.faults]


def warned(scene: Scene, word: str) -> list[str]:
    """The warnings of a scene with a word in them."""
    return [line for line in derive(scene).warnings if word in line]


def grain(x: float, y: float, diameter: float = 0.001, **more: Any) -> dict[str, Any]:
    """A grain placed by hand."""
    return {"x": x, "y": y, "diameter": diameter, **more}


def toml(values: Mapping[str, Any], above: str = "") -> str:
    """A table as TOML text: JSON spells numbers, texts and lists the same way."""
    lines = [f"{k} = {json.dumps(v)}" for k, v in values.items() if not isinstance(v, Mapping) and not _tables(v)]
    for name, value in values.items():
        if isinstance(value, Mapping):
            lines += [f"[{above}{name}]", toml(value, f"{above}{name}.")]
        elif _tables(value):
            lines += [f"[[{above}{name}]]\n" + toml(item, f"{above}{name}.") for item in value]
    return "\n".join(lines)


def write(path: Path, values: Mapping[str, Any]) -> Path:
    """A scene file with ``values``."""
    path.write_text(toml(values) + "\n", encoding="utf-8")
    return path


def _tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], Mapping)

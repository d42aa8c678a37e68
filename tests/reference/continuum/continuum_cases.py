"""Cases of the continuum run in this process: their series, and which expectations these miss."""

import tomllib
from collections.abc import Callable
from typing import Any

import numpy as np

from continuum_sph.scene.sections import Scene
from porescale.common.schema.sections import load
from porescale.common.studies.quantities import Columns, measured
from tests.reference.folders import CASES


def series(build: Callable[[Scene], Any], every: int, case: str, *settings: str) -> Columns:
    """Columns of the series of a case, changed by ``settings``, a row every so many steps and at the end."""
    scene = load(CASES / case, Scene, overrides=settings)
    model = build(scene)
    rows = [model.series()]
    while model.time < scene.time.end:
        model.advance(every)
        model.check()
        rows.append(model.series())
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def missed(case: str, columns: Columns) -> list[str]:
    """Names of the expectations of ``case`` that ``columns`` do not meet."""
    rows = tomllib.loads((CASES / case / "expected.toml").read_text(encoding="utf-8"))["expected"]
    return [row["name"] for row in rows if not abs(measured(columns, row) - row["value"]) <= row["tolerance"]]

"""Measuring a finished run: what [[probe]] and [[level]] say, from its snapshots."""

from dataclasses import replace
from typing import Any

from continuum_sph.builders.parts.instruments import WaterInstruments, level_row, probe_row
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from porescale.common.core.errors import Fault, InputError
from porescale.common.record.open_run import Run


def measure_run(run: Run, scene: Scene) -> dict[str, dict[str, list[Any]]]:
    """Tables "probes" and "levels", each columns by name, with a row for every snapshot; to the bit those of the run.

    scene : that of the run, with the sections to measure in place of its own.  InputError with soil: its snapshots do
    not say how much water a particle is.
    """
    if scene.soil:
        key = "probe" if scene.probe else "level"
        problem = "cannot be measured afterwards in a run with [soil]"
        raise InputError(Fault(key, None, problem, repair=f"put [[{key}]] into the scene, and run it"))
    instruments = Simulation(scene).part(WaterInstruments)
    assert instruments
    start = instruments.measured()
    masses = instruments.flow.layer.mass[: len(start.x)]
    rows: dict[str, list[dict[str, float]]] = {}
    for snapshot in run.snapshots():
        cloud = snapshot.clouds["particles"]
        data = cloud.data
        water = replace(
            start, x=cloud.position, volume=masses / data["density"], pressure=data["pressure"],
            v=data["velocity"][:, :2],
        )  # fmt: skip
        first = {"time (s)": snapshot.time}
        if scene.probe:
            rows.setdefault("probes", []).append(first | probe_row(scene.probe, water))
        if scene.level:
            rows.setdefault("levels", []).append(first | level_row(scene.level, water))
    return {name: {key: [row[key] for row in each] for key in each[0]} for name, each in rows.items()}

"""Rate of the main job as a whole: the underwater column collapse, all of a step included, in cells per second."""

from typing import Any

from porescale.benchmarks.lbm import bytes_of, kind_on, memory_of, plain
from porescale.builders.build import build
from porescale.builders.scene import Scene
from porescale.common.core.errors import Fault, InputError
from porescale.common.evidence.benchmarks import CPU, PLAIN, Benchmarks, Dtype, Work
from porescale.common.schema.sections import validate

BENCHMARKS = Benchmarks()

SIZE = 400
"""Cells across the box: the case's levels have 320 (draft), 400 (standard) and 1200 (fine)."""
FALLEN = 0.05
"""Time (s) after which it is timed: grains move, the pair list is rebuilt now and then."""
STEPS = 40


def column(size: int, dtype: Dtype, device: str = CPU) -> Scene:
    """The column collapse of cases/column_collapse on ``size``² cells, the step scaled with the spacing."""
    spacing = 0.12 / size
    table: dict[str, Any] = {
        "domain": {"width": 0.12, "height": 0.12, "top": "slip"},
        "time": {"end": 1.2},
        "output": {"snapshot_interval": 0.02, "series_interval": 0.005},
        "fluid": {"viscosity": 1e-4, "spacing": spacing, "step": 0.125 * spacing, "precision": dtype},
        "grains": {
            "density": 2500,
            "hydraulic_radius_ratio": 0.8,
            "packing": {"left": 0.09, "width": 0.03, "height": 0.072, "diameter": 0.0015},
        },
        "contact": {"stiffness": 5e5, "tangential_stiffness": 1.25e5, "restitution": 0.97, "friction": 0.5},
        "gate": {"x": 0.09, "friction": 0.05},
        "run": {"device": device},
    }
    return validate(Scene, table)


@BENCHMARKS.row("column", gpu=True)
def bench_column(size: int | None, threads: int, dtype: Dtype, device: str = CPU) -> list[Work]:
    """Coupled steps of the collapsing column; beside them plain fluid of its size, and the contact steps alone.

    What neither of these takes is coverage, the cells that grains lie in and their loads.  Raises InputError if the
    gate fits no cell side.
    """
    cells = SIZE if size is None else size
    if cells % 4 or cells < 100:
        raise InputError(Fault("--size", cells, "the gate stands at three quarters", allowed="multiples of 4 from 100"))
    simulation = build(column(cells, dtype, device))
    simulation.advance(max(2, round(FALLEN / simulation.step_seconds)))
    updates, fluid = float(cells * cells * STEPS), plain(cells, dtype, device)
    coupled = simulation.coupled
    assert coupled

    _, wait = kind_on(device)

    def coupled_steps() -> None:
        """STEPS steps of all."""
        simulation.advance(STEPS)
        wait()

    def contacts() -> None:
        """All the contact steps of STEPS steps, without the lattice."""
        step = simulation.step_seconds / coupled.contact_steps
        for _ in range(STEPS):
            coupled.grains.step(step, coupled.force, coupled.torque, coupled.contact_steps)

    return [
        Work(coupled_steps, updates, "cells/s", cells, gpu=device != CPU),
        Work(contacts, updates, "cells/s", cells, variant="contacts"),
        Work(
            lambda: fluid(STEPS),
            updates,
            "cells/s",
            cells,
            bytes_of(dtype),
            PLAIN,
            yardstick=True,
            memory=memory_of(cells, dtype),
            gpu=device != CPU,
        ),
    ]

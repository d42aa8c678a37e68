"""``python -m porescale.builders.rehearsal``: comes to the kernels of a scene sooner than its run does.

The packing stands in rows rather than settles, and steps of a fluid begin with the fluid: while the run looks for pairs
and settles its packing, this compiles what the run comes to last.  A few steps are made, a row and a snapshot.  Nothing
is written but kernels.  A scene that takes much memory, or names a user's own functions, is not rehearsed.
"""

from contextlib import AbstractContextManager
from typing import Any

from porescale.builders.cost import memory
from porescale.builders.derive import derive
from porescale.builders.scene import Scene
from porescale.common.api import run_scene
from porescale.common.compiled.ahead import serve

LARGEST = 2.0**28
"""Bytes of the largest scene: it is held twice while its run begins."""
STEPS = (1, 1, 2)
"""Blocks of steps, a row of the series after each: odd and even ones have kernels of their own."""


def rehearsed(scene: Scene) -> AbstractContextManager[None]:
    """Within this, kernels of ``scene`` are compiled by a second process, too, if there are cores for it."""

    def fits() -> bool:
        """Whether the scene runs on the processor and is small."""
        return not (scene.run and scene.run.device != "cpu") and memory(scene, derive(scene)) <= LARGEST

    return run_scene.rehearsed(__name__, scene, fits)


def rehearse(given: dict[str, Any]) -> None:
    """Build the scene and begin with it."""
    from porescale.builders.build import system_of
    from porescale.builders.kinds import add_parts
    from porescale.builders.simulation import Simulation

    system = system_of(run_scene.scene_given(given, Scene), hasty=True)
    model = Simulation(system, add_parts(system))
    for steps in STEPS:
        model.advance(steps)
        model.series()
    model.snapshot()


if __name__ == "__main__":
    serve(rehearse)

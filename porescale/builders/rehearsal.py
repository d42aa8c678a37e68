"""``python -m porescale.builders.rehearsal``: comes to the kernels of a scene sooner than its run does.

The packing stands in rows rather than settles, and steps of a fluid begin with the fluid: while the run looks for pairs
and settles its packing, this compiles what the run comes to last.  A few steps are made, a row and a snapshot.  Nothing
is written but kernels.  A scene that takes much memory, or names a user's own functions, is not rehearsed.
"""

from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from porescale.builders.cost import memory
from porescale.builders.derive import derive
from porescale.builders.scene import Scene
from porescale.common.compiled.ahead import ahead, serve
from porescale.common.compiled.jit import set_threads, threads

LARGEST = 2.0**28
"""Bytes of the largest scene: it is held twice while its run begins."""
STEPS = (1, 1, 2)
"""Blocks of steps, a row of the series after each: odd and even ones have kernels of their own."""


def rehearsed(scene: Scene) -> AbstractContextManager[None]:
    """Within this, kernels of ``scene`` are compiled by a second process, too, if there are cores for it."""
    from porescale.common.schema.own import on_card
    from porescale.common.schema.sections import scene_as_dict

    if threads() < 2:
        return nullcontext()

    def given() -> dict[str, Any] | None:
        """What the second process reads; None where it is not to be started."""
        if on_card(scene) or (scene.run and scene.run.device != "cpu") or memory(scene, derive(scene)) > LARGEST:
            return None
        return {"scene": scene_as_dict(scene), "folder": str(scene.source.folder or ""), "threads": threads()}

    return ahead(__name__, given)


def rehearse(given: dict[str, Any]) -> None:
    """Build the scene and begin with it."""
    from porescale.builders.build import system_of
    from porescale.builders.kinds import add_parts
    from porescale.builders.simulation import Simulation
    from porescale.common.schema.sections import validate

    set_threads(given["threads"])
    scene = validate(Scene, given["scene"], folder=Path(given["folder"]) if given["folder"] else None)
    system = system_of(scene, hasty=True)
    model = Simulation(system, add_parts(system))
    for steps in STEPS:
        model.advance(steps)
        model.series()
    model.snapshot()


if __name__ == "__main__":
    serve(rehearse)

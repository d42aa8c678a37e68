"""``python -m continuum_sph.builders.rehearsal``: comes to the kernels of water in soil sooner than a run does.

A run begins with the rates of its soil; here the water comes first, so that both are compiled at the same time, and
then the soil, whose kernels are on disk by then.  A few steps are made.  Nothing is written but kernels.  Soil without
water, and water without soil that moves, come to their kernels in one order only: they are not rehearsed.
"""

from contextlib import AbstractContextManager
from typing import Any

from continuum_sph.scene.sections import Scene
from porescale.common.api import run_scene
from porescale.common.compiled.ahead import serve

LARGEST = 2e5
"""Particles, of soil and water each, of the largest scene: it is held twice while its run begins."""
STEPS = 3
"""Steps that are made: the second takes up what the first leaves."""


def rehearsed(scene: Scene) -> AbstractContextManager[None]:
    """Within this, kernels of ``scene`` are compiled by a second process, too, if there are cores for it."""

    def fits() -> bool:
        """Whether there is water in soil that moves, and not much of it."""
        soil, (width, height) = scene.soil, scene.inner
        moves = soil is not None and not soil.held and soil.suction is None and not scene.dry
        return moves and width * height / scene.numerics.spacing**2 <= LARGEST

    return run_scene.rehearsed(__name__, scene, fits)


def rehearse(given: dict[str, Any]) -> None:
    """Build soil and water of the scene and begin with them."""
    from continuum_sph.builders.parts.pore_water import seepage_flow

    both = seepage_flow(run_scene.scene_given(given, Scene), hasty=True)
    for _ in range(STEPS):
        both.advance()


if __name__ == "__main__":
    serve(rehearse)

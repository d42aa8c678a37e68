"""Bodies of segments in snapshots: their corners as points, segments as lines, solid polygons as polygons."""

from collections.abc import Sequence

import numpy as np

from porescale.builders.initial.frames import Placed, disc_count
from porescale.common.core.types import AnyArray
from porescale.common.record.model import Cloud
from porescale.dem.bodies.frames import cells_of
from porescale.dem.grains import Grains

FRAMES, BONDS = "frames", "bonds"
"""Names of the clouds in snapshots."""
KIND = {"segment": 0, "polygon": 1, "container": 2, "rock": 3, "plate": 4}
"""Numbers of the kinds of frames in the cloud."""


def frame_cloud(grains: Grains, placed: Sequence[Placed]) -> Cloud:
    """Corners with thickness ("radius"), velocity, the number of their body among frames, its kind, see KIND, and
    whether its motion is prescribed ("driven").

    Bodies in a periodic box lie where their centroid is within it.
    """
    d, first, clumps = grains.discs, disc_count(grains), grains.steering.clumps
    sizes = [len(it.frame.corners) for it in placed]
    body = np.repeat(np.arange(len(placed)), sizes)
    at = d.position[first:].copy()
    centre = clumps.position[clumps.count - len(placed) :]
    for axis, period in enumerate(grains.box.period):
        if period > 0.0:
            at[:, axis] -= (period * np.floor(centre[:, axis] / period))[body]
    flat = np.zeros((len(at), 3))
    flat[:, :2] = d.velocity[first:]
    data: dict[str, AnyArray] = {
        "radius": d.radius[first:], "velocity": flat, "spin": d.spin[first:], "body": body.astype(np.int32),
        "kind": np.array([KIND[it.kind] for it in placed], np.int32)[body],
        "driven": np.array([not it.free for it in placed], np.uint8)[body],
    }  # fmt: skip
    lines, polygons = cells_of([it.frame for it in placed], [it.kind != "container" for it in placed])
    return Cloud(at, data, {"radius": "m", "velocity": "m/s", "spin": "rad/s"}, lines=lines, polygons=polygons)

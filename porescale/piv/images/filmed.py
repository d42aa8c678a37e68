"""Frames of the virtual camera as files: pictures, masks, a film, and how they were taken."""

import json
import logging
import time
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.core.atomic import write_bytes, write_text
from porescale.common.pictures.film import write_film
from porescale.common.record.open_run import Run
from porescale.piv.images.camera import ROUNDING, Shooting, frames
from porescale.piv.images.rendered import FRAMES, MASKS, SHOT

LOG = logging.getLogger(__name__)
PATIENCE = 10.0
"""Seconds between lines of progress, which go to the log; commands print it."""
RATE = 25
"""Frames a second that the film is played at."""


def write_frames(run: Run, shot: Shooting, folder: Path) -> int:
    """Write frames/00000.png …, masks/00000.png … (solid white), film.mp4, shooting.json; gives the number of frames.

    What an earlier film left in ``frames`` and ``masks`` goes.  One frame is in memory at a time.
    """
    for name in (FRAMES, MASKS):
        for old in (folder / name).glob("[0-9]*.png"):
            old.unlink()
    count = 0
    total = int((shot.end - shot.start) / shot.interval + ROUNDING) + 1
    began = last = time.perf_counter()

    def painted() -> Iterator[NDArray[Any]]:
        """Frames in colour, each written with its mask as it comes."""
        nonlocal count, last
        for frame in frames(run, shot):
            mask = np.where(frame.solid, 255, 0).astype(np.uint8)
            for name, image in ((FRAMES, frame.picture), (MASKS, mask)):
                write_bytes(folder / name / f"{count:05d}.png", cv2.imencode(".png", image)[1].tobytes())
            count += 1
            now = time.perf_counter()
            if now - last > PATIENCE:
                left = (now - began) / count * (total - count)
                LOG.info("%d of %d frames, about %.0f s left", count, total, left)
                last = now
            rows, columns = (side // 2 * 2 for side in frame.picture.shape)
            yield np.repeat(frame.picture[:rows, :columns, None], 3, 2)

    write_film(folder / "film", painted(), RATE)
    write_text(folder / SHOT, json.dumps({"run": str(run.folder), **asdict(shot)}, indent=1) + "\n")
    return count

"""A film of a run that browsers play: H.264 in MP4, or VP9 in WebM where no H.264 encoder is built in."""

from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import av
from PIL import Image

from porescale.common.core.atomic import whole
from porescale.common.core.types import AnyArray
from porescale.common.pictures.look import Look
from porescale.common.pictures.picture import Painter, painter_of, pictures
from porescale.common.record.open_run import Run, open_run

WATCHABLE = 6.0
"""A film is played in about this many seconds, at 5 to 30 frames a second."""
ENCODERS: tuple[tuple[str, str, dict[str, str]], ...] = (
    ("libx264", ".mp4", {"crf": "20", "preset": "veryfast"}),
    ("libopenh264", ".mp4", {}),
    ("libvpx-vp9", ".webm", {"crf": "30", "b": "0", "deadline": "realtime", "cpu-used": "5"}),
)


def painted(folder: Path | str, look: Look | None = None, **changes: Any) -> list[Path]:
    """Write the pictures of a run (`pictures`) and film.mp4 or film.webm, in the same colours; returns their paths.

    changes : fields of :class:`Look`.  InputError when the run has no snapshots.
    """
    run = open_run(folder)
    painter = painter_of(run, replace(look or Look(), **changes))
    return [*pictures(run, painter), film_of(run, painter, run.folder / "film")]


def film_of(run: Run, painter: Painter, stem: Path, rate: int | None = None) -> Path:
    """Paint every snapshot of a run into <stem>.mp4 (or .webm); returns its path.

    rate : frames per second (None: so that it lasts about six seconds).
    """
    rate = rate or rate_of(len(run))
    return write_film(stem, (painter.paint(snapshot) for snapshot in run.snapshots(painter.survey.look.cells)), rate)


def rate_of(frames: int) -> int:
    """Frames a second of a film that lasts about six seconds."""
    return min(30, max(5, round(frames / WATCHABLE)))


def write_gif(path: Path, images: Iterable[AnyArray], rate: int) -> Path:
    """Write RGB images as a GIF that goes round, of 256 colours, whole; returns the path."""
    frames = (Image.fromarray(image).quantize(256, dither=Image.Dither.NONE) for image in images)
    first = next(frames)
    with whole(path) as beside:
        first.save(beside, format="gif", save_all=True, append_images=frames, duration=round(1000 / rate), loop=0)
    return path


def write_film(stem: Path, images: Iterable[AnyArray], rate: int) -> Path:
    """Encode RGB images (even sides, all alike) into <stem>.mp4 or .webm, whole; returns the path.

    A frame is encoded by a second thread while the next is painted.
    """
    name, suffix, options = encoder()
    path = stem.with_name(stem.name + suffix)
    how = {"movflags": "+faststart"} if suffix == ".mp4" else {}
    with (
        whole(path) as beside,
        av.open(str(beside), "w", options=how) as container,
        ThreadPoolExecutor(max_workers=1) as encoding,
    ):
        stream = container.add_stream(name, rate=rate, options=options)
        assert isinstance(stream, av.VideoStream)
        stream.pix_fmt = "yuv420p"

        def add(image: AnyArray) -> None:
            """Encode the next frame."""
            container.mux(stream.encode(av.VideoFrame.from_ndarray(image, format="rgb24")))

        under_way: Future[None] | None = None
        for image in images:
            if under_way is None:
                stream.height, stream.width = image.shape[:2]
            else:
                under_way.result()  # one frame in memory besides that which is painted
            under_way = encoding.submit(add, image)
        if under_way is not None:
            under_way.result()
        container.mux(stream.encode())
    return path


def encoder() -> tuple[str, str, dict[str, str]]:
    """The first encoder that this PyAV has: its name, the file suffix, its options."""
    for name, suffix, options in ENCODERS:
        if name in av.codecs_available:
            return name, suffix, dict(options)
    raise RuntimeError("PyAV was built without an H.264 or VP9 encoder")

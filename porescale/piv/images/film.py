"""Pictures from files: single ones, series of them, and films (mp4, avi, whatever PyAV opens, stacks in one TIFF file),
one at a time."""

import glob
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError, warn
from porescale.common.core.given_file import STILLS, given_bytes, require_finite
from porescale.common.core.ranges import Range
from porescale.piv import given
from porescale.piv.images import stacks
from porescale.piv.images.numbered import doubt_of_order, natural
from porescale.piv.images.rendered import measured_with

Picture = NDArray[Any]
Box = tuple[int, int, int, int]

AS_SHOWN = cv2.IMREAD_ANYDEPTH | cv2.IMREAD_ANYCOLOR
"""Depth and colours as they are, turned as the file says: cameras store what an upright one sees lying on its side."""
LEAST = {"start": 0, "step": 1, "end": 1}
"""Least numbers of frames that choose among those of a film."""


def picture(path: Path) -> Picture:
    """A grey picture (rows, columns), 8 or 16 bits, the way up that the file says; colour becomes its luminance.

    InputError if it cannot be read.
    """
    try:
        content = np.frombuffer(given_bytes(Path(path)), np.uint8)
    except OSError as error:
        raise InputError(Fault("picture", str(path), f"cannot be read ({error.strerror})")) from error
    try:
        found = cv2.imdecode(content, AS_SHOWN) if content.size else None
    except cv2.error:
        found = None
    if found is None:
        kinds = ", ".join(STILLS)
        raise InputError(Fault("picture", str(path), "is no picture that can be read", allowed=kinds))
    if found.ndim == 3:
        found = cv2.cvtColor(found, cv2.COLOR_BGR2GRAY)
    return np.asarray(found)


@dataclass(frozen=True)
class Film:
    """Frames of a film or of a series of pictures.

    files : one film or stack, or the pictures in order;  start, end : first frame and the one after the last (None:
    all);  step : frames from one used to the next;  region : left, top, right, bottom px, the last two excluded;
    rate : frames a second, None if the files do not hold it.
    """

    files: tuple[Path, ...]
    start: int = 0
    end: int | None = None
    step: int = 1
    region: Box | None = None
    rate: float | None = None

    @property
    def moving(self) -> bool:
        """Whether it is a film rather than pictures."""
        return len(self.files) == 1

    def __iter__(self) -> Iterator[Picture]:
        """The chosen frames, grey, cut to the region; InputError where one cannot be read or differs in size."""
        size = None
        for number, frame in self._chosen():
            if size is not None and frame.shape != size:
                shapes = " and ".join(f"{it[1]} x {it[0]}" for it in (size, frame.shape))
                raise InputError(Fault("frame", number, f"pictures are not of one size: {shapes}"))
            size = frame.shape
            yield self.cut(frame)

    def cut(self, whole: Picture) -> Picture:
        """The part of a frame, or of its mask, (rows, columns), that is in the region; InputError if it leaves it."""
        if self.region is None:
            return whole
        left, top, right, bottom = self.region
        rows, columns = whole.shape
        if not (0 <= left < right <= columns and 0 <= top < bottom <= rows):
            text = ",".join(map(str, self.region))
            raise InputError(Fault("--region", text, "leaves the picture", "px", f"within 0,0,{columns},{rows}"))
        return whole[top:bottom, left:right]

    def count(self) -> int:
        """Number of chosen frames; a film whose file does not hold it is decoded."""
        known = self.certain()
        if known is None and (stated := _stated(self.files[0])):
            known = len(range(stated)[self._choice])
        return sum(1 for _ in self._chosen()) if known is None else known

    def certain(self) -> int | None:
        """Number of chosen frames of pictures and stacks; None of a film, whose file may state another than it has."""
        known = self._pages if self.moving else len(self.files)
        return len(range(known)[self._choice]) if known else None

    @property
    def _choice(self) -> slice:
        """The chosen ones of all frames."""
        return slice(self.start, self.end, self.step)

    @property
    def _pages(self) -> int:
        """Number of pages of a stack, 0 of a film."""
        return stacks.count(self.files[0]) if self.files[0].suffix.lower() in stacks.SUFFIXES else 0

    def _chosen(self) -> Iterator[tuple[int, Picture]]:
        """The chosen frames: number and whole picture."""
        if not self.moving:
            for number in range(len(self.files))[self._choice]:
                yield number, picture(self.files[number])
            return
        if total := self._pages:
            yield from stacks.pages(self.files[0], range(total)[self._choice])
            return
        for number, frame in enumerate(_decoded(self.files[0])):
            if self.end is not None and number >= self.end:
                return
            if number >= self.start and (number - self.start) % self.step == 0:
                yield number, frame


def open_film(names: Sequence[str | Path], **chosen: Any) -> Film:
    """A film from one film file or stack, a folder or pattern (img_*.png) by the numbers in its names (img2 before
    img10), or pictures in the order given.

    chosen : start, end, step, region of :class:`Film`.  InputError where there is nothing to read; PorescaleWarning
    where numbers in the chosen names jump, or names that were given are in the order of their text.
    """
    film = opened(names, **chosen)
    doubt = doubt_of_order(film.files[film.start : film.end]) if not film.moving else ""
    if doubt:
        warn(doubt)
    return film


def opened(names: Sequence[str | Path], **chosen: Any) -> Film:
    """A film as ``open_film`` gives it, without its warnings."""
    given.refuse(
        *(
            given.within(f"--{key}", chosen[key], Range(ge=least, whole=True))
            for key, least in LEAST.items()
            if chosen.get(key) is not None
        ),
        given.region("--region", chosen.get("region")),
    )
    if len(names) == 1:
        path = Path(names[0])
        if path.is_dir():
            files = sorted((it for it in path.iterdir() if it.suffix.lower() in STILLS), key=natural)
        elif not path.exists() and any(letter in str(path) for letter in "*?["):
            files = sorted(map(Path, glob.glob(str(path))), key=natural)
        elif stacks.is_stack(path):
            return Film((path,), **chosen)
        elif path.suffix.lower() in STILLS and path.is_file():
            if path.suffix.lower() in stacks.SUFFIXES:
                stacks.count(path)  # a torn stack: says that it cannot be read
            raise InputError(Fault("film", str(path), "is a single picture", repair="give two, or a film"))
        else:
            return Film((path,), rate=_rate(path), **chosen)
        if len(files) < 2:
            rendered = measured_with(path)
            repair = f"those of `piv render` are measured with {rendered}" if rendered else "give two or more"
            raise InputError(Fault("film", str(path), f"{len(files)} pictures there", repair=repair))
        return Film(tuple(files), **chosen)
    for stack in (it for it in names if stacks.is_stack(Path(it))):
        repair = "give it alone, or single pictures"
        raise InputError(
            Fault("film", str(stack), f"is a stack of {stacks.count(Path(stack))} pictures", repair=repair)
        )
    return Film(tuple(Path(it) for it in names), **chosen)


@dataclass(frozen=True)
class Held(Film):
    """Frames in memory.  pictures : grey, (rows, columns) each, in order."""

    pictures: tuple[Picture, ...] = ()

    def certain(self) -> int:
        """Number of chosen frames."""
        return len(range(len(self.pictures))[self._choice])

    def _chosen(self) -> Iterator[tuple[int, Picture]]:
        """The chosen frames: number and whole picture."""
        for number in range(len(self.pictures))[self._choice]:
            yield number, self.pictures[number]


def background(film: Film, kind: str) -> NDArray[np.float32] | None:
    """What does not move: the mean or the least of every pixel over the film; None for "none"."""
    if kind == "none":
        return None
    total, count = None, 0
    for frame in film:
        grey = frame.astype(np.float32)
        if total is None:
            total = grey
        elif kind == "mean":
            total += grey
        else:
            np.minimum(total, grey, out=total)
        count += 1
    if total is None:
        raise InputError(Fault("film", None, "no frames chosen"))
    return total / np.float32(count) if kind == "mean" else total


def _unreadable(path: Path, error: Exception) -> InputError:
    """What is wrong with a film that cannot be opened or decoded."""
    reason = getattr(error, "strerror", None) or " ".join(str(error).split())[:80]
    return InputError(Fault("film", str(path), f"cannot be read ({reason})"))


def _decoded(path: Path) -> Iterator[Picture]:
    """Frames of a film, grey, turned as the film says: phones store what they see upright lying on its side."""
    try:
        require_finite(path)
        with av.open(str(path), metadata_errors="replace") as container:
            if not container.streams.video:
                raise InputError(Fault("film", str(path), "holds no pictures"))
            for frame in container.decode(video=0):
                turns = round(getattr(frame, "rotation", 0) / 90)  # against the clock
                yield np.ascontiguousarray(np.rot90(frame.to_ndarray(format="gray"), turns))
    except (av.FFmpegError, OSError) as error:
        raise _unreadable(path, error) from error


def _stream(path: Path, name: str) -> Any:
    """An attribute of a film's first stream."""
    try:
        require_finite(path)
        with av.open(str(path), metadata_errors="replace") as container:
            if not container.streams.video:
                raise InputError(Fault("film", str(path), "holds no pictures"))
            return getattr(container.streams.video[0], name)
    except (av.FFmpegError, OSError) as error:
        raise _unreadable(path, error) from error


def _rate(path: Path) -> float | None:
    """Frames a second that a film states."""
    rate = _stream(path, "average_rate")
    return float(rate) if rate else None


def _stated(path: Path) -> int:
    """Number of frames that a film states; 0 if it does not."""
    return int(_stream(path, "frames") or 0)

"""Where solids are in pictures: bitmaps with solid white, polygons, segmented; one for all frames or one each."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import repeat
from pathlib import Path

import cv2
import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Flags
from porescale.piv.images.film import Film, Picture, opened, picture
from porescale.piv.images.stacks import is_stack

SEGMENTS = ("bright", "dark")
"""Words in a mask's place: segment every frame."""
GREY = 0.5
"""Share of white from which a pixel is solid."""


def bitmap(image: Picture) -> Flags:
    """True where a mask picture is white."""
    return np.asarray(image > GREY * (np.iinfo(image.dtype).max if image.dtype.kind == "u" else 1.0), bool)


def polygon(text: str, size: tuple[int, int]) -> Flags:
    """True within a polygon "x,y x,y x,y …", px, of a picture of ``size`` (rows, columns); InputError if none."""
    try:
        corners = np.array([[float(part) for part in corner.split(",")] for corner in text.split()])
        if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
            raise ValueError
    except ValueError as error:
        raise InputError(Fault("--polygon", text, "is no polygon", allowed='"x,y x,y x,y …" in px')) from error
    drawn = np.zeros(size, np.uint8)
    cv2.fillPoly(drawn, [np.rint(corners * 16).astype(np.int32)], (1,), cv2.LINE_8, 4)
    return drawn > 0


def segmented(image: Picture, *, bright: bool, least: int = 9) -> Flags:
    """Large bright (or dark) bodies of a picture: what is left of it, smaller than ``least`` px wiped out, by Otsu's
    bound.

    Opening by a disc removes tracers (Otsu 1979, IEEE Trans. Syst. Man Cybern. 9, 62).
    """
    span = float(image.max()) - float(image.min())
    grey = np.asarray((image - float(image.min())) * (255 / max(span, 1e-9)), np.uint8)
    grey = grey if bright else np.asarray(255 - grey, np.uint8)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (least, least))
    opened = cv2.morphologyEx(grey, cv2.MORPH_OPEN, disc)
    _, found = cv2.threshold(opened, 0, 1, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    return np.asarray(found > 0, bool)


def masks(source: str | Flags | None, corners: list[str], film: Film) -> Iterator[Flags | None]:
    """The mask of every chosen frame of ``film``, in turn.

    source : None, a bitmap, a film, stack or series of bitmaps (one a frame, frames chosen like the film's), "bright"
    or "dark" to segment each frame, or an array (rows, columns), True in solids of all frames;  corners : polygons that
    are solid in all.
    """
    for frame, found in zip(film, _sources(source, film), strict=False):
        mask = found
        if isinstance(source, str) and source in SEGMENTS:
            mask = segmented(frame, bright=source == "bright")
        for text in corners:
            left, top = film.region[:2] if film.region else (0, 0)
            whole = polygon(text, (frame.shape[0] + top, frame.shape[1] + left))[top:, left:]
            mask = whole if mask is None else mask | whole
        yield mask


def _cut(whole: Flags, film: Film) -> Flags:
    """The part of a mask that is in the film's region."""
    left, top, right, bottom = film.region or (0, 0, *whole.shape[::-1])
    return whole[top:bottom, left:right]


def _sources(source: str | Flags | None, film: Film) -> Iterator[Flags | None]:
    """Masks from files, None where there are none."""
    if isinstance(source, np.ndarray):
        yield from repeat(_cut(source.astype(bool), film))
        return
    if source is None or source in SEGMENTS:
        yield from repeat(None)
        return
    path = Path(source)
    still_picture = path.is_file() and path.suffix.lower() not in (".mp4", ".avi", ".mov", ".mkv", ".webm")
    if still_picture and not is_stack(path):
        try:
            still = bitmap(picture(path))
        except InputError as error:
            raise InputError([replace(fault, key="--mask") for fault in error.faults]) from None
        yield from repeat(_cut(still, film))
        return
    if not path.exists() and not any(letter in source for letter in "*?["):
        repair = "name a bitmap, a film, a folder or pattern of bitmaps; or bright or dark, to segment"
        raise InputError(Fault("--mask", source, "is no file", repair=repair))
    try:
        several = opened([source], start=film.start, end=film.end, step=film.step, region=film.region)
    except InputError as error:
        raise InputError([replace(it, key="--mask" if it.key == "film" else it.key) for it in error.faults]) from None
    count = 0
    for frame in several:
        count += 1
        yield bitmap(frame)
    raise InputError(Fault("--mask", source, f"has {count} masks", repair="give one for every frame"))

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
FAR = 1e6
"""px: beyond it OpenCV's whole numbers may run over."""
GREY = 0.5
"""Share of white from which a pixel of a bitmap of more than two values is solid."""


def bitmap(image: Picture) -> Flags:
    """True where a mask picture is white: the larger of its two values, whatever they are (0 and 1, 0 and 255).

    Of more values, as lossy files have them, those above half of the largest that its type holds.  InputError where
    nothing is, though not all is black.
    """
    low, high = image.min(), image.max()
    if low < high and not ((image > low) & (image < high)).any():
        return np.asarray(image == high, bool)
    found = _white(image)
    if high > 0 and not found.any():
        problem = f"has no pixel above half of white: {low:g} to {high:g} of {_most(image):g}"
        raise InputError(Fault("--mask", None, problem, repair="save solids white and fluid black"))
    return found


def _white(image: Picture) -> Flags:
    """True above half of white."""
    return np.asarray(image > GREY * _most(image), bool)


def _most(image: Picture) -> float:
    """What is white: the largest number of the type, 1 of floating ones."""
    return float(np.iinfo(image.dtype).max) if image.dtype.kind == "u" else 1.0


def polygon(text: str, size: tuple[int, int]) -> Flags:
    """True within a polygon "x,y x,y x,y …", px, of a picture of ``size`` (rows, columns); InputError if it is none, or
    holds no pixel."""
    try:
        corners = np.array([[float(part) for part in corner.split(",")] for corner in text.split()])
        if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3 or not np.all(np.abs(corners) <= FAR):
            raise ValueError
    except ValueError as error:
        allowed = f'"x,y x,y x,y …" in px, {FAR:g} at most'
        raise InputError(Fault("--polygon", text, "is no polygon", allowed=allowed)) from error
    drawn = np.zeros(size, np.uint8)
    cv2.fillPoly(drawn, [np.rint(corners * 16).astype(np.int32)], (1,), cv2.LINE_8, 4)
    if not drawn.any():
        allowed = f"0 to {size[1] - 1} and 0 to {size[0] - 1} px"
        raise InputError(Fault("--polygon", text, "lies outside of the picture", allowed=allowed))
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
    """The mask of every chosen frame of ``film``, in turn, cut to its region.

    source : None, a bitmap, a film, stack or series of bitmaps (one a frame, frames chosen like the film's), "bright"
    or "dark" to segment each frame, or an array (rows, columns), True in solids of all frames;  corners : polygons that
    are solid in all.  InputError for masks that are not of the whole pictures' size, or not as many.
    """
    for whole, found in zip(replace(film, region=None), _sources(source, film), strict=False):
        if found is not None and found.shape != whole.shape:
            sizes = " and ".join("x".join(str(side) for side in it.shape[::-1]) for it in (found, whole))
            raise InputError(Fault("--mask", sizes, "the bitmap is not of the pictures' size"))
        mask = None if found is None else film.cut(found)
        if isinstance(source, str) and source in SEGMENTS:
            mask = segmented(film.cut(whole), bright=source == "bright")
        for text in corners:
            inside = film.cut(polygon(text, (whole.shape[0], whole.shape[1])))
            mask = inside if mask is None else mask | inside
        yield mask


def _sources(source: str | Flags | None, film: Film) -> Iterator[Flags | None]:
    """Whole masks of a source, None where there are none; what is wrong with its files is said of the mask."""
    if isinstance(source, np.ndarray):
        yield from repeat(source.astype(bool))
    elif source is None or source in SEGMENTS:
        yield from repeat(None)
    else:
        try:
            yield from _of_files(source, film)
        except InputError as error:
            faults = [replace(it, key="--mask", value=source if it.value is None else it.value) for it in error.faults]
            raise InputError(faults) from None


def _of_files(source: str, film: Film) -> Iterator[Flags]:
    """Whole masks of a bitmap, the same for all frames, or of a film, stack or series of them.

    Frames of a film that is compressed with loss have more than two values: above half of white they are solid.
    """
    path = Path(source)
    still_picture = path.is_file() and path.suffix.lower() not in (".mp4", ".avi", ".mov", ".mkv", ".webm")
    if still_picture and not is_stack(path):
        yield from repeat(bitmap(picture(path)))
        return
    if not path.exists() and not any(letter in source for letter in "*?["):
        repair = "name a bitmap, a film, a folder or pattern of bitmaps; or bright or dark, to segment"
        raise InputError(Fault("--mask", source, "is no file", repair=repair))
    several = opened([source], start=film.start, end=film.end, step=film.step)
    total, due = several.certain(), film.certain()
    if total is not None and due is not None and total > due:
        problem = f"has {total} masks for {due} frames"
        raise InputError(Fault("--mask", source, problem, repair="give one for every frame"))
    count = 0
    for frame in several:
        count += 1
        yield _white(frame) if total is None else bitmap(frame)
    raise InputError(Fault("--mask", source, f"has {count} masks", repair="give one for every frame"))

"""Stacks of pictures in one TIFF file, of 8 or 16 bits, compressed or not, BigTIFF too: read a page at a time.

Read by Pillow, which is there: OpenCV decodes all pages before the one that it is asked for (56 ms a page of 4000), and
tifffile needs a further library for LZW.  Pillow reads colours of 16 bits as 8.
"""

import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from porescale.common.core.errors import Fault, InputError

SUFFIXES = (".tif", ".tiff")
GREY = ("L", "I;16", "F")
"""Pillow's modes that are grey as they are."""


def is_stack(path: Path) -> bool:
    """Whether a file is a TIFF of several pictures of one size; a small preview beside a picture makes no stack.

    A file that cannot be read is none.
    """
    if Path(path).suffix.lower() not in SUFFIXES:
        return False
    try:
        with _opened(path) as image:
            first = image.size
            if _pages(image) < 2:
                return False
            image.seek(1)
            return bool(image.size == first)
    except InputError:
        return False


def count(path: Path) -> int:
    """Number of pages; InputError if the file cannot be read."""
    with _opened(path) as image:
        return _pages(image)


def _pages(image: Image.Image) -> int:
    """Number of pages of an opened file; what Pillow warns of in a torn one, it raises an error for, too."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", category=UserWarning, module="PIL")
        return int(getattr(image, "n_frames", 1))


def pages(path: Path, numbers: Iterable[int]) -> Iterator[tuple[int, NDArray[Any]]]:
    """The pages of these numbers, ascending, each with its number: grey (rows, columns), 8 or 16 bits.

    Colour becomes its luminance.  InputError where one cannot be read.
    """
    with _opened(path) as image:
        for number in numbers:
            image.seek(number)
            yield number, _grey(image)


def _grey(image: Image.Image) -> NDArray[Any]:
    """A page as an array in the machine's byte order."""
    if image.mode in ("I;16B", *GREY):
        found = np.asarray(image)
        return np.array(found, found.dtype.newbyteorder("="))
    if image.mode == "1":
        return np.array(image.convert("L"))
    if image.mode == "I":
        return np.array(image, np.float32)
    return np.asarray(cv2.cvtColor(np.asarray(image.convert("RGB")), cv2.COLOR_RGB2GRAY))


@contextmanager
def _opened(path: Path) -> Iterator[Image.Image]:
    """The file; what Pillow says of one that it cannot read as InputError."""
    try:
        with Image.open(path) as image:
            yield image
    except (OSError, EOFError, SyntaxError, ValueError, TypeError, KeyError, Image.DecompressionBombError) as error:
        known = not isinstance(error, UnidentifiedImageError)
        said = getattr(error, "strerror", None) or " ".join(str(error).split())[:80]
        reason = said if known and said else "no picture"
        raise InputError(Fault("film", str(path), f"cannot be read ({reason})")) from error

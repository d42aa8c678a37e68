"""`piv measure --review`: a page, complete in itself, with both pictures of a pair and the vectors over them."""

import json
from base64 import b64encode
from collections.abc import Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import matplotlib
import numpy as np
from numpy.typing import NDArray

from porescale.common.core.atomic import write_text
from porescale.common.core.html import data_url
from porescale.common.core.types import AnyArray
from porescale.common.page.scripts import filled, joined, static
from porescale.piv.estimate.advice import Pair
from porescale.piv.estimate.rejected import picked

NAME = "review.html"
MEBIBYTES = 5.0
"""Largest page, if pictures can be held coarsely enough."""
QUALITIES = (None, 90, 75, 50)
"""Of JPEG, in turn until the page is small enough; None: PNG, without loss."""
FLOATS = ("x", "y", "u", "v", "uncertainty", "correlation")
FLAGS = ("valid", "replaced", "solid")


class Shown(NamedTuple):
    """What a page says besides its pair.  title;  facts : name, value, whether it is bad;  doubts : lines;  corner,
    whole, step : column and row of the pictures' first pixel in the whole picture, its (rows, columns), px between
    vectors;  speed : m/s of a displacement of one px, None where that is not known.
    """

    title: str
    facts: Sequence[tuple[str, str, bool]]
    doubts: Sequence[str]
    corner: tuple[int, int]
    whole: tuple[int, int]
    step: int
    speed: float | None


def write_page(pair: Pair, shown: Shown, path: Path) -> Path:
    """Write the page of a pair, whole; gives its path.  Pictures lose quality where it would exceed MEBIBYTES."""
    field = pair.field
    arrays: dict[str, AnyArray] = {name: getattr(field, name).astype("<f4") for name in FLOATS}
    arrays["u"], arrays["v"] = (np.nan_to_num(arrays[name]) for name in "uv")
    arrays |= {name: getattr(field, name).astype(np.uint8) for name in FLAGS}
    arrays["rejected"] = (picked(field.x, field.y, pair.rejected) & ~field.solid).astype(np.uint8)
    data: dict[str, Any] = {name: b64encode(it.tobytes()).decode() for name, it in arrays.items()}
    data |= {
        "facts": shown.facts, "doubts": shown.doubts, "corner": shown.corner, "whole": shown.whole, "step": shown.step,
        "speed": shown.speed or 1.0, "scaled": shown.speed is not None, "unit": "m/s" if shown.speed else "px",
        "maps": _maps(), "again": "porescale piv measure … --reject reject.png --review",
    }  # fmt: skip
    greys, text = _greys(pair), ""
    for quality in QUALITIES:
        data["pictures"] = [_address(it, quality) for it in greys]
        held = json.dumps(data, allow_nan=False).replace("<", "\\u003c")
        text = _page({"title": escape(shown.title), "data": held})
        if len(text) <= MEBIBYTES * 2**20:
            break
    write_text(path, text)
    return path


def _page(parts: dict[str, str]) -> str:
    """The page with its parts, styles and scripts in their places."""
    scripts = [static("colours.js"), static("view.js"), _own("vectors.js"), _own("review.js")]
    parts = {"css": static("page.css") + _own("review.css"), "script": joined(scripts), **parts}
    return filled(_own("review.html"), parts)


def _own(name: str) -> str:
    """The text of a file of this folder."""
    return files("porescale.piv.review").joinpath(name).read_text(encoding="utf-8")


def _greys(pair: Pair) -> list[NDArray[np.uint8]]:
    """Both pictures in 8 bits, on one scale: 255 what all but 0.2 % of their pixels stay below."""
    both = np.stack([pair.first, pair.second]).astype(float)
    low, high = min(0.0, float(both.min())), float(np.percentile(both, 99.8))
    return [np.clip((it - low) * (255.0 / max(high - low, 1e-9)), 0, 255).astype(np.uint8) for it in both]


def _address(grey: NDArray[np.uint8], quality: int | None) -> str:
    """A picture as a data: address."""
    kind, options = ("png", []) if quality is None else ("jpeg", [cv2.IMWRITE_JPEG_QUALITY, quality])
    content = cv2.imencode(f".{kind}", grey, options)[1].tobytes()
    return data_url(f"image/{kind}", content)


def _maps() -> dict[str, str]:
    """Colours that are seen on dark pictures, best first: "rising" for what is best low, "falling" for what is best
    high; 256 RGB bytes in base64.
    """
    light = np.asarray(matplotlib.colormaps["plasma"](np.linspace(0.97, 0.35, 256)))[:, :3]
    ends = {"rising": light, "falling": light[::-1]}
    return {name: b64encode(np.rint(255 * it).astype(np.uint8).tobytes()).decode() for name, it in ends.items()}

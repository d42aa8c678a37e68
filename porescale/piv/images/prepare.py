"""A picture made ready: spline coefficients, fluid mask, and grey values less their local mean."""

from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Flags, Singles
from porescale.piv.estimate.interpolate import coefficients

RIM = 1
"""Pixels around a solid that its blurred edge brightens."""


class Ready(NamedTuple):
    """contrast : grey values less their local mean, 0 in solids;  coefficients : of the spline through it;  fluid : 1
    where fluid, the rim of solids left out;  half_* : the same at half the resolution;  solid : whether there
    is any.  Arrays float32, (rows, columns), the coefficients padded.
    """

    coefficients: Singles
    fluid: Singles
    contrast: Singles
    half_fluid: Singles
    half_contrast: Singles
    solid: bool


def ready(picture: NDArray[Any], solid: Flags | None, reach: int) -> Ready:
    """Prepare a grey picture (rows, columns); ``reach`` : px over which the local mean is taken."""
    grey = np.ascontiguousarray(picture, np.float32)
    side = (2 * (reach // 2) + 1,) * 2
    if solid is None or not solid.any():
        fluid = np.ones(grey.shape, np.float32)
        contrast = grey - cv2.blur(grey, side, borderType=cv2.BORDER_REFLECT_101)
        return Ready(coefficients(contrast), fluid, contrast, _halved(fluid), _halved(contrast), False)
    grown = cv2.dilate(solid.astype(np.uint8), np.ones((2 * RIM + 1,) * 2, np.uint8))
    fluid = np.asarray(grown == 0, np.float32)
    share = cv2.blur(fluid, side, borderType=cv2.BORDER_REFLECT_101)
    light = cv2.blur(grey * fluid, side, borderType=cv2.BORDER_REFLECT_101)
    mean = np.where(share > 1e-3, light / np.maximum(share, 1e-3), np.float32(0))
    whole = float((grey * fluid).sum() / max(1.0, float(fluid.sum())))
    mean[share <= 1e-3] = whole
    contrast = (grey - mean) * fluid
    half = np.asarray(_halved(fluid) > 0.5, np.float32)
    return Ready(coefficients(contrast), fluid, contrast, half, _halved(contrast) * half, True)


def _halved(image: Singles) -> Singles:
    """Means over two by two pixels; an odd last row or column is left out."""
    rows, columns = image.shape[0] // 2, image.shape[1] // 2
    return np.asarray(
        cv2.resize(image[: 2 * rows, : 2 * columns], (columns, rows), interpolation=cv2.INTER_AREA), np.float32
    )

"""Pictures whose stated uncertainty is known to be too small, by what can be measured in them.

The factors are those of synthetic pairs, uniform flow and a vortex (the page on PIV of the manual has the table).
"""

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Flags
from porescale.piv.estimate.advice import Pair, seeding, spots
from porescale.piv.estimate.measure import Settings

NARROW = 2.5
"""px: diameter of particle images below which grey values between pixels are aliased: at 2.4 px errors are 1.2 to 1.4
times what is stated, as they are at 2.8 px, at 2.0 px up to 2.2 times.
"""
SCARCE = 2.0
"""Tracers that are seen in a window, below which their scatter no longer tells their variance: 0.8 times at 2.4, 1.3
times at 1.2, 1.8 times at 0.7 of them.
"""
UNLIKE = 0.65
"""Correlation of the pictures below which errors are more than 1.8 times what is stated."""
WINDOWS, NOISY = (16, 20, 24, 32), (0.17, 0.35, 0.43, 0.5)
"""Windows, px, and the noise over the tracers' contrast, standard deviations of grey levels, from which errors are more
than 1.4 times what is stated, with 0.05 tracers a pixel of 2.8 px.  Six to eight pairs of each of a uniform flow and a
vortex at 16 px: 1.3 and 1.2 times at 0.08, 1.4 and 1.4 at 0.15, 1.45 and 1.4 at 0.20, 1.5 at 0.25, 1.7 at 0.51, 1.8 at
0.76; at 20 px 1.4 at 0.35, at 24 px 1.3 at 0.35 and 1.45 at 0.51, at 32 px 1.4 at 0.51.
"""
REACH = 33
"""px: side of the squares whose mean is taken off before grey values are correlated."""


def diameter(picture: NDArray[np.generic], solid: Flags) -> float:
    """Diameter of particle images, px, four standard deviations of a spot; nan where there are none.

    Of Gaussian spots, integrated over pixels, the autocorrelation falls as exp(-r^2/(2 s^2)), s^2 = 2 (sigma^2 + 1/12):
    its values one pixel away along rows and along diagonals give s, and know nothing of noise, which is at r = 0.
    """
    near, far = _products(_contrast(picture, solid))
    if not near > far > 0:
        return float("nan")
    square = 0.5 / np.log(near / far)
    return 4 * float(np.sqrt(max(0.0, square / 2 - 1 / 12)))


def noise(picture: NDArray[np.generic], solid: Flags) -> float:
    """Noise over the contrast of tracers, standard deviations of grey levels; nan where there are no tracers.

    Of Gaussian spots (``diameter``) the autocorrelation at r = 0 is near^2/far without noise; what is there beyond it
    is the noise's.  Integration over pixels and the mean that is taken off leave -0.004 of its square, with which 0.17
    reads 0.16.
    """
    contrast, free = _contrast(picture, solid), np.asarray(~solid, np.float32)
    (near, far), (near_share, far_share) = _products(contrast), _products(free)
    if not near > far > 0:
        return float("nan")
    near, far = near / near_share, far / far_share
    variance = float((contrast * contrast).mean()) / float(free.mean())
    return float(np.sqrt(max(0.0, variance * far / near**2 - 1)))


def _contrast(picture: NDArray[np.generic], solid: Flags) -> NDArray[np.float32]:
    """Grey values less their mean over the fluid around, 0 in solids."""
    grey = picture.astype(np.float32)
    free = np.asarray(~solid, np.float32)
    share = np.maximum(cv2.blur(free, (REACH, REACH)), np.float32(1e-3))
    return np.asarray((grey - cv2.blur(grey * free, (REACH, REACH)) / share) * free)


def _products(values: NDArray[np.float32]) -> tuple[float, float]:
    """Twice the mean product of neighbours, one pixel away along rows and columns, and along diagonals."""
    inner = values[1:, 1:], values[:-1, :-1], values[1:, :-1], values[:-1, 1:]
    near = float((inner[0] * inner[2]).mean() + (inner[0] * inner[3]).mean())
    return near, float((inner[0] * inner[1]).mean() + (inner[2] * inner[3]).mean())


def understated(pair: Pair, settings: Settings) -> list[str]:
    """Why the pair's errors are larger than its uncertainties, with the factors known; empty where they are not."""
    field, found = pair.field, []
    if not field.valid.any():
        return []
    wide = diameter(pair.first, pair.solid)
    if wide < NARROW:
        found.append(
            f"particle images are {wide:.1f} px wide: errors are larger than stated, up to 2.2 times at 2.0 px and 6.4"
            " times at 1.6 px and below; put them out of focus a little, or take pictures from nearer by"
        )
    near = seeding(spots(pair.first, pair.solid), field, settings)[field.valid]
    seen = float(np.median(near)) * settings.window**2
    if seen < SCARCE:
        found.append(
            f"{seen:.1f} tracers are seen in a window of {settings.window} px: errors are larger than stated, 1.2 to"
            " 1.8 times below 2 of them; seed more, or give a larger --window"
        )
    alike = float(np.median(field.correlation[field.valid]))
    if alike < UNLIKE:
        found.append(
            f"pictures correlate by {alike:.2f}, by noise or tracers that one of them lacks: errors are larger than"
            f" stated, 1.9 to 2.4 times below {UNLIKE:g}; give more light"
        )
    else:
        # What is no noise may look like it in one picture (sharp edges), but not in the correlation of two.
        much = float(np.sqrt(min(noise(pair.first, pair.solid) ** 2, max(0.0, 1 / alike - 1))))
        most = float(np.interp(settings.window, WINDOWS, NOISY))
        if much > most:
            found.append(
                f"noise is {much:.2f} of the contrast of the tracers: errors are larger than stated, 1.4 to 1.9 times"
                f" above {most:.2g} in windows of {settings.window} px; give more light, or a larger --window"
            )
    return found

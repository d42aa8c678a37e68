"""Lines and polygons of a cloud as pixels: filled outlines and strokes as wide as their thickness, to scale."""

import cv2
import numpy as np

from porescale.common.core.types import AnyArray
from porescale.common.pictures.look import ONE, PLATE, RIM, SHIFT, rgb
from porescale.common.record.model import Cloud

LEAST = 1.5
"""Pixels that a segment is wide at the least: a thin one is to be seen."""
CRACK = "#c0182b"


def paint_shapes(image: AnyArray, cloud: Cloud, at: AnyArray, scale: float, colours: AnyArray) -> None:
    """Paint the polygons of ``cloud``, then its lines, into ``image`` (h, w, 3).

    at (n, 2) pixels of its points;  scale : pixels per metre;  colours (n, 3) of its points: that of the first point is
    that of a polygon, of the mean that of a line; what is "driven" is grey.  Thickness is the cloud's "radius".
    """
    there = np.asarray(np.isfinite(at).all(axis=1))
    whole = np.rint(np.where(there[:, None], at, 0.0) * ONE).astype(np.int32)
    thick = np.asarray(cloud.data.get("radius", np.zeros(len(at))), float) * 2.0 * scale
    if "driven" in cloud.data:
        colours = np.where(np.asarray(cloud.data["driven"])[:, None] != 0, rgb(PLATE), colours)
    offsets, corners = cloud.polygons if cloud.polygons is not None else (np.zeros(1, np.int64), np.zeros(0, np.int64))
    for start, end in zip(offsets[:-1].tolist(), offsets[1:].tolist(), strict=True):
        own = corners[start:end]
        if there[own].all():
            outline, colour = [whole[own]], colours[own[0]].tolist()
            wide = max(1, round(float(thick[own[0]])))
            cv2.polylines(image, outline, True, rgb(RIM), wide + 2, cv2.LINE_AA, SHIFT)
            cv2.fillPoly(image, outline, colour, cv2.LINE_AA, SHIFT)
            if wide > 1:
                cv2.polylines(image, outline, True, colour, wide, cv2.LINE_AA, SHIFT)
    lines = np.zeros((0, 2), np.int64) if cloud.lines is None else cloud.lines
    for wider in (2, 0):
        for a, b in lines.tolist():
            if there[a] and there[b]:
                colour = rgb(RIM) if wider else np.mean(colours[[a, b]], axis=0).round().tolist()
                wide = round(max(float(thick[a]), LEAST)) + wider
                cv2.line(image, whole[a].tolist(), whole[b].tolist(), colour, wide, cv2.LINE_AA, SHIFT)


def paint_marks(image: AnyArray, ends: AnyArray) -> None:
    """Paint marks, such as cracks, between ``ends`` (m, 2, 2) pixels."""
    wide = max(2, image.shape[1] // 250)
    for start, end in np.rint(ends * ONE).astype(int).tolist():
        cv2.line(image, start, end, rgb(CRACK), wide, cv2.LINE_AA, SHIFT)

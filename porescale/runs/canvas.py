"""The inside of a picture: field, walls, points, lines, arrows as pixels.  Row 0 of an image is its top."""

from __future__ import annotations

import cv2
import numpy as np

from porescale.runs.look import GRAIN, PAPER, RIM, WALL, Survey, magnitude, rgb
from porescale.runs.model import Array, Cloud, Grid, Snapshot

SHIFT = 4
"""OpenCV coordinates in sixteenths of a pixel."""
ONE = 1 << SHIFT


class Canvas:
    """Maps metres to pixels of an image of ``width`` x ``height`` that shows the survey's view."""

    def __init__(self, survey: Survey, width: int, height: int) -> None:
        self.survey, self.look = survey, survey.look
        self.width, self.height = width, height
        left, right, bottom, top = survey.view
        self.left, self.top = left, top
        self.per_x, self.per_y = width / (right - left), height / (top - bottom)

    def pixels(self, points: Array) -> Array:
        """(n, 2) m -> (n, 2) pixels as OpenCV counts them: pixel (0, 0) has its centre at 0, 0."""
        at = np.empty((len(points), 2))
        at[:, 0] = (points[:, 0] - self.left) * self.per_x - 0.5
        at[:, 1] = (self.top - points[:, 1]) * self.per_y - 0.5
        return at

    def draw(self, snapshot: Snapshot) -> Array:
        """The image of a snapshot, (height, width, 3) uint8 RGB."""
        grid, cloud = self.look.painted(snapshot), self.look.drawn(snapshot)
        image = np.full((self.height, self.width, 3), rgb(PAPER), np.uint8)
        if grid is not None and self.survey.field is not None:
            self._field(image, grid)
        if cloud is not None and len(cloud.position):
            self._cloud(image, cloud)
        if grid is not None and self.look.arrows:
            self._arrows(image, grid)
        lines = self.look.lines(snapshot) if callable(self.look.lines) else self.look.lines
        for ends in lines:
            self._line(image, self.pixels(np.array(ends, float)), rgb(RIM), max(2, self.width // 250))
        return image

    def _field(self, image: Array, grid: Grid) -> None:
        assert self.survey.field is not None
        values, inside = self._resampled(grid, magnitude(grid.cells[self.look.field], 2))
        image[inside] = self.survey.field.colours(values)[inside]
        if self.look.walls in grid.cells:
            solid, _ = self._resampled(grid, grid.cells[self.look.walls].astype(np.float32))
            share = np.where(inside, np.clip(solid, 0, 1), 0)[..., None]
            image[:] = (image * (1 - share) + np.array(rgb(WALL)) * share + 0.5).astype(np.uint8)

    def _resampled(self, grid: Grid, values: Array) -> tuple[Array, Array]:
        """Cell values at the pixels' centres (linear; averaged where cells are finer) and where they lie."""
        values = np.ascontiguousarray(values, np.float32)
        ny, nx = values.shape
        left, right, bottom, top = grid.extent
        across = min(nx, max(1, round((right - left) * self.per_x)))
        up = min(ny, max(1, round((top - bottom) * self.per_y)))
        if (up, across) != (ny, nx):
            values = cv2.resize(values, (across, up), interpolation=cv2.INTER_AREA)
        dx, dy = (right - left) / across, (top - bottom) / up
        x = self.left + (np.arange(self.width) + 0.5) / self.per_x
        y = self.top - (np.arange(self.height) + 0.5) / self.per_y
        matrix = np.array(
            [
                [1 / (self.per_x * dx), 0.0, (x[0] - left) / dx - 0.5],
                [0.0, -1 / (self.per_y * dy), (y[0] - bottom) / dy - 0.5],
            ]
        )
        how = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        size = (self.width, self.height)
        warped = cv2.warpAffine(values, matrix, size, flags=how, borderMode=cv2.BORDER_REPLICATE)
        inside = ((y >= bottom) & (y <= top))[:, None] & ((x >= left) & (x <= right))[None, :]
        return warped, inside

    def _cloud(self, image: Array, cloud: Cloud) -> None:
        discs = "radius" in cloud.data
        radius = (
            np.asarray(cloud.data["radius"], float)
            if discs
            else np.full(len(cloud.position), self.survey.dot)
        )
        at = self.pixels(cloud.position)
        size = radius * self.per_x if discs else np.maximum(radius * self.per_x, 1.0)
        seen = np.isfinite(at).all(1) & (at > -size[:, None]).all(1)
        seen &= (at < [self.width, self.height] + size[:, None]).all(1)
        colours = self._colours(cloud)[seen].tolist()
        centres, radii = np.rint(at[seen] * ONE).astype(int).tolist(), size[seen]
        rim, rim_colour = np.clip(0.08 * radii, 0.7, 2.0), rgb(RIM)
        whole, inner = (
            np.rint(radii * ONE).astype(int).tolist(),
            np.rint((radii - rim) * ONE).astype(int).tolist(),
        )
        rimmed = discs & (radii >= 2.5)
        for centre, outer, core, edge, colour in zip(
            centres, whole, inner, rimmed.tolist(), colours, strict=True
        ):
            if edge:
                cv2.circle(image, centre, outer, rim_colour, -1, cv2.LINE_AA, SHIFT)
                cv2.circle(image, centre, core, colour, -1, cv2.LINE_AA, SHIFT)
            else:
                cv2.circle(image, centre, outer, colour, -1, cv2.LINE_AA, SHIFT)
        if discs and "angle" in cloud.data:
            self._spokes(image, at[seen], radii, np.asarray(cloud.data["angle"], float)[seen])

    def _spokes(self, image: Array, at: Array, radii: Array, angle: Array) -> None:
        """A line from each centre towards the rim shows how a disc has turned."""
        big = radii >= 4
        tip = at + 0.8 * radii[:, None] * np.stack([np.cos(angle), -np.sin(angle)], 1)
        for start, end, radius in zip(at[big], tip[big], radii[big].tolist(), strict=True):
            self._line(image, np.array([start, end]), rgb(RIM), max(1, round(radius / 10)))

    def _colours(self, cloud: Cloud) -> Array:
        """(n, 3) uint8."""
        name = self.look.colouring(cloud)
        painted = np.full((len(cloud.position), 3), rgb(GRAIN), np.uint8)
        if name and self.look.kinds:
            for kind, (_, colour) in self.look.kinds.items():
                painted[cloud.data[name] == kind] = rgb(colour)
        elif name and self.survey.cloud is not None:
            painted = self.survey.cloud.colours(magnitude(cloud.data[name], 1))
        return painted

    def _arrows(self, image: Array, grid: Grid) -> None:
        """Velocity arrows on a regular raster; the longest one spans a raster cell."""
        assert self.survey.field is not None
        velocity = grid.cells[self.look.field]
        if velocity.ndim != 3:
            return
        pitch = self.width / self.look.arrows
        u, inside = self._resampled(grid, velocity[..., 0])
        v, _ = self._resampled(grid, velocity[..., 1])
        top = self.survey.field.high
        for row in np.arange(pitch / 2, self.height, pitch).astype(int):
            for column in np.arange(pitch / 2, self.width, pitch).astype(int):
                along = np.array([u[row, column], -v[row, column]]) / top
                speed = float(np.hypot(*along))
                if not inside[row, column] or not speed > 0.02:
                    continue
                along *= 0.9 * pitch * min(1.0, 1.0 / speed)
                start = np.array([column, row]) - along / 2
                tip = float(np.clip(5.0 / np.hypot(*along), 0.3, 0.6))
                tail, head = np.rint(np.array([start, start + along]) * ONE).astype(int).tolist()
                for colour, width in ((rgb(RIM), 3), (rgb(PAPER), 1)):
                    cv2.arrowedLine(image, tail, head, colour, width, cv2.LINE_AA, SHIFT, tip)

    def _line(self, image: Array, ends: Array, colour: tuple[int, int, int], thickness: int) -> None:
        """A segment between two pixel positions, (2, 2)."""
        start, end = np.rint(ends * ONE).astype(int).tolist()
        cv2.line(image, start, end, colour, thickness, cv2.LINE_AA, SHIFT)

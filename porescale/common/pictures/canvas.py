"""The inside of a picture: field, walls, points, lines, arrows as pixels.  Row 0 of an image is its top."""

import cv2
import numpy as np

from porescale.common.core.types import AnyArray
from porescale.common.pictures.arrows import arrows
from porescale.common.pictures.look import ONE, PAPER, PLATE, RIM, SHIFT, WALL, Survey, magnitude, rgb
from porescale.common.pictures.repeated import discs_again, shifts
from porescale.common.pictures.shapes import paint_marks, paint_shapes
from porescale.common.record.model import Cloud, Grid, Snapshot


class Canvas:
    """Maps metres to pixels of an image of ``width`` x ``height`` that shows the survey's view."""

    def __init__(self, survey: Survey, width: int, height: int) -> None:
        self.survey, self.look = survey, survey.look
        self.width, self.height = width, height
        left, right, bottom, top = survey.view
        self.left, self.top = left, top
        self.per_x, self.per_y = width / (right - left), height / (top - bottom)

    def pixels(self, points: AnyArray) -> AnyArray:
        """(n, 2) m -> (n, 2) pixels as OpenCV counts them: pixel (0, 0) has its centre at 0, 0."""
        at = np.empty((len(points), 2))
        at[:, 0] = (points[:, 0] - self.left) * self.per_x - 0.5
        at[:, 1] = (self.top - points[:, 1]) * self.per_y - 0.5
        return at

    def draw(self, snapshot: Snapshot, over_field: AnyArray | None = None) -> AnyArray:
        """The image of a snapshot, (height, width, 3) uint8 RGB.

        over_field : RGBA image of the same size, blended over the field and under the points (streamlines).
        """
        grid, cloud = self.look.painted(snapshot), self.look.drawn(snapshot)
        image = np.full((self.height, self.width, 3), rgb(PAPER), np.uint8)
        if grid is not None and self.survey.field is not None:
            self._field(image, grid)
        if over_field is not None:
            _blend(image, over_field[..., 3] / 255.0, over_field[..., :3])
        if cloud is not None and len(cloud.position):
            self._cloud(image, cloud)
        shapes = self.look.shaped(snapshot)
        if shapes is not None:
            colours = self.survey.colours(shapes)
            for shift in shifts(shapes, self.look):
                paint_shapes(image, shapes, self.pixels(shapes.position + shift), self.per_x, colours)
        self._arrows(image, snapshot)
        for ends in self.look.lines_at(snapshot):
            start, end = np.rint(self.pixels(np.array(ends, float)) * ONE).astype(int).tolist()
            thick = max(2, self.width // 250)
            cv2.line(image, start, end, rgb(RIM), thick + 2, cv2.LINE_AA, SHIFT)
            cv2.line(image, start, end, rgb(PLATE), thick, cv2.LINE_AA, SHIFT)
        if len(marks := self.look.marks_at(snapshot)):
            paint_marks(image, self.pixels(np.array(marks, float).reshape(-1, 2)).reshape(-1, 2, 2))
        return image

    def _field(self, image: AnyArray, grid: Grid) -> None:
        assert self.survey.field is not None
        rows, columns = self._inside(grid)
        part = image[rows, columns]
        values = self._resampled(grid, magnitude(grid.cells[self.look.field], 2))
        part[:] = self.survey.field.colours(values[rows, columns])
        if self.look.walls in grid.cells:
            share = self._resampled(grid, grid.cells[self.look.walls])[rows, columns]
            _blend(part, np.clip(share, 0, 1), rgb(WALL))

    def _inside(self, grid: Grid) -> tuple[slice, slice]:
        """Rows and columns of the pixels whose centres lie in the grid."""
        left, right, bottom, top = grid.extent
        edges = self.pixels(np.array([[left, top], [right, bottom]]))
        (first, upper), (last, lower) = np.ceil(edges).astype(int).tolist()
        return slice(max(0, upper), max(0, lower)), slice(max(0, first), max(0, last))

    def _resampled(self, grid: Grid, values: AnyArray) -> AnyArray:
        """Cell values at the pixels' centres, (height, width): linear, averaged where cells are finer."""
        values = np.ascontiguousarray(values, np.float32)
        ny, nx = values.shape
        left, right, bottom, top = grid.extent
        across = min(nx, max(1, round((right - left) * self.per_x)))
        up = min(ny, max(1, round((top - bottom) * self.per_y)))
        if (up, across) != (ny, nx):
            values = cv2.resize(values, (across, up), interpolation=cv2.INTER_AREA)
        dx, dy = (right - left) / across, (top - bottom) / up
        x, y = self.left + 0.5 / self.per_x, self.top - 0.5 / self.per_y
        matrix = np.array(
            [
                [1 / (self.per_x * dx), 0.0, (x - left) / dx - 0.5],
                [0.0, -1 / (self.per_y * dy), (y - bottom) / dy - 0.5],
            ]
        )
        how = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        size = (self.width, self.height)
        warped: AnyArray = cv2.warpAffine(values, matrix, size, flags=how, borderMode=cv2.BORDER_REPLICATE)
        return warped

    def _cloud(self, image: AnyArray, cloud: Cloud) -> None:
        discs = "radius" in cloud.data
        which, places = discs_again(cloud, self.look)
        radius = np.asarray(cloud.data["radius"], float)[which] if discs else np.full(len(which), self.survey.dot)
        at = self.pixels(places)
        size = radius * self.per_x if discs else np.maximum(radius * self.per_x, 1.0)
        seen = np.isfinite(at).all(1) & (at > -size[:, None]).all(1)
        seen &= (at < [self.width, self.height] + size[:, None]).all(1)
        colours = self.survey.colours(cloud)[which[seen]].tolist()
        centres, radii = np.rint(at[seen] * ONE).astype(int).tolist(), size[seen]
        rim, rim_colour = np.clip(0.08 * radii, 0.7, 2.0), rgb(RIM)
        whole, inner = (np.rint(it * ONE).astype(int).tolist() for it in (radii, radii - rim))
        rimmed = discs & (radii >= 2.5)
        for centre, outer, core, edge, colour in zip(centres, whole, inner, rimmed.tolist(), colours, strict=True):
            if edge:
                cv2.circle(image, centre, outer, rim_colour, -1, cv2.LINE_AA, SHIFT)
            cv2.circle(image, centre, core if edge else outer, colour, -1, cv2.LINE_AA, SHIFT)
        if discs and "angle" in cloud.data:
            self._spokes(image, at[seen], radii, np.asarray(cloud.data["angle"], float)[which[seen]])

    def _spokes(self, image: AnyArray, at: AnyArray, radii: AnyArray, angle: AnyArray) -> None:
        """A line from each centre towards the rim shows how a disc has turned."""
        big = radii >= 4
        tip = at + 0.8 * radii[:, None] * np.stack([np.cos(angle), -np.sin(angle)], 1)
        starts, ends = (np.rint(points[big] * ONE).astype(int).tolist() for points in (at, tip))
        widths, colour = np.maximum(1, np.rint(radii[big] / 10)).astype(int).tolist(), rgb(RIM)
        for start, end, width in zip(starts, ends, widths, strict=True):
            cv2.line(image, start, end, colour, width, cv2.LINE_AA, SHIFT)

    def _arrows(self, image: AnyArray, snapshot: Snapshot) -> None:
        """Arrows of the velocity."""
        shapes = arrows(snapshot, self.survey)
        for shape in np.rint(self.pixels(shapes.reshape(-1, 2)).reshape(shapes.shape) * ONE).astype(np.int32):
            cv2.fillPoly(image, [shape], rgb(PAPER), cv2.LINE_AA, SHIFT)
            cv2.polylines(image, [shape], True, rgb(RIM), 1, cv2.LINE_AA, SHIFT)


def _blend(image: AnyArray, share: AnyArray, colour: AnyArray | tuple[int, int, int]) -> None:
    """Paint ``colour`` over an image with opacity ``share`` (height, width) of 0..1."""
    opacity = share[..., None]
    image[:] = (image * (1 - opacity) + np.asarray(colour) * opacity + 0.5).astype(np.uint8)

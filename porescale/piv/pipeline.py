"""From a film to fields: every pair of frames measured, or all pairs of a steady flow at once, and files of them.

film = open_film(["film.mp4"])
measurement = Measurement(Shots(film), Settings(window=16), pixel=1e-4, interval=5e-3)
for field in measurement.fields():
    ...
written = write_fields(measurement, measurement.fields(), Path("runs/piv_film"))
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.record import snapshots
from porescale.common.record.model import Snapshot
from porescale.piv.estimate.measure import Settings, Vectors
from porescale.piv.estimate.series import Shots, as_grid, averaged, corner, measured, whole_rows
from porescale.piv.fields.field import Field, in_metres, in_pixels, write_csv, write_openpiv
from porescale.piv.fields.overlay import overlay_film
from porescale.piv.fields.pictures import quiver, vorticity

CHANCE = 0.05
"""Share of vectors of the fluid that passes validation by chance where two pictures have nothing in common (measured:
up to 0.04 of small ones)."""
STRANGERS = Fault("pictures", None, "do not show the same tracers: hardly a vector passes validation")


@dataclass(frozen=True)
class Measurement:
    """Pictures, and how they are measured.

    average : one field from all pairs of a steady flow;  pixel : its length, m, else fields are in pixels;  interval :
    time between two frames of the film, s;  zero : time of frame 0, s.
    """

    shots: Shots
    settings: Settings
    average: bool = False
    pixel: float | None = None
    interval: float | None = None
    zero: float = 0.0

    @cached_property
    def pairs(self) -> int:
        """Number of pairs of frames of the film."""
        return max(0, self.shots.film.count() - 1)

    @property
    def total(self) -> int:
        """Number of fields that the measurement returns."""
        return 1 if self.average else self.pairs

    @cached_property
    def rows(self) -> int:
        """Rows of the whole picture, which a height in metres counts from; 0 in pixels."""
        return whole_rows(self.shots.film) if self.pixel is not None else 0

    @property
    def spacing(self) -> float:
        """Time between two fields, s; in frames where the interval is not given."""
        return (self.interval or 1.0) * self.shots.film.step

    def time(self, number: int) -> float:
        """Time (s) of a field, numbered from 0: the middle between its two pictures."""
        film = self.shots.film
        return self.zero + (self.interval or 1.0) * (film.start + 0.5 * film.step) + number * self.spacing

    def fields(
        self, warn: Callable[[str], object] | None = None, passed: Callable[[], object] | None = None
    ) -> Iterator[Field]:
        """Fields one by one, in pixels, or in m and m/s.  InputError where a pair cannot be measured.

        warn : called with a text for pairs that show nothing, which are an error without it, and where the film has
        one pair only;  passed : called for every pair of every pass over a film that is averaged.
        """
        film, rows, pixel, interval = self.shots.film, self.rows, self.pixel, self.interval
        if self.average:
            found: Iterable[Vectors] = (averaged(self.shots, self.settings, passed) for _ in range(1))
        else:
            found = measured(self.shots, self.settings, warn if self.pairs > 1 else None)

        def finished(vectors: Vectors) -> Field:
            """Vectors as a field of the whole picture, in metres where both scales are given."""
            field = in_pixels(vectors, corner(film))
            return field if pixel is None or interval is None else in_metres(field, rows, pixel, interval * film.step)

        return (finished(it) for it in found)

    def extent(self, shape: tuple[int, ...]) -> tuple[float, ...]:
        """Left, right, bottom, top of a picture of a ``shape`` (rows, columns), in the fields' units."""
        left, top = corner(self.shots.film)
        if self.pixel is None:
            return left - 0.5, left + shape[1] - 0.5, top + shape[0] - 0.5, top - 0.5
        scale, rows = self.pixel, self.rows
        return left * scale, (left + shape[1]) * scale, (rows - top - shape[0]) * scale, (rows - top) * scale


def write_fields(
    measurement: Measurement,
    fields: Iterable[Field],
    folder: Path | None,
    *,
    csv: Path | None = None,
    openpiv: Path | None = None,
    overlay: bool = False,
) -> dict[str, Any]:
    """Write each field as it comes: tables and piv.vtkhdf with two pictures in ``folder``, the first field as ``csv``
    and in OpenPIV's format.

    overlay : a film of the pictures with arrows, too, unless fields are averaged.  Returns counts of pairs and vectors
    and the names of the files.  InputError where hardly a vector is valid: the pictures are not of one flow.
    """
    counts = {"pairs": 0, "vectors": 0, "valid": 0, "replaced": 0, "solid": 0}
    files: list[Path] = []
    last, film, alone = None, measurement.shots.film, measurement.total == 1
    if folder is not None:
        snapshots.clear(folder)
    for number, field in enumerate(fields):
        if alone and field.valid.sum() < CHANCE * (~field.solid).sum():
            raise InputError(STRANGERS)
        last = field
        counts["pairs"] += 1
        counts["vectors"] += field.u.size
        for name in ("valid", "replaced", "solid"):
            counts[name] += int(getattr(field, name).sum())
        if number == 0:
            for path, write in ((csv, write_csv), (openpiv, write_openpiv)):
                if path is not None:
                    write(field, path)
                    files.append(path)
        if folder is not None:
            table = folder / f"vectors_{number:04d}.csv"
            write_csv(field, table)
            files += [table] if number == 0 else []
            grids = {"piv": as_grid(field)}
            snapshots.write_part(folder, Snapshot(measurement.time(number), number, grids=grids))
    if not alone and counts["valid"] < CHANCE * (counts["vectors"] - counts["solid"]):
        if folder is not None:
            snapshots.clear(folder)
        raise InputError(STRANGERS)
    if folder is not None and last is not None:
        snapshots.assemble(folder)
        image = next(iter(film))
        files += [folder / "piv.vtkhdf", quiver(last, folder / "quiver.png", image, measurement.extent(image.shape))]
        files.append(vorticity(last, folder / "vorticity.png"))
    if overlay and folder is not None and not measurement.average:
        files.append(overlay_film(folder, film, measurement.extent(next(iter(film)).shape)))
    return {**counts, "files": [str(path) for path in files]}

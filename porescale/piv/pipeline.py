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
from itertools import chain, islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Flags
from porescale.common.record import snapshots
from porescale.common.record.model import Snapshot
from porescale.piv.estimate.advice import FEW_VALID, Pair, advice
from porescale.piv.estimate.measure import Settings, Vectors
from porescale.piv.estimate.rejected import rejections, without
from porescale.piv.estimate.series import Shots, as_grid, averaged, corner, measured, whole_size
from porescale.piv.estimate.understated import understated
from porescale.piv.fields.field import Field, in_metres, in_pixels, on_picture, write_csv, write_openpiv
from porescale.piv.fields.overlay import overlay_film
from porescale.piv.fields.pictures import quiver, vorticity
from porescale.piv.review.review import NAME as REVIEW
from porescale.piv.review.review import Shown, write_page

CHANCE = 0.05
"""Share of vectors of the fluid that passes validation by chance where two pictures have nothing in common (measured:
up to 0.04 of small ones)."""

TRAVEL = 6.0
"""px that tracers move at least while a background is taken of them, two widths of their images.  Over a shorter way it
holds the tracers, too: displacements are 1 % too large at 6 px, 5 to 15 % at 3 and 1.5 px (measured, of images 2.8 px
wide), and of a pair they are of any size."""


@dataclass(frozen=True)
class Measurement:
    """Pictures, and how they are measured.

    average : one field from all pairs of a steady flow;  pixel : its length, m, else fields are in pixels;  interval :
    time between two frames of the film, s;  zero : time of frame 0, s;  reject : bitmap, or file of it or of one a
    frame, of vectors to take out (``rejected``).
    """

    shots: Shots
    settings: Settings
    average: bool = False
    pixel: float | None = None
    interval: float | None = None
    zero: float = 0.0
    reject: str | Flags | None = None

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
        return whole_size(self.shots.film)[0] if self.pixel is not None else 0

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

        rejected = rejections(self.reject, film)
        if self.reject is not None:  # a wrong one is an error before anything is measured
            rejected = chain([next(rejected, None)], rejected)
        return (finished(without(it, gone)) for it, gone in zip(found, rejected, strict=False))

    def pair(self, number: int, field: Field) -> Pair:
        """A pair of the film, numbered from 0, with its ``field`` laid on its pictures."""
        frames = list(islice(self.shots.frames(), number, number + 2))
        (first, one), (second, two) = frames
        none = np.zeros(first.shape, bool)
        solid = np.asarray((none if one is None else one) | (none if two is None else two), bool)
        gone = next(islice(rejections(self.reject, self.shots.film), number, None))
        step = (self.interval or 1.0) * self.shots.film.step
        placed = on_picture(field, self.rows, self.pixel or 1.0, step, corner(self.shots.film))
        return Pair(first, second, solid, placed, none if gone is None else gone)

    def extent(self, shape: tuple[int, ...]) -> tuple[float, ...]:
        """Left, right, bottom, top of a picture of a ``shape`` (rows, columns), in the fields' units."""
        left, top = corner(self.shots.film)
        if self.pixel is None:
            return left - 0.5, left + shape[1] - 0.5, top + shape[0] - 0.5, top - 0.5
        scale, rows = self.pixel, self.rows
        return left * scale, (left + shape[1]) * scale, (rows - top - shape[0]) * scale, (rows - top) * scale


class Worst(NamedTuple):
    """The pair with the smallest share of valid vectors: its number, from 0, that share, its field."""

    number: int
    share: float
    field: Field

    @property
    def rank(self) -> tuple[bool, float]:
        """What orders pairs: those that show nothing come last."""
        return not self.field.correlation.any(), self.share


def write_fields(
    measurement: Measurement,
    fields: Iterable[Field],
    folder: Path | None,
    *,
    csv: Path | None = None,
    openpiv: Path | None = None,
    overlay: bool = False,
    review: bool = False,
) -> dict[str, Any]:
    """Write each field as it comes: tables and piv.vtkhdf with two pictures in ``folder``, the first field as ``csv``
    and in OpenPIV's format.

    overlay : a film of the pictures with arrows, too, unless fields are averaged;  review : a page of the pair with the
    fewest valid vectors.  Returns counts of pairs and vectors, the names of the files, and ``doubts``: where fewer than
    FEW_VALID of the vectors are valid, that, and what to try; else why errors are larger than stated, if they are.
    InputError where hardly a vector is valid: the pictures are not of one flow.
    """
    counts = {"pairs": 0, "vectors": 0, "valid": 0, "replaced": 0, "solid": 0}
    files: list[Path] = []
    last, film, alone = None, measurement.shots.film, measurement.total == 1
    worst: Worst | None = None
    seen = 0, 0
    if folder is not None:
        snapshots.clear(folder)
        for stale in [*folder.glob("vectors_[0-9]*.csv"), *folder.glob("overlay.*"), folder / REVIEW]:
            stale.unlink(missing_ok=True)  # of an earlier film
    for number, field in enumerate(fields):
        if alone and field.valid.sum() < CHANCE * (~field.solid).sum():
            raise strangers(measurement, Worst(number, 0.0, field))
        last = field
        valid, fluid = int(field.valid.sum()), int((~field.solid).sum())
        this = Worst(number, valid / max(1, fluid), field)
        worst = this if worst is None or this.rank < worst.rank else worst
        if field.correlation.any():
            seen = seen[0] + valid, seen[1] + fluid
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
    if worst is not None and not alone and counts["valid"] < CHANCE * (counts["vectors"] - counts["solid"]):
        if folder is not None:
            snapshots.clear(folder)
        raise strangers(measurement, worst)
    if folder is not None and last is not None:
        snapshots.assemble(folder)
        image = next(iter(film))
        files += [folder / "piv.vtkhdf", quiver(last, folder / "quiver.png", image, measurement.extent(image.shape))]
        files.append(vorticity(last, folder / "vorticity.png"))
    if overlay and folder is not None and not measurement.average:
        files.append(overlay_film(folder, film, measurement.extent(next(iter(film)).shape)))
    found = doubts(measurement, seen, worst)
    if review and folder is not None and worst is not None:
        files.append(write_review(measurement, worst, found, folder / REVIEW))
    return {**counts, "files": [str(path) for path in files], "doubts": found}


def write_review(measurement: Measurement, worst: Worst, found: list[str], path: Path) -> Path:
    """Write the page of the pair with the fewest valid vectors, with the doubts ``found``; gives its path."""
    film, settings, field = measurement.shots.film, measurement.settings, worst.field
    fluid = int((~field.solid).sum())
    names = [it.name for it in film.files] if len(film.files) != 1 else [film.files[0].name] * 2
    first = film.start + worst.number * film.step
    shown = [names[k] for k in (first, first + film.step)] if len(names) > first + film.step else ["pictures"] * 2
    frames = "" if len(film.files) == 2 else f" (frames {first} and {first + film.step})"
    facts = [
        ("pictures", f"{shown[0]}, {shown[1]}{frames}" if shown[0] != shown[1] else f"{shown[0]}{frames}", False),
        ("vectors", f"{fluid}", False),
        ("valid", f"{100 * worst.share:.1f} %", worst.share < FEW_VALID),
        ("window", f"{settings.window} px", False),
        ("step", f"{settings.step} px", False),
    ]
    if not measurement.average and measurement.total > 1:
        facts.append(
            ("pair", f"{worst.number} of 0 to {measurement.total - 1}, the one with the fewest valid vectors", False)
        )
    if measurement.average:
        facts.append(("vectors of", f"all {measurement.pairs} pairs", False))
    speed = None
    if measurement.pixel is not None and measurement.interval is not None:
        speed = measurement.pixel / (measurement.interval * film.step)
    title = f"Vectors of {' and '.join(dict.fromkeys(shown))}"
    words = Shown(title, facts, found, corner(film), whole_size(film), settings.step, speed)
    return write_page(measurement.pair(worst.number, field), words, path)


def strangers(measurement: Measurement, worst: Worst) -> InputError:
    """The error of pictures that show nothing in common, with what to try as far as they tell."""
    words = "do not show the same tracers, or not where they are looked for: hardly a vector passes validation"
    found = advice(measurement.pair(worst.number, worst.field), measurement.settings)
    return InputError(Fault("pictures", None, words, repair="; ".join(found)))


def doubts(measurement: Measurement, seen: tuple[int, int], worst: Worst | None) -> list[str]:
    """That too few vectors are valid, and what the pair with the fewest says to try; where enough are, why its errors
    are larger than stated, if they are.

    seen : numbers of valid vectors and of all, in pairs that show anything: the others have been said already.
    """
    share = seen[0] / max(1, seen[1])
    if worst is None or not seen[1]:
        return []
    held = background_doubt(measurement, worst.field)
    if held and share >= FEW_VALID:
        return held  # what is left of the tracers looks narrow, faint and noisy
    if share >= FEW_VALID:
        return understated(measurement.pair(worst.number, worst.field), measurement.settings)
    pair = "" if measurement.total == 1 else f" ({100 * worst.share:.0f} % of pair {worst.number})"
    found = held + advice(measurement.pair(worst.number, worst.field), measurement.settings)
    if not found:
        found = ["the pictures do not tell why: see them, and the vectors on them, by --review"]
    return [f"only {100 * share:.0f} % of the vectors are valid{pair}, fewer than {100 * FEW_VALID:.0f} %", *found]


def background_doubt(measurement: Measurement, field: Field) -> list[str]:
    """That the background holds the tracers, too, where half of them move by less than TRAVEL over the film; none of a
    ``field`` without a valid vector."""
    kind, frames = measurement.shots.background, measurement.pairs + 1
    if kind == "none" or not field.valid.any():
        return []
    step = (measurement.interval or 1.0) * measurement.shots.film.step
    placed = on_picture(field, measurement.rows, measurement.pixel or 1.0, step)
    moved = float(np.median(np.hypot(placed.u, placed.v)[placed.valid])) * measurement.pairs
    if moved >= TRAVEL:
        return []
    return [
        f"tracers move by {moved:.1f} px over the {frames} pictures of which --background {kind} is taken, less than"
        f" {TRAVEL:g} px: it holds the tracers, too, and displacements are wrong; give more pictures, or leave it out"
    ]

"""Open the folder of a run, finished or killed, and look at it."""

from collections.abc import Collection, Iterable, Iterator
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from porescale.common.core.atomic import owned
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import AnyArray
from porescale.common.record import snapshots
from porescale.common.record.columns import Columns
from porescale.common.record.model import Snapshot
from porescale.common.record.read_card import read_card
from porescale.common.record.series import NAME as SERIES
from porescale.common.record.series import read_series
from porescale.common.record.vtkhdf import Frame, Readers


class Run:
    """What a run recorded.  Snapshots are read one at a time, on access."""

    def __init__(self, folder: Path, card: dict[str, Any], frames: dict[int, dict[str, Frame]]) -> None:
        self.folder, self.card = folder, card
        self._frames = list(frames.items())

    @property
    def name(self) -> str:
        """The run's name: the card's, or the folder's."""
        return str(self.card.get("name") or self.folder.resolve().name)

    @cached_property
    def series(self) -> Columns:
        """Columns of series.csv by name ("time (s)", ...), each (rows,)."""
        return Columns(read_series(self.folder / SERIES), "series")

    def table(self, name: str) -> Columns:
        """Columns of <name>.csv, a further time series, by name, each (rows,); none when there is no such file."""
        return Columns(read_series(self.folder / f"{name}.csv"), name)

    @property
    def times(self) -> AnyArray:
        """Times of the snapshots, (snapshots,) s."""
        return np.array([next(iter(entry.values())).time for _, entry in self._frames])

    @property
    def steps(self) -> AnyArray:
        """Steps done at the snapshots, (snapshots,)."""
        return np.array([step for step, _ in self._frames], np.int64)

    @property
    def grids(self) -> list[str]:
        """Names of the grids in every snapshot."""
        return sorted(self.snapshot(0).grids) if self._frames else []

    @property
    def clouds(self) -> list[str]:
        """Names of the clouds in every snapshot."""
        return sorted(self.snapshot(0).clouds) if self._frames else []

    def __len__(self) -> int:
        return len(self._frames)

    def require_snapshots(self) -> None:
        """InputError where the run has none: there is none yet, or their files are no longer there."""
        if len(self):
            return
        problem, repair = "has no snapshots", "let it run until its first snapshot"
        if self.card.get("time"):  # it ended beyond its first
            problem = "has no snapshots: their files (*.vtkhdf) are missing"
            repair = "put them back, or run its scene again with --overwrite"
        raise InputError(Fault("run folder", str(self.folder), problem, repair=repair))

    def snapshot(self, k: int, cells: Collection[str] | None = None) -> Snapshot:
        """Snapshot ``k`` (negative from the end); of its grids only the arrays in ``cells``, if given.

        IndexError beyond the last, InputError when its file is damaged.
        """
        return self._read(k, cells)

    def _read(self, k: int, cells: Collection[str] | None, readers: Readers | None = None) -> Snapshot:
        """`snapshot`;  readers : as of `snapshots.load`."""
        step, entry = self._frames[k]
        try:
            return snapshots.load(entry, step, cells, readers)
        except snapshots.DAMAGE as error:
            raise snapshots.damaged(self.folder, error) from error

    def frames(self, name: str) -> list[Frame]:
        """Where each snapshot of the grid or cloud ``name`` lies in the files."""
        return [entry[name] for _, entry in self._frames]

    def nearest(self, time: float) -> Snapshot:
        """The snapshot nearest to ``time``, s."""
        return self.snapshot(int(np.abs(self.times - time).argmin()))

    def snapshots(
        self, cells: Collection[str] | None = None, numbers: Iterable[int] | None = None
    ) -> Iterator[Snapshot]:
        """All snapshots in time, or those of these numbers, one in memory at a time; of grids as in `snapshot`."""
        with Readers() as readers:
            for k in range(len(self)) if numbers is None else numbers:
                yield self._read(k, cells, readers)


def open_run(folder: Path | str) -> Run:
    """Open a run folder.  The parts of a killed run are joined first, unless a living run holds the folder.

    InputError when the folder holds no run or its files are damaged.
    """
    folder = Path(folder)
    card = read_card(folder)
    try:
        if snapshots.parts(folder):
            _join(folder)
        return Run(folder, card, snapshots.catalogue(folder))
    except snapshots.DAMAGE as error:
        raise snapshots.damaged(folder, error) from error


def _join(folder: Path) -> None:
    """Join parts where this process may write and no other process does; else they are read as they are."""
    try:
        with owned(folder) as held:
            if held:
                snapshots.assemble(folder)
    except PermissionError:
        return

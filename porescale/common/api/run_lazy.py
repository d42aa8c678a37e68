"""An array of all snapshots of a run that is read when xarray uses its values: of a selection only its snapshots."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from xarray.backends import BackendArray
from xarray.core import indexing

from porescale.common.core.types import AnyArray
from porescale.common.record.snapshots import damage_as_input_error
from porescale.common.record.vtkhdf import Frame, read_array


def lazy(
    folder: Path, frames: Sequence[Frame], name: str, shape: tuple[int, ...], dtype: np.dtype[Any],
    component: int | slice | None = None,
) -> Any:  # fmt: skip
    """The array ``name`` of ``frames`` for a Dataset, of ``shape`` (frames, ...).

    component : of vectors, which one or which ones.  Frames of fewer points are filled up with nan.
    """
    return indexing.LazilyIndexedArray(_Frames(folder, frames, name, shape, dtype, component))


class _Frames(BackendArray):  # type: ignore[misc]
    """What xarray asks for values; see `lazy`."""

    def __init__(
        self, folder: Path, frames: Sequence[Frame], name: str, shape: tuple[int, ...], dtype: np.dtype[Any],
        component: int | slice | None,
    ) -> None:  # fmt: skip
        self.folder, self.frames, self.name, self.component = folder, frames, name, component
        self.shape, self.dtype = shape, dtype

    def __getitem__(self, key: Any) -> AnyArray:
        found: AnyArray = indexing.explicit_indexing_adapter(
            key, self.shape, indexing.IndexingSupport.OUTER, self._read
        )
        return found

    def _read(self, key: tuple[Any, ...]) -> AnyArray:
        """Values of an outer index: for each axis a number, a slice or numbers."""
        chosen, rest = np.arange(len(self.frames))[key[0]], key[1:]
        if chosen.ndim == 0:
            return self._picked(int(chosen), rest)
        sample = np.empty(self.shape[1:], bool)  # never read: what shape the rest of the index leaves
        found = np.empty((len(chosen), *_outer(sample, rest).shape), self.dtype)
        for at, k in enumerate(chosen.tolist()):
            found[at] = self._picked(k, rest)
        return found

    def _picked(self, k: int, rest: tuple[Any, ...]) -> AnyArray:
        """The part ``rest`` of frame ``k``."""
        with damage_as_input_error(self.folder):
            values = read_array(self.frames[k], self.name)
        if self.component is not None:
            values = values[..., self.component]
        if values.shape != self.shape[1:]:
            whole = np.full(self.shape[1:], np.nan)
            whole[: len(values)] = values
            values = whole
        return _outer(values.astype(self.dtype, copy=False), rest)


def _outer(values: AnyArray, key: tuple[Any, ...]) -> AnyArray:
    """``values`` with an index for each axis, applied from the last one, so that those before keep their place."""
    for axis in reversed(range(len(key))):
        values = values[(slice(None),) * axis + (key[axis],)]
    return values

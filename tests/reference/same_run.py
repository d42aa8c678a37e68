"""Whether two run folders hold the same run, to the bit: rows, snapshots and the whole state at the end."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from porescale.common.record.checkpoint import read_checkpoint


def contents(path: Path) -> dict[str, bytes]:
    """Every dataset and attribute of an HDF5 file."""
    found: dict[str, bytes] = {}

    def note(name: str, item: h5py.Dataset | h5py.Group) -> None:
        if isinstance(item, h5py.Dataset):
            found[name] = str((item.dtype, item.shape)).encode() + np.ascontiguousarray(item[...]).tobytes()
        for key, value in item.attrs.items():
            found[f"{name}@{key}"] = repr(value).encode()

    with h5py.File(path, "r") as file:
        file.visititems(note)
    return found


def leaves(state: Any, place: str = "") -> Iterator[tuple[str, bytes]]:
    """Every array, number and text of a nested state, as bytes, with its place."""
    if isinstance(state, dict):
        for key, value in state.items():
            yield from leaves(value, f"{place}/{key}")
    elif isinstance(state, list | tuple):
        for number, value in enumerate(state):
            yield from leaves(value, f"{place}/{number}")
    elif isinstance(state, np.ndarray):
        yield place, str((state.dtype, state.shape)).encode() + np.ascontiguousarray(state).tobytes()
    elif isinstance(state, float):
        yield place, np.float64(state).tobytes()
    else:
        yield place, repr(state).encode()


def state_of(folder: Path) -> dict[str, bytes]:
    """The state in the checkpoint of a run, leaf by leaf."""
    return dict(leaves(read_checkpoint(folder / "checkpoint.h5")["state"]))


def _bytes(path: Path) -> bytes | None:
    return path.read_bytes() if path.exists() else None


def differences(one: Path, other: Path) -> list[str]:
    """What differs between the runs in two folders: rows, places in the state, arrays of snapshots."""
    series = sorted({path.name for folder in (one, other) for path in folder.glob("*.csv")})
    found = [name for name in series if _bytes(one / name) != _bytes(other / name)]
    pairs = [("checkpoint.h5", state_of(one), state_of(other))]
    names = {path.name for folder in (one, other) for path in folder.glob("*.vtkhdf")}
    pairs += [(name, contents(one / name), contents(other / name)) for name in sorted(names)]
    for name, first, second in pairs:
        keys = sorted(first.keys() | second.keys())
        found += [f"{name}: {key}" for key in keys if first.get(key) != second.get(key)]
    return found

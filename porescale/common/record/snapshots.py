"""Snapshots on disk: one whole part each, joined into one temporal file for each grid and cloud.

``parts/<step>/<name>.vtkhdf`` hold one frame; a part's folder appears by a rename, with all its files.
They are joined into ``<name>.vtkhdf`` at the end, on resume and on demand, and removed once the joined
files are in place. Frames are identified by their step: a kill at any moment leaves each snapshot in a part, in
the joined files or (equal) in both.
"""

import os
import shutil
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

from porescale.common.core import atomic
from porescale.common.core.errors import Fault, InputError
from porescale.common.record import vtkhdf
from porescale.common.record.model import Cloud, Grid, Snapshot
from porescale.common.record.vtkhdf import Frame, Readers

PARTS = "parts"
FramesOf = Callable[[Path], list[Frame]]
DAMAGE = (OSError, KeyError, ValueError, RuntimeError, TypeError, AttributeError, IndexError)
"""Errors that reading a damaged file raises."""


def damaged(folder: Path, error: BaseException) -> InputError:
    """The message for a snapshot file in ``folder`` that ``error`` came from."""
    reason = " ".join(str(error).split())[:120]
    repair = "run it again, or take the file from a backup"
    return InputError(Fault("run folder", str(folder), f"a snapshot file is damaged ({reason})", repair=repair))


@contextmanager
def damage_as_input_error(folder: Path) -> Iterator[None]:
    """What reading a damaged file raises as InputError; what the system says of the disk as it is."""
    try:
        yield
    except DAMAGE as error:
        if isinstance(error, OSError) and error.errno is not None:
            raise
        raise damaged(folder, error) from error


def write_part(folder: Path, snapshot: Snapshot) -> Path:
    """Put one snapshot on disk, whole or absent; returns its folder."""
    names = [name for _, name, _ in snapshot.blocks()]
    if len(set(names)) != len(names) or not names:
        raise ValueError(f"a snapshot needs grids or clouds of different names, not {names}")
    target = Path(folder) / PARTS / f"{snapshot.step:012d}"
    beside = target.with_name(f".{target.name}.{os.getpid()}{atomic.MARK}")
    shutil.rmtree(beside, ignore_errors=True)
    beside.mkdir(parents=True)
    for _, name, block in snapshot.blocks():
        vtkhdf.write_frame(beside / f"{name}.vtkhdf", name, block, snapshot.step, snapshot.time)
    shutil.rmtree(target, ignore_errors=True)
    os.replace(beside, target)
    atomic.sync_folder(target.parent)
    return target


def parts(folder: Path) -> dict[int, Path]:
    """The folders of the parts by step, ascending."""
    found = (Path(folder) / PARTS).glob("[0-9]*")
    return {int(path.name): path for path in sorted(found) if path.name.isdigit()}


def joined(folder: Path, read: FramesOf = vtkhdf.frames_of) -> dict[str, list[Frame]]:
    """The frames of the joined files by name of the grid or cloud."""
    return {path.stem: read(path) for path in sorted(Path(folder).glob("[!.]*.vtkhdf"))}


def catalogue(folder: Path, read: FramesOf = vtkhdf.frames_of) -> dict[int, dict[str, Frame]]:
    """Every snapshot of a run, joined or not: step -> name -> frame, ascending in time.

    read : gives the frames of a file.  A snapshot that lacks one of the names (a kill while files were rewritten) is
    none.  InputError where a file is damaged.
    """
    found: dict[int, dict[str, Frame]] = {}
    with damage_as_input_error(folder):
        for step, part in parts(folder).items():
            found[step] = {name: frames[0] for name, frames in joined(part, read).items()}
        for name, frames in joined(folder, read).items():
            for frame in frames:
                found.setdefault(frame.step, {})[name] = frame
    names = {name for entry in found.values() for name in entry}
    return {step: entry for step, entry in sorted(found.items()) if entry.keys() == names}


def load(
    frames: dict[str, Frame], step: int, cells: Collection[str] | None = None, readers: Readers | None = None
) -> Snapshot:
    """One entry of the catalogue, read; of grids only the arrays named in ``cells``, if given.

    readers : of files that stay open, where more entries are read.
    """
    if readers is None:
        with Readers() as own:
            return load(frames, step, cells, own)
    snapshot = Snapshot(next(iter(frames.values())).time, step)
    for name, frame in frames.items():
        block = readers.of(name, frame.path).frame(frame.index, cells)
        if isinstance(block, Grid):
            snapshot.grids[name] = block
        elif isinstance(block, Cloud):
            snapshot.clouds[name] = block
    return snapshot


def assemble(folder: Path) -> None:
    """Join all parts into the run's files and remove them.  Killed in between, it can be done again."""
    found = parts(folder)
    if found:
        _rewrite(folder, catalogue(folder))
        shutil.rmtree(Path(folder) / PARTS, ignore_errors=True)


def trim(folder: Path, last: int) -> None:
    """Remove every snapshot after step ``last``."""
    for step, part in parts(folder).items():
        if step > last:
            shutil.rmtree(part)
    with damage_as_input_error(folder):
        frames = joined(folder)
    if any(frame.step > last for many in frames.values() for frame in many):
        kept = {step: entry for step, entry in catalogue(folder).items() if step <= last}
        if kept:
            _rewrite(folder, kept)
        else:
            for name in frames:
                (Path(folder) / f"{name}.vtkhdf").unlink()


def require_all(folder: Path, snapshot: Snapshot) -> None:
    """InputError where there are joined files, but not that of each grid and cloud of a ``snapshot`` to come: one that
    was removed would take the earlier snapshots of the others with it, which would lack its part."""
    there = {path.stem for path in Path(folder).glob("[!.]*.vtkhdf")}
    for name in sorted({*snapshot.grids, *snapshot.clouds} - there if there else ()):
        problem = "is missing, and there are earlier snapshots"
        repair = "put it back, or start the run anew"
        raise InputError(Fault("snapshots", str(Path(folder) / f"{name}.vtkhdf"), problem, repair=repair))


def _rewrite(folder: Path, entries: dict[int, dict[str, Frame]]) -> None:
    """Write each joined file anew from the catalogue's ``entries``."""
    names = {name for entry in entries.values() for name in entry}
    with damage_as_input_error(folder):
        for name in sorted(names):
            vtkhdf.join(Path(folder) / f"{name}.vtkhdf", [entry[name] for entry in entries.values() if name in entry])


def clear(folder: Path) -> None:
    """Remove parts (and what a killed run left half-made among them) and joined files."""
    shutil.rmtree(Path(folder) / PARTS, ignore_errors=True)
    for path in Path(folder).glob("[!.]*.vtkhdf"):
        path.unlink()

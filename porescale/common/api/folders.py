"""Output folders, from Python and from the command line: tried before anything is built."""

import os
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import path_of
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card


class Words(NamedTuple):
    """What messages call the folder, and what goes on with the run in it, or replaces that."""

    out: str
    resume: str
    overwrite: str


TYPED = Words("--out", "--resume", "--overwrite")
IN_PYTHON = Words("out", "resume=True", "overwrite=True")


def named_folder(out: str | Path | None, name: str, words: Words = TYPED) -> Path:
    """The folder that is asked for, ``name`` in runs/ where none is; InputError where it is empty or no path."""
    if out == "":
        raise InputError(Fault(words.out, out, "is empty", repair="name a folder"))
    return Path("runs") / name if out is None else path_of(words.out, out, "name a folder")


def output_folder(out: str | Path | None, name: str = "", words: Words = TYPED) -> Path:
    """As `named_folder`; InputError where it cannot be written, too."""
    folder = named_folder(out, name, words)
    require_writable(folder, words.out)
    return folder


def check_folder(folder: Path, package: str, *, resume: bool, overwrite: bool, words: Words = TYPED) -> None:
    """InputError unless a run may and can be written to ``folder``: nothing that is there is lost by accident."""
    if resume and overwrite:
        raise InputError(Fault(words.resume, None, f"contradicts {words.overwrite}", repair="give one of them"))
    try:
        _require_fitting_content(folder, package, words, resume=resume, overwrite=overwrite)
    except OSError as error:  # a name too long, a folder that may not be looked into
        raise unusable(folder, words.out, error) from error
    require_writable(folder, words.out)


def _require_fitting_content(folder: Path, package: str, words: Words, *, resume: bool, overwrite: bool) -> None:
    """InputError when what is in ``folder`` does not go with what is asked for."""
    out = words.out
    if folder.exists() and not folder.is_dir():
        raise InputError(Fault(out, str(folder), "is a file", repair="name a folder"))
    if (folder / CARD).is_dir():
        raise InputError(Fault(out, str(folder), f"{CARD} there is a folder", repair="name another folder"))
    if resume:
        if not (folder / CARD).is_file():
            repair = f"no {CARD} there; name the run's folder with {out}, or leave {words.resume} out"
            raise InputError(Fault(out, str(folder), "holds no run to resume", repair=repair))
        read_card(folder, package)
    elif folder.is_dir() and any(folder.iterdir()) and not overwrite:
        problem = "already holds a run" if (folder / CARD).is_file() else "is not empty"
        repair = f"choose another {out}, {words.resume} the run, or {words.overwrite} it"
        if problem == "is not empty":
            repair = f"choose another {out}, or {words.overwrite} to write beside what is there"
        elif words is not TYPED:
            repair = f"choose another {out}, go on with the run ({words.resume}), or replace it ({words.overwrite})"
        raise InputError(Fault(out, str(folder), problem, repair=repair))


def require_writable(folder: Path, key: str) -> None:
    """InputError naming ``key`` unless ``folder`` can be made and written; leaves nothing behind."""
    made: list[Path] = []
    probe = folder / f".{os.getpid()}.writable"
    try:
        for part in [*reversed(folder.parents), folder]:
            if not part.exists():
                part.mkdir()
                made.append(part)
        probe.touch(exist_ok=False)
    except OSError as error:
        raise unusable(folder, key, error) from error
    finally:
        with suppress(OSError):  # replaced by another process, or never made
            probe.unlink()
        with suppress(OSError):
            for part in reversed(made):
                part.rmdir()


def require_file(file: Path, key: str, like: str = "") -> None:
    """InputError naming ``key`` unless ``file`` can be written: no folder, and in one that can be; leaves nothing
    behind.  like : a name to propose."""
    if file.is_dir():
        raise InputError(Fault(key, str(file), "is a folder", repair=f"name a file{f', as {like}' if like else ''}"))
    require_writable(file.parent, key)


def unusable(folder: Path, key: str, error: OSError) -> InputError:
    """The system's error on ``folder``, as a fault of the input."""
    problem = f"cannot be written ({error.strerror or error})"
    return InputError(Fault(key, str(folder), problem, repair="name another folder"))

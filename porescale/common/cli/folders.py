"""Output folders of commands: tried before anything is built."""

import os
from contextlib import suppress
from pathlib import Path

from porescale.common.core.errors import Fault, InputError


def named_folder(out: str | None, name: str = "") -> Path:
    """The folder that ``--out`` names, ``name`` in runs/ where it is not given; InputError where it is empty."""
    if out == "":
        raise InputError(Fault("--out", out, "is empty", repair="name a folder"))
    return Path("runs") / name if out is None else Path(out)


def output_folder(out: str | None, name: str = "") -> Path:
    """As `named_folder`; InputError where it cannot be written, too."""
    folder = named_folder(out, name)
    require_writable(folder, "--out")
    return folder


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


def unusable(folder: Path, key: str, error: OSError) -> InputError:
    """The system's error on ``folder``, as a fault of the input."""
    problem = f"cannot be written ({error.strerror or error})"
    return InputError(Fault(key, str(folder), problem, repair="name another folder"))

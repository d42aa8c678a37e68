"""The scene files that `porescale homogenise` runs its tests from."""

from pathlib import Path

from porescale.common.api.folders import unusable
from porescale.common.core.atomic import write_text
from porescale.common.core.errors import Fault, InputError


def specimen_file(folder: Path, name: str, text: str) -> None:
    """Write the scene of the tests in ``folder``; InputError where another one was begun there."""
    file = folder / name
    try:
        if file.exists() and file.read_text(encoding="utf-8", errors="replace") != text:
            repair = "name another --out, or remove that folder"
            raise InputError(Fault("--out", str(folder), "holds specimens of another scene", repair=repair))
        folder.mkdir(parents=True, exist_ok=True)
        if not file.exists():
            write_text(file, text)
    except OSError as error:
        raise unusable(folder, "--out", error) from None

"""Output folders of commands: tried before anything is built."""

from pathlib import Path

from porescale.common.api import folders
from porescale.common.api.folders import require_writable as require_writable
from porescale.common.api.folders import unusable as unusable


def named_folder(out: str | None, name: str = "") -> Path:
    """The folder that ``--out`` names, ``name`` in runs/ where it is not given; InputError where it is empty."""
    return folders.named_folder(out, name, "--out")


def output_folder(out: str | None, name: str = "") -> Path:
    """As `named_folder`; InputError where it cannot be written, too."""
    folder = named_folder(out, name)
    require_writable(folder, "--out")
    return folder

"""The folder that `piv render` writes: where its pictures lie, and with what they are measured."""

import json
from pathlib import Path
from shlex import quote

FRAMES, MASKS, SHOT = "frames", "masks", "shooting.json"
"""Names in the folder: of the pictures, of their masks with solids white, and of how they were taken."""


def measured_with(folder: Path) -> str:
    """Words of `piv measure` for the pictures that lie in a folder of `piv render`; "" where it is none.

    Of what was taken how: the length of a pixel, m, the time between two frames and that of the first, s.
    """
    try:
        shot = json.loads((folder / SHOT).read_text(encoding="utf-8"))
        options = f"--scale {shot['scale']:.6g} --interval {shot['interval']:.6g} --time {shot['start']:g}"
    except (OSError, ValueError, KeyError, TypeError):
        return ""
    if not (folder / FRAMES).is_dir():
        return ""
    frames, masks = (quote(f"{folder}/{name}") for name in (FRAMES, MASKS))
    return f"{frames} --mask {masks} {options}"

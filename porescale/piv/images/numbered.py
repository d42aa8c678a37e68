"""The order of pictures whose names are numbered, and what their numbers tell of pictures that are missing."""

import re
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

_DIGITS = re.compile(r"(\d+)")
SAID = 3
"""Jumps that a warning names, at most."""


def natural(path: Path) -> tuple[list[str | int], str]:
    """Key of the natural order, digits of the name as whole numbers: img2 comes before img10.

    Names whose numbers are equal (img1, img01) stand in the order of their text.
    """
    parts = _DIGITS.split(path.name)
    return [int(part) if k % 2 else part for k, part in enumerate(parts)], path.name


def doubt_of_order(files: Sequence[Path]) -> str:
    """What is doubtful about the order of ``files`` as their names tell; "" where nothing is.

    Their order is that of text rather than of numbers, as a shell gives them; or one number counts from name to name,
    in most of them by its least step, and jumps.
    """
    ordered = sorted(files, key=natural)
    if list(files) != ordered and list(files) == sorted(files):
        first = next(k for k, (one, other) in enumerate(zip(files, ordered, strict=True)) if one != other)
        names = ", ".join(it.name for it in files[max(0, first - 1) : first + 2])
        return f"pictures are in the order of their names' text ({names}), not of the numbers in them"
    numbers = _numbers(files)
    steps = [b - a for a, b in pairwise(numbers)]
    if len(steps) < 2 or min(steps) <= 0:
        return ""
    jumps = [k for k, step in enumerate(steps) if step > min(steps)]
    if not jumps or 2 * len(jumps) >= len(steps) + 1:
        return ""
    named = ", ".join(f"{files[k].name} to {files[k + 1].name}" for k in jumps[:SAID])
    more = f" and {len(jumps) - SAID} more" if len(jumps) > SAID else ""
    return f"numbers in the pictures' names jump: {named}{more}; displacements there are of a longer time"


def _numbers(files: Sequence[Path]) -> list[int]:
    """The one number in which all names differ; none where their text differs, or several numbers do."""
    names = [_DIGITS.split(it.name) for it in files]
    if len({len(it) for it in names}) != 1:
        return []
    columns = [set(column) for column in zip(*names, strict=True)]
    differ = [k for k, column in enumerate(columns) if len(column) > 1]
    return [int(name[differ[0]]) for name in names] if len(differ) == 1 and differ[0] % 2 else []

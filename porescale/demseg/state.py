"""in_cf.dat: the whole state of a run as text, from which the next one goes on bit for bit.

The DEMseg tutorial does not give its layout; here for every array a line ``name type length length …`` (no length: a
single number), then its numbers, eight a line, read back bit for bit.  Names are those of the model's state, parts
of parts joined by "/".  Types: float64, int64, int32, uint8.
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import given_bytes

TYPES = ("float64", "int64", "int32", "uint8")
WIDTH = 8


def state_text(state: dict[str, Any]) -> str:
    """The text of a nested dict of arrays and numbers."""
    lines: list[str] = []
    for name, value in _flat(state, ""):
        array = np.asarray(value)
        lines.append(" ".join([name, str(array.dtype), *(str(size) for size in array.shape)]))
        words = [repr(number) for number in array.ravel().tolist()]
        lines += [" ".join(words[k : k + WIDTH]) for k in range(0, len(words), WIDTH)]
    return "\n".join(lines) + "\n"


def read_state(path: Path) -> dict[str, Any]:
    """The nested dict of a file that ``state_text`` made; InputError naming the line where it is none."""
    try:
        lines = given_bytes(path).decode(errors="replace").splitlines()
    except OSError as error:
        raise InputError(Fault(str(path), problem=f"cannot be read ({error.strerror}), jclid 1 needs it")) from None
    state: dict[str, Any] = {}
    at = 0
    while at < len(lines):
        first, head = at + 1, lines[at].split()
        at += 1
        if not head:
            continue
        if len(head) < 2 or head[1] not in TYPES or not all(word.isdecimal() and len(word) < 10 for word in head[2:]):
            raise _damaged(path, first, lines[first - 1][:40], f"a name, one of {', '.join(TYPES)}, and lengths")
        shape = tuple(int(word) for word in head[2:])
        count, words = int(np.prod(shape, dtype=np.int64)), list[str]()
        while len(words) < count and at < len(lines):
            words += lines[at].split()
            at += 1
        try:
            numbers = np.array([float(w) if head[1] == "float64" else int(w) for w in words], head[1]).reshape(shape)
        except (ValueError, OverflowError):
            raise _damaged(path, first, head[0], f"{count} numbers of type {head[1]}") from None
        _put(state, head[0], numbers if shape else numbers.item())
    return state


def _damaged(path: Path, line: int, value: str, expected: str) -> InputError:
    return InputError(Fault(f"line {line}", value, f"makes no sense, expected {expected}", file=str(path)))


def _flat(value: Any, name: str) -> list[tuple[str, NDArray[Any] | float]]:
    if isinstance(value, dict):
        return [item for key, part in value.items() for item in _flat(part, f"{name}/{key}" if name else key)]
    return [(name, value)]


def _put(state: dict[str, Any], name: str, value: Any) -> None:
    *above, last = name.split("/")
    for part in above:
        state = state.setdefault(part, {})
    state[last] = value

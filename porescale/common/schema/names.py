"""Names of what is recorded, from which the columns of tables have theirs."""

import unicodedata
from collections.abc import Sequence
from typing import Protocol

from porescale.common.core.errors import Fault

BREAKING = "Cc", "Zl", "Zp"
"""Categories of characters, control characters and ends of lines, that break the head of a table."""


class Named(Protocol):
    """A section with a name, which may be left out."""

    @property
    def name(self) -> str:
        """Its name, "" where it has none."""


def names_of(sections: Sequence[Named], kind: str) -> list[str]:
    """Names in columns and messages of ``sections``: their own, else what ``kind`` they are and their number."""
    return [it.name or f"{kind} {number}" for number, it in enumerate(sections)]


def name_faults(key: str, sections: Sequence[Named], kind: str) -> list[Fault]:
    """What is wrong with the names of ``sections`` at a ``key``; of two that have one name the second is named.

    kind : what they are, in words.
    """
    found, names = [], names_of(sections, kind)
    for number, name in enumerate(names):
        place = f"{key}[{number}].name"
        if bad := sign_faults(place, name):
            found += bad
        elif name in names[:number]:
            found.append(Fault(place, name, f"is that of another {kind}", repair="rename it"))
    return found


def sign_faults(place: str, name: str) -> list[Fault]:
    """What is wrong with the characters of the ``name`` at the key ``place``."""
    if not name.strip():
        return [Fault(place, name, "is blank", repair="give a name, or leave it out")]
    if any(unicodedata.category(sign) in BREAKING for sign in name):
        return [Fault(place, name, "has control characters, which break the tables", repair="take them out")]
    return []

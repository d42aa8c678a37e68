"""``porescale verify``: the validations of every folder below `porescale.validation`."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from porescale.common.evidence.validations import Validations


def validations() -> Validations:
    """All rows, file by file."""
    from porescale.common.evidence.discover import registers
    from porescale.common.evidence.validations import Validations

    return Validations(registers("porescale.validation", "VALIDATIONS"))

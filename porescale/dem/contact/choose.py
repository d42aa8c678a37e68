"""Contact laws by name: the register of this folder."""

from porescale.common.core.register import discover
from porescale.dem.contact.law import ContactLaw

LAWS: dict[str, type[ContactLaw]] = discover(__package__, "LAW")
"""Every ``LAW`` of a file of this folder, by name."""

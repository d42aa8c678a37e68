"""Files with laws of a user, for tests."""

from pathlib import Path
from typing import Any

from porescale.common.compiled.own import OwnLaw
from porescale.common.compiled.own_file import law_of
from porescale.common.compiled.own_kernel import kernel_of
from porescale.dem.contact.own import OwnContact, own_contact

CONTACTS = """
import math

import porescale as ps


@ps.contact_law(keys={"stiffness": "N/m", "damping": "N s/m"})
def linear(overlap, closing, radius, mass, p):
    return p.stiffness * overlap + p.damping * closing


@ps.contact_law(keys={"modulus": "Pa"})
def hertz(overlap, closing, radius, mass, p):
    return 4.0 / 3.0 * p.modulus * math.sqrt(radius * overlap) * overlap


@ps.contact_law(keys={"stiffness": "N/m", "adhesion": "N/m"})
def sticky(overlap, closing, radius, mass, p):
    return p.stiffness * overlap - p.adhesion


@ps.contact_law()
def unset(overlap, closing, radius, mass, p):
    return math.nan * overlap


@ps.contact_law()
def hard(overlap, closing, radius, mass, p):
    return 5.0


@ps.contact_law()
def nothing(overlap, closing, radius, mass, p):
    return 0.0 * overlap


@ps.contact_law()
def giving(overlap, closing, radius, mass, p):
    return 1e4 * overlap - 0.5 * closing


@ps.contact_law()
def log(overlap, closing, radius, mass, p):
    return 1e4 / (overlap - overlap)
"""


def write_laws(folder: Path, text: str = CONTACTS, name: str = "laws.py") -> Path:
    """A file of laws in a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def contact_of(law: OwnLaw, release: str = "force", **numbers: float) -> OwnContact:
    """The contact law of a user's function with these numbers."""
    made: Any = own_contact(law.reference, kernel_of(law.function), law.keys)
    found: OwnContact = made.from_numbers(numbers, release, 1.0, 0.02)
    return found


def contact_named(folder: Path, name: str, release: str = "force", **numbers: float) -> OwnContact:
    """The contact law called ``name`` of laws.py in a folder."""
    return contact_of(law_of(f"laws.py:{name}", folder, "contact_law"), release, **numbers)

"""The rows of both programs by name, and what each allows."""

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE

ROWS = {row.name: row for package in (PACKAGE, CONTINUUM) for row in package.validations()}


def tolerance(name: str) -> float:
    """Largest error that the row of this ``name`` may have."""
    return ROWS[name].tolerance

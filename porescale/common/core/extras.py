"""Libraries that only some need: imported when asked for, with one clear line where they are not installed."""

import importlib
import importlib.util
from typing import Any

from porescale.common.core.errors import Fault, InputError

EXTRAS = {
    "pandas": "notebook",
    "xarray": "notebook",
    "pyvista": "notebook",
    "anywidget": "widget",
    "lbmpy": "peers",
    "pystencils": "peers",
    "lammps": "peers",
    "openpiv": "piv",
    "submitit": "cluster",
    "distributed": "cluster",
}
"""Libraries, and the extra of this package that brings them."""


def extra(library: str) -> Any:
    """The imported ``library``; InputError with the pip command where it is not installed."""
    try:
        return importlib.import_module(library)
    except ModuleNotFoundError:
        whole = library.partition(".")[0]
        repair = f"pip install 'porescale[{EXTRAS[whole]}]'"
        raise InputError(Fault(whole, None, "is not installed", repair=repair)) from None


def installed(library: str) -> bool:
    """Whether ``library`` can be imported; it is not."""
    return importlib.util.find_spec(library) is not None

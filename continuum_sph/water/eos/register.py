"""The equations of state that there are: every file of this folder but the contract's and this one."""

from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

OTHERS = ("__init__", "law", "register")


@cache
def laws() -> dict[str, Any]:
    """Classes of laws, see `law.StateLaw`, by the names of their files: by these scenes name them."""
    names = sorted(path.stem for path in Path(__file__).parent.glob("*.py") if path.stem not in OTHERS)
    return {name: import_module(f"{__package__}.{name}").LAW for name in names}


def offered(*, gas: bool | None = None) -> list[str]:
    """Names of all laws, or of those of gases or of liquids."""
    return [name for name, law in laws().items() if gas is None or law.gas == gas]

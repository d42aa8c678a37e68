"""card.json, the identity of a run folder: where it lies and how it is read."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from porescale.ground.check import Fault, InputError

NAME = "card.json"
"""Every run folder has one from its first moment on."""


def read_card(folder: Path, package: object = None) -> dict[str, Any]:
    """The card of the run in ``folder``: a table with the scene as a table in it.

    package : whose run it must be, where that matters and the card says it.  InputError, naming the folder, when
    there is no card, when it is damaged or none of ours, and when it is another package's.
    """
    folder = Path(folder)
    repair = "name a folder that `run` has written"
    try:
        card = json.loads((folder / NAME).read_text(encoding="utf-8"))
    except (FileNotFoundError, NotADirectoryError):
        raise _fault(folder, f"no run here ({NAME} is missing)", repair) from None
    except OSError as error:
        raise _fault(folder, f"{NAME} cannot be read ({error.strerror})", repair) from None
    except (ValueError, RecursionError):  # not JSON, not UTF-8
        raise _fault(folder, f"{NAME} is damaged", repair) from None
    if not isinstance(card, dict) or not isinstance(card.get("scene"), dict):
        raise _fault(folder, f"{NAME} is damaged or not that of a run (it holds no scene)", repair)
    whose = card.get("package")
    if package is not None and whose is not None and whose != package:
        raise _fault(folder, f"holds a run of {whose}, not of {package}", f"use {whose}, or name another folder")
    return card


def _fault(folder: Path, problem: str, repair: str) -> InputError:
    return InputError(Fault("run folder", str(folder), problem, repair=repair))

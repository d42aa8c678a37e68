"""card.json, the identity of a run folder: where it lies and how it is read."""

import json
import operator
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from porescale.common.core.errors import Fault, InputError

NAME = "card.json"
"""Every run folder has one from its first moment on."""
FORMAT = 1
"""Format of run folders; cards that do not state theirs have this one."""


def read_card(folder: Path, package: object = None) -> dict[str, Any]:
    """The card of the run in ``folder``: a table with the scene as a table in it.

    package : whose run it must be, where that matters and the card holds it.  InputError, naming the folder, when
    there is no card, when it is damaged or of another program, and when it is another package's.
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
    require_format(folder, NAME, card.get("format", FORMAT), FORMAT)
    whose = card.get("package")
    if package is not None and whose is not None and whose != package:
        raise _fault(folder, f"holds a run of {whose}, not of {package}", f"use {whose}, or name another folder")
    return card


def scene_folder(card: Mapping[str, Any]) -> Path | None:
    """The folder that names of files in the scene of a ``card`` count from; None where it was made in Python."""
    return Path(card["scene_file"]).parent if card.get("scene_file") else None


def scene_end(card: Mapping[str, Any]) -> float | None:
    """Time that the scene of a ``card`` is to simulate, s; None where it does not say so."""
    times = card["scene"].get("time")
    end = times.get("end") if isinstance(times, dict) else None
    return end if isinstance(end, int | float) else None


def short_commit(known: Mapping[str, Any] | None) -> str:
    """Eight digits of the commit of a card, with a + where files had changed since; "" outside of a checkout."""
    return known["hash"][:8] + "+" * known["changed"] if known else ""


def require_format(place: Path, what: str, found: object, reads: int) -> None:
    """InputError unless the format that ``what`` in ``place`` says it has, ``found``, is the one that is read here."""
    if hasattr(found, "__index__") and not isinstance(found, bool):
        if operator.index(found) == reads:
            return
        if operator.index(found) > reads:
            problem, repair = f"{what} was written by a newer version (format {found})", "read it with that version"
            raise InputError(Fault("run folder", str(place), problem, "", f"format {reads}", repair))
    problem = f"{what} is damaged or of no known format ({str(found)[:40]!r})"
    raise InputError(Fault("run folder", str(place), problem, "", f"format {reads}", "take it from a backup"))


def _fault(folder: Path, problem: str, repair: str) -> InputError:
    return InputError(Fault("run folder", str(folder), problem, repair=repair))

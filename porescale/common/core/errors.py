"""Faults: what a person can cause, in one line each, and the exit code each kind of failure has."""

import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it: 128 + SIGINT."""
LONGEST = 200
"""Largest number of characters of a key or value in a message."""


@dataclass(frozen=True)
class Fault:
    """One thing wrong with an input.

    key : dotted name, e.g. ``fluid.viscosity``;  value : as given;  problem : what is wrong with it;
    unit : SI unit of the key, "" if none;  allowed : range or choices;  repair : what to do;  file : where.
    """

    key: str
    value: Any = None
    problem: str = ""
    unit: str = ""
    allowed: str = ""
    repair: str = ""
    file: str = ""

    def line(self) -> str:
        """The fault as one line of text; what was given is shortened where it is long."""
        text = f"{self.file}: " if self.file else ""
        text += _shortened(self.key)
        if self.value is not None:
            text += f" = {_shortened(repr(self.value) if isinstance(self.value, str) else str(self.value))}"
            if self.unit and not isinstance(self.value, str):
                text += f" {self.unit}"
        if self.problem:
            text += f": {_shortened(self.problem, 2 * LONGEST)}"
        if self.allowed:
            text += f" (allowed: {_shortened(self.allowed, 2 * LONGEST)}{' ' + self.unit if self.unit else ''})"
        if self.repair:
            text += f"; {_shortened(self.repair, 2 * LONGEST)}"
        return text


def _shortened(text: str, longest: int = LONGEST) -> str:
    """``text`` in one line, its middle left out where it is long."""
    text = " ".join(text.splitlines())
    return text if len(text) <= longest else f"{text[: longest // 2]}…{text[-longest // 4 :]}"


class PorescaleError(Exception):
    """Base of all errors with a message to the user; ``code`` is the exit code of a command that ends with it."""

    code = 1


class InputError(PorescaleError):
    """Wrong use or wrong input: one or more faults.  Exit code 2."""

    code = 2

    def __init__(self, faults: Fault | Sequence[Fault]) -> None:
        self.faults: list[Fault] = [faults] if isinstance(faults, Fault) else list(faults)
        super().__init__("\n".join(fault.line() for fault in self.faults))

    def in_file(self, file: str) -> "InputError":
        """An error with the same faults, each naming ``file``."""
        return InputError([replace(fault, file=fault.file or file) for fault in self.faults])


class Unstable(PorescaleError):
    """A run left the range in which it means anything.  Exit code 3.

    where : cell, grain or particle;  quantity, value, unit;  step, time (s);  cause : the likely one and its repair.
    """

    code = 3

    def __init__(self, where: str, quantity: str, value: float, unit: str, step: int, time: float, cause: str) -> None:
        self.where, self.quantity, self.value, self.unit = where, quantity, value, unit
        self.step, self.time, self.cause = step, time, cause
        super().__init__(
            f"unstable at step {step} (t = {time:.6g} s): {quantity} = {value:.4g} {unit} at {where}; {cause}"
        )


class PorescaleWarning(UserWarning):
    """What is doubtful and goes on all the same, in one line: `warnings` silences or catches it; commands print it."""


def warn(text: str) -> None:
    """Give ``text`` as a PorescaleWarning at the line that called the package, not at one within it."""
    package = __name__.split(".")[0]
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and str(frame.f_globals.get("__name__", "")).split(".")[0] == package:
        frame, level = frame.f_back, level + 1
    warnings.warn(text, PorescaleWarning, stacklevel=level)

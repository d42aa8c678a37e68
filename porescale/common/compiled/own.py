"""A user's own laws: plain functions, each made known with one decorator, and compiled into the kernels that use them.

A law is known by its name and by the text of all files that it stands on: its own and those of the same folder that it
imports.  A function of a notebook has no file; it is known by its own text, and that of what it uses.
"""

import hashlib
import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import FunctionType
from typing import Any

from porescale.common.compiled.own_sources import place, sources_of
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.units import require_unit, to_si

CONTACT_LAW, BODY_FORCE, INFLOW = "contact_law", "body_force", "inflow"
ARGUMENTS: dict[str, tuple[tuple[str, ...], ...]] = {
    CONTACT_LAW: (("overlap", "closing", "radius", "mass", "p"),),
    BODY_FORCE: (("x", "y", "t"), ("x", "y")),
    INFLOW: (("s", "t"),),
}
"""What each kind of law is given, in this order."""


@dataclass(frozen=True, eq=False)
class OwnLaw:
    """A user's function with what its decorator says.  Calling it calls the function.

    kind : of the law, name of its decorator;  function;  keys : unit (SI, "" for none) of each number that a scene
    gives it;  reference : how a scene names it, "laws.py:sticky";  sources : text of each file that it stands on, by
    name.  Laws of the same kind, name and sources are equal.
    """

    kind: str
    function: FunctionType
    keys: Mapping[str, str] = field(default_factory=dict)
    reference: str = ""
    sources: Mapping[str, str] = field(default_factory=dict)

    def __call__(self, *arguments: Any) -> Any:
        """What the function returns, in plain Python."""
        return self.function(*arguments)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, OwnLaw) and (self.kind, self.name, self.hash) == (other.kind, other.name, other.hash)

    def __hash__(self) -> int:
        return hash((self.kind, self.name, self.hash))

    def __repr__(self) -> str:
        return f"<{self.kind} {self.reference or self.name}, {self.hash}>"

    def __str__(self) -> str:
        return self.reference

    @property
    def name(self) -> str:
        """Name of the function."""
        return self.function.__name__

    @property
    def file(self) -> Path | None:
        """The file that the function stands in; None where it is none, as in a notebook."""
        path = Path(self.function.__code__.co_filename)
        return path if path.is_file() else None

    @property
    def place(self) -> str:
        """File and line of the function, for messages."""
        return place(self.function.__code__.co_filename, self.function.__code__.co_firstlineno)

    @cached_property
    def hash(self) -> str:
        """Hash (12 hex digits) of the texts that the law stands on."""
        return hashlib.sha256(repr(sorted(self.sources.items())).encode()).hexdigest()[:12]

    def card(self) -> dict[str, Any]:
        """What a run card holds of the law: name, hash, and the text of all that it stands on."""
        return {"kind": self.kind, "law": self.reference, "hash": self.hash, "sources": dict(self.sources)}

    def named(self, reference: str) -> "OwnLaw":
        """The same law under the name that a scene gives it."""
        return self if reference == self.reference else replace(self, reference=reference)


def contact_law(
    function: object = None, /, *, keys: Mapping[str, str] | None = None
) -> Callable[[Callable[..., Any]], OwnLaw]:
    """Make a function a contact law, for ``[contact] law = "laws.py:NAME"``.

    The function is given (overlap, closing, radius, mass, p) and returns the normal force, N/m, > 0 where it pushes the
    grains apart.  overlap : m, > 0;  closing : speed at which it grows, m/s;  radius : reduced, m;  mass : reduced,
    kg/m;  p : the numbers of ``keys``, as ``p.adhesion``.  keys : SI unit of each number that [contact] gives the law,
    "" for a plain number.  Friction, rolling resistance and the end of a contact are those of the linear law.
    """
    if function is not None:
        name = getattr(function, "__name__", type(function).__name__)
        raise InputError(
            Fault(CONTACT_LAW, name, "has no keys", repair='write @contact_law(keys={"stiffness": "N/m"})')
        )
    return lambda made: _law(CONTACT_LAW, made, keys or {})


def body_force(function: Callable[..., Any]) -> OwnLaw:
    """Make a function (x, y, t) a body force: the force (fx, fy) on a volume, N/m3, at a place (m) and time (s).

    ``[fluid] body_force = "laws.py:NAME"`` lets it act on the fluid.  A function (x, y) is worked out once.
    """
    return _law(BODY_FORCE, function, {})


def inflow(function: Callable[..., Any]) -> OwnLaw:
    """Make a function (s, t) an inflow: the velocity (u, v), m/s, along a side at a time (s).

    s : distance (m) from the side's left or lower end.  ``[domain] left = { kind = "velocity", velocity =
    "laws.py:NAME" }`` lets the fluid in, or out, with it.
    """
    return _law(INFLOW, function, {})


def _law(kind: str, function: Any, keys: Mapping[str, str]) -> OwnLaw:
    """The law, if function and keys are what the kind needs."""
    if not isinstance(function, FunctionType):
        problem = f"@{kind} stands above a function, this is {type(function).__name__}"
        repair = "write @contact_law(keys={...}) with keys by name" if kind == CONTACT_LAW else "write def below it"
        raise InputError(Fault(kind, None, problem, repair=repair))
    code, name = function.__code__, function.__name__
    where = f"{place(code.co_filename, code.co_firstlineno)}: {name}"
    given = code.co_varnames[: code.co_argcount]
    counts = [len(it) for it in ARGUMENTS[kind]]
    if len(given) not in counts or code.co_kwonlyargcount or code.co_flags & inspect.CO_VARARGS:
        allowed = " or ".join(f"({', '.join(it)})" for it in ARGUMENTS[kind])
        raise InputError(Fault(where, None, f"takes ({', '.join(given)})", "", allowed, "write these arguments"))
    for key, unit in keys.items():
        if not (isinstance(key, str) and key.isidentifier() and not key.startswith("_")):
            raise InputError(Fault(where, str(key), "is no name for a key", repair="take letters, digits and _"))
        try:
            require_unit(unit)
        except (ValueError, TypeError) as error:
            problem = f"unit of the key {key!r}: {error}"
            raise InputError(Fault(where, str(unit), problem, repair="give an SI unit, such as N/m")) from None
    path = Path(code.co_filename)
    reference = f"{path.resolve()}:{name}" if path.is_file() else f"notebook:{name}"
    return OwnLaw(kind, function, dict(keys), reference, sources_of(function))


def number_of(law: OwnLaw, key: str, value: Any) -> float:
    """A number that a scene gives a law, in SI; raises ValueError, with the reason, where it is none."""
    number = to_si(value, law.keys[key])
    if not math.isfinite(number):
        raise ValueError("is not finite")
    return number

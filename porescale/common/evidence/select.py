"""Choosing rows of a register by name."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from porescale.common.core.errors import Fault, InputError
from porescale.common.schema.messages import nearest


def choose(asked: Sequence[str], known: Iterable[str], what: str) -> list[str]:
    """Names in ``known`` that are asked for, in the order of ``known``; all of them if nothing is asked for.

    A name asks for itself and for all below it: ``lbm`` for ``lbm.poiseuille``.  Raises InputError with one
    fault for each name that asks for nothing.
    """
    names = list(known)
    below = {name: [other for other in names if other == name or other.startswith(f"{name}.")] for name in asked}
    rooms = {name.partition(".")[0] for name in names}
    unknown = [name for name, found in below.items() if not found]
    if unknown:
        repair = {name: nearest(name, [*names, *rooms], "names") for name in unknown}
        raise InputError([Fault(name, None, f"no such {what}", repair=repair[name]) for name in unknown])
    wanted = {other for found in below.values() for other in found}
    return [name for name in names if not asked or name in wanted]

"""Columns of a table over time as curves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.record.columns import TIME, Columns, split

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot(table: Columns, columns: Sequence[str], ax: Axes | None = None) -> Any:
    """Draw ``columns`` over time; the Axes, or an array of Axes where units differ.  As `Run.plot`."""
    if not columns:
        names = ", ".join(name for name in table if name != TIME)
        raise InputError(Fault("columns", None, "none named", allowed=names, repair="name one or more"))
    for column in columns:
        if not isinstance(column, str):
            repair = 'write run.plot("front (m)", "…")'
            raise InputError(Fault("columns", str(column), f"is no name but {type(column).__name__}", repair=repair))
    by_unit: dict[str, list[str]] = {}
    for column in columns:
        table[column]
        by_unit.setdefault(split(column)[1], []).append(column)
    if ax is not None and len(by_unit) > 1:
        units = " and ".join(unit or "none" for unit in by_unit)
        raise InputError(Fault("columns", None, f"have different units: {units}", repair="leave ax out, or draw each"))
    made: Any = [ax]
    if ax is None:
        import matplotlib.pyplot as plt

        count = len(by_unit)
        _, panels = plt.subplots(
            count, 1, sharex=True, squeeze=False, figsize=(6.4, 1.6 + 2.4 * count), layout="constrained"
        )
        made = panels[:, 0]
    for axes, (unit, group) in zip(made, by_unit.items(), strict=True):
        for column in group:
            axes.plot(table[TIME], table[column], label=split(column)[0])
        name = split(group[0])[0] if len(group) == 1 else ""
        axes.set_ylabel(f"{name} ({unit})".strip() if unit else name)
        if len(group) > 1:
            axes.legend()
    made[-1].set_xlabel(TIME)
    return made[0] if len(made) == 1 else made

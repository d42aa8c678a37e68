"""Whether particles still make sense: numbers that are some, and nobody farther than anybody goes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.errors import no_step
from porescale.common.core.errors import Unstable

Floats = NDArray[np.float64]

FARTHER = 2.0
"""Ways of the fastest particle that another may have come: shifting and smoothed velocities add to its own."""

LONGER = 2.0
"""Times what its rules allow, how long the next step may be: twice 0.25 h/c is the last that sound is stable at, ω Δt
about 0.7 (`continuum_sph.water.step`); exact limits are of densities at mid-step, which a check does not know."""


def stepped(advance: Callable[[], object], step: int, time: float, repair: str) -> None:
    """Do a step, from the ``step`` and ``time`` (s) reached; Unstable when a position is no number any more, which the
    search for neighbours says."""
    try:
        advance()
    except ValueError as error:
        raise Unstable(str(error), "position", float("nan"), "m", step, time, repair) from error


def refuse_no_numbers(
    arrays: Mapping[str, tuple[str, NDArray[Any]]], step: int, time: float, repair: str, of: str = "particle"
) -> None:
    """Unstable at the first entry that is no number of ``arrays``: (unit, (n,) or (n, k) of particles) by name."""
    for name, (unit, values) in arrays.items():
        if np.isfinite(values.sum()):  # a sum that is a number has none among it that is not
            continue
        lost = ~np.isfinite(values.reshape(len(values), -1)).all(axis=1)
        if lost.any():
            raise Unstable(f"{of} {int(lost.argmax())}", name, float("nan"), unit, step, time, repair)


def refuse_one_place(x: Floats, there: NDArray[np.int64], step: int, time: float, repair: str) -> None:
    """Unstable when two of the particles ``there`` of ``x`` (n, 2) m are in one place: nothing pushes them apart.

    Only those whose x + √2 y is the same are looked at: one sort.
    """
    mixed = x[there, 0] + 2.0**0.5 * x[there, 1]
    order = np.argsort(mixed, kind="stable")
    a, b = there[order[:-1]], there[order[1:]]
    same = (np.diff(mixed[order]) == 0.0) & (x[a] == x[b]).all(axis=1)
    if same.any():
        at, other = int(a[same.argmax()]), int(b[same.argmax()])
        where = f"particle {at} at ({x[at, 0]:.4g}, {x[at, 1]:.4g}) m, and {other} there, too"
        raise Unstable(where, "distance", 0.0, "m", step, time, repair)


def refuse_beyond(
    values: Floats, least: Floats | float, most: Floats | float, name: str, unit: str, of: NDArray[np.int64], x: Floats,
    step: int, time: float, repair: str,
) -> None:  # fmt: skip
    """Unstable at the first of ``values`` (m,) that is not within [``least``, ``most``]; they are those of the
    particles ``of`` (m,) of ``x`` (n, 2) m."""
    wrong = ~((values >= least) & (values <= most))
    if wrong.any():
        at = int(of[wrong.argmax()])
        where = f"particle {at} at ({x[at, 0]:.4g}, {x[at, 1]:.4g}) m"
        raise Unstable(where, name, float(values[wrong.argmax()]), unit, step, time, repair)


def refuse_step(
    seconds: float, limits: Sequence[float], rules: Sequence[str], x: Floats, acceleration: Floats, density: Floats,
    step: int, time: float, repair: str,
) -> None:  # fmt: skip
    """Unstable when a next step of ``seconds`` is none, or longer than the ``rules`` allow by their ``limits``, s."""
    if not 0.0 < seconds <= LONGER * min(limits):
        rule = rules[int(np.argmin(limits))]
        raise no_step(seconds, rule, x, acceleration, density, step, time, repair)


class Leaps:
    """Remembers where particles were at the last look, and the way of the fastest since.

    A particle that came farther than `FARTHER` such ways and a spacing did not go there.  strips : (left, right) m of
    reservoirs, whose particles come and go.
    """

    def __init__(self, spacing: float) -> None:
        self.spacing = spacing
        self.strips: Sequence[tuple[float, float]] = ()
        self.forget()

    def forget(self) -> None:
        """Nothing is known of where they were."""
        self._seen: Floats | None = None
        self._there: NDArray[np.bool_] | None = None
        self._way, self._time, self._swiftest = 0.0, -1.0, 0.0

    def went(self, time: float, swiftest: float) -> None:
        """It is ``time`` (s) now, and the fastest goes at ``swiftest``, m/s."""
        if self._time >= 0.0:
            self._way += (time - self._time) * max(swiftest, self._swiftest)
        self._time, self._swiftest = time, swiftest

    def check(self, x: Floats, mass: Floats, step: int, time: float, repair: str) -> None:
        """Unstable when a particle of ``mass`` (n,) kg/m, 0: not there, has leapt to its place ``x`` (n, 2) m."""
        there = mass > 0.0
        for left, right in self.strips:
            there &= (x[:, 0] < left) | (x[:, 0] > right)
        if self._seen is not None and self._there is not None:
            gone = np.hypot(x[:, 0] - self._seen[:, 0], x[:, 1] - self._seen[:, 1])
            leapt = there & self._there & ~(gone <= FARTHER * self._way + self.spacing)
            if leapt.any():
                at = int(leapt.argmax())
                where = f"particle {at} at ({x[at, 0]:.4g}, {x[at, 1]:.4g}) m"
                raise Unstable(where, "way since the last look", float(gone[at]), "m", step, time, repair)
        self._seen, self._there, self._way = x.copy(), there, 0.0

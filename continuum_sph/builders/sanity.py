"""Checks of particles: finite values, distinct positions, no jumps, a step within its bounds."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from continuum_sph.seepage.reservoir import NoneLeftError
from continuum_sph.water.no_step import no_step
from porescale.common.core.errors import Unstable
from porescale.common.core.types import Floats

FARTHER = 2.0
"""Ways of the fastest particle that another may have come: shifting and smoothed velocities add to its own."""

LONGER = 2.0
"""Times what its rules allow, how long the next step may be: twice 0.25 h/c is the last that sound is stable at, ω Δt
about 0.7 (`continuum_sph.water.step`); exact limits are of densities at mid-step, which a check does not have."""


class Now(NamedTuple):
    """Steps done, time reached (s), and what helps against instability."""

    step: int
    time: float
    repair: str


def advance_one(advance: Callable[[], object], now: Now) -> None:
    """Advance one step; raise Unstable when the neighbour search finds a position that is not finite, or a reservoir
    has no particles left."""
    try:
        advance()
    except NoneLeftError as error:
        raise Unstable(
            f"the strip of {error.name}", "level", error.level, "m", now.step, now.time,
            f"no particles are left to bring it to {error.target:g} m: all that fill the tank to its highest level are "
            "in it; find what drives water out of the strip",
        ) from error  # fmt: skip
    except ValueError as error:
        if getattr(error, "__notes__", None):  # of a function of the user's
            raise
        raise Unstable(str(error), "position", float("nan"), "m", *now) from error


def require_finite(arrays: Mapping[str, tuple[str, NDArray[Any]]], now: Now, of: str = "particle") -> None:
    """Unstable at the first entry that is no number of ``arrays``: (unit, (n,) or (n, k) of particles) by name."""
    for name, (unit, values) in arrays.items():
        if np.isfinite(values.sum()):  # a sum that is a number has none among it that is not
            continue
        lost = ~np.isfinite(values.reshape(len(values), -1)).all(axis=1)
        if lost.any():
            raise Unstable(f"{of} {int(lost.argmax())}", name, float("nan"), unit, *now)


def require_distinct(x: Floats, there: NDArray[np.int64], now: Now) -> None:
    """Unstable when two of the particles ``there`` of ``x`` (n, 2) m are in one place: nothing pushes them apart.

    Only those whose x + √2 y is the same are looked at: one sort.
    """
    mixed = x[there, 0] + 2.0**0.5 * x[there, 1]
    order = np.argsort(mixed, kind="stable")
    a, b = there[order[:-1]], there[order[1:]]
    same = (np.diff(mixed[order]) == 0.0) & (x[a] == x[b]).all(axis=1)
    if same.any():
        at, other = int(a[same.argmax()]), int(b[same.argmax()])
        raise Unstable(f"{place(x, at)}, and {other} there, too", "distance", 0.0, "m", *now)


class Range(NamedTuple):
    """A quantity and the values that it may have, of all particles or (m,) of each."""

    name: str
    unit: str
    least: Floats | float
    most: Floats | float


def require_within(values: Floats, allowed: Range, of: NDArray[np.int64], x: Floats, now: Now) -> None:
    """Unstable at the first of ``values`` (m,) that is not ``allowed``; they are those of the particles ``of`` (m,) of
    ``x`` (n, 2) m."""
    wrong = ~((values >= allowed.least) & (values <= allowed.most))
    if wrong.any():
        at = int(of[wrong.argmax()])
        raise Unstable(place(x, at), allowed.name, float(values[wrong.argmax()]), allowed.unit, *now)


def require_step(
    seconds: float, limits: Sequence[float], rules: Sequence[str], x: Floats, acceleration: Floats, density: Floats,
    now: Now,
) -> None:  # fmt: skip
    """Unstable when a next step of ``seconds`` is none, or longer than the ``rules`` allow by their ``limits``, s."""
    if not 0.0 < seconds <= LONGER * min(limits):
        raise no_step(seconds, rules[int(np.argmin(limits))], x, acceleration, density, *now)


def place(x: Floats, at: int) -> str:
    """A particle and its place, for messages."""
    return f"particle {at} at ({x[at, 0]:.4g}, {x[at, 1]:.4g}) m"


class JumpCheck:
    """Positions of particles at the last check, and the distance covered by the fastest since.

    A particle that came farther than `FARTHER` such ways and a spacing did not go there.
    """

    def __init__(self, spacing: float) -> None:
        self.spacing = spacing
        self.reset()

    def reset(self) -> None:
        """Discard the stored positions."""
        self._seen: Floats | None = None
        self._there: NDArray[np.bool_] | None = None
        self._way, self._time, self._max_speed = 0.0, -1.0, 0.0

    def add_time(self, time: float, max_speed: float) -> None:
        """Add a step that ends at ``time`` (s), with the largest speed ``max_speed``, m/s."""
        if self._time >= 0.0:
            self._way += (time - self._time) * max(max_speed, self._max_speed)
        self._time, self._max_speed = time, max_speed

    def check(self, x: Floats, mass: Floats, now: Now, renewed: NDArray[np.bool_] | None = None) -> None:
        """Unstable when a particle of ``mass`` (n,) kg/m, 0: not there, has jumped to its place ``x`` (n, 2) m.

        renewed (n,) : those that were put where they are, which is forgotten then: False is written.
        """
        there = mass > 0.0
        if self._seen is not None and self._there is not None:
            gone = np.hypot(x[:, 0] - self._seen[:, 0], x[:, 1] - self._seen[:, 1])
            jumped = there & self._there & ~(gone <= FARTHER * self._way + self.spacing)
            if renewed is not None:
                jumped &= ~renewed
            if jumped.any():
                at = int(jumped.argmax())
                raise Unstable(place(x, at), "way since the last look", float(gone[at]), "m", *now)
        self._seen, self._there, self._way = x.copy(), there, 0.0
        if renewed is not None:
            renewed[:] = False

"""How much longer many runs take, told by how fast each of them goes on, whatever the clocks of their machines say."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from porescale.common.core.errors import InputError
from porescale.common.record.progress import duration
from porescale.common.record.read_card import read_card, scene_end
from porescale.common.record.series import NAME as SERIES
from porescale.common.watch.growing import last_value


def share_done(folder: Path) -> float | None:
    """How much of a run is done, 0 to 1, as its card and its last row say; None where they do not."""
    try:
        end = scene_end(read_card(folder))
    except (InputError, OSError):
        return None
    reached = last_value(folder / SERIES)
    if reached is None or end is None or end <= 0:
        return None
    return min(max(reached / end, 0.0), 1.0)


@dataclass
class Progress:
    """Of runs that a scheduler makes.

    say : prints a line;  folders : of the runs that have not ended, by name;  at_a_time : how many run, set by the
    scheduler;  now : gives seconds.
    """

    say: Callable[[str], object]
    folders: dict[str, Path]
    at_a_time: int = 1
    now: Callable[[], float] = time.monotonic
    _whole: list[float] = field(default_factory=list)
    _seen: dict[str, tuple[float, float]] = field(default_factory=dict)

    def ended(self, name: str, seconds: float) -> None:
        """A run has ended that took so many seconds, 0 where that is not known."""
        self.folders.pop(name, None)
        self._seen.pop(name, None)
        if seconds > 0:
            self._whole.append(seconds)

    def words(self) -> str:
        """About how long the rest takes."""
        seconds = self.seconds()
        return "time left not known yet" if seconds is None else f"about {duration(seconds)} left"

    def seconds(self) -> float | None:
        """About how many seconds the rest takes; None while nothing tells it.

        A run that has begun takes as long as it goes on at the pace that was seen since the first look at it; one that
        has not, the mean of those that have ended and of those whose pace is known.
        """
        left = {name: self._left(name, share_done(folder)) for name, folder in self.folders.items()}
        if not left:
            return 0.0
        paces = [rest / (1 - share) for rest, share in left.values() if rest is not None and share < 1]
        whole = [*self._whole, *paces]
        if not whole:
            return None
        mean = sum(whole) / len(whole)
        rests = [mean * (1 - share) if rest is None else rest for rest, share in left.values()]
        return max(sum(rests) / max(self.at_a_time, 1), *rests)

    def _left(self, name: str, share: float | None) -> tuple[float | None, float]:
        """Seconds that a run still takes, None where its pace is not known, and how much of it is done."""
        if share is None:
            return None, 0.0
        now = self.now()
        first, at = self._seen.setdefault(name, (share, now))
        if share < first:  # begun anew
            first, at = self._seen[name] = share, now
        if share == first or now <= at:
            return None, share
        return (now - at) * (1 - share) / (share - first), share


def of(folders: Mapping[str, Path], say: Callable[[str], object]) -> Progress:
    """Progress of the runs in these folders; a first look at them is taken."""
    made = Progress(say, dict(folders))
    made.seconds()
    return made

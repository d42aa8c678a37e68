"""Cores of this machine for runs side by side, so that no two of them share one."""

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from porescale.common.core.atomic import owned

TOPOLOGY = Path("/sys/devices/system/cpu")


def usable() -> list[int]:
    """Numbers of the logical cores that this process may use: first one of each core that is built, then their twins;
    none where the system does not place processes on cores."""
    if not hasattr(os, "sched_getaffinity"):
        return []
    return sorted(os.sched_getaffinity(0), key=lambda core: (_twins(core).index(core), core))


def busy() -> float:
    """How many processes the machine had to run at a time in the last minute; 0 where the system does not say."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0


def _twins(core: int) -> list[int]:
    """The logical cores that share one that is built, ``core`` among them."""
    with suppress(OSError, ValueError):
        text = (TOPOLOGY / f"cpu{core}" / "topology" / "thread_siblings_list").read_text(encoding="ascii")
        found: list[int] = []
        for part in text.split(","):
            first, _, last = part.partition("-")
            found += range(int(first), int(last or first) + 1)
        if core in found:
            return found
    return [core]


@contextmanager
def taken(jobs: int, threads: int) -> Iterator[list[list[int]]]:
    """Cores for each of ``jobs`` runs of ``threads`` threads, while this lasts; lists without any where there are not
    enough free ones: beside other work, or beside campaigns on this machine that have taken theirs.

    What is placed on a core waits where other work comes to it.  What it gains was not resolved: on two cores with ten
    times as much to do as they have, two runs took 0.9 to 1.3 times as long placed as not, in four turns.
    """
    nothing: list[list[int]] = [[] for _ in range(jobs)]
    wanted = jobs * threads
    if jobs == 1 or wanted + round(busy()) > len(usable()):
        yield nothing
        return
    with ExitStack() as held:
        mine: list[int] = []
        for core in usable():
            if len(mine) < wanted and _take(held, core):
                mine.append(core)
        enough = len(mine) == wanted
        yield [mine[k * threads : (k + 1) * threads] for k in range(jobs)] if enough else nothing


def _take(held: ExitStack, core: int) -> bool:
    """Whether this process now has the core to itself among campaigns, until ``held`` ends."""
    try:
        folder = Path(tempfile.gettempdir()) / f"porescale-cores-{os.getuid()}" / str(core)
        folder.mkdir(parents=True, exist_ok=True)
        return held.enter_context(owned(folder))
    except OSError:
        return True


def pin(process: int, cores: Sequence[int]) -> None:
    """Let a process, just begun, use these cores alone; nothing where there are none or the system does not do it."""
    if cores and hasattr(os, "sched_setaffinity"):
        with suppress(OSError):
            os.sched_setaffinity(process, cores)

"""``python -m tests.fingerprints list | write | compare [NAMES] [--quick] [--jobs 2]``.

write : record the fingerprints of NAMES (all; patterns as "cases/*" are understood) in recorded.json.
compare : make them anew and say of each whether it is the same; exit code 1 unless all are.
"""

import argparse
import sys
import time
from collections.abc import Iterator
from fnmatch import fnmatch
from multiprocessing.connection import wait
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.fingerprints import places, record
from tests.fingerprints.names import QUICK, SUBJECTS
from tests.fingerprints.one import THREADS, Child, preload


def chosen(patterns: list[str], quick: bool) -> list[str]:
    """Names that match; SystemExit at a pattern that matches none."""
    for pattern in patterns:
        if not any(fnmatch(name, pattern) for name in SUBJECTS):
            raise SystemExit(f"no fingerprint is named {pattern!r}: see list")
    names = QUICK if quick else SUBJECTS
    return [name for name in names if not patterns or any(fnmatch(name, it) for it in patterns)]


def results(names: list[str], jobs: int, threads: list[int]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Each name with what its processes found, by numbers of threads, in the order in which they end."""
    if names:
        preload()
    waiting, running = [(name, count) for name in names for count in threads], list[Child]()
    found: dict[str, dict[str, Any]] = {name: {} for name in names}
    with TemporaryDirectory() as folder:
        while waiting or running:
            while waiting and len(running) < jobs:
                name, count = waiting.pop(0)
                running.append(Child(name, SUBJECTS[name], count, Path(folder)))
            wait([it.process.sentinel for it in running])
            for it in [it for it in running if not it.process.is_alive()]:
                running.remove(it)
                found[it.name][str(it.threads)] = it.result()
                if len(found[it.name]) == len(threads):
                    yield it.name, {str(count): found[it.name][str(count)] for count in threads}


def main() -> int:
    """Do what the command line asks; the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.fingerprints", description=__doc__)
    parser.add_argument("command", choices=("list", "write", "compare"))
    parser.add_argument("names", nargs="*", help="names or patterns; all if left out")
    parser.add_argument("--quick", action="store_true", help="the quick ones only")
    parser.add_argument("--jobs", type=int, default=1, help="processes at a time")
    parser.add_argument("--threads", type=int, nargs="+", default=list(THREADS), help="numbers of threads")
    parser.add_argument("--missing", action="store_true", help="write: only what is not recorded")
    parser.add_argument("--record", type=Path, default=record.RECORD, help="another record")
    asked = parser.parse_intermixed_args()
    names, known = chosen(asked.names, asked.quick), record.read(asked.record)
    if asked.command == "list":
        print("\n".join(names))
        return 0
    if asked.missing:
        names = [name for name in names if name not in known["fingerprints"]]
    processor = places.fetch(places.MACHINE)()["processor"]
    if asked.command == "compare" and known["processor"] not in (None, processor):
        print(f"warning: recorded on {known['processor']}, this is {processor}: last bits may differ", flush=True)
    bad, began = 0, time.perf_counter()
    if asked.command == "compare":
        new = [name for name in names if name not in known["fingerprints"]]
        names, bad = [name for name in names if name not in new], len(new)
        print(*(f"{name}: fails: not recorded\n" for name in new), sep="", end="", flush=True)
    for k, (name, found) in enumerate(results(names, asked.jobs, asked.threads), 1):
        if asked.command == "write":
            word = record.kept(name, found, processor, asked.record)
        else:
            word = record.compared(known["fingerprints"][name], found)
        bad += not word.startswith(("same", "written"))
        print(f"[{k}/{len(names)}] {name}: {word}", flush=True)
    print(f"{len(names)} names made, {bad} not as they should be, {time.perf_counter() - began:.0f} s", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())

"""One fingerprint in a process of its own: forked, so that the imports are paid for once."""

import contextlib
import gc
import io
import json
import os
import time
import traceback
import warnings
from importlib import import_module
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.fingerprints import places
from tests.fingerprints.digest import fingerprint
from tests.fingerprints.subjects import Subject

THREADS = (1, 2)
PRELOADED = ("numba", "numpy", "scipy.spatial", "pydantic", "matplotlib.figure", "h5py")
"""What every child needs."""


def preload() -> None:
    """Import in the parent what no child need import again; no kernel is compiled or run here."""
    os.environ.setdefault("NUMBA_NUM_THREADS", str(max(THREADS)))
    os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")  # threads that wait leave the cores to others
    import_module(places.KERNELS)
    for name in PRELOADED:
        import_module(name)
    gc.freeze()


def taken(subject: Subject, threads: int) -> dict[str, Any]:
    """Hash, parts, steps and seconds of a subject, in this process; packings are settled anew."""
    import numba

    numba.set_num_threads(threads)
    kept, began = os.environ.get("XDG_CACHE_HOME"), time.perf_counter()
    with TemporaryDirectory() as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        try:
            with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
                warnings.simplefilter("ignore")
                value, steps = subject.take(threads)
        finally:
            os.environ.pop("XDG_CACHE_HOME")
            if kept is not None:
                os.environ["XDG_CACHE_HOME"] = kept
    whole, parts = fingerprint(value)
    return {"hash": whole, "parts": parts, "steps": steps, "seconds": round(time.perf_counter() - began, 2)}


def _child(subject: Subject, threads: int, answer: Path) -> None:
    """In the child: the fingerprint, or what went wrong, into a file."""
    try:
        found = taken(subject, threads)
    except BaseException as error:
        trace = traceback.extract_tb(error.__traceback__)[-1]
        found = {"error": f"{type(error).__name__}: {error} ({Path(trace.filename).name}:{trace.lineno})"}
    answer.write_text(json.dumps(found), encoding="utf-8")


class Child:
    """A subject at work on so many threads, in a process of its own: what modules keep serves no other."""

    def __init__(self, name: str, subject: Subject, threads: int, room: Path) -> None:
        self.name, self.threads = name, threads
        self.answer = room / f"{name.replace('/', '_')} {threads}.json"
        self.process = get_context("fork").Process(target=_child, args=(subject, threads, self.answer), daemon=True)
        self.process.start()

    def result(self) -> dict[str, Any]:
        """What it found; {"error": …} where it crashed."""
        self.process.join()
        if not self.answer.exists():
            return {"error": f"ended with code {self.process.exitcode}"}
        found: dict[str, Any] = json.loads(self.answer.read_text(encoding="utf-8"))
        return found

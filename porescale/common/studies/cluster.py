"""Points over other machines, through dask.distributed: an optional extra, imported on request.

Every worker must see the folders of scene and runs under the same paths, and have this package installed.
"""

import subprocess
import sys
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.studies.runner import Run

CONNECT_SECONDS = 20.0


def elsewhere(module: str, words: list[str]) -> tuple[int, str]:
    """On a worker: run a command line of ``module``; exit code and what it said on stderr."""
    done = subprocess.run(
        [sys.executable, "-m", module, *words], capture_output=True, text=True, errors="replace", check=False
    )
    return done.returncode, done.stderr


def connect(address: str, module: str) -> tuple[Run, int]:
    """A runner on the scheduler at ``address``, and how many points it can take at a time; InputError if none."""
    try:
        from distributed import Client
    except ImportError:
        problem = "needs dask.distributed"
        raise InputError(Fault("--scheduler", address, problem, repair="pip install 'porescale[cluster]'")) from None
    try:
        client: Any = Client(address, timeout=CONNECT_SECONDS)
        slots = len(client.ncores())
    except (OSError, ValueError, TypeError) as error:
        said = " ".join(str(error).split())[:120]
        repair = "name it as tcp://host:8786, as `dask scheduler` prints it"
        raise InputError(Fault("--scheduler", address, f"does not answer ({said})", repair=repair)) from None
    if not slots:
        raise InputError(Fault("--scheduler", address, "has no workers", repair="start some with `dask worker`"))

    def run(words: list[str]) -> tuple[int, str]:
        """One point on any worker; never shared, since a run folder is no pure function's value."""
        found: tuple[int, str] = client.submit(elsewhere, module, words, pure=False).result()
        return found

    return run, slots

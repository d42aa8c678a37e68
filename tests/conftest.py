"""Options of the test suite: slow tests are left out unless asked for, and can be run in shares."""

import gc
import os
import random
import signal
import sys
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from tests.compile_times import CompileTimes
from tests.shares import long_first, share

pytest_plugins = ["tests.browser"]

# The same examples on every machine, however slow: a failure can be repeated, and a kernel may be compiled within one.
settings.register_profile("steady", deadline=None, derandomize=True)
settings.load_profile("steady")

# Compiling makes many objects and few circles of them: looking for those after every 700 took a seventh of its time.
gc.set_threshold(50_000, 20, 50)

# Tests compare one thread with two, on machines with one core too; read by numba when it is first imported.
os.environ.setdefault("NUMBA_NUM_THREADS", str(max(2, os.cpu_count() or 1)))
# Kernels of a GPU run in numba's simulator, with 0 on the GPU of the machine.  A variable, not a setting made later:
# numba reads all its settings anew when a variable of its own changes.
os.environ.setdefault("NUMBA_ENABLE_CUDASIM", "1")
# Threads of OpenBLAS spin while they wait for each other: beside other work a solve of 1 s takes minutes.  Read at the
# first import of numpy.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# What a shell starts in the background ignores Ctrl-C, until a notebook's client takes the handler of a terminal back.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--share", help="of the slow tests run an n-th, the k-th, beside the others: k/n")
    parser.addoption("--shuffle", type=int, help="run files, and the tests of each, in an order by this seed")
    parser.addoption("--compile-times", action="store_true", help="say which kernels took how long to compile")


def pytest_configure(config: pytest.Config) -> None:
    from porescale.common.compiled import ahead
    from porescale.common.compiled.cuda import simulated
    from porescale.common.compiled.jit import when_compiling  # and with it numpy, once the variables above are set

    # A second process that compiles a run's kernels takes 8 s for a scene of which none is kept, and has no core of its
    # own beside two workers: for the tests there is one core, but in those of that process.
    ahead.cores = lambda: 1

    if simulated():
        from tests import simulator

        simulator.use()

    # In systems of a few cells waiting for a second thread is all that is done, and the other worker needs the core.
    when_compiling(lambda machine: machine.numba.set_num_threads(1))
    if config.option.compile_times:
        plugin = CompileTimes()
        config.pluginmanager.register(plugin)
        if hasattr(config, "workerinput") or not config.option.numprocesses:
            plugin.listen()


@pytest.hookimpl(trylast=True)  # once tests that share a parameter stand together
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    slow = [item for item in items if item.get_closest_marker("slow")]
    part, parts = map(int, (config.option.share or "0/1").split("/"))
    kept = share(slow, part, parts) if config.option.share or config.option.markexpr else []
    left = set(slow) - set(kept)
    items[:] = [item for item in items if item not in left]
    config.hook.pytest_deselected(items=list(left))
    if hasattr(config, "workerinput"):
        long_first(items)
    if config.option.shuffle is not None:
        dice = random.Random(config.option.shuffle)
        files = {path: dice.random() for path in sorted({item.path for item in items})}
        places = {item.nodeid: dice.random() for item in items}
        items.sort(key=lambda item: (files[item.path], places[item.nodeid]))


def process_state() -> dict[str, Any]:
    """What one test could change for the next: folder, handlers of signals, tracing, environment."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM, signal.SIGXFSZ)
    return {
        "folder": os.getcwd(),
        "signals": {number: signal.getsignal(number) for number in numbers},
        "tracing": tracemalloc.is_tracing(),
        "environment": {key: value for key, value in os.environ.items() if key != "PYTEST_CURRENT_TEST"},
    }


@pytest.fixture(autouse=True)
def the_next_test_finds_the_process_as_it_was() -> Iterator[None]:
    """One thread for the kernels again, and an error where a test leaves anything else changed.

    Libraries may set variables of the environment when they are imported.
    """
    before = process_state()
    yield
    if "numba" in sys.modules:
        sys.modules["numba"].set_num_threads(1)
    after = process_state()
    after["environment"] = {key: after["environment"].get(key) for key in before["environment"]}
    tracemalloc.stop()
    os.chdir(before["folder"])
    assert after == before


@pytest.fixture
def without_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs in this process end without pictures and films, which take longer than small runs do; with their tables."""
    monkeypatch.setattr("porescale.common.pictures.film.painted", lambda folder, look: [])
    monkeypatch.setattr("porescale.common.pictures.picture.paint_last", lambda folder, name, look: Path(folder))


@pytest.fixture
def toy(tmp_path: Path, monkeypatch, capsys) -> Callable[..., tuple[int, str, list[str]]]:
    """Runs a command line in an empty folder; gives exit code, stdout, stderr lines."""
    from porescale.common.cli.application import application, main
    from tests.reference.toy_package import TOY

    monkeypatch.chdir(tmp_path)

    def _toy(*tokens: str) -> tuple[int, str, list[str]]:
        code = main(application(TOY), tokens)
        said = capsys.readouterr()
        return code, said.out, said.err.splitlines()

    return _toy

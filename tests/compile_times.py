"""Where the time of the suite goes: seconds spent compiling, kernel by kernel, printed by `pytest --compile-times`."""

import time
from collections import Counter
from typing import Any

import pytest

SHOWN = 15
"""Kernels that are listed."""


class CompileTimes:
    """Listens to numba in this process, and gathers what the worker processes of pytest-xdist heard."""

    def __init__(self) -> None:
        self.seconds: Counter[str] = Counter()
        self.times: Counter[str] = Counter()
        self._open: list[list[float]] = []  # start, seconds of kernels compiled on the way

    def listen(self) -> None:
        """From now on, note what is compiled; what is read from disk is not."""
        from numba.core import event

        class Listener(event.Listener):  # type: ignore[misc]
            """Start and end of each compilation; one may lie within another."""

            def on_start(listener, event: Any) -> None:
                self._open.append([time.perf_counter(), 0.0])

            def on_end(listener, event: Any) -> None:
                start, inner = self._open.pop()
                took = time.perf_counter() - start
                if self._open:
                    self._open[-1][1] += took
                function = event.data["dispatcher"].py_func
                name = f"{function.__module__}.{function.__qualname__}"
                self.seconds[name] += took - inner
                self.times[name] += 1

        event.register("numba:compile", Listener())

    @pytest.hookimpl
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """A worker hands over what it has heard."""
        output = getattr(session.config, "workeroutput", None)
        if output is not None:
            output["compiled"] = {name: [self.seconds[name], self.times[name]] for name in self.seconds}

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any, error: object) -> None:
        """The main process adds it up."""
        for name, (seconds, times) in getattr(node, "workeroutput", {}).get("compiled", {}).items():
            self.seconds[name] += seconds
            self.times[name] += times

    @pytest.hookimpl
    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        """The slowest kernels, and all together."""
        write = terminalreporter.write_line
        write(f"compiling: {self.seconds.total():.0f} s for {self.times.total()} kernels and types, most for")
        for name, seconds in self.seconds.most_common(SHOWN):
            write(f"{seconds:8.1f} s in {self.times[name]:3d}  {name}")

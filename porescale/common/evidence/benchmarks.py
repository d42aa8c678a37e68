"""Benchmarks: rates in updates per second, and the share of the memory bandwidth measured beside them."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from porescale.common.api.report import shown
from porescale.common.core.errors import Fault, InputError
from porescale.common.evidence.register import Register
from porescale.common.evidence.timing import interleaved, repeated, seconds_of

if TYPE_CHECKING:
    from rich.table import Table

    from porescale.common.evidence.bandwidth import Copy
    from porescale.common.evidence.device_bandwidth import DeviceCopy

Dtype = Literal["float32", "float64"]
CPU, GPU = "cpu", "gpu"
LARGEST = 10_000_000
"""Largest size that is accepted: of discs some 10 GiB, of cells along a side more than any machine holds."""


@dataclass(frozen=True)
class Work:
    """Something to time.

    call : does it once;  updates : cells, discs, particles or image pairs that a call updates;
    unit : "cells/s" and so on;  size : as in the row;  bytes : what one update must move between memory and
    processor (0: not bound by memory);  variant : added to the row's name when a benchmark times several;
    remark : a further line of text, made once;  yardstick : whether the others of its benchmark are held against it,
    in turns; the last of them;  memory : bytes of what a call goes over;  gpu : whether a call steps on a GPU and
    waits for it.
    """

    call: Callable[[], object]
    updates: float
    unit: str
    size: int
    bytes: float = 0.0
    variant: str = ""
    remark: Callable[[], str] | None = None
    yardstick: bool = False
    memory: int = 2**28
    gpu: bool = False


PLAIN = "plain"
"""Variant of the fluid alone, which is the yardstick of what is done with bodies in it."""

Prepare = Callable[..., Work | Sequence[Work]]


@dataclass(frozen=True)
class Benchmark:
    """A registered benchmark.  prepare : ``(size | None, threads, dtype) -> Work``, one or several;  gpu : whether it
    also takes ``device="gpu"``."""

    name: str
    prepare: Prepare
    gpu: bool = False


@dataclass(frozen=True)
class Row:
    """A measured rate; the fields are the JSON keys.

    rate : updates per second, median;  seconds : of one call, median;  bytes : per update;
    share_of_bandwidth : rate * bytes over the in-place bandwidth of as much memory, the best that was seen in turns
    with it, by its own rounds too: at most 1; None if bytes is 0;  device : "cpu", or the name of the GPU, whose
    memory the share is of then.
    """

    name: str
    size: int
    threads: int
    dtype: str
    rate: float
    unit: str
    seconds: float
    bytes: float
    share_of_bandwidth: float | None
    device: str = CPU


class Benchmarks(Register[Benchmark]):
    """A register of benchmarks.

    remarks : of the last ``run``: what part of the rate of its yardstick a benchmark has, measured in turns.
    """

    what = "benchmark"

    def __init__(self, rows: Iterable[Benchmark] = ()) -> None:
        super().__init__(rows)
        self.remarks: list[str] = []

    def row(self, name: str, *, gpu: bool = False) -> Callable[[Prepare], Prepare]:
        """Register the decorated function: ``(size | None, threads, dtype) -> Work``, one or several.

        ``size`` None means the benchmark's own size; the number of threads is already set for kernels.  ``gpu`` : it
        also takes ``device="gpu"``.
        """

        def register(prepare: Prepare) -> Prepare:
            """Keep ``prepare`` under the name; returns it."""
            self.add(Benchmark(name, prepare, gpu))
            return prepare

        return register

    def run(
        self,
        names: Sequence[str] = (),
        *,
        size: int | None = None,
        threads: int | None = None,
        dtype: Dtype = "float64",
        device: str = CPU,
        min_seconds: float = 1.0,
    ) -> Iterator[Row]:
        """Time the benchmarks named (without names all that there are for the device), one after another, yielding each
        row once it is measured.

        Raises InputError on unknown names, sizes below 1 and threads or a device that this machine does not have,
        before anything is timed; a benchmark may check more.
        """
        from porescale.common.compiled.jit import set_threads

        chosen = self.chosen(names)
        if device == GPU:
            chosen = _on_gpu(chosen, names)
        if size is not None and not 1 <= size <= LARGEST:
            raise InputError(Fault("--size", size, "is out of range", "", f"1 to {LARGEST}"))
        self.remarks = []
        return self._timed(chosen, size, set_threads(threads), dtype, device, min_seconds)

    def _timed(
        self, chosen: Sequence[Benchmark], size: int | None, count: int, dtype: Dtype, device: str, min_seconds: float
    ) -> Iterator[Row]:
        """Prepare and time each benchmark."""
        for it in chosen:
            made = it.prepare(size, count, dtype, **({"device": GPU} if device == GPU else {}))
            works = [made] if isinstance(made, Work) else list(made)
            titles = [f"{it.name}.{work.variant}" if work.variant else it.name for work in works]
            for title, work in zip(titles, works, strict=True):
                yield _measured(title, work, count, dtype, min_seconds)
                if work.remark is not None:
                    self.remarks.append(f"{title}: {work.remark()}")
            for title, work in zip(titles[:-1], works, strict=False) if works[-1].yardstick else ():
                last = works[-1]
                share = interleaved(work.call, last.call) * work.updates / last.updates
                self.remarks.append(f"{title}: {share:.2f} of the rate of {titles[-1]}, in turns")


def _on_gpu(chosen: Sequence[Benchmark], names: Sequence[str]) -> list[Benchmark]:
    """Those that run on a GPU; InputError where one was asked for by name that does not, or without a GPU."""
    from porescale.common.compiled.cuda import require_device

    able = [it for it in chosen if it.gpu]
    if lacking := [it.name for it in chosen if not it.gpu and it.name in names]:
        raise InputError(Fault("--device", GPU, f"does not run {', '.join(lacking)}", repair='take "cpu"'))
    if not able:
        raise InputError(Fault("--device", GPU, "has no benchmark here", repair='take "cpu"'))
    require_device()
    return able


def _copy_of(work: Work, threads: int, dtype: Dtype) -> Copy | DeviceCopy:
    """What gives the bandwidth that the work is held against."""
    if work.gpu:
        from porescale.common.evidence.device_bandwidth import DeviceCopy

        return DeviceCopy(work.memory)
    from porescale.common.evidence.bandwidth import Copy

    return Copy(threads, dtype, work.memory)


def _measured(name: str, work: Work, threads: int, dtype: Dtype, min_seconds: float) -> Row:
    """Time one piece of work; if it is bound by memory, in turns with the copy that gives the bandwidth."""
    rates: list[float] = []
    copies: list[float] = []
    copy = None
    work.call()
    if work.bytes:
        copy = _copy_of(work, threads, dtype)
        copy.seconds()  # the first one compiles

    def once() -> float:
        """Seconds of a call; notes the bandwidth that it needed, and that of the copies."""
        seconds = seconds_of(work.call)
        if copy is not None:
            rates.append(work.updates * work.bytes / seconds)
            copies.append(copy.bytes / copy.seconds())
        return seconds

    seconds = statistics.median(repeated(once, min_seconds))
    share = statistics.median(rates) / max(*rates, *copies) if rates else None
    return Row(
        name, work.size, threads, dtype, work.updates / seconds, work.unit, seconds, work.bytes, share, _device(work)
    )  # fmt: skip


def _device(work: Work) -> str:
    """The entry ``device`` of a row."""
    if not work.gpu:
        return CPU
    from porescale.common.compiled.cuda import describe

    return describe()[0]


def table(rows: Sequence[Row]) -> Table:
    """Rows as a table for the terminal."""
    from rich.table import Table
    from rich.text import Text

    made = Table(box=None, pad_edge=False, header_style="bold")
    for heading in ("name", "size", "threads", "dtype", "rate", "", "s/call", "bytes", "of bandwidth", "on"):
        made.add_column(heading, no_wrap=heading in ("name", "rate", ""))  # half a number is none
    for row in rows:
        share = None if row.share_of_bandwidth is None else f"{100 * row.share_of_bandwidth:.0f} %"
        numbers = f"{row.rate:.4g}", row.unit, f"{row.seconds:.3g}", row.bytes or None, share, row.device
        cells = row.name, row.size, row.threads, row.dtype, *numbers
        made.add_row(*(Text(shown(cell)) for cell in cells))
    return made

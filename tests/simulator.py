"""numba's simulator of a GPU with one thread of Python for a block, in place of one for each of its threads.

Starting and watching 256 threads takes a third of the time of a launch.  No kernel here has a barrier, so that threads
may be taken one after another; a kernel with one is refused.  Nor are the names of a device function looked through at
each call, for the module that the simulator puts in place of ``numba.cuda``, where it has no such name.
"""

from typing import Any

from numba import cuda
from numba.cuda.simulator import kernel

THREADS = kernel.BlockManager.run
"""numba's own way, with all threads at once."""
_call = kernel.FakeCUDAKernel.__call__


class InTurn(kernel.BlockThread):  # type: ignore[misc]
    """A thread that is all threads of a block, from the first to the last."""

    def __init__(self, manager: Any, block: tuple[int, ...], arguments: tuple[Any, ...]) -> None:
        places = list(kernel.np.ndindex(*manager._block_dim))
        wide, high = (*manager._block_dim, 1, 1)[:2]

        def all_of_them() -> None:
            """The kernel, once for each thread."""
            for place in places:
                x, y, z = place
                self.threadIdx, self.thread_id = kernel.Dim3(x, y, z), x + wide * (y + high * z)
                manager._f(*arguments)

        super().__init__(all_of_them, manager, block, places[0], manager._debug)

    def syncthreads(self) -> None:
        """A barrier would wait for threads whose turn has not come."""
        raise NotImplementedError("a barrier in a kernel, which needs all threads at once: tests/simulator.py")


def _in_turn(manager: Any, block: tuple[int, ...], *arguments: Any) -> None:
    """Run the kernel for all threads of a block."""
    thread = InTurn(manager, block, arguments)
    thread.start()
    thread.join()
    if thread.exception:
        raise thread.exception[0].with_traceback(thread.exception[1])


def _called(function: Any, *arguments: Any) -> Any:
    """Call a kernel or a device function."""
    known = vars(function)
    if "_plain" not in known:
        known["_plain"] = function._device and not any(it is cuda for it in function.fn.__globals__.values())
    return function.fn(*arguments) if known["_plain"] else _call(function, *arguments)


def use() -> None:
    """Let the simulator of this process run blocks so."""
    kernel.BlockManager.run, kernel.FakeCUDAKernel.__call__ = _in_turn, _called

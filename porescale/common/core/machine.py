"""The machine that numbers are measured on."""

import platform
import sys
import time
from pathlib import Path
from typing import Any


def machine() -> dict[str, Any]:
    """Processor, cores this process may use, memory (bytes), operating system."""
    return {"processor": _processor(), "cores": cores(), "memory": memory_bytes(), "system": platform.platform()}


def memory_bytes() -> int:
    """Memory of this machine."""
    from psutil import virtual_memory

    return int(virtual_memory().total)


def age() -> float:
    """Wall-clock seconds since this process was started."""
    import psutil

    return max(time.time() - float(psutil.Process().create_time()), 0.0)


def cores() -> int:
    """Cores that this process may use, where the system limits them to some; else those of the machine."""
    import psutil

    process = psutil.Process()
    return len(process.cpu_affinity()) if hasattr(process, "cpu_affinity") else psutil.cpu_count() or 1


def _processor() -> str:
    """The processor's own name where the system gives it."""
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def peak_bytes() -> int:
    """Memory that this process had at most, so far."""
    try:
        import resource
    except ImportError:  # not a POSIX system
        from psutil import Process

        now = Process().memory_info()
        return int(getattr(now, "peak_wset", now.rss))
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)

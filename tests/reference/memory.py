"""What a step allocates, measured."""

from __future__ import annotations

import tracemalloc


def growth(step, steps=50):
    """Most bytes by which memory grew within one of ``steps`` steps; numpy reports its arrays to tracemalloc."""
    for _ in range(4):
        step()
    tracemalloc.start()
    try:
        worst = 0
        for _ in range(steps):
            tracemalloc.reset_peak()
            before = tracemalloc.get_traced_memory()[0]
            step()
            worst = max(worst, tracemalloc.get_traced_memory()[1] - before)
    finally:
        tracemalloc.stop()
    return worst

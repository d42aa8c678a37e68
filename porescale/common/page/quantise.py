"""Arrays as a page holds them: whole numbers of one to four bytes with a low end and a step, or float32.

A value is ``low + step * code``.  The largest code stands for what is no number.  Codes of two bytes and more lie apart
by bytes, the lowest first, and codes of cells are differences from the cell to the left: both make them smaller when
they are deflated.  `values.js` (decode) turns them back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from porescale.common.core.types import AnyArray

HALF_ULP = 2.0**-24
"""Largest relative error of a number in single precision, in which the page computes."""
ALIGNED = 8


@dataclass(frozen=True)
class Precision:
    """How finely a page holds a run.

    bits : of values in cells, 8 or 16 (those at points have 16);  every : of cells, in either direction, one is
    held;  thin : of frames, one is held;  full : float32 of everything, in place of ``bits``.
    """

    bits: int = 16
    every: int = 1
    thin: int = 1
    full: bool = False


@dataclass
class Packed:
    """Parts of a frame one after the other."""

    content: bytearray

    def add(self, values: AnyArray, bits: int, *, cells: bool, full: bool) -> dict[str, Any]:
        """Append ``values``, (n,) or (n, w), of cells (ny, nx) or (ny, nx, w); returns how they are read.

        {"type": "u1" to "u4" or "f4", "at": first byte, "width": w, "low", "step": of each component, "whole": whether
        they are whole numbers, "error": largest, "across": cells of a row where codes are differences}
        """
        if np.asarray(values).dtype.kind == "b":
            values = values.astype(np.uint8)
        axes = 2 if cells else 1
        parts = [values] if values.ndim == axes else [values[..., k] for k in range(min(2, values.shape[-1]))]
        whole = values.dtype.kind in "iu"
        spec: dict[str, Any] = {"at": len(self.content), "width": len(parts)}
        if full and not whole:
            data = np.concatenate([np.asarray(part, "<f4").ravel() for part in parts])
            spec |= {"type": "f4", "error": _rounding(values) if values.dtype != np.float32 else 0.0}
            self._append(data.tobytes())
            return spec
        size = _whole_bytes(parts) if whole else bits // 8
        low, step, codes, worst = [], [], [], 0.0
        for part in parts:
            first, width, code = _whole(part, size) if whole else _codes(part, size)
            low.append(first)
            step.append(width)
            codes.append(code)
            worst = max(worst, 0.0 if whole else 0.5 * width + _rounding(part))
        spec |= {"type": f"u{size}", "low": low, "step": step, "error": worst, "whole": whole}
        if cells:
            spec["across"] = int(parts[0].shape[1])
            codes = [np.diff(code, axis=1, prepend=code.dtype.type(0)) for code in codes]
        joined = np.concatenate([code.ravel() for code in codes])
        self._append(joined.view(np.uint8).reshape(-1, size).T.tobytes())
        return spec

    def _append(self, content: bytes) -> None:
        self.content += content
        self.content += bytes(-len(self.content) % ALIGNED)


def _codes(part: AnyArray, size: int) -> tuple[float, float, AnyArray]:
    """Low end, step and codes of numbers; what is not finite gets the largest code."""
    most = 256**size - 2
    there = np.isfinite(part)
    known = part[there]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)
    step = (high - low) / most
    with np.errstate(invalid="ignore"):
        code = np.rint((np.asarray(part, float) - low) / (step or 1.0))
    return low, step, np.where(there, code, most + 1).astype(f"<u{size}")


def _whole(part: AnyArray, size: int) -> tuple[float, float, AnyArray]:
    """Low end, step 1 and codes of whole numbers, which are exact."""
    low = int(part.min()) if part.size else 0
    return float(low), 1.0, (part.astype(np.int64) - low).astype(f"<u{size}")


def _whole_bytes(parts: list[AnyArray]) -> int:
    """Bytes that hold the codes of whole numbers; those that need more than four are cut there."""
    span = max((int(part.max()) - int(part.min()) for part in parts if part.size), default=0)
    return 1 if span < 255 else 2 if span < 65535 else 4


def _rounding(values: AnyArray) -> float:
    """Error of single precision in the page, of what is finite."""
    return HALF_ULP * float(np.abs(values[np.isfinite(values)]).max(initial=0.0))

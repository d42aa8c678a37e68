"""Arrays as annotations name them; shapes stand in the docstrings."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
"""Real numbers in double precision."""
Singles = NDArray[np.float32]
"""Real numbers in single precision."""
Reals = NDArray[np.floating]
"""Real numbers in either precision."""
Integers = NDArray[np.int64]
"""Indices and counts."""
Flags = NDArray[np.bool_]
"""Truth values."""
AnyArray = NDArray[Any]
"""Elements of any kind."""

"""Ranges of quantities, SI: far beyond what grains and water need.

What lies outside is a slip of unit or exponent, and would end in numbers that are none.
"""

from typing import Any

LENGTH: Any = {"ge": 1e-9, "le": 1e3}
"""Range of lengths, m."""
PLACE: Any = {"ge": -1e3, "le": 1e3}
"""Range of coordinates, m."""
SPEED: Any = {"ge": -1e4, "le": 1e4}
"""Range of velocity components, m/s."""
SPIN: Any = {"ge": -1e7, "le": 1e7}
"""Range of angular velocities, rad/s."""
TIME: Any = {"ge": 1e-12, "le": 1e9}
"""Range of times, s."""
DENSITY: Any = {"ge": 1e-3, "le": 1e5}
"""Range of densities, kg/m^3."""
FRICTION: Any = {"ge": 0, "le": 1e3}
"""Range of the coefficient of friction."""

"""Bounds of the sections: wider than any flow of water in practice, and inside them every product is finite."""

SMALLEST, LARGEST = 1e-6, 1e5
"""Smallest and largest length that a scene may give, m."""
WEAKEST = 1e-6
"""Gravity other than none, m/s²."""
MOST = 100_000_000
"""Largest number of particles of a scene: 60 GB of memory."""
WHOLE = 1e-6
"""Share of a spacing by which a length may miss a whole number of them."""


def spacings(length: float, spacing: float) -> int:
    """The whole number (1 at least) of spacings nearest to a length, both in m."""
    return max(1, round(length / spacing))

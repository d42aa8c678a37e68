"""The version of both packages, from one place: pyproject.toml reads it here."""

VERSION = "0.1.0"
"""Version of porescale: major, minor, patch."""

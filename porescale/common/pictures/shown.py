"""Pictures and films as values that notebooks display."""

from dataclasses import dataclass
from html import escape
from pathlib import Path

from porescale.common.core.atomic import write_bytes
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import path_of
from porescale.common.core.html import data_url
from porescale.common.core.types import AnyArray

LARGEST = 50 * 2**20
"""Bytes of a film that a notebook holds within itself; a larger one is named."""


@dataclass(frozen=True, repr=False)
class Picture:
    """A picture in memory.  pixels : (height, width, 3) uint8 RGB;  title : what it shows."""

    pixels: AnyArray
    title: str = ""

    def save(self, path: Path | str) -> Path:
        """Write it as a PNG file, whole or not at all; returns the path.  InputError for a name of another format."""
        path = path_of("path", path, "name a file")
        if path.suffix.lower() not in ("", ".png"):
            repair = f"name it {path.stem}.png; run.figure writes other formats"
            raise InputError(Fault("path", str(path), "is not that of a PNG file", repair=repair))
        write_bytes(path, self._repr_png_())
        return path

    def __repr__(self) -> str:
        height, width = self.pixels.shape[:2]
        return f"Picture of {width} x {height} pixels{f': {self.title}' if self.title else ''}"

    def _repr_png_(self) -> bytes:
        from porescale.common.pictures.picture import png

        return png(self.pixels)


@dataclass(frozen=True, repr=False)
class Film:
    """A film on disk, which browsers play.  path : of the file, .mp4 or .webm."""

    path: Path

    def __fspath__(self) -> str:
        return str(self.path)

    def __repr__(self) -> str:
        return f"Film {str(self.path)!r}"

    def _repr_html_(self) -> str:
        if self.path.stat().st_size > LARGEST:
            return escape(repr(self))
        url = data_url(f"video/{self.path.suffix[1:]}", self.path.read_bytes())
        return f"<video controls loop style='max-width:100%' src='{url}'></video>"

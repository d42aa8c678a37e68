"""What a scene was made from: its tables as a file would have them, and where they come from."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any, Literal, get_origin

from pydantic import BaseModel


@dataclass(frozen=True)
class Source:
    """Where a scene comes from.

    file : its TOML file, None of one made in Python;  folder : what names of files in it are relative to, None: the
    working directory;  name : of the scene;  quality : chosen level or None;  levels : those that the file has;
    settings : ``section.key=value``, laid over the file since.
    """

    file: Path | None = None
    folder: Path | None = None
    name: str = ""
    quality: str | None = None
    levels: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()


def plain(value: Any, *, sections: bool = False) -> Any:
    """``value`` with tables for sections, lists for tuples and arrays, numbers for those of numpy, texts for paths.

    None within a table is left out, as TOML has none;  sections : they stay as they are.
    """
    if isinstance(value, BaseModel):
        return value if sections else plain(_given(value))
    if isinstance(value, Mapping):
        return {str(key): plain(below, sections=sections) for key, below in value.items() if below is not None}
    if isinstance(value, list | tuple):
        return [plain(below, sections=sections) for below in value]
    if isinstance(value, PurePath):
        return value.as_posix()
    if hasattr(value, "tolist"):  # an array, or a number of numpy
        return value.tolist()
    return value


def _given(section: BaseModel) -> dict[str, Any]:
    """What of a section was given, by the names of a file; and the word by which it is told from others."""
    fields = type(section).model_fields
    return {
        field.alias or name: getattr(section, name)
        for name, field in fields.items()
        if name in section.model_fields_set or get_origin(field.annotation) is Literal
    }

"""What every scene can do as an object of Python: changed copies, where it comes from, equality by its values."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

import pydantic

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import path_of
from porescale.common.core.html import data_url
from porescale.common.schema import scene_file
from porescale.common.schema.describe import as_html, in_lines
from porescale.common.schema.messages import Key, dotted, every_key, nearest
from porescale.common.schema.sections import Section, of_a_setting, scene_as_dict, try_scene
from porescale.common.schema.written import Source, plain

if TYPE_CHECKING:
    from porescale.common.pictures.shown import Picture


class SceneBase(Section):
    """Base of the scenes of all programs.  Two are equal where all their values are, wherever they come from."""

    follows: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("quality_default", "quality"), "the file alone; --quality chooses one of its levels"
    )
    """Keys that there are none of, and what they follow from."""

    _source: Source = pydantic.PrivateAttr(default_factory=Source)
    _written: dict[str, Any] = pydantic.PrivateAttr(default_factory=dict)
    """Its tables as they were given, before defaults and what follows from other keys."""

    def __init__(self, /, **keys: Any) -> None:
        """A scene of its sections, as tables or sections; InputError with every fault, as of a file."""
        super().__init__(**keys)
        self._remember(keys, Source())

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def __eq__(self, other: object) -> bool:
        """Whether all values are equal, those of defaults included."""
        if type(self) is not type(other):
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in type(self).model_fields)

    __hash__ = Section.__hash__

    @property
    def source(self) -> Source:
        """File, name, quality level and settings that the scene comes from."""
        return self._source

    @property
    def name(self) -> str:
        """Name of the scene: of its file, or of the file's folder if that is a scene.toml; "" if made in Python."""
        return self._source.name

    def to_dict(self) -> dict[str, Any]:
        """The full scene with its defaults, in SI, as JSON-able tables: ``Scene(**scene.to_dict())`` equals it."""
        return scene_as_dict(self)

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """JSON Schema (2020-12) of scene files, for editors: keys, units, ranges, choices, quality levels."""
        from porescale.common.schema.json_schema import scene_schema

        return scene_schema(cls)

    def with_(self, changes: Mapping[str, Any], /) -> Self:
        """A copy with other values: ``scene.with_({"fluid.spacing": "0.3 mm", "probe[0].x": 0.1})``; this one stays.

        changes : key -> SI number, text with a unit, list or whole table; None takes the key or section out, as if
        the scene's file did not have it.  What follows from changed keys follows again, and files are read again.
        Raises InputError with every fault, worded as those of a file.
        """
        if not isinstance(changes, Mapping):
            repair = 'write it as scene.with_({"time.end": 0.1})'
            raise InputError(Fault("with_", type(changes).__name__, "is no mapping of keys to values", repair=repair))
        table: Mapping[str, Any] = self._written
        keys: list[Key] = []
        faults: list[Fault] = []
        for name, value in changes.items():
            try:
                key = scene_file.parse_name(name)
                table = self._without(table, key) if value is None else scene_file.assign(table, key, plain(value))
                keys.append(key)
            except InputError as error:
                faults += [replace(fault, file="") for fault in error.faults]
        source = self._source
        made, wrong = try_scene(type(self), table, source.folder)
        for key, fault in wrong:
            own = fault.file or of_a_setting(key, keys, self._written)
            faults.append(fault if own else replace(fault, file=str(source.file or "")))
        if made is None or faults:
            raise InputError(faults)
        settings = [scene_file.setting_text(name, value) for name, value in changes.items()]
        made._remember(table, replace(source, settings=(*source.settings, *settings)))
        return made

    def save(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write the scene as a TOML file that loads to an equal scene, whole or not at all; returns its path.

        path : file, or an existing folder, which gets a scene.toml.  The file has the keys that differ from the
        defaults, as they were written, with the chosen quality level and all changes in them; names of files that the
        scene uses are those seen from the new place.  Raises InputError where there is a file, unless ``overwrite``.
        """
        from porescale.common.schema.save import save

        return save(self, self._written, self._source.folder, path_of("path", path, "name a file"), overwrite)

    def picture(self) -> Picture:
        """The built initial state to scale, with everything in the scene labelled and a lens on its resolution.

        It is what `check --picture` draws, and displays in notebooks; ``.save(path)`` writes it.  A packing is settled
        first, or read from the cache; that can take seconds.  InputError for what the scene must not request.
        """
        package = import_module(type(self).__module__.partition(".")[0])  # of this very class: its own builder
        made: Picture = package.build(self).scene_picture()
        return made

    @property
    def drawn_at_once(self) -> bool:
        """Whether the picture takes seconds at the most."""
        return True

    def __dir__(self) -> list[str]:
        """Sections, and what a scene can do; for completion, without what pydantic adds."""
        own = {name for kind in type(self).__mro__ if issubclass(kind, SceneBase) for name in vars(kind)}
        return sorted({*type(self).model_fields, *(name for name in own if not name.startswith(("_", "model_")))})

    def __repr__(self) -> str:
        """At most three lines."""
        return in_lines(self, self.name, self._source.quality)

    __str__ = __repr__

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        return as_html(self, f"Scene {self.name!r}" if self.name else "Scene")

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        """The picture over the table, for notebooks; left out where it takes long, or cannot be had."""
        shown = "<p>picture() draws it</p>"
        if self.drawn_at_once:
            with suppress(InputError):  # `check` says what is wrong
                url = data_url("image/png", self.picture()._repr_png_())
                shown = f"<img style='max-width:100%' src='{url}'>"
        return {"text/plain": repr(self), "text/html": shown + self._repr_html_()}

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy, of pydantic: ``update`` is not checked; use `with_`."""
        made = super().model_copy(update=update, deep=deep)
        if update:
            made._remember({name: getattr(made, name) for name in made.model_fields_set}, made._source)
        return made

    def _remember(self, table: Mapping[str, Any], source: Source) -> None:
        self._written, self._source = plain(table), source

    def _without(self, table: Mapping[str, Any], key: Key) -> dict[str, Any]:
        """``table`` without ``key``; InputError where it has no such key, nor have scenes."""
        known = {dotted(place) for place in every_key(type(self))}
        name = dotted(tuple(part for part in key if isinstance(part, str)))
        if name not in known and not scene_file.holds(table, key):  # some keys have no field: a file's name
            raise InputError(Fault(dotted(key), None, "unknown key", repair=nearest(name, known)))
        return scene_file.without(table, key)

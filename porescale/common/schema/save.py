"""A scene as a file: what differs from the defaults, names of files as they are seen from the new place."""

import tomllib
from collections.abc import Mapping
from pathlib import Path, PurePath
from typing import Any, get_args, get_origin

import tomli_w
from pydantic import BaseModel

from porescale.common.core.atomic import write_text
from porescale.common.core.errors import Fault, InputError
from porescale.common.schema.messages import dotted, sections_in
from porescale.common.schema.own import named_from, require_files, seen_from
from porescale.common.schema.scene_file import SCENE_FILE, parse_setting, setting_text
from porescale.common.schema.sections import Section, scene_as_dict, try_scene
from porescale.common.schema.written import plain


def save(scene: Section, written: Mapping[str, Any], folder: Path | None, path: Path, overwrite: bool) -> Path:
    """Write ``scene``, made from the tables ``written`` with files relative to ``folder``; see `SceneBase.save`."""
    file = path / SCENE_FILE if path.is_dir() else path
    if file.exists() and not overwrite:
        repair = "name another file, or give overwrite=True"
        raise InputError(Fault(str(file), None, "exists already", repair=repair))
    require_files(scene)
    file.parent.mkdir(parents=True, exist_ok=True)  # names of files are read from there
    old, new = (folder or Path()).resolve(), file.parent.resolve()
    moved = named_from(_moved(dict(written), type(scene), old, new), old, new)
    for table in (_changed(moved, scene), moved, plain(scene_as_dict(scene))):
        text = tomli_w.dumps(table)
        read, _ = try_scene(type(scene), tomllib.loads(text), file.parent.resolve())
        if read == scene:  # what follows from a key may hold the key there, though its value is the default
            write_text(file, text)
            return file
    repair = "load it again; files that it names have changed since"
    raise InputError(Fault(str(file), None, "would not be the same scene, and was not written", repair=repair))


def _changed(table: Mapping[str, Any], section: BaseModel) -> dict[str, Any]:
    """``table`` without the keys whose values in ``section`` are the defaults."""
    kept = {}
    fields = {field.alias or name: (name, field) for name, field in type(section).model_fields.items()}
    for key, given in table.items():
        if key not in fields:
            kept[key] = given
            continue
        name, field = fields[key]
        value = getattr(section, name)
        replaced = isinstance(given, Mapping) and not isinstance(value, BaseModel)  # as by what a file holds
        default = not field.is_required() and value == field.get_default(call_default_factory=True)
        if not default or replaced:
            kept[key] = _within(given, value)
    return kept


def _within(given: Any, value: Any) -> Any:
    """``given`` without the defaults of the section, or sections, that it became."""
    if isinstance(given, Mapping) and isinstance(value, BaseModel):
        return _changed(given, value)
    if isinstance(given, list) and isinstance(value, list | tuple) and len(given) == len(value):
        return [_within(below, made) for below, made in zip(given, value, strict=True)]
    return given


def _moved(table: Mapping[str, Any], section: type[BaseModel], old: Path, new: Path) -> dict[str, Any]:
    """``table`` with names of files that were relative to the folder ``old`` as they are seen from ``new``."""
    moved = dict(table)
    for name in getattr(section, "files", ()):
        given = table.get(name)
        if isinstance(given, str) and given and not PurePath(given).is_absolute():
            moved[name] = seen_from(new, old / given)
    for name, field in section.model_fields.items():
        key = field.alias or name
        inner = list(sections_in(field.annotation))
        if key in table and len(inner) == 1 and _is_a_place(field.annotation):
            given = table[key]
            if isinstance(given, Mapping):
                moved[key] = _moved(given, inner[0], old, new)
            elif isinstance(given, list):
                moved[key] = [_moved(it, inner[0], old, new) if isinstance(it, Mapping) else it for it in given]
    return moved


def placed(setting: str, section: type[BaseModel], folder: Path) -> str:
    """``section.key=value`` whose value names a file, relative to ``folder``, with its whole place; others as given."""
    key, value = parse_setting(setting)
    for part in (it for it in key[:-1] if isinstance(it, str)):
        fields = {field.alias or name: field for name, field in section.model_fields.items()}
        inner = list(sections_in(fields[part].annotation)) if part in fields else []
        if len(inner) != 1:
            return setting
        section = inner[0]
    if key[-1] not in getattr(section, "files", ()) or not isinstance(value, str):
        return setting
    return setting_text(dotted(key), str((folder / value).resolve()))


def _is_a_place(annotation: Any) -> bool:
    """Whether a field holds sections, not tables of them by name."""
    return get_origin(annotation) is not dict and all(_is_a_place(it) for it in get_args(annotation))

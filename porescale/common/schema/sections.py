"""Scenes are data: typed sections, read from TOML with every fault of a file reported at once."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from shlex import quote
from typing import Any, ClassVar, TypeVar, get_args

import pydantic
from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from porescale.common.core.errors import Fault, InputError
from porescale.common.schema import scene_file
from porescale.common.schema.describe import as_html, in_a_line
from porescale.common.schema.messages import Key, dotted, nearest, translate
from porescale.common.schema.quantity import Quantity as Quantity
from porescale.common.schema.quantity import Refused as Refused
from porescale.common.schema.quantity import quantity as quantity
from porescale.common.schema.written import Source, plain

LEVELS = ("draft", "standard", "fine")


class Section(BaseModel):
    """Base of every section and scene: frozen, no unknown keys, no booleans or infinities for numbers.

    A validator may raise `Refused` or an `InputError` with faults whose keys are relative to its section.
    """

    elsewhere: ClassVar[Mapping[str, str]] = {}
    """Of a scene: sections that it has not and every scene of another program has, and that program."""
    follows: ClassVar[Mapping[str, str]] = {}
    """Names that a person may give and no key has, and the keys that what they mean follows from."""
    files: ClassVar[tuple[str, ...]] = ()
    """Keys that are names of files, relative to the scene's folder; also such that no field has."""
    checks: ClassVar[list[Callable[[Any], list[Fault]]]] = []
    """Functions that return what is wrong with a valid section of this very class.  Checks between sections, and those
    that need physics, are registered here by the builders: sections import neither."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, validate_default=True)

    def __init__(self, /, **keys: Any) -> None:
        """A section of its keys, nested ones as tables or sections; InputError with every fault, as of a file."""
        keys = plain(keys, sections=True)
        try:
            super().__init__(**keys)
        except ValidationError as error:
            raise InputError([fault for _, fault in translate(error, type(self), keys)]) from None

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]
    """Pydantic calls an ``__init__`` without this mark for every nested section as well: each would raise for itself,
    without the faults of the others and without the folder of the file."""

    def __hash__(self) -> int:
        """Equal sections have equal hashes, those with tables among their values, too."""
        return hash(tuple(_hashable(getattr(self, name)) for name in type(self).model_fields))

    def __repr__(self) -> str:
        """What is not as by default, in one line."""
        return in_a_line(self)

    __str__ = __repr__

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        return as_html(self, type(self).__name__)

    def __setattr__(self, name: str, value: Any) -> None:
        """InputError: sections do not change."""
        if name.startswith("_"):
            return super().__setattr__(name, value)
        raise _unchangeable(self, name, value)

    def __delattr__(self, name: str) -> None:
        """InputError: sections do not change."""
        raise _unchangeable(self, name, None)

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        """Every class has checks of its own."""
        super().__pydantic_init_subclass__(**options)
        cls.checks = []

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: pydantic.GetCoreSchemaHandler) -> CoreSchema:
        """Validation that collects an InputError raised inside a section with the other faults."""

        def collect(value: Any, inner: pydantic.ValidatorFunctionWrapHandler) -> Any:
            """``value`` validated, with the faults that a section raises."""
            try:
                made = inner(cls._spell_booleans(value))
                faults = made._faults() or [fault for check in cls.checks for fault in check(made)]
            except InputError as error:
                raise Refused(*error.faults) from None
            if faults:
                raise Refused(*faults)
            return made

        return core_schema.no_info_wrap_validator_function(collect, handler(source))

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: pydantic.GetJsonSchemaHandler) -> dict[str, Any]:
        """The JSON schema of the section as files write it."""
        made: dict[str, Any] = handler(core)
        table = handler.resolve_ref_schema(made)
        if "$comment" not in table:  # pydantic asks once for each validator around the section
            changed = {**cls._schema(dict(table)), "$comment": cls.__name__}
            table.clear()
            table.update(changed)
        return made

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        """The JSON ``schema`` of the fields with what validators take besides, as a word in place of a table."""
        return schema

    def _faults(self) -> list[Fault]:
        """What is wrong with the section by itself, whose fields are valid; ``checks`` follow where nothing is."""
        return []

    def _remember(self, table: Mapping[str, Any], source: Source) -> None:
        """Keep what the section was made from; only whole scenes do."""

    @classmethod
    def _spell_booleans(cls, table: Any) -> Any:
        """``table`` with true and false as words where a number is meant: pydantic takes them for 1 and 0."""
        if not isinstance(table, Mapping):
            return table
        numbers = {name for name, field in cls.model_fields.items() if _is_plain_number(field)}
        return {k: str(v).lower() if isinstance(v, bool) and k in numbers else v for k, v in table.items()}


def _hashable(value: Any) -> Any:
    """A value with tuples for lists and sets of pairs for tables."""
    if isinstance(value, Mapping):
        return frozenset((key, _hashable(below)) for key, below in value.items())
    return tuple(map(_hashable, value)) if isinstance(value, list | tuple) else value


def _unchangeable(section: Section, name: str, value: Any) -> InputError:
    """The error for a value assigned to a section."""
    known = {field.alias or key for key, field in type(section).model_fields.items()}
    if name not in known:
        return InputError(Fault(name, None, f"unknown key of {type(section).__name__}", repair=nearest(name, known)))
    place = name if hasattr(section, "with_") else f"SECTION.{name}"
    repair = f'make a changed copy, scene.with_({{"{place}": VALUE}})'
    shown = value if isinstance(value, str | int | float) else None
    return InputError(Fault(name, shown, "cannot be assigned, a scene never changes", repair=repair))


def _is_plain_number(field: FieldInfo) -> bool:
    """Whether a field holds a number, not a boolean, and is no quantity (which checks itself)."""
    kinds = (field.annotation, *get_args(field.annotation))
    marked = any(isinstance(mark, Quantity) for mark in field.metadata)
    return (int in kinds or float in kinds) and bool not in kinds and not marked


S = TypeVar("S", bound=Section)


def validate(scene_type: type[S], table: Mapping[str, Any], *, file: str = "", folder: Path | None = None) -> S:
    """``table`` as a scene; InputError with all its faults, each naming ``file``.

    Validators find ``folder`` as ``info.context["folder"]``: paths in a scene are relative to its file.
    """
    scene, faults = try_scene(scene_type, table, folder)
    if scene is None:
        raise InputError([replace(fault, file=file) for _, fault in faults])
    scene._remember(table, Source(folder=folder))
    return scene


def try_scene(
    scene_type: type[S], table: Mapping[str, Any], folder: Path | None
) -> tuple[S | None, list[tuple[Key, Fault]]]:
    """A scene, or None and what is wrong with each key; arguments as of `validate`."""
    try:
        return scene_type.model_validate(table, context={"folder": folder}), []
    except ValidationError as error:
        return None, translate(error, scene_type, table)


def load(path: str | Path, scene_type: type[S], *, quality: str | None = None, overrides: Sequence[str] = ()) -> S:
    """The scene at ``path``, a TOML file or a folder with scene.toml.  Later wins: scene, quality level, overrides.

    quality : level, None for the file's ``quality_default`` or none;  overrides : ``section.key=value``.
    Raises InputError with every fault of the file, its quality levels (chosen or not) and the overrides.
    """
    file = scene_file.find(Path(path))
    table = scene_file.read(file)
    _require_own_program(scene_type, table, file)
    levels, level, faults = _levels(table, quality)
    base = {name: value for name, value in table.items() if name not in ("quality", "quality_default")}
    written = scene_file.merge(base, levels[level]) if level else base
    chosen, settings, wrong_settings = _with_settings(written, overrides)
    scene, wrong = try_scene(scene_type, chosen, file.parent)
    faults += wrong_settings
    for key, fault in wrong:
        if of_a_setting(key, settings, written):
            faults.append(replace(fault, file="--set"))
        else:
            faults.append(_in_level(key, fault, level, levels[level]) if level else fault)
    for other in (name for name in levels if name != level):
        _, wrong = try_scene(scene_type, scene_file.merge(base, levels[other]), file.parent)
        own = [(key, fault) for key, fault in wrong if scene_file.holds(levels[other], key)]
        faults += [_in_level(key, fault, other, levels[other]) for key, fault in own]
    if faults or scene is None:
        raise InputError(faults).in_file(str(file))
    name = scene_file.name_of(file)
    scene._remember(chosen, Source(file, file.parent.absolute(), name, level, tuple(levels), tuple(overrides)))
    return scene


def _require_own_program(scene_type: type[Section], table: Mapping[str, Any], file: Path) -> None:
    """InputError, one line in place of one for every section, where a scene is another program's."""
    own = {name for name, field in scene_type.model_fields.items() if field.is_required()}
    if not own <= table.keys():
        for section, program in scene_type.elsewhere.items():
            if section in table:
                problem, repair = f"is a section of scenes of {program}", f"{program} check {quote(str(file))}"
                raise InputError(Fault(section, problem=problem, repair=repair, file=str(file)))


def _with_settings(
    table: Mapping[str, Any], overrides: Sequence[str]
) -> tuple[Mapping[str, Any], list[Key], list[Fault]]:
    """``table`` with the settings in it, their keys, and what is wrong with those that cannot be set."""
    keys: list[Key] = []
    faults: list[Fault] = []
    for text in overrides:
        try:
            key, value = scene_file.parse_setting(text)
            table = scene_file.assign(table, key, value)
            keys.append(key)
        except InputError as error:
            faults += error.faults
    return table, keys, faults


def of_a_setting(key: Key, settings: Sequence[Key], written: Mapping[str, Any]) -> bool:
    """Whether a fault at ``key`` is that of a setting: of the key, or within a section that ``written`` has not."""
    made = not scene_file.holds(written, key)
    return any(key[: len(it)] == it or (made and it[: len(key)] == key) for it in settings)


def _in_level(key: Key, fault: Fault, level: str, entries: Mapping[str, Any]) -> Fault:
    """``fault`` with the key that a person must correct: the quality level's, if that is where it stands."""
    return replace(fault, key=dotted(("quality", level, *key))) if scene_file.holds(entries, key) else fault


def scene_as_dict(scene: Section) -> dict[str, Any]:
    """The full scene with its defaults, in SI, as JSON-able tables; `validate` makes the same scene of it."""
    return scene.model_dump(mode="json", by_alias=True)


def _levels(table: Mapping[str, Any], chosen: str | None) -> tuple[dict[str, dict[str, Any]], str | None, list[Fault]]:
    """Quality levels of a scene file, the one to use (None: none), and what is wrong with them."""
    given, default = table.get("quality", {}), table.get("quality_default")
    if not isinstance(given, Mapping):
        fault = Fault("quality", problem="is not a table of levels", repair="write [quality.draft] and so on")
        return {}, None, [fault]
    faults = []
    for name, entries in given.items():
        if name not in LEVELS:
            repair = nearest(name, LEVELS, "levels")
            faults.append(Fault(f"quality.{name}", None, "unknown level", "", ", ".join(LEVELS), repair))
        elif not isinstance(entries, Mapping):
            faults.append(Fault(f"quality.{name}", entries, "is not a table", repair=f"write [quality.{name}.section]"))
    levels = {name: dict(given[name]) for name in LEVELS if isinstance(given.get(name), Mapping)}
    level, key = (chosen, "--quality") if chosen is not None else (default, "quality_default")
    if level is not None and not isinstance(level, str):
        shown = level if isinstance(level, int | float) else None
        faults.append(Fault(key, shown, "is not the name of a level", "", ", ".join(LEVELS), 'write it as "draft"'))
        level = next(iter(levels), None)
    elif level is not None and level not in levels:
        has = ", ".join(levels)
        repair = f"choose one of these or add [quality.{level}]" if has else f"add [quality.{level}] or leave it out"
        faults.append(Fault(key, level, "this scene has no such level", "", has or "none", repair))
        level = next(iter(levels), None)
    return levels, level, faults  # with another level than the wrong one, what it would give is not missed as well

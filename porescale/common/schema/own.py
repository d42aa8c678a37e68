"""Own laws in scenes: fields that may name a user's function, and all that a scene names."""

import functools
import operator
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, get_args, get_origin

import pydantic
from pydantic import BaseModel
from pydantic_core import CoreSchema, core_schema

from porescale.common.compiled.own import OwnLaw
from porescale.common.compiled.own_file import is_reference, law_of
from porescale.common.core.errors import Fault, InputError
from porescale.common.schema.quantity import Refused

OWN_LAW = {"type": "string", "pattern": r"\.py:\w+$"}
"""JSON schema of the name of an own law, "laws.py:NAME"."""


@dataclass(frozen=True)
class OrOwn:
    """Marks a field that may also name an own law of a ``kind``, or be one: ``Annotated[str | OwnLaw, OrOwn(kind)]``.

    In files it is a text, "laws.py:NAME", the file relative to the scene's.
    """

    kind: str

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: pydantic.GetJsonSchemaHandler) -> dict[str, Any]:
        """What a file may say: what the field is without own laws, or the name of one."""
        return {"anyOf": [handler(core), OWN_LAW]}

    def __get_pydantic_core_schema__(self, source: Any, handler: pydantic.GetCoreSchemaHandler) -> CoreSchema:
        """Own laws pass; all else is what the field is without them."""

        def found(value: Any, inner: pydantic.ValidatorFunctionWrapHandler, info: pydantic.ValidationInfo) -> Any:
            """The own law, or the value validated."""
            law = own_law(value, self.kind, folder_of(info))
            return inner(value) if law is None else law

        def written(value: Any, inner: pydantic.SerializerFunctionWrapHandler) -> Any:
            """The name of an own law, or the value as it is written."""
            return value.reference if isinstance(value, OwnLaw) else inner(value)

        return core_schema.with_info_wrap_validator_function(
            found, handler(_without_own(source)), serialization=core_schema.wrap_serializer_function_ser_schema(written)
        )


def or_own(kind: str, field: Any) -> Any:
    """A field (of `quantity`, say) that may also name an own law of a ``kind``."""
    field.metadata.append(OrOwn(kind))
    return field


def _without_own(source: Any) -> Any:
    """An annotation without OwnLaw in a union."""
    parts = [it for it in get_args(source) if it is not OwnLaw] if get_origin(source) is not None else []
    return functools.reduce(operator.or_, parts) if len(parts) < len(get_args(source)) else source


def folder_of(info: pydantic.ValidationInfo) -> Path | None:
    """The folder that paths of a scene count from."""
    return (info.context or {}).get("folder")


def own_law(value: Any, kind: str, folder: Path | None) -> OwnLaw | None:
    """The own law that a value is or names, None where it is something else; raises Refused."""
    if isinstance(value, OwnLaw):
        if value.kind != kind:
            raise Refused(Fault("", value.reference, f"is made for @{value.kind}, here @{kind} is needed"))
        return value
    if not is_reference(value):
        return None
    try:
        return law_of(value, folder, kind)
    except InputError as error:
        raise Refused(*(_of_its_file(value, fault) for fault in error.faults)) from None


def _of_its_file(reference: str, fault: Fault) -> Fault:
    """A fault of the key that names a law, also where its file, or a decorator in it, says what is wrong there."""
    if not fault.key:
        return fault
    given = "" if fault.value is None else f" = {fault.value!r}"
    return replace(fault, key="", value=reference, problem=f"{fault.key}{given}: {fault.problem}")


def own_laws(scene: Any, place: str = "") -> Iterator[tuple[str, OwnLaw]]:
    """Every own law of a scene, with the key that names it."""
    if isinstance(scene, OwnLaw):
        yield place, scene
    elif isinstance(scene, BaseModel):
        for name in type(scene).model_fields:
            yield from own_laws(getattr(scene, name), f"{place}.{name}" if place else name)
    elif isinstance(scene, list | tuple):
        for k, it in enumerate(scene):
            yield from own_laws(it, f"{place}[{k}]")


def on_card(scene: Any) -> dict[str, Any]:
    """The entry of a run card for the own laws of a scene, by key; {} where there are none."""
    laws = {key: law.card() for key, law in own_laws(scene)}
    return {"laws": laws} if laws else {}


def require_files(scene: Any) -> None:
    """InputError where an own law of a scene stands in no file, so that the scene cannot be saved."""
    faults = [
        Fault(key, law.reference, "stands in no file", repair="put it into a file, laws.py, and name that")
        for key, law in own_laws(scene) if law.file is None
    ]  # fmt: skip
    if faults:
        raise InputError(faults)


def named_from(table: Any, old: Path, new: Path) -> Any:
    """``table`` with own laws by their names, and files of such names that were relative to the folder ``old`` as they
    are seen from ``new``."""
    if isinstance(table, Mapping):
        return {key: named_from(value, old, new) for key, value in table.items()}
    if isinstance(table, list | tuple):
        return [named_from(value, old, new) for value in table]
    if isinstance(table, OwnLaw) and table.file:
        return f"{seen_from(new, table.file.resolve())}:{table.name}"
    if is_reference(table):
        file, _, name = table.rpartition(":")
        if (old / file).is_file() and not Path(file).is_absolute():
            return f"{seen_from(new, (old / file).resolve())}:{name}"
    return table


def seen_from(folder: Path, file: Path) -> str:
    """Name of a file as it is seen from a folder."""
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # on another drive
        return file.as_posix()

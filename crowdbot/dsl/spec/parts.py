"""Specs that contain other specs: narrow abstract ones to installed ones."""

from __future__ import annotations

from dataclasses import replace
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BeforeValidator
from pydantic.fields import FieldInfo

from crowdbot.dsl.spec.spec import ComponentSpec


def parts_category(spec: type[ComponentSpec]) -> str:
    """Return the category of a spec's parts; empty if it has none.

    Raises:
        TypeError: its field of parts does not exist, or does not contain specs of one category.
    """
    if not spec.parts_field:
        return ""
    field = spec.model_fields.get(spec.parts_field)
    found = [] if field is None else list(_abstract_specs(field.annotation))
    if len(found) != 1:
        raise TypeError(
            f"parts_field: '{spec.parts_field}' is not a field of dict[str, SerializeAsAny[SPEC]], "
            "where SPEC is one of crowdbot's abstract specs"
        )
    return found[0].category


def narrowed(field: FieldInfo, member: Any) -> Any:
    """Return a field's annotation with the abstract spec type replaced by another one."""
    metadata = [
        replace(m, json_schema_input_type=_narrowed(m.json_schema_input_type, member))
        if isinstance(m, BeforeValidator)
        else m
        for m in field.metadata
    ]
    annotation = _narrowed(field.annotation, member)
    return Annotated[(annotation, *metadata)] if metadata else annotation


def _abstract_specs(annotation: Any) -> list[type[ComponentSpec]]:
    if isinstance(annotation, type) and issubclass(annotation, ComponentSpec):
        return [annotation]
    return [spec for part in get_args(annotation) for spec in _abstract_specs(part)]


def _narrowed(annotation: Any, member: Any) -> Any:
    """Return the annotation with ``member`` in place of each abstract spec."""
    if not _abstract_specs(annotation):
        return annotation
    origin, args = get_origin(annotation), get_args(annotation)
    if origin is None or origin is Annotated:
        return member
    members = tuple(_narrowed(a, member) for a in args)
    return Union[members] if origin in (Union, UnionType) else origin[members]  # noqa: UP007

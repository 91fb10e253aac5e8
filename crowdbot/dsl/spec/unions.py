"""Unions of models in which a function chooses the member."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema


@dataclass(frozen=True, slots=True)
class AnyOf:
    """Writes a union with several distinguishing fields as ``anyOf`` in JSON Schema."""

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        made = handler(schema)
        if "oneOf" not in made:
            return made
        return {"anyOf": [m for one in made["oneOf"] for m in one.get("anyOf", [one])]}

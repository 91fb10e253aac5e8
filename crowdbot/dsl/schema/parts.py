"""Parts of schemas: pydantic's JSON Schema, adapted to hand-written documents.

pydantic describes complete documents. Here every map of fields becomes partial and accepts dotted
keys (``flow.density``, by pattern), and a place for one of several components requires ``kind``
first, so that an editor offers only the fields of that kind.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain, count
from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

Json = dict[str, Any]

_REF = "#/$defs/"
_NULL: Json = {"type": "null"}
#: Field of a scenario that documents write elsewhere; its abstract type cannot be in a schema.
_ELSEWHERE = "references"


class Parts:
    """JSON Schema definitions of models, adapted to hand-written documents.

    Args:
        models: the first one is the root.
        canonical: numbers only, every field required.
        layered: documents are merged, so fields may be missing, removed by ``null`` or written with
            dots.
    """

    def __init__(
        self, *models: type[BaseModel], canonical: bool = False, layered: bool = True
    ) -> None:
        mode: Any = "serialization" if canonical else "validation"
        keys, whole = models_json_schema([(m, mode) for m in models])
        roots = [_short(keys[m, mode]["$ref"]) for m in models]
        names = _short_names(whole["$defs"], roots)
        self._canonical, self._layered = canonical, layered and not canonical
        self._raw = _renamed(_without_titles(whole["$defs"]), names)
        self._roots = [names[r] for r in roots]
        self._made: Json = {}
        self._unions: dict[tuple[str, ...], str] = {}

    def root(self, without: Sequence[str]) -> Json:
        """Return the schema of the first root, without the named fields."""
        raw = self._raw[self._roots[0]]
        fields = {k: v for k, v in raw["properties"].items() if k not in without}
        return self._model({**raw, "properties": fields})

    def union(self) -> Json:
        """Return the schema of a document that is one of the roots, chosen by ``kind``."""
        return self.one_of(self._roots)

    def outer(self, model: type[BaseModel]) -> Json:
        """Return the schema of a document's top-level fields, required as in the model."""
        raw = _without_titles(model.model_json_schema())
        self._raw |= raw.pop("$defs", {})
        made = {k: self._place(v, k) for k, v in raw["properties"].items()}
        return {**raw, "properties": made}

    def named(self, name: str, schema: Json) -> Json:
        """Store a schema as a definition under a name; return a reference to it."""
        self._made[name] = schema
        return {"$ref": _REF + name}

    def used_by(self, content: Json) -> Json:
        """Return the definitions that a schema uses, directly or indirectly, sorted by name."""
        found: Json = {}
        waiting = list(_refs(content))
        while waiting:
            name = waiting.pop()
            if name not in found:
                found[name] = described(self._definition(name))
                waiting += _refs(found[name])
        return dict(sorted(found.items()))

    def one_of(self, names: Sequence[str]) -> Json:
        """Return the schema of a component of several possible kinds, chosen by ``kind``."""
        kinds = {self._kind(n): n for n in names}
        words = [
            {"const": k, "description": self._raw[n].get("description", "")}
            for k, n in kinds.items()
        ]
        cases = [
            {
                "if": {"properties": {"kind": {"const": kind}}, "required": ["kind"]},
                "then": {"$ref": _REF + name},
            }
            for kind, name in kinds.items()
        ]
        if self._layered:
            any_kind = {"anyOf": [{"$ref": _REF + n} for n in names]}
            cases.append({"if": {"not": {"required": ["kind"]}}, "then": any_kind})
        kind_field = {"description": "Which component this is.", "oneOf": words}
        silent = [n for n in names if "kind" in self._raw[n].get("left_out", ())]
        if self._canonical:  # at most one: the kind that is meant where none is written
            none = {"not": {"required": ["kind"]}}
            cases += [{"if": none, "then": {"$ref": _REF + name}} for name in silent]
        free = self._layered or (self._canonical and silent)
        required = {} if free else {"required": ["kind"]}
        return {"type": "object", "properties": {"kind": kind_field}, **required, "allOf": cases}

    # ------------------------------------------------------------ making definitions
    def _definition(self, name: str) -> Json:
        if name not in self._made:
            self._made[name] = self._model(self._raw[name])
        made: Json = self._made[name]
        return made

    def _model(self, raw: Json) -> Json:
        """Return the schema of a map of fields as users write it."""
        if "properties" not in raw:
            return raw
        made = {k: v for k, v in raw.items() if k not in ("required", "short", "left_out")}
        fields = raw["properties"]
        places = {k: self._place(v, k) for k, v in fields.items()}
        if not self._layered:
            always = sorted(set(fields) - set(raw.get("left_out", ())))  # omitted while default
            required = always if self._canonical else raw.get("required", [])
            return {**made, "properties": places, "required": required}
        kept = "kind" if "const" in fields.get("kind", {}) else None
        places = {k: v if k == kept else _or_null(v) for k, v in places.items()}
        dotted = dict(sorted(self._paths(fields)))
        patterns = {"patternProperties": dotted} if dotted else {}
        return {**made, "properties": places, **patterns}

    def _place(self, raw: Json, name: str) -> Json:
        """Return the schema of a field's value."""
        extra = {k: v for k, v in raw.items() if k in ("description", "default")}
        names = self._components(raw)
        if names:
            return {**extra, **self._union(tuple(names), name)}
        if "$ref" in raw:
            model = _short(raw["$ref"])
            about = {k: v for k, v in self._raw[model].items() if k == "description"}
            return {**about, **extra, **self._with_short_form(model)}
        if "anyOf" in raw:
            return {**raw, "anyOf": [self._place(a, name) for a in raw["anyOf"]]}
        if isinstance(raw.get("additionalProperties"), dict):
            return self._map(raw, name)
        if "items" in raw:
            return {**raw, "items": self._place(raw["items"], name)}
        return raw

    def _union(self, names: tuple[str, ...], field: str) -> Json:
        """Return a reference to the definition of a set of components; equal sets share it."""
        if names not in self._unions:
            others = (f"{field}{i}" for i in count(2))
            free = next(n for n in chain([field], others) if n not in self._made)
            self._unions[names] = free
            self._made[free] = self.one_of(names)
        return {"$ref": _REF + self._unions[names]}

    def _with_short_form(self, name: str) -> Json:
        """Return the schema of a part; if it has a short form, that or the whole map."""
        field = self._raw[name].get("short")
        if field is None or self._canonical:
            return {"$ref": _REF + name}
        whole, short = {"$ref": _REF + name}, self._raw[name]["properties"][field]
        return {"anyOf": [*short.get("anyOf", [short]), whole]}

    def _map(self, raw: Json, name: str) -> Json:
        """Return the schema of a map of named members; dotted keys lead into a member."""
        member = self._place(raw["additionalProperties"], name)
        made = {k: v for k, v in raw.items() if k != "additionalProperties"}
        if not self._layered:
            return {**made, "additionalProperties": member}
        dotted = {f"^[^.]+\\.{p}$": v for p, v in self._below(raw["additionalProperties"], name)}
        patterns = {"^[^.]+$": _or_null(member), **dotted}
        return {**made, "patternProperties": patterns, "additionalProperties": False}

    # ------------------------------------------------------------------- dotted keys
    def _paths(self, fields: Json) -> Iterator[tuple[str, Json]]:
        """Yield pattern and schema of every dotted key that leads into one of the fields."""
        for name, raw in fields.items():
            for path, schema in self._below(raw, name):
                yield f"^{name}\\.{path}$", schema

    def _below(self, raw: Json, name: str) -> Iterator[tuple[str, Json]]:
        """Yield the dotted path (a pattern without anchors) and schema of all below a value."""
        models = self._components(raw) or self._models(raw)
        fields = list(dict.fromkeys(f for m in models for f in self._raw[m]["properties"]))
        for field in fields:
            owners = [m for m in models if field in self._raw[m]["properties"]]
            places = [{"$ref": f"{_REF}{m}/properties/{field}"} for m in owners]
            yield field, places[0] if len(places) == 1 else {"anyOf": places}
            deeper: dict[str, list[Json]] = {}
            for owner in owners:
                for path, schema in self._below(self._raw[owner]["properties"][field], field):
                    deeper.setdefault(path, []).append(schema)
            for path, schemas in deeper.items():
                yield f"{field}\\.{path}", _any_of(schemas)
        for member in self._members(raw):
            yield "[^.]+", _or_null(self._place(member, name))
            for path, schema in self._below(member, name):
                yield f"[^.]+\\.{path}", schema

    def _components(self, raw: Json) -> list[str]:
        """Return the names of the components' definitions that a schema allows; often none."""
        listed = raw.get("oneOf", [raw])
        names = [_short(one["$ref"]) for one in listed if "$ref" in one]
        return [n for n in names if "const" in self._raw[n].get("properties", {}).get("kind", {})]

    def _models(self, raw: Json) -> list[str]:
        """Return the names of the definitions of plain maps of fields that a schema allows."""
        names = [_short(one["$ref"]) for one in raw.get("anyOf", [raw]) if "$ref" in one]
        return [n for n in names if "properties" in self._raw[n]]

    def _members(self, raw: Json) -> list[Json]:
        maps = [one.get("additionalProperties") for one in raw.get("anyOf", [raw])]
        return [m for m in maps if isinstance(m, dict)]

    def _kind(self, name: str) -> str:
        return str(self._raw[name]["properties"]["kind"]["const"])


def described(schema: Json) -> Json:
    """Return a copy without the double backticks of docstrings."""
    return json.loads(json.dumps(schema).replace("``", "`"))  # type: ignore[no-any-return]


def _or_null(schema: Json) -> Json:
    """Return a schema that also allows ``null``, which restores the default."""
    if "$ref" in schema:
        rest = {k: v for k, v in schema.items() if k != "$ref"}
        return {**rest, "anyOf": [{"$ref": schema["$ref"]}, _NULL]}
    if "anyOf" in schema:
        return {**schema, "anyOf": [*(a for a in schema["anyOf"] if a != _NULL), _NULL]}
    if "const" in schema:
        rest = {k: v for k, v in schema.items() if k != "const"}
        return _or_null({**rest, "enum": [schema["const"]]})
    if "enum" in schema:
        return {**schema, "type": ["string", "null"], "enum": [*schema["enum"], None]}
    if isinstance(schema.get("type"), str):
        return {**schema, "type": [schema["type"], "null"]}
    return schema


def _any_of(schemas: Sequence[Json]) -> Json:
    flat = [s for one in schemas for s in one.get("anyOf", [one])]
    unique = list({json.dumps(s, sort_keys=True): s for s in flat}.values())
    return unique[0] if len(unique) == 1 else {"anyOf": unique}


def _short(reference: str) -> str:
    return reference.removeprefix(_REF)


def _refs(schema: Any) -> Iterator[str]:
    """Yield the names of the definitions that a schema refers to."""
    if isinstance(schema, dict):
        for key, value in schema.items():
            if key == "$ref" and isinstance(value, str):
                yield _short(value).partition("/")[0]
            else:
                yield from _refs(value)
    elif isinstance(schema, list):
        for item in schema:
            yield from _refs(item)


def _without_titles(schema: Any, *, names: bool = False) -> Any:
    """Return a copy without pydantic's titles; ``names``: keys are names."""
    if isinstance(schema, list):
        return [_without_titles(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    return {
        key: _without_titles(value, names=key in ("properties", "$defs") and not names)
        for key, value in schema.items()
        if names or key != "title" or not isinstance(value, str)
    }


def _short_names(defs: Json, roots: Sequence[str]) -> dict[str, str]:
    """Return definition -> class name, if used; the long name if two classes share one."""
    used, waiting = set[str](), list(roots)
    while waiting:
        name = waiting.pop()
        if name not in used:
            used.add(name)
            fields = defs[name].get("properties", {})
            waiting += _refs({k: v for k, v in fields.items() if k != _ELSEWHERE})
    shared = Counter(n.rpartition("__")[2] for n in used)
    return {n: last if shared[last := n.rpartition("__")[2]] == 1 else n for n in used}


def _renamed(schema: Any, names: dict[str, str]) -> Any:
    """Return the definitions with new names."""
    text = json.dumps({new: schema[old] for old, new in sorted(names.items())})
    reference = re.compile(rf'"{re.escape(_REF)}([^"]+)"')
    renamed = reference.sub(lambda m: f'"{_REF}{names.get(m[1], m[1])}"', text)
    return json.loads(renamed)

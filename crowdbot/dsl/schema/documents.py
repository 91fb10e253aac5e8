"""JSON Schemas (draft 2020-12) of documents that users write and crowdbot writes.

The *authoring* schema is for editors: every field may be missing, because ``extends``, a matrix or
a dotted key may supply it; quantities may be text; ``null`` restores the default. The *canonical*
one describes ``scenario.yaml`` of a run: numbers only, every field written out.

Everything that a schema refuses, ``validate`` refuses as well. The reverse does not hold: only
``validate`` checks rules between fields, whole documents and positions.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from pydantic import BaseModel

from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.schema.parts import Json, Parts, described
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.dsl.suite.documents import FORMAT, ScenarioDocument, SuiteDocument

DIALECT = "https://json-schema.org/draft/2020-12/schema"

_NAME = "^[A-Za-z0-9_]+$"
_DOTTED = r"^[^.]+(\.[^.]+)+$"
_EXTENDS: Json = {
    "description": "Files laid under this map, left to right; relative to this file, or "
    "'NAME:path' in a plugin's folder.",
    "anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}],
}
_VERSION: Json = {"const": FORMAT, "description": "Version of the format."}


def suite_schema(scenario: type[Scenario], metrics: Iterable[str]) -> Json:
    """Return the schema of a suite document.

    Args:
        scenario: `Scenario`, narrowed to the installed components.
        metrics: kinds of the installed metrics.
    """
    parts = Parts(scenario)
    labels = _map_of(_override(parts), _NAME)
    matrix = {
        **_map_of({**labels, "minProperties": 1}, _NAME),
        "type": ["object", "null"],
        "description": "Axes of variation: axis -> label -> what it overrides.",
    }
    return _document(
        "suite", "crowdbot suite", SuiteDocument, parts, metrics,
        {"base": _body(parts, ("id", "references")), "matrix": matrix},
    )  # fmt: skip


def scenario_schema(scenario: type[Scenario], metrics: Iterable[str]) -> Json:
    """Return the schema of a document with one scenario; arguments as for `suite_schema`."""
    parts = Parts(scenario)
    body = _body(parts, ("references",))
    whole = _if_plain({"required": ["id", "environment"]})
    return _document(
        "scenario", "crowdbot scenario", ScenarioDocument, parts, metrics,
        {"scenario": {**body, "allOf": [whole]}},
    )  # fmt: skip


def part_schema(scenario: type[Scenario]) -> Json:
    """Return the schema of a file for ``extends``: some fields of a scenario."""
    parts = Parts(scenario)
    return _head("part", "crowdbot part", _body(parts, ("references",)), parts)


def planner_schema(planners: Sequence[type[ComponentSpec]], *, canonical: bool = False) -> Json:
    """Return the schema of a planner file: ``kind`` and its parameters.

    Args:
        planners: specs of the installed planners.
        canonical: numbers only, every field required.
    """
    parts = Parts(*planners, canonical=canonical, layered=False)
    return _head("planner", "crowdbot planner", parts.union(), parts, canonical=canonical)


def canonical_scenario_schema(scenario: type[Scenario]) -> Json:
    """Return the schema of a resolved scenario, such as ``scenario.yaml`` of a run."""
    parts = Parts(scenario, canonical=True)
    content = {
        "type": "object",
        "properties": {
            "crowdbot": _VERSION,
            "kinds": {
                "type": "object",
                "description": "spec_version of every component in use.",
                "additionalProperties": {"type": "integer", "minimum": 1},
            },
            "scenario": parts.root(without=("references",)),
            "references": {
                "type": "object",
                "description": "What each calibration run changes.",
                "additionalProperties": {"type": "object"},
            },
        },
        "required": ["crowdbot", "scenario"],
        "additionalProperties": False,
    }
    return _head("scenario", "crowdbot scenario, resolved", content, parts, canonical=True)


def _document(
    name: str,
    title: str,
    model: type[BaseModel],
    parts: Parts,
    metrics: Iterable[str],
    fields: Mapping[str, Json],
) -> Json:
    """Return the schema of a document's top-level fields: the model's, some refined."""
    outer = parts.outer(model)
    known = {
        "crowdbot": _VERSION,
        "metrics": _metrics(metrics),
        "references": {**_map_of(_override(parts)), "description": "Calibration runs, by name."},
        **fields,
        "extends": _EXTENDS,
    }
    for key, schema in known.items():
        about = outer["properties"].get(key, {}).get("description")
        outer["properties"][key] = {**({"description": about} if about else {}), **schema}
    required = outer.pop("required")
    outer["patternProperties"] = {_DOTTED: True}
    outer["allOf"] = [_if_plain({"required": required})]
    return _head(name, title, outer, parts)


def _head(name: str, title: str, content: Json, parts: Parts, *, canonical: bool = False) -> Json:
    urn = f"urn:crowdbot:{name}{':canonical' if canonical else ''}:v{FORMAT}"
    about = {"$schema": DIALECT, "$id": urn, "title": title}
    return {**about, **described(content), "$defs": parts.used_by(content)}


def _body(parts: Parts, without: tuple[str, ...]) -> Json:
    """Return the schema of a scenario's fields and ``extends``, all optional."""
    body = parts.root(without=without)
    return {**body, "properties": {"extends": _EXTENDS, **body["properties"]}}


def _override(parts: Parts) -> Json:
    return parts.named("Override", _body(parts, without=("id", "references")))


def _map_of(member: Json, name: str = "^[^.]+$") -> Json:
    """Return the schema of a map of named members; values of dotted keys are not checked."""
    return {
        "type": "object",
        "patternProperties": {name: member, _DOTTED: True},
        "additionalProperties": False,
    }


def _if_plain(then: Json) -> Json:
    """Return ``then`` as a rule for maps without ``extends`` and dotted keys."""
    plain = {"not": {"required": ["extends"]}, "propertyNames": {"pattern": "^[^.]*$"}}
    return {"if": plain, "then": then}


def _metrics(kinds: Iterable[str]) -> Json:
    name = {"anyOf": [{"enum": sorted(kinds)}, {"type": "string", "pattern": r"[*?\[]"}]}
    return {"type": ["array", "null"], "items": name}

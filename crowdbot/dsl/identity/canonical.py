"""Canonical form 1: the same scenario gives the same bytes, regardless of its notation.

Changing this file changes every hash; golden hashes in the tests guard it.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from crowdbot.dsl.scenario.scenario import OUTSIDE_HASH, Scenario
from crowdbot.dsl.text.yaml_in_parts import to_yaml_in_parts

PREFIX = "cb1-sha256:"

_HEADER = """\
# A resolved crowdbot scenario: every default is written out, units are SI.
"""


def canonical_bytes(scenario: Scenario, kinds: Mapping[str, int]) -> bytes:
    """Return the bytes that are hashed: JSON, sorted keys, no spaces, shortest floats.

    Args:
        scenario: a validated scenario.
        kinds: kind -> spec_version of every component in it.
    """
    content = scenario.model_dump(mode="json", exclude=set(OUTSIDE_HASH))
    content["kinds"] = dict(kinds)
    text = json.dumps(_fold(content), sort_keys=True, separators=(",", ":"), allow_nan=False)
    return text.encode("ascii")


def content_hash(scenario: Scenario, kinds: Mapping[str, int]) -> str:
    """Return ``cb1-sha256:<hex>`` of a scenario's content, without id, title and references."""
    return PREFIX + hashlib.sha256(canonical_bytes(scenario, kinds)).hexdigest()


def dump_scenario_yaml(scenario: Scenario, kinds: Mapping[str, int] | None = None) -> str:
    """Return a document with references that reads back to the same scenario and hash.

    Args:
        scenario: a validated scenario.
        kinds: kind -> spec_version, which the document then requires.
    """
    content = plain(scenario)
    references = {
        name: difference(content, {**plain(other), "id": scenario.id, "title": scenario.title})
        for name, other in scenario.references.items()
    }
    document: dict[str, Any] = {"crowdbot": 1}
    if kinds:
        document["kinds"] = dict(sorted(kinds.items()))
    document["scenario"] = content
    if references:
        document["references"] = references
    return _HEADER + to_yaml_in_parts(document)


def difference(old: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    """Return the overrides that convert one document to another."""
    out: dict[str, Any] = {key: None for key in old if key not in new}
    for key, value in new.items():
        before = old.get(key)
        if key in old and before == value:
            continue
        same_kind = isinstance(before, dict) and isinstance(value, dict) and (
            before.get("kind") == value.get("kind")
        )  # fmt: skip
        out[key] = difference(before, value) if same_kind and before and value else value
    return out


def plain(scenario: Scenario) -> dict[str, Any]:
    """Return all fields as plain data, defaults included; -0.0 becomes 0.0."""
    content: dict[str, Any] = _fold(scenario.model_dump(mode="json"))
    return content


def _fold(value: Any) -> Any:
    """Convert minus zero to zero."""
    if isinstance(value, dict):
        return {key: _fold(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_fold(item) for item in value]
    return value + 0.0 if isinstance(value, float) else value

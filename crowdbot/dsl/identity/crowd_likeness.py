"""Similarity of crowds, regardless of the place: policy, costs, steering, speeds, bodies."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from crowdbot.dsl.scenario.crowd import Crowd

_LIKE = ("policy", "costs", "steering", "speed", "body")


def fingerprint(crowd: Crowd) -> str:
    """Return 16 hex digits, equal for similar crowds, regardless of their people's paths."""
    content = crowd.model_dump(mode="json", include=set(_LIKE))
    kept = {name: content[name] for name in _LIKE if content.get(name) is not None}
    text = json.dumps(_plain(kept), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _plain(value: Any) -> Any:
    """Convert numbers to floats, since 1 and 1.0 are equal."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value

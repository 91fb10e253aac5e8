"""Which crowds are alike wherever they walk: the same policy, costs, steering, speeds, bodies."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from crowdbot.dsl.scenario.scenario import Crowd

_LIKE = ("policy", "costs", "steering", "speed", "body")


def fingerprint(crowd: Crowd) -> str:
    """Equal for crowds that are alike, whoever walks where in them; 16 hex digits."""
    content = crowd.model_dump(mode="json", include=set(_LIKE))
    kept = {name: content[name] for name in _LIKE if content.get(name) is not None}
    text = json.dumps(_plain(kept), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _plain(value: Any) -> Any:
    """Numbers as floats: 1 and 1.0 are equal."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value

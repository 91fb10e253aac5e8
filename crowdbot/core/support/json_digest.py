"""Hash of a JSON document, independent of the order of its keys."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any


def digest(document: Mapping[str, Any]) -> str:
    """Return the ``cb1-sha256:`` hash of a JSON document."""
    text = json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return f"cb1-sha256:{hashlib.sha256(text.encode()).hexdigest()}"

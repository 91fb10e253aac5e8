"""Plain data as YAML."""

from __future__ import annotations

import io
import re
from typing import Any

_PLAIN = re.compile(r"[A-Za-z_]([A-Za-z0-9_ ./+-]*[A-Za-z0-9_])?")


def to_yaml(document: Any) -> str:
    """Return plain data as YAML, in the given order, innermost lists and maps on one line."""
    from ruamel.yaml import YAML  # slow to import, and few commands write documents

    yaml = YAML(typ="safe", pure=True)
    yaml.default_flow_style = None
    yaml.sort_base_mapping_type_on_output = False  # type: ignore[assignment]
    yaml.width = 100
    yaml.representer.ignore_aliases = lambda _data: True
    yaml.representer.add_representer(str, _represent_text)
    stream = io.StringIO()
    yaml.dump(document, stream)
    return stream.getvalue()


def _represent_text(representer: Any, text: str) -> Any:
    """Represent text without quotes unless it is ambiguous in some YAML reader."""
    style = None if _PLAIN.fullmatch(text) else '"'
    return representer.represent_scalar("tag:yaml.org,2002:str", text, style=style)

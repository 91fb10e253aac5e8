"""The scenario language: specs, YAML, matrices, hashes, diagnostics.

It imports the standard library, pydantic, PyYAML and ruamel.yaml only. Plugins import its specs
from `crowdbot.plugin`; here those names are kept until 1.0.
"""

from __future__ import annotations

from typing import Any


def __getattr__(name: str) -> Any:
    from crowdbot import plugin
    from crowdbot.old_names import old_name

    return old_name(__name__, plugin, name)

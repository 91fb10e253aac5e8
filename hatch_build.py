"""Build hook of hatch: the JSON Schemas of documents are made, not committed.

It runs for a wheel and for an editable installation, which ``make setup`` makes. An isolated build
lacks the packages that crowdbot needs; its wheel has no schema files, and ``crowdbot schema`` makes
them.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SCRIPT = Path("scripts") / "write_schemas.py"


class SchemaHook(BuildHookInterface[Any]):
    """Writes ``scenario_specs/schema`` before files are collected."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write the schemas; a failure leaves them out."""
        del version, build_data
        environment = {**os.environ, "PYTHONPATH": self.root}
        done = subprocess.run(
            [sys.executable, str(Path(self.root) / SCRIPT)], env=environment, capture_output=True
        )
        if done.returncode:
            self.app.display_warning("without JSON Schemas: 'crowdbot schema' makes them")

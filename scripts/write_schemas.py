"""Writes scenario_specs/schema from the built-in components; a test compares the files with them.

Example: .venv/bin/python scripts/write_schemas.py
"""

from __future__ import annotations

from pathlib import Path

from crowdbot.cli.commands.schema import DocumentKind, build, to_text
from crowdbot.core.registry.registry import discover

FOLDER = Path(__file__).parent.parent / "scenario_specs" / "schema"


def schema_texts() -> dict[str, str]:
    """File name -> text of every committed schema."""
    registry = discover(allow=())
    return {f"{d}.v1.schema.json": to_text(build(d, registry)) for d in DocumentKind}


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, text in schema_texts().items():
        (FOLDER / name).write_text(text, encoding="utf-8")

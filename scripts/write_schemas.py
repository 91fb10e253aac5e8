"""Write the JSON Schemas of the built-in components into scenario_specs/schema, for editors.

The folder is not committed: ``make setup``, ``make generate`` and the build of a wheel write it.

Example: .venv/bin/python scripts/write_schemas.py
"""

from __future__ import annotations

from pathlib import Path

from crowdbot.cli.commands.extend.schema import DocumentKind, build, to_text
from crowdbot.core.registry.registry import discover
from crowdbot.core.support.atomic_write import atomic_write

FOLDER = Path(__file__).parent.parent / "scenario_specs" / "schema"


def schema_texts() -> dict[str, str]:
    """Return file name -> text of every schema."""
    registry = discover(entry_points=False)
    return {f"{d}.v1.schema.json": to_text(build(d, registry)) for d in DocumentKind}


def write() -> None:
    """Write every schema."""
    FOLDER.mkdir(exist_ok=True)
    for name, text in schema_texts().items():
        atomic_write(FOLDER / name, text.encode())


if __name__ == "__main__":
    write()

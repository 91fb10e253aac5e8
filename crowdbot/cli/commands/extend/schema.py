"""``crowdbot schema``: print JSON Schemas of documents, from the installed components."""

from __future__ import annotations

import json
import logging
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.errors import UsageError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry


_LOG = logging.getLogger(__name__)


class DocumentKind(StrEnum):
    """Kinds of documents with a schema."""

    SUITE = "suite"
    SCENARIO = "scenario"
    PLANNER = "planner"
    PART = "part"


def schema(
    document: Annotated[
        DocumentKind, typer.Argument(help="part: a file that others name in 'extends'.")
    ],
    canonical: Annotated[
        bool, switch("--canonical", "Schema of what crowdbot writes: numbers only, every field.")
    ] = False,
    out: Annotated[Path | None, option("FILE", "File to write; default: standard output.")] = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
) -> None:
    """Print the JSON Schema of a document, for editors, including plugins' components.

    Example: crowdbot schema suite --out suite.schema.json
    """
    if canonical and document not in (DocumentKind.SCENARIO, DocumentKind.PLANNER):
        raise UsageError(
            f"a {document} has no canonical form; 'crowdbot schema scenario --canonical' is that "
            "of its scenarios"
        )
    text = to_text(build(document, _describable(plugin, no_plugins), canonical=canonical))
    if out is None:
        say(text, nl=False)
    else:
        atomic_write(out, text.encode())


def _describable(plugin: list[Path] | None, no_plugins: bool) -> Registry:
    """Return the installed registry without plugins whose schemas fail; each gives a warning."""
    from crowdbot.core.registry.schema_check import describable

    found = installed(plugin, no_plugins)
    described = describable(found)
    for old, new in zip(found.plugins, described.plugins, strict=True):
        if new.failure and not old.error:
            _LOG.warning("warning: plugin '%s' is left out: %s", new.name, new.failure)
    return described


def build(document: str, registry: Registry, *, canonical: bool = False) -> dict[str, Any]:
    """Return the schema of a kind of document."""
    from crowdbot.dsl.schema import documents as schemas

    metrics = registry.components("metric")
    if document == DocumentKind.PLANNER:
        planners = [c.spec for c in registry.components("planner").values()]
        return schemas.planner_schema(planners, canonical=canonical)
    if document == DocumentKind.SUITE:
        return schemas.suite_schema(registry.scenario_model, metrics)
    if document == DocumentKind.PART:
        return schemas.part_schema(registry.scenario_model)
    if canonical:
        return schemas.canonical_scenario_schema(registry.scenario_model)
    return schemas.scenario_schema(registry.scenario_model, metrics)


def to_text(schema: dict[str, Any]) -> str:
    """Return JSON as it is printed and committed."""
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"

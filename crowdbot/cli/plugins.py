"""``crowdbot plugins``: what is installed, and what a component can be told."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from crowdbot.core.component import Component
    from crowdbot.core.registry import Plugin, Registry

plugins = typer.Typer(
    add_completion=False, context_settings={"help_option_names": ["-h", "--help"]}
)
_Json = Annotated[bool, typer.Option("--json", help="JSON on stdout.")]
_FEW = 6
_HEAD = ["plugin", "distribution", "api", "state", "provides"]


@plugins.callback(invoke_without_command=True)
def listing(context: typer.Context, as_json: _Json = False) -> None:
    """List plugins, healthy or not, and what they provide.

    Example: crowdbot plugins show lidar2d
    """
    if context.invoked_subcommand is not None:
        return
    from crowdbot.core.registry import discover

    found = discover().plugins
    if as_json:
        typer.echo(json.dumps([_as_dict(p) for p in found], indent=2))
    else:
        typer.echo(_table([_HEAD, *map(_row, found)]))


@plugins.command()
def show(
    kind: Annotated[str, typer.Argument(metavar="KIND", help="Name of a component.")],
    as_json: _Json = False,
) -> None:
    """Show a component: summary, fields, an example, where it is built.

    Example: crowdbot plugins show ttca_dca
    """
    from crowdbot.core.registry import discover
    from crowdbot.errors import UnknownNameError

    registry = discover()
    everything = [c for p in registry.plugins for c in p.components]
    found = [c for c in everything if c.kind == kind]
    if not found:
        raise UnknownNameError("kind", kind, {c.kind for c in everything})
    if as_json:
        typer.echo(json.dumps([_component_dict(c, registry) for c in found], indent=2))
    else:
        typer.echo("\n\n".join(_component_text(c, registry) for c in found))


def _row(plugin: Plugin) -> list[str]:
    from crowdbot.hookspecs import API_VERSION

    if plugin.error:
        return [plugin.name, plugin.distribution, "–", "failed", " ".join(plugin.error.split())]
    provides = "  ".join(f"{c}: {_few(kinds)}" for c, kinds in _provided(plugin).items())
    return [plugin.name, plugin.distribution, str(API_VERSION), "ok", provides]


def _few(kinds: list[str]) -> str:
    return " ".join(kinds) if len(kinds) <= _FEW else str(len(kinds))


def _provided(plugin: Plugin) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for component in plugin.components:
        found.setdefault(component.category, []).append(component.kind)
    return found


def _as_dict(plugin: Plugin) -> dict[str, Any]:
    return {
        "name": plugin.name,
        "distribution": plugin.distribution,
        "pinned": plugin.pinned,
        "state": "failed" if plugin.error else "ok",
        "error": plugin.error,
        "provides": _provided(plugin),
    }


def _table(rows: list[list[str]]) -> str:
    """Columns as wide as their widest cell; the last one is free."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]) - 1)]
    lines = []
    for row in rows:
        cells = [f"{cell:<{width}}" for cell, width in zip(row, widths, strict=False)]
        lines.append("  ".join([*cells, row[-1]]).rstrip())
    return "\n".join(lines)


def _component_dict(component: Component[Any], registry: Registry) -> dict[str, Any]:
    owner = registry.owner(component)
    names = ("field", "type", "unit", "default", "description")
    return {
        "kind": component.kind,
        "category": component.category,
        "summary": component.summary,
        "spec_version": component.spec_version,
        "build": component.build,
        "plugin": owner.name,
        "distribution": owner.distribution,
        "fields": [dict(zip(names, row, strict=True)) for row in _fields(component.spec)],
        "example": {"kind": component.kind, **component.examples[0]} if component.examples else {},
    }


def _component_text(component: Component[Any], registry: Registry) -> str:
    from crowdbot.dsl.canonical import to_yaml

    about = _component_dict(component, registry)
    head = ["field", "type", "unit", "default", "description"]
    return "\n".join(
        [
            f"{component.kind}: {component.category}, {component.summary}",
            f"from {about['distribution']}, spec version {component.spec_version}, "
            f"built by {component.build}",
            "",
            _table([head, *_fields(component.spec)]),
            "",
            "example:",
            *(f"  {line}" for line in to_yaml(about["example"]).splitlines()),
        ]
    )


def _fields(model: Any, prefix: str = "") -> Iterator[list[str]]:
    """Rows of name, type, unit, default and description; maps of fields are followed."""
    from crowdbot.dsl.quantities import Quantity
    from crowdbot.dsl.validation import nested_model

    for name, info in model.model_fields.items():
        if name == "kind":
            continue
        unit = next((m.si_unit for m in info.metadata if isinstance(m, Quantity)), "")
        inner = nested_model(info.annotation)
        if inner is not None:
            yield from _fields(inner, f"{prefix}{name}.")
            continue
        default = "required" if info.is_required() else _short(info.default)
        kind = "number" if info.annotation is float else _type_name(info.annotation)
        yield [f"{prefix}{name}", kind, unit, default, info.description or ""]


def _type_name(annotation: Any) -> str:
    if getattr(annotation, "__origin__", None) is dict:
        return "map of names"
    text = getattr(annotation, "__name__", "") if not hasattr(annotation, "__args__") else ""
    words = {"int": "integer", "str": "text", "bool": "true/false"}
    return words.get(text, text) or str(annotation).replace("typing.", "").replace(
        "crowdbot.dsl.base.", ""
    )


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    return str(value).lower() if isinstance(value, bool) else str(value)

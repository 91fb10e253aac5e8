"""Everything about one component, as text or JSON."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import metadata
from typing import Any

from crowdbot.cli.output.plugin_table import table
from crowdbot.cli.output.type_words import default_words, type_words
from crowdbot.core.registry.plugin import BUILTIN, Plugin
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.metric_component import MetricComponent

_FIELDS = ("field", "type", "unit", "default", "description")


def as_dict(component: Component[Any], registry: Registry) -> dict[str, Any]:
    """Return the description of a component as JSON data."""
    owner = registry.owner(component)
    return {
        "kind": component.kind,
        "category": component.category,
        "summary": component.summary,
        "spec_version": component.spec_version,
        "spec": f"{component.spec.__module__}:{component.spec.__qualname__}",
        "build": component.build,
        "plugin": owner.name,
        "distribution": owner.distribution,
        "pinned": owner.pinned,
        "reference": reference(component, owner),
        "experimental": component.experimental,
        "successor": component.successor,
        "fields": [dict(zip(_FIELDS, row, strict=True)) for row in _fields(component.spec)],
        "example": {"kind": component.kind, **component.examples[0]} if component.examples else {},
        **({"label": _label(component)} if isinstance(component, MetricComponent) else {}),
    }


def as_text(component: Component[Any], registry: Registry) -> str:
    """Return the description of a component as text."""
    from crowdbot.dsl.text.plain_yaml import to_yaml

    about = as_dict(component, registry)
    marks = ", experimental" * component.experimental
    marks += f", retired for {component.successor}" if component.successor else ""
    loose = ", not installed" if registry.owner(component).given else ", installed to be edited"
    where = "" if about["pinned"] else loose
    lines = [
        f"{component.kind}: {component.category}, {component.summary}{marks}",
        f"from {about['distribution']} (plugin {about['plugin']}{where}), "
        f"spec version {component.spec_version}",
        f"built by {component.build}",
        f"described in {about['reference']}",
    ]
    if label := about.get("label"):
        lines += [f"{label['symbol']} in {label['unit'] or '1'}, better: {label['better']}"]
        lines += [f"variants: {' '.join(label['variants'])}"]
    rows = list(_fields(component.spec, words=True))
    lines += ["", table([_FIELDS, *rows]) if rows else "no fields"]
    example = to_yaml(about["example"]).splitlines()
    return "\n".join([*lines, "", "example:", *(f"  {line}" for line in example)])


def reference(component: Component[Any], owner: Plugin) -> str:
    """Return where a component is documented: page, card, address or file."""
    name = component.kind
    if owner.name == BUILTIN:
        learning = f"learning.md#{name}"
        pages = {
            "metric": f"metrics/{name}.md", "planner": _page_of_planner(component),
            "observation": learning, "reward": learning,
        }  # fmt: skip
        plural = re.sub("y$", "ie", component.category).replace(" ", "_") + "s"
        return f"docs/reference/{pages.get(component.category, f'components/{plural}.md#{name}')}"
    if component.category == "metric" and component.card_place:
        return component.card_place
    return _documentation(owner) or component.spec.__module__


def _page_of_planner(component: Component[Any]) -> str:
    """Return the documentation page of one of crowdbot's planners, with its section if shared."""
    role = getattr(component.spec, "role", "")
    own = f"planners/{component.kind}.md"
    pages = {"adversary": "planners.md#adversaries", "candidate": own, "ceiling": own}
    return pages.get(role, f"planners.md#{component.kind}")


def _documentation(owner: Plugin) -> str:
    """Return the documentation address that a distribution declares, or its home page."""
    if owner.given:
        return ""
    try:
        listed = metadata.metadata(owner.distribution.rpartition(" ")[0]).get_all("Project-URL")
    except metadata.PackageNotFoundError:
        return ""
    pairs = [entry.partition(",") for entry in listed or ()]
    urls = {label.strip().lower(): url.strip() for label, _, url in pairs}
    labels = ("documentation", "docs", "homepage", "source", "repository")
    return next((urls[label] for label in labels if label in urls), "")


def _label(metric: MetricComponent[Any]) -> dict[str, Any]:
    return {
        "symbol": metric.symbol,
        "unit": metric.unit,
        "better": metric.better,
        "variants": list(metric.variants),
    }


def _fields(model: Any, prefix: str = "", *, words: bool = False) -> Iterator[list[str]]:
    """Yield rows of name, type, unit, default and description, nested fields included.

    Args:
        model: the spec.
        prefix: put before all names.
        words: True for types and defaults in words, with limits.
    """
    from crowdbot.dsl.checks.pydantic_errors import nested_model
    from crowdbot.dsl.spec.quantities import Quantity

    for name, info in model.model_fields.items():
        if name == "kind":
            continue
        unit = next((m.si_unit for m in info.metadata if isinstance(m, Quantity)), "")
        inner = nested_model(info.annotation)
        if inner is not None:
            yield from _fields(inner, f"{prefix}{name}.", words=words)
            continue
        shown = default_words if words else _short
        default = "required" if info.is_required() else shown(info.default)
        kind = "number" if info.annotation is float else _type_name(info.annotation)
        if words:
            kind = type_words(info.annotation, tuple(info.metadata))
        yield [f"{prefix}{name}", kind, unit, default, info.description or ""]


def _type_name(annotation: Any) -> str:
    if getattr(annotation, "__origin__", None) is dict:
        return "map of names"
    text = getattr(annotation, "__name__", "") if not hasattr(annotation, "__args__") else ""
    words = {"int": "integer", "str": "text", "bool": "true/false"}
    return words.get(text, text) or re.sub(r"typing\.|crowdbot\.dsl\.\w+\.", "", str(annotation))


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    return str(value).lower() if isinstance(value, bool) else str(value)

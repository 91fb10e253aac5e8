"""The editor's drawing of a text: walls, people, movable items, and validation messages."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from crowdbot.core.environments.build import build_environment
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.library import installed
from crowdbot.core.scenarios.lock import population
from crowdbot.core.scenarios.plugin_folders import plugin_folders
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expand import expand_document, load_document
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.dsl.text.nodes import parse, to_data
from crowdbot.errors import CrowdbotError, SpecError

#: Most people who are drawn one by one.
_MOST = 5000


def drawn(text: str, file: Path, registry: Registry) -> dict[str, Any]:
    """Return the drawing of a document: ``errors``, ``data``, ``walls``, ``people`` and more.

    Args:
        text: the document.
        file: its file, beside which `extends` and tables lie; it is not read.
        registry: the installed components.
    """
    aside = file.with_name(f".{file.stem}.{os.getpid()}.edit.yaml")
    try:
        aside.write_text(text, encoding="utf-8")
        suite = load_document(
            aside, plugin_folders(registry), name=file.name, installed=installed(registry)
        )
        found = expand_document(suite, registry.scenario_model)
        return _scene(found.scenarios[0], registry)
    except SpecError as error:
        return {"errors": [_shown(d) for d in error.diagnostics[:50]], "data": _raw(text, file)}
    except (CrowdbotError, OSError) as error:
        whole = Diagnostic("E402", str(error), Mark(Source(file.name)))
        return {"errors": [_shown(whole)], "data": _raw(text, file)}
    finally:
        aside.unlink(missing_ok=True)


def _shown(diagnostic: Diagnostic) -> dict[str, Any]:
    fields = {name: getattr(diagnostic, name) for name in ("code", "message", "hint")}
    return {"line": diagnostic.mark.line + 1, "column": diagnostic.mark.column + 1, **fields}


def _scene(scenario: Scenario, registry: Registry) -> dict[str, Any]:
    parts = build_environment(registry, scenario.environment)
    people: list[list[float]] = []
    if scenario.crowd is not None:
        agents = population(scenario, registry).agents
        count = min(len(agents), _MOST)
        people = [
            [round(float(v), 3) for v in row]
            for row in zip(agents.x[:count], agents.y[:count], agents.radius[:count], strict=True)
        ]
    return {
        "errors": [],
        "data": scenario.model_dump(mode="json", exclude_unset=True),
        "walls": [[round(v, 4) for v in wall] for wall in parts.walls.tolist()],
        "pillars": [[round(v, 4) for v in pillar[:3]] for pillar in parts.pillars.tolist()],
        "zones": _boxes(parts.zones),
        "portals": _boxes(parts.portals),
        "people": people,
    }


def _boxes(named: Mapping[str, Any]) -> dict[str, list[float]]:
    return {name: [float(v) for v in _bounds(box)] for name, box in named.items()}


def _bounds(box: Any) -> list[float]:
    """Return the bounds x0, x1, y0, y1 of a polygon; given bounds are returned unchanged."""
    if len(box) == 4 and not hasattr(box[0], "__len__"):
        return list(box)
    xs, ys = [p[0] for p in box], [p[1] for p in box]
    return [min(xs), max(xs), min(ys), max(ys)]


def _raw(text: str, file: Path) -> Any:
    """Return the scenario of a document that is not valid, as far as it can be parsed."""
    problems: list[Diagnostic] = []
    try:
        root = to_data(parse(text, replace(Source(file.name)), problems))
    except SpecError:
        return {}
    found = root.get("scenario") if isinstance(root, dict) else None
    return found if isinstance(found, dict) else {}

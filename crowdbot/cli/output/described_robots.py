"""Robots from files, built for ``crowdbot validate``: faults that only a build finds."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from crowdbot.errors import InputError, PluginError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.suite.expansion import Expansion
    from crowdbot.dsl.text.diagnostics import Diagnostic


def robot_faults(expansion: Expansion, registry: Registry) -> Iterator[Diagnostic]:
    """Yield why robots from a URDF or an SDFormat file cannot be built; each robot once.

    Such files include others, place wheels one before the other or at two heights, or miss parts.
    """
    from crowdbot.dsl.checks.pydantic_errors import mark_of
    from crowdbot.dsl.spec.assets import Asset
    from crowdbot.dsl.text.diagnostics import Diagnostic

    seen = set[str]()
    for scenario in expansion.scenarios:
        for name, robot in scenario.robots.items():
            key = robot.model.model_dump_json()
            if not isinstance(getattr(robot.model, "file", None), Asset) or key in seen:
                continue
            seen.add(key)
            from crowdbot.core.robots.build import build_model  # numpy

            try:
                build_model(registry, robot.model)
            except (InputError, PluginError) as error:
                mark = mark_of(expansion.trees[scenario.id], "robots", name, "model")
                yield Diagnostic("E115", str(error), mark)

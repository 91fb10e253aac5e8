"""A scenario as a drawing for notebooks."""

from __future__ import annotations

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.lock import population
from crowdbot.core.view.build import build_map_content
from crowdbot.core.view.facts import scenario_facts
from crowdbot.core.view.render import render
from crowdbot.core.view.svg import element, stylesheet
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.scenario.scenario import Scenario


def scenario_html(scenario: Scenario) -> str:
    """Return the drawing of ``crowdbot view`` as an ``svg`` element with its own style.

    Raises:
        InputError: its lock is out of date.
        PluginError: its environment or robot cannot be built.
    """
    registry = discover()
    people = population(scenario, registry).agents
    facts = scenario_facts(
        scenario, people, content_hash(scenario, registry.spec_versions(scenario))
    )
    content = build_map_content(scenario, people, registry)
    drawing = render(content, scenario.id, facts, heading=True)
    return element(drawing, f"<style>{stylesheet()}</style>")

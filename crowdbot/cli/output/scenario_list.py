"""The list printed by ``crowdbot expand``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from crowdbot.cli.output.say import say

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.scenario.scenario import Scenario


def print_scenarios(scenarios: Sequence[Scenario], registry: Registry, *, count: bool) -> None:
    """Print id and hash of each scenario, or only their number."""
    if count:
        say(len(scenarios))
        return
    width = max((len(s.id) for s in scenarios), default=0)
    for scenario in scenarios:
        text = "hidden draw" if scenario.hidden else hash_of(scenario, registry)
        say(f"{scenario.id:<{width}}  {text}")


def hash_of(scenario: Scenario, registry: Registry) -> str:
    """Return the content hash of a scenario, with the installed components."""
    from crowdbot.dsl.identity.canonical import content_hash

    return content_hash(scenario, registry.spec_versions(scenario))

"""A cache of a suite's people, since many scenarios share one sampled crowd."""

from __future__ import annotations

from collections.abc import Callable

from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.lock import Population, population
from crowdbot.core.scenarios.lock_check import check_fits
from crowdbot.dsl.identity.population_inputs import population_inputs
from crowdbot.dsl.scenario.scenario import Scenario


def cached_population() -> Callable[[Scenario, Registry], Population]:
    """Return a cached `population`: each table is drawn or read once, every scenario is checked."""
    known: dict[tuple[str, str], Population] = {}

    def populate(scenario: Scenario, registry: Registry) -> Population:
        if scenario.crowd is None:
            return population(scenario, registry)
        lock = ""
        if scenario.locked is not None:
            check_fits(scenario.locked.files, scenario.locked.origin(), registry)
            lock = str(scenario.locked.files.lock_path)
        key = (lock, population_inputs(scenario))
        if key not in known:
            known[key] = population(scenario, registry)
        return known[key]

    return populate

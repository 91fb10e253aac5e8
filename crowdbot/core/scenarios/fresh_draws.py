"""The scenarios of a suite with other people: the same conditions, another seed."""

from __future__ import annotations

from dataclasses import replace

from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.library import open_document
from crowdbot.dsl.suite.expand import expand_document
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError


def fresh_draws(spec: str, registry: Registry, seed: int) -> Expansion:
    """Return a suite's scenarios with people of another seed, without its lock.

    A suite whose seed is hidden may be given, too.

    Args:
        spec: file or name of the suite.
        registry: the installed components.
        seed: root of the random numbers of every crowd.

    Raises:
        SpecError: the document is invalid.
        InputError: it is a single scenario, which has no draws.
    """
    document = open_document(spec, registry)
    suite = document.suite
    if suite.seed is None:
        raise InputError(f"{document.name} is a single scenario; only suites have draws")
    own = replace(suite, seed=replace(suite.seed, value=seed), commitment="", hidden=False)
    return expand_document(own, registry.scenario_model)

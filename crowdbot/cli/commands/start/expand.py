"""``crowdbot expand``: list the scenarios of a suite and their hashes, or print one in full."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.output.scenario_list import hash_of, print_scenarios
from crowdbot.cli.shared.option import option, switch
from crowdbot.cli.shared.options import EveryScenarioSet, NoPlugins, Plugins, installed
from crowdbot.cli.shared.run_arguments import AsJson, SpecArgument
from crowdbot.errors import printable

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.scenario.scenario import Scenario
    from crowdbot.dsl.suite.expansion import Expansion


def expand(
    spec: SpecArgument,
    only: Annotated[
        list[str] | None, option("GLOB", "Only ids that match, e.g. 'in-*-c50-*'; repeatable.")
    ] = None,
    one: Annotated[str | None, option("ID", "Print one scenario with every default.")] = None,
    explain: Annotated[
        bool, switch("--explain", "With --one: say where each value comes from.")
    ] = False,
    count: Annotated[bool, switch("--count", "Print only how many there are.")] = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: AsJson = False,
    overrides: EveryScenarioSet = None,
) -> None:
    """List the scenarios of a suite with their hashes, or print one in full.

    Example: crowdbot expand challenge-2020 --only 'counter-*-c50-*'
    """
    from crowdbot.core.scenarios.library import open_spec

    if explain and one is None:
        raise typer.BadParameter("--explain goes with --one ID")
    registry = installed(plugin, no_plugins)
    expansion = open_spec(spec, registry, overrides or ())
    if one is not None:
        say(_one(expansion, one, registry, as_json=as_json, explain=explain), nl=False)
        return
    scenarios = _matching(expansion, only or ())
    if as_json and not count:
        say_json([_row(expansion, s, registry) for s in scenarios])
        return
    print_scenarios(scenarios, registry, count=count)
    if expansion.round is not None and not count:
        say(f"round: {printable(expansion.round.text)}")


def _matching(expansion: Expansion, patterns: Sequence[str]) -> list[Scenario]:
    """Return scenarios whose id matches any pattern, in the suite's order; all without patterns.

    Raises:
        UnknownNameError: no id matches one of them.
    """
    from crowdbot.core.scenarios.library import select_any
    from crowdbot.errors import UnknownNameError

    found, unmatched = select_any(expansion, patterns)
    if unmatched:
        raise UnknownNameError("scenario", unmatched[0], [s.id for s in expansion.scenarios])
    return found


def _one(
    expansion: Expansion, pattern: str, registry: Registry, *, as_json: bool, explain: bool
) -> str:
    from crowdbot.core.scenarios.library import pick
    from crowdbot.dsl.identity.canonical import canonical_bytes, dump_scenario_yaml
    from crowdbot.dsl.suite.explain import explain_yaml

    scenario = pick(expansion, pattern)
    if scenario.hidden:
        say("its people are hidden: the seed below is not theirs", err=True)
    if as_json:
        text = canonical_bytes(scenario, registry.spec_versions(scenario)).decode()
        content = {**_row(expansion, scenario, registry), "scenario": json.loads(text)}
        return json.dumps(content, indent=2) + "\n"
    if explain:
        return explain_yaml(scenario, expansion.trees[scenario.id])
    return dump_scenario_yaml(scenario, registry.spec_versions(scenario))


def _row(expansion: Expansion, scenario: Scenario, registry: Registry) -> dict[str, str | None]:
    row = {"suite": expansion.suite_id, "id": scenario.id, "title": scenario.title}
    return row | {"hash": None if scenario.hidden else hash_of(scenario, registry)}

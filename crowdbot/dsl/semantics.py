"""Checks between fields that no single field can make, after a scenario is validated."""

from __future__ import annotations

from collections.abc import Iterator

from crowdbot.dsl.components import components
from crowdbot.dsl.diagnostics import Diagnostic
from crowdbot.dsl.nodes import Node
from crowdbot.dsl.scenario import Scenario, TaskSpec
from crowdbot.dsl.semantics_agents import check_agents
from crowdbot.dsl.semantics_crowd import check_crowd
from crowdbot.dsl.semantics_facts import Facts
from crowdbot.dsl.semantics_spawns import check_spawns
from crowdbot.dsl.semantics_streams import check_streams
from crowdbot.dsl.semantics_ways import check_ways
from crowdbot.dsl.validation import locate, missing_field


def check(scenario: Scenario, tree: Node) -> list[Diagnostic]:
    """All contradictions of a scenario, each with its place in the tree it came from."""
    found, facts = list(_check_kinds(scenario, tree)), Facts(scenario, tree)
    if scenario.crowd is not None:
        found += [*check_crowd(facts), *check_streams(facts), *check_spawns(facts)]
        found += check_agents(facts)
    found += check_ways(facts)
    for name, robot in scenario.robots.items():
        found += _check_task(facts, name, robot.task)
    return found


def _check_kinds(scenario: Scenario, tree: Node) -> Iterator[Diagnostic]:
    """A kind is always written: left out, it would mean something as long as one is installed."""
    for path, _ in components(scenario):
        if _has_kind(tree, path):
            continue
        place = locate(tree, path)
        if not place.rest and place.node.child("kind") is None:
            yield missing_field(tree, place, "kind")


def _has_kind(tree: Node, path: tuple[str, ...]) -> bool:
    """Whether a kind is written at a path: the usual case, seen without looking for anything."""
    node: Node | None = tree
    for name in (*path, "kind"):
        node = None if node is None else node.child(name)
    return node is not None


def _check_task(facts: Facts, name: str, task: TaskSpec) -> Iterator[Diagnostic]:
    zones, path = facts.scenario.environment.zones, ("robots", name, "task")
    if task.goal.zone not in zones:
        yield facts.unknown("zone", task.goal.zone, zones, *path, "goal", "zone")
    yield from facts.outside(
        f"the start {{at}} of robot '{name}'", [task.start[:2]], *path, "start"
    )

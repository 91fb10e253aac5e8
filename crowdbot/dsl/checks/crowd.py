"""Checks of a whole crowd: its flow, its policies, and that it has people."""

from __future__ import annotations

from collections.abc import Iterator

from crowdbot.dsl.checks.facts import Facts
from crowdbot.dsl.scenario.crowd import Flow
from crowdbot.dsl.spec.component_specs import CrowdPolicySpec
from crowdbot.dsl.text.diagnostics import Diagnostic


def check_crowd(facts: Facts) -> Iterator[Diagnostic]:
    """Check everything about a crowd except single spawns and agents."""
    crowd = facts.crowd
    if crowd.names_nobody and crowd.policy.record is None:
        hint = (
            "write one of flow, streams, spawns and agents; "
            "'crowd: null' is a scenario without people"
        )
        yield Diagnostic("E134", "the crowd has no people", facts.mark("crowd"), hint)
    if crowd.flow is not None:
        yield from _check_flow(facts, crowd.flow)
    yield from _check_costs(facts, crowd.policy, not crowd.costs, "crowd")
    for name, named in crowd.policies.items():
        yield from _check_costs(facts, named.policy, not named.costs, "crowd", "policies", name)


def _check_flow(facts: Facts, flow: Flow) -> Iterator[Diagnostic]:
    zones = facts.scenario.environment.zones
    if flow.area in zones:
        where = f"zone '{flow.area}'"
        yield from facts.whole(flow.density, zones[flow.area].area, where, *_DENSITY)
    else:
        yield facts.unknown("zone", flow.area, zones, "crowd", "flow", "area")
    yield from facts.portals(flow.portals, "a flow", "crowd", "flow", "portals")
    if facts.crowd.speed is None:
        yield missing_speed(facts, "the flow", "crowd", "flow")


_DENSITY = ("crowd", "flow", "density")


def _check_costs(
    facts: Facts, policy: CrowdPolicySpec, bare: bool, *path: str
) -> Iterator[Diagnostic]:
    if policy.needs_costs and bare:
        where = ".".join((*path, "costs"))
        text = f"policy {policy.kind} minimises cost functions, and {where} has none"
        hint = "write some, such as {reflex: {kind: rvo}}"
        yield Diagnostic("E133", text, facts.mark(*path, "costs"), hint)


def missing_speed(facts: Facts, subject: str, *path: str | int) -> Diagnostic:
    """Return the error for people without a preferred speed, of their own or the crowd's."""
    hint = "write crowd.speed, such as {mean: 1.3 m/s, std: 0.2 m/s}"
    return Diagnostic("E135", f"{subject} has no speed, nor has the crowd", facts.mark(*path), hint)

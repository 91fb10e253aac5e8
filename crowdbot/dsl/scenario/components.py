"""The components of a scenario, and their paths in its document."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.component_specs import CostFunctionSpec, CrowdPolicySpec
from crowdbot.dsl.spec.spec import ComponentSpec

Path = tuple[str, ...]


def components(scenario: Scenario) -> Iterator[tuple[Path, ComponentSpec]]:
    """Yield path and spec of every component; nested ones follow their owner."""
    for path, spec in _stated(scenario):
        yield path, spec
        for name, part in spec.parts().items():
            yield (*path, spec.parts_field, name), part


def _stated(scenario: Scenario) -> Iterator[tuple[Path, ComponentSpec]]:
    yield ("environment",), scenario.environment
    if (crowd := scenario.crowd) is not None:
        yield from _policy(("crowd",), crowd.policy, crowd.costs)
        for name, named in crowd.policies.items():
            yield from _policy(("crowd", "policies", name), named.policy, named.costs)
    for name, robot in scenario.robots.items():
        yield ("robots", name, "model"), robot.model
        for sensor, spec in robot.sensors.items():
            yield ("robots", name, "sensors", sensor), spec


def _policy(
    above: Path, policy: CrowdPolicySpec, costs: Mapping[str, CostFunctionSpec]
) -> Iterator[tuple[Path, ComponentSpec]]:
    yield (*above, "policy"), policy
    for name, cost in costs.items():
        yield (*above, "costs", name), cost

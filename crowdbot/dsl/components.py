"""The components of a scenario, and where in its document they stand."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from crowdbot.dsl.base import ComponentSpec, CostFunctionSpec, CrowdPolicySpec
from crowdbot.dsl.proximity import ProximitySpec
from crowdbot.dsl.scenario import Scenario

Path = tuple[str, ...]


def components(scenario: Scenario) -> Iterator[tuple[Path, ComponentSpec]]:
    """Path and spec of every component."""
    yield ("environment",), scenario.environment
    if (crowd := scenario.crowd) is not None:
        yield from _policy(("crowd",), crowd.policy, crowd.costs)
        for name, named in crowd.policies.items():
            yield from _policy(("crowd", "policies", name), named.policy, named.costs)
    for name, robot in scenario.robots.items():
        yield ("robots", name, "model"), robot.model
        for sensor, spec in robot.sensors.items():
            above = ("robots", name, "sensors", sensor)
            yield above, spec
            for noise, generator in spec.noise.items() if isinstance(spec, ProximitySpec) else ():
                yield (*above, "noise", noise), generator


def _policy(
    above: Path, policy: CrowdPolicySpec, costs: Mapping[str, CostFunctionSpec]
) -> Iterator[tuple[Path, ComponentSpec]]:
    yield (*above, "policy"), policy
    for name, cost in costs.items():
        yield (*above, "costs", name), cost

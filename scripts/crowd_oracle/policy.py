"""Convert policies of the original crowd engine to our specs.

Names, attributes and defaults follow its XML files.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from typing import Any, cast

from crowdbot.core.exchange.umans.policies import COSTS
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.dsl.spec.component_specs import CostFunctionSpec
from crowdbot.dsl.spec.spec import Range
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec


@cache
def _registry() -> Registry:
    return discover()


def cost_spec(given: Mapping[str, str]) -> CostFunctionSpec:
    """Return the spec of one ``costfunction`` element.

    Raises:
        ValueError: its name is unknown, or one of its values is not a number.
    """
    name = given.get("name", "")
    if name not in COSTS:
        raise ValueError(f"cost function {name!r}: known are {', '.join(COSTS)}")
    kind, names = COSTS[name]
    fields: dict[str, Any] = {
        "weight": float(given.get("coeff", 1.0)),
        "range": Range(value=float(given.get("range", 5.0)), measure="centre"),
    }
    for theirs, ours in names.items():
        if theirs in given:
            fields[ours] = float(given[theirs])
    spec: Any = _registry().find(CostFunctionSpec.category, kind).spec(kind=kind, **fields)
    return cast(CostFunctionSpec, spec)


def policy_spec(given: Mapping[str, str]) -> VelocitySpaceSpec:
    """Return the spec of one ``Policy`` element.

    Raises:
        ValueError: an option is unknown, or one of its values is not a number.
    """

    def option(name: str, default: str) -> Any:
        return given.get(name, default).strip().lower().replace(" ", "_")

    degrees = float(given.get("SamplingAngle", 180.0))
    return VelocitySpaceSpec(
        method=option("OptimizationMethod", "gradient"),
        relaxation_time=float(given.get("RelaxationTime", 0.0)),
        contact_stiffness=float(given.get("ContactForceScale", 62.5)),
        samples=option("SamplingType", "regular"),
        base=option("SamplingBase", "zero"),
        direction=option("SamplingBaseDirection", "current velocity"),
        radius=option("SamplingRadius", "preferred speed"),
        angle=math.radians(degrees),
        speeds=int(given.get("SpeedSamples", 4)),
        angles=int(given.get("AngleSamples", 11)),
        random_samples=int(given.get("RandomSamples", 100)),
        include_base=option("IncludeBaseAsSample", "false") in ("true", "1"),
    )

"""Convert policies of the original crowd engine to our specs.

Names, attributes and defaults follow its XML files.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from crowdbot.dsl.spec.component_specs import CostFunctionSpec
from crowdbot.dsl.spec.spec import Range
from crowdbot.plugins.crowd.cost_functions.foe_avoidance import FoeAvoidanceSpec
from crowdbot.plugins.crowd.cost_functions.goal_reaching_force import GoalReachingForceSpec
from crowdbot.plugins.crowd.cost_functions.karamouzas import KaramouzasSpec
from crowdbot.plugins.crowd.cost_functions.moussaid import MoussaidSpec
from crowdbot.plugins.crowd.cost_functions.orca import OrcaSpec
from crowdbot.plugins.crowd.cost_functions.paris import ParisSpec
from crowdbot.plugins.crowd.cost_functions.pledestrians import PledestriansSpec
from crowdbot.plugins.crowd.cost_functions.power_law import PowerLawSpec
from crowdbot.plugins.crowd.cost_functions.random_function import RandomFunctionSpec
from crowdbot.plugins.crowd.cost_functions.rvo import RvoSpec
from crowdbot.plugins.crowd.cost_functions.social_forces_avoidance import SocialForcesAvoidanceSpec
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.cost_functions.van_toll import VanTollSpec
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec

#: Cost functions: our spec, and our name of each attribute. A later attribute replaces an earlier
#: one with the same name: U0 of the social forces overwrites V0.
COSTS: dict[str, tuple[type[CostFunctionSpec], dict[str, str]]] = {
    "TtcaDca": (
        TtcaDcaSpec,
        {
            "sigmaTtca": "sigma_ttca",
            "sigmaDca": "sigma_dca",
            "sigmaAngle_goal": "sigma_angle_goal",
            "sigmaSpeed_goal": "sigma_speed_goal",
        },
    ),
    "RVO": (RvoSpec, {"w": "w"}),
    "ORCA": (OrcaSpec, {"timeHorizon": "time_horizon"}),
    "FOEAvoidance": (FoeAvoidanceSpec, {}),
    "GoalReachingForce": (GoalReachingForceSpec, {}),
    "Karamouzas": (
        KaramouzasSpec,
        {name: name for name in ("alpha", "beta", "gamma", "delta", "t_max")},
    ),
    "Moussaid": (MoussaidSpec, {"d_max": "d_max"}),
    "Paris": (ParisSpec, {name: name for name in ("w_a", "w_b", "t_max")}),
    "PLEdestrians": (PledestriansSpec, {name: name for name in ("w_a", "w_b", "t_min", "t_max")}),
    "PowerLaw": (PowerLawSpec, {"k": "k", "tau0": "tau0"}),
    "RandomFunction": (RandomFunctionSpec, {}),
    "SocialForcesAvoidance": (
        SocialForcesAvoidanceSpec,
        {"dt": "dt", "V0": "v0", "sigma": "sigma", "R": "r", "U0": "v0"},
    ),
    "VanToll": (VanTollSpec, {"max_distance": "max_distance"}),
}


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
    return kind(**fields)


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

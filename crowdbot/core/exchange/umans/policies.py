"""Policies of UMANS as ours: optimisation methods, sampling and cost functions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, not_negative, positive, text
from crowdbot.core.exchange.scene import Data, free_name

#: Cost functions: our kind, and our name of each attribute. A later attribute replaces an earlier
#: one with the same name: U0 of the social forces overwrites V0.
COSTS: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "TtcaDca": ("ttca_dca", {"sigmaTtca": "sigma_ttca", "sigmaDca": "sigma_dca",
                             "sigmaAngle_goal": "sigma_angle_goal",
                             "sigmaSpeed_goal": "sigma_speed_goal"}),
    "RVO": ("rvo", {"w": "w"}),
    "ORCA": ("orca", {"timeHorizon": "time_horizon"}),
    "FOEAvoidance": ("foe_avoidance", {}),
    "GoalReachingForce": ("goal_reaching_force", {}),
    "Karamouzas": ("karamouzas", {n: n for n in ("alpha", "beta", "gamma", "delta", "t_max")}),
    "Moussaid": ("moussaid", {"d_max": "d_max"}),
    "Paris": ("paris", {n: n for n in ("w_a", "w_b", "t_max")}),
    "PLEdestrians": ("pledestrians", {n: n for n in ("w_a", "w_b", "t_min", "t_max")}),
    "PowerLaw": ("power_law", {"k": "k", "tau0": "tau0"}),
    "RandomFunction": ("random_function", {}),
    "SocialForcesAvoidance": ("social_forces_avoidance",
                              {"dt": "dt", "V0": "v0", "sigma": "sigma", "R": "r", "U0": "v0"}),
    "VanToll": ("van_toll", {"max_distance": "max_distance"}),
}  # fmt: skip


def _option(*known: str) -> Any:
    def read(item: Item) -> str:
        return item.word(*(k.replace("_", " ") for k in known)).replace(" ", "_")

    return read


def _degrees(item: Item) -> float:
    return math.radians(item.number(1e-6, 360.0))


def _count(item: Item) -> int:
    return item.whole(1)


POLICY = RowTable(
    "Policy",
    (
        Row("@OptimizationMethod", "velocity_space.method",
            read=_option("gradient", "sampling", "global")),
        Row("@RelaxationTime", "velocity_space.relaxation_time", read=not_negative),
        Row("@ContactForceScale", "velocity_space.contact_stiffness", read=not_negative),
        Row("@SamplingType", "velocity_space.samples", read=_option("regular", "random")),
        Row("@SamplingBase", "velocity_space.base", read=_option("zero", "current_velocity")),
        Row("@SamplingBaseDirection", "velocity_space.direction",
            read=_option("unit", "current_velocity", "preferred_velocity")),
        Row("@SamplingRadius", "velocity_space.radius",
            read=_option("preferred_speed", "maximum_speed", "maximum_acceleration")),
        Row("@SamplingAngle", "velocity_space.angle", read=_degrees),
        Row("@SpeedSamples", "velocity_space.speeds", read=_count),
        Row("@AngleSamples", "velocity_space.angles", read=_count),
        Row("@RandomSamples", "velocity_space.random_samples", read=_count),
        Row("@IncludeBaseAsSample", "velocity_space.include_base", read=Item.truth),
        Row("costfunction", "crowd.costs", read=text),
    ),
)  # fmt: skip
#: Values of UMANS where a policy does not say them.
DEFAULTS: Mapping[str, Any] = {
    "method": "gradient", "relaxation_time": 0.0, "contact_stiffness": 62.5, "samples": "regular",
    "base": "zero", "direction": "current_velocity", "radius": "preferred_speed",
    "angle": math.pi, "speeds": 4, "angles": 11, "random_samples": 100, "include_base": False,
}  # fmt: skip
#: Fields of a policy that only samples have.
_OF_SAMPLES = ("samples", "base", "direction", "radius", "angle", "speeds", "angles",
               "random_samples", "include_base")  # fmt: skip


def cost_table(name: str) -> RowTable:
    """Return the table of one cost function."""
    kind, names = COSTS[name]
    own = (Row(f"@{theirs}", f"{kind}.{ours}", read=not_negative) for theirs, ours in names.items())
    return RowTable(
        f"costfunction {name}",
        (
            Row("@coeff", f"{kind}.weight", read=not_negative),
            Row("@range", f"{kind}.range", read=positive),
            *own,
        ),
    )


def read_cost(item: Item, report: Report) -> Data:
    """Return one ``costfunction`` as our cost function.

    Raises:
        SpecError: E402, its name is unknown, or one of its values is invalid.
    """
    name = item.need("@name")
    if name.text() not in COSTS:
        name.refuse(f"no cost function '{name.text()[:60]}' in UMANS", sorted(COSTS))
    kind, _ = COSTS[name.text()]
    report.carried(name, f"crowd.costs kind {kind}")
    found = report.take(item, cost_table(name.text()))
    reach = {"value": found.pop("range", 5.0), "measure": "centre"}
    return {"kind": kind, "weight": found.pop("weight", 1.0), "range": reach, **found}


def read_policy(item: Item, report: Report) -> Data:
    """Return one ``Policy`` as ``{policy, costs}``.

    Raises:
        SpecError: E402, it has no cost function, or one of its values is invalid.
    """
    parts = item.every("costfunction")
    if not parts:
        item.refuse("a policy without a costfunction; UMANS does not start with it")
    costs: Data = {}
    for part in parts:
        cost = read_cost(part, report)
        costs[free_name(cost["kind"], costs)] = cost
    table = RowTable(POLICY.element, [r for r in POLICY.rows if r.theirs != "costfunction"])
    fields = {**DEFAULTS, **report.take(item, table)}
    return {"policy": {"kind": "velocity_space", **_written_fields(fields)}, "costs": costs}


def _written_fields(fields: Mapping[str, Any]) -> Data:
    """Return the fields that the method uses, always with method and relaxation."""
    if fields["method"] == "gradient":
        return {name: value for name, value in fields.items() if name not in _OF_SAMPLES}
    return dict(fields)


def read_policies(root: Item, report: Report) -> dict[int, tuple[Data, Item]]:
    """Return id -> ``{policy, costs}`` and element, for a ``Policies`` element.

    Raises:
        SpecError: E402, an id is there twice.
    """
    policies: dict[int, tuple[Data, Item]] = {}
    for item in root.every("Policy"):
        ident = item.need("@id")
        number = ident.whole(0)
        if number in policies:
            ident.refuse(
                f"policy {number} is there twice; the first is at {policies[number][1].mark}"
            )
        report.carried(ident, "crowd.policies")
        policies[number] = read_policy(item, report), item
    if not policies:
        root.refuse("Policies without a Policy")
    return policies

"""Control sims of a trial: the policy and parameters that move a person."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, positive
from crowdbot.core.exchange.scene import Data
from crowdbot.core.exchange.trial.law import only_child
from crowdbot.core.exchange.umans.agents import limited
from crowdbot.core.exchange.umans.presets import PRESETS, preset

_SHARED = Row("@SimulationID", "", "one crowd: people of all simulations react to each other",
              unless="0")  # fmt: skip
_RADIUS = Row("@radius", "crowd.agents.radius", read=lambda item: item.number(1e-6, 100.0))
_MOST = Row("@maxNeighbors", "", "all within the range count")
_FORMATION = "groups here hold together by crowd.groups, which is common to all"
_RVO = (
    _SHARED,
    Row("@neighborDist", "orca.range", read=positive),
    _MOST,
    Row("@timeHorizon", "orca.time_horizon", read=positive),
    Row("@timeHorizonObst", "", "walls push on contact; ORCA here does not look ahead to them"),
    _RADIUS,
    Row("@maxSpeed", "crowd.agents.max_speed", read=limited),
)


SIMS: Mapping[str, RowTable] = {
    "UMANSconfig": RowTable(
        "UMANSconfig",
        (
            _SHARED,
            Row("@PolicyID", "crowd.agents.policy", read=lambda item: item.whole(0)),
            _RADIUS,
            Row("@prefered_speed", "crowd.agents.speed", read=limited),
            Row("@max_speed", "crowd.agents.max_speed", read=limited),
            Row("@max_acceleration", "crowd.agents.max_acceleration", read=limited),
        ),
    ),
    "RVOconfig": RowTable("RVOconfig", _RVO),
    "RosSimConfig": RowTable("RosSimConfig", _RVO),
    "SidoSimConfig": RowTable("SidoSimConfig", _RVO),
    "VOGConfig": RowTable(
        "VOGConfig",
        (
            *_RVO,
            Row("group@groupID", "crowd.agents.group", read=lambda item: item.whole(-1, 2**31 - 1)),
            *(Row(f"group@{name}", "", _FORMATION) for name in (
                "useFormation", "neighbourNum", "neighbourDist", "neighbourDetectionDist",
                "horizonTime", "weightPrefVel", "weightGroup")),
        ),
    ),
    "HelbingConfig": RowTable(
        "HelbingConfig",
        (
            _SHARED,
            _RADIUS,
            Row("@neighborDist", "social_forces_avoidance.range", read=positive),
            Row("@doBoids", "", "flocking is not part of the social force model", unless="false"),
        ),
    ),
    "TangentConfig": RowTable(
        "TangentConfig",
        (
            _SHARED,
            Row("@speedComfort", "crowd.agents.speed", read=limited),
            Row("@personalArea", "crowd.agents.radius", read=lambda item: item.number(1e-6, 100.0)),
            Row("@speedMax", "crowd.agents.max_speed", read=limited),
            Row("@g_beta", "", "share of turning in a manoeuvre: costs here weigh it themselves"),
            Row("@g_gamma", "", "the role of who passes first: costs here weigh it themselves"),
            Row("@timeHorizon", "paris.t_max", read=positive),
            _MOST,
        ),
    ),
    "VBMConfig": RowTable(
        "VBMConfig",
        (
            _SHARED,
            _RADIUS,
            Row("@neighborAgentDist", "ttca_dca.range", read=positive),
            Row("@neighborWallDist", "", "walls push on contact; vision here ignores them"),
            Row("@sigTtca", "ttca_dca.sigma_ttca", read=positive),
            Row("@sigDca", "ttca_dca.sigma_dca", read=positive),
            Row("@sigSpeed", "ttca_dca.sigma_speed_goal", read=positive),
            Row("@sigAngle", "ttca_dca.sigma_angle_goal", read=positive),
        ),
    ),
}  # fmt: skip
_RVO_DEFAULTS: Data = {"range": 5.0, "time_horizon": 2.0, "radius": 0.33, "max_speed": 2.0}
#: Values of the original where a sim does not say them.
_DEFAULTS: Mapping[str, Data] = {
    "UMANSconfig": {"policy": 0, "radius": 0.3, "speed": 1.4, "max_speed": 3.0,
                    "max_acceleration": 1e3},
    "RVOconfig": _RVO_DEFAULTS, "VOGConfig": _RVO_DEFAULTS,
    "RosSimConfig": {**_RVO_DEFAULTS, "max_speed": 0.8},
    "SidoSimConfig": {**_RVO_DEFAULTS, "max_speed": 0.8},
    "HelbingConfig": {"radius": 0.33, "range": 10.0},
    "TangentConfig": {"speed": 1.3, "radius": 0.33, "max_speed": 2.0, "t_max": 15.0},
    "VBMConfig": {"radius": 0.33, "range": 5.0, "sigma_ttca": 1.8, "sigma_dca": 0.3,
                  "sigma_speed_goal": 3.3, "sigma_angle_goal": 2.0},
}  # fmt: skip
#: Sim -> how it differs from the policy that stands for it.
_LIKE: Mapping[str, str] = {
    "RVOconfig": "ORCA as in RVO2",
    "RosSimConfig": "another program moved these people; ORCA does",
    "SidoSimConfig": "another program moved these people; ORCA does",
    "VOGConfig": "ORCA, with our forces in groups",
    "HelbingConfig": "social forces of 1995 and a driving force",
    "TangentConfig": "passing before or behind (Paris et al. 2007), the nearest of our models",
    "VBMConfig": "the gradient of time and distance of closest approach (Dutra et al. 2017), "
    "the successor of the vision-based model",
}


@dataclass(frozen=True, slots=True)
class Simulated:
    """Policy and fields of one person, from its control sim.

    Attributes:
        policy: ``{policy, costs}``.
        name: a name for it.
        item: its element.
        fields: fields of `crowd.agents`.
    """

    policy: Data
    name: str
    item: Item
    fields: Data


def _in_space(method: str, relaxation: float, **costs: Data) -> Data:
    policy = {"kind": "velocity_space", "method": method, "relaxation_time": relaxation}
    return {"policy": policy, "costs": costs}


def _reach(value: float) -> Data:
    return {"value": value, "measure": "centre"}


def _orca(f: Data) -> Data:
    cost = {"kind": "orca", "time_horizon": f["time_horizon"], "range": _reach(f["range"])}
    return _in_space("global", 0.0, orca=cost)


def _helbing(f: Data) -> Data:
    away = {"kind": "social_forces_avoidance", "range": _reach(f["range"])}
    return _in_space("gradient", 0.5, away=away, drive={"kind": "goal_reaching_force"})


def _tangent(f: Data) -> Data:
    found = _in_space("sampling", 0.5, paris={"kind": "paris", "t_max": f["t_max"],
                                              "range": _reach(20.0)})  # fmt: skip
    found["policy"] |= {"direction": "unit", "angle": 6.283185307179586, "angles": 36,
                        "radius": "maximum_speed"}  # fmt: skip
    return found


def _vision(f: Data) -> Data:
    names = ("sigma_ttca", "sigma_dca", "sigma_speed_goal", "sigma_angle_goal")
    cost = {"kind": "ttca_dca", "weight": 20.0, "range": _reach(f["range"])}
    return _in_space("gradient", 0.0, vision=cost | {name: f[name] for name in names})


_POLICIES: Mapping[str, tuple[str, Callable[[Data], Data]]] = {
    "RVOconfig": ("rvo2", _orca),
    "RosSimConfig": ("ros", _orca),
    "SidoSimConfig": ("sido", _orca),
    "VOGConfig": ("groups", _orca),
    "HelbingConfig": ("helbing", _helbing),
    "TangentConfig": ("tangent", _tangent),
    "VBMConfig": ("vision", _vision),
}
_FIELDS = ("radius", "speed", "max_speed", "max_acceleration", "group")


def read_sim(wrapper: Item, policies: Mapping[int, tuple[Data, Item]], report: Report) -> Simulated:
    """Return the policy and fields of a ``controlSim``.

    Args:
        wrapper: the element.
        policies: those of a file of UMANS; empty for the original's presets.
        report: where each part is recorded.

    Raises:
        SpecError: E402, the sim or its policy is unknown, or a value is invalid.
    """
    item = only_child(wrapper, SIMS)
    fields = {**_DEFAULTS[item.name], **_taken(item, report)}
    if item.name == "UMANSconfig":
        used, name = _umans(item, fields["policy"], policies)
        report.carried(item, "crowd.policies")
    else:
        name, make = _POLICIES[item.name]
        used = make(fields)
        report.interpreted(item, "crowd.policies", _LIKE[item.name])
    return Simulated(used, name, item, {n: fields[n] for n in _FIELDS if n in fields})


def _taken(item: Item, report: Report) -> dict[str, Any]:
    """Return the fields of a sim, and of the group in it."""
    table = SIMS[item.name]
    own = RowTable(table.element, [r for r in table.rows if r.theirs.startswith("@")])
    found = report.take(item, own)
    group = item.find("group")
    if group is not None:
        inner = [Row(r.theirs.removeprefix("group"), r.ours, r.note, r.read)
                 for r in table.rows if r.theirs.startswith("group@")]  # fmt: skip
        found |= report.take(group, RowTable("group", inner))
    return found


def _umans(item: Item, number: int, policies: Mapping[int, tuple[Data, Item]]) -> tuple[Data, str]:
    known = list(policies) or list(PRESETS)
    if number not in known:
        at = item.find("@PolicyID") or item
        at.refuse(f"no policy {number}; there are: {', '.join(map(str, known))}")
    if policies:
        return policies[number][0], f"policy_{number}"
    return preset(number), f"preset_{number}"


def law_alone() -> Data:
    """Return the policy of people who follow their control law and avoid no one."""
    return _in_space("gradient", 0.1, drive={"kind": "goal_reaching_force"})

"""Crowdbot's policies as UMANS policies: presets by number, others in a file beside the trial."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any
from xml.etree import ElementTree as Xml

from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.scene import Data
from crowdbot.core.exchange.trial.sims import law_alone
from crowdbot.core.exchange.trial_export.elements import add, number, text_of
from crowdbot.core.exchange.umans.policies import COSTS
from crowdbot.core.exchange.umans.presets import PRESETS, preset
from crowdbot.dsl.scenario.crowd import Crowd, NamedPolicy

#: UMANS' name of each of our cost functions, and its names of their parameters.
_NAMES: Mapping[str, tuple[str, Mapping[str, str]]] = {
    kind: (name, {ours: theirs for theirs, ours in names.items() if theirs != "U0"})
    for name, (kind, names) in COSTS.items()
}
#: Sampling fields: ours -> attribute and default.
_SAMPLING: Mapping[str, str] = {
    "samples": "SamplingType", "base": "SamplingBase", "direction": "SamplingBaseDirection",
    "radius": "SamplingRadius",
}  # fmt: skip
_COUNTS: Mapping[str, str] = {
    "speeds": "SpeedSamples", "angles": "AngleSamples", "random_samples": "RandomSamples",
}  # fmt: skip
#: Usual diameter of two bodies, m: surface gap + this is the distance of their centres.
_BODIES = 0.66


@dataclass(slots=True)
class Policies:
    """The policies of an export, each with the number by which agents name it.

    Attributes:
        report: where losses are recorded.
        kept: policies that are not presets, in the order of their numbers.
    """

    report: Report
    kept: list[Data] = field(default_factory=list)

    def number_of(self, name: str, policy: Crowd | NamedPolicy) -> int | None:
        """Return the number of a policy; None if the control law alone moves its people."""
        data = _data(policy)
        if _same(data, law_alone()):
            return None
        if policy.policy.kind != "velocity_space":
            note = f"{policy.policy.kind} is not a policy of UMANS: preset 0 in its place"
            self.report.added("PolicyID", f"{name or 'crowd.policy'}: {note}")
            data = preset(0)
        if data not in self.kept:
            self.kept.append(data)
        return self.kept.index(data)

    def numbers(self) -> tuple[dict[int, int], str]:
        """Return policy number -> PolicyID, and the file of policies; empty if presets suffice."""
        presets = {
            k: n for k, data in enumerate(self.kept) for n in PRESETS if _same(data, preset(n))
        }
        if len(presets) == len(self.kept):
            return presets, ""
        root = Xml.Element("Policies")
        for k, data in enumerate(self.kept):
            _policy(root, k, data, self.report)
        return {k: k for k in range(len(self.kept))}, text_of(root)


def _data(policy: Crowd | NamedPolicy) -> Data:
    costs = {
        name: {"kind": c.kind, **c.model_dump(mode="json")} for name, c in policy.costs.items()
    }
    return {
        "policy": {"kind": policy.policy.kind, **policy.policy.model_dump(mode="json")},
        "costs": costs,
    }


def _same(data: Data, other: Data) -> bool:
    """Return True if two policies are equal; the second may omit default values."""
    mine, theirs = list(data["costs"].values()), list(other["costs"].values())
    return len(mine) == len(theirs) and _holds(data["policy"], other["policy"]) and all(
        _holds(a, b) for a, b in zip(mine, theirs, strict=True)
    )  # fmt: skip


def _holds(whole: Mapping[str, Any], part: Mapping[str, Any]) -> bool:
    return all(
        _holds(whole[k], v) if isinstance(v, dict) else whole.get(k) == v for k, v in part.items()
    )


def _policy(root: Xml.Element, ident: int, data: Data, report: Report) -> None:
    policy = data["policy"]
    attributes = {"id": str(ident), "OptimizationMethod": policy["method"],
            "RelaxationTime": number(policy["relaxation_time"]),
            "ContactForceScale": number(policy["contact_stiffness"])}  # fmt: skip
    if policy["method"] != "gradient":
        attributes |= {theirs: policy[ours].replace("_", " ") for ours, theirs in _SAMPLING.items()}
        attributes |= {theirs: str(policy[ours]) for ours, theirs in _COUNTS.items()}
        attributes["SamplingAngle"] = number(math.degrees(policy["angle"]))
        attributes["IncludeBaseAsSample"] = "true" if policy["include_base"] else "false"
    element = add(root, "Policy", **attributes)
    for name, cost in data["costs"].items():
        _cost(element, name, cost, report)


def _cost(parent: Xml.Element, name: str, cost: Data, report: Report) -> None:
    if cost["kind"] not in _NAMES:
        report.added(f"costs.{name}", f"left out: {cost['kind']} is not a function of UMANS")
        return
    theirs, names = _NAMES[cost["kind"]]
    reach = cost["range"]["value"]
    if cost["range"]["measure"] == "surface":
        reach += _BODIES
        note = f"measured between centres there: {_BODIES} m more"
        report.added(f"costs.{name}.range", note)
    attributes = {"name": theirs, "coeff": number(cost["weight"]), "range": number(reach)}
    attributes |= {names[k]: number(v) for k, v in cost.items() if k in names}
    for key in set(cost) - {*names, "kind", "weight", "range"}:
        report.added(f"costs.{name}.{key}", "left out: no parameter of UMANS")
    add(parent, "costfunction", **attributes)

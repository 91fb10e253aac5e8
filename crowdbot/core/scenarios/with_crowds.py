"""Replace the crowds of scenarios: behaviour changes, starts and goals do not."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.named_crowds import open_crowd
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError

#: Name of the axis for the crowds.
AXIS = "crowd"


def with_crowds(expansion: Expansion, names: Sequence[str], registry: Registry) -> Expansion:
    """Repeat every scenario with each named crowd, on the axis ``crowd``; sorted by crowds.

    Policy, cost functions, steering, the named crowd's bodies and how they part after contact are
    replaced; flows, places, speeds, responses to robots and draws remain the scenario's.

    Args:
        expansion: expansion of a suite or a scenario.
        names: names for `open_crowd`; if empty, the expansion is unchanged.

    Raises:
        InputError: a scenario has no crowd, a name occurs twice, or the suite has such an axis.
        SpecError, UnknownNameError: a crowd does not exist or is invalid.
    """
    if not names:
        return expansion
    crowds = {label_of(name): open_crowd(name, registry) for name in dict.fromkeys(names)}
    if len(crowds) < len(set(names)):
        raise InputError(f"--crowds {','.join(names)}: two crowds have the same label")
    if any(AXIS in axes for axes in expansion.axes.values()):
        raise InputError(f"{expansion.suite_id} has an axis '{AXIS}' already; --crowds makes one")
    scenarios, axes, trees = [], {}, {}
    for label, crowd in crowds.items():
        for scenario in expansion.scenarios:
            made = _with_crowd(scenario, label, crowd)
            scenarios.append(made)
            axes[made.id] = {**expansion.axes.get(scenario.id, {}), AXIS: label}
            if scenario.id in expansion.trees:
                trees[made.id] = expansion.trees[scenario.id]
    return replace(expansion, scenarios=scenarios, axes=axes, trees=trees)


def label_of(name: str) -> str:
    """Return the name of a crowd in ids and on axes."""
    stem = re.sub(r"\.ya?ml$", "", name.rpartition("/")[2])
    return re.sub(r"[^A-Za-z0-9_.-]", ".", stem)


def _with_crowd(scenario: Scenario, label: str, crowd: Crowd) -> Scenario:
    if scenario.crowd is None:
        raise InputError(f"{scenario.id} has no crowd that another one could take the place of")
    references: Mapping[str, Scenario] = {
        name: r if r.crowd is None else r.model_copy(update={"crowd": _laid_over(r.crowd, crowd)})
        for name, r in scenario.references.items()
    }
    return scenario.model_copy(
        update={
            "id": f"{scenario.id}+{label}",
            "crowd": _laid_over(scenario.crowd, crowd),
            "references": references,
        }
    )


def _laid_over(own: Crowd, other: Crowd) -> Crowd:
    body = own.body.model_copy(
        update={name: getattr(other.body, name) for name in other.body.model_fields_set}
    )
    return own.model_copy(
        update={
            "policy": other.policy,
            "costs": other.costs,
            "steering": other.steering,
            "body": body,
            "contact_dissipation": other.contact_dissipation,
        }
    )

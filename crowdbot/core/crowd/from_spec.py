"""Build a crowd's policy from the fields of a scenario, without a whole scenario."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.build import build_cost, build_policy
from crowdbot.core.crowd.engine import PolicyFactory
from crowdbot.core.crowd.policy import CrowdPolicy
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.errors import InputError

Fields = Mapping[str, Any]


def policy_of(
    policy: Fields, costs: Mapping[str, Fields] | None = None, registry: Registry | None = None
) -> PolicyFactory:
    """Return a policy for `CrowdEngine`, from the fields ``crowd.policy`` and ``crowd.costs``.

    Args:
        policy: ``kind`` and other fields of a crowd policy.
        costs: the same for its cost functions, by any names.
        registry: the installed components; default: discovered now.

    Raises:
        InputError: a field does not exist or has an invalid value.
        UnknownNameError: nothing of a kind is installed.
    """
    known = registry or discover()
    spec = _spec(known, "crowd policy", policy)
    specs = [_spec(known, "cost function", fields) for fields in (costs or {}).values()]

    def make(agents: Agents) -> CrowdPolicy:
        return build_policy(known, spec, [build_cost(known, cost) for cost in specs], agents)

    return make


def _spec(registry: Registry, category: str, fields: Fields) -> Any:
    if "kind" not in fields:
        raise InputError(f"a {category} needs a kind")
    try:
        return registry.find(category, fields["kind"]).spec.model_validate(dict(fields))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise InputError(f"{category} '{fields['kind']}': {where}: {first['msg']}") from error

"""Conventions of a trained policy: its observation, and the meaning of its actions.

They are kept as JSON in the policy's file, under the name `KEY`.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from crowdbot.core.learning.build import CheckedObserver
from crowdbot.core.learning.seen import LearningContext
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.spec.component_specs import ObservationSpec
from crowdbot.errors import InputError, did_you_mean, nearest

#: Name of the conventions in a policy's file.
KEY = "crowdbot"
#: Version of what is written.
_VERSION = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Conventions:
    """A trained policy's observation, and the meaning of its actions.

    Attributes:
        observation: its spec.
        size: number of values in an observation.
        action: meaning of an action's numbers: v, w, vy, as fractions of the limits, -1 to 1.
        step: time between two actions, s.
    """

    observation: ObservationSpec
    size: int
    action: tuple[str, ...]
    step: float

    def to_json(self) -> str:
        """Return the conventions as JSON."""
        return json.dumps(self.values, sort_keys=True)

    @property
    def values(self) -> dict[str, Any]:
        """Return the conventions as JSON values."""
        return {
            "version": _VERSION,
            "observation": self.observation.model_dump(mode="json"),
            "size": self.size,
            "action": list(self.action),
            "step": self.step,
        }


def conventions_of(
    spec: ObservationSpec, observer: CheckedObserver, context: LearningContext
) -> Conventions:
    """Return the conventions of policies that are trained with an observer."""
    names = ("v", "w", "vy")[: 3 if context.limits.vy_max > 0.0 else 2]
    return Conventions(observation=spec, size=observer.size, action=names, step=context.step)


def read_conventions(given: object, where: str, registry: Registry) -> Conventions:
    """Return the conventions that a policy's file holds.

    Args:
        given: JSON, or the values it holds; None where the file has none.
        where: the file, for messages.

    Raises:
        InputError: there are none, or they are wrong.
    """
    if given is None:
        raise InputError(
            f"{where}: says nothing of its observation and action; crowdbot.rl.conventions(env) "
            f"returns what belongs under '{KEY}'"
        )
    try:
        values: Any = json.loads(given) if isinstance(given, str) else given
        fields = dict(values["observation"])
        size, step = int(values["size"]), float(values["step"])
        action, version = tuple(values["action"]), values["version"]
    except (ValueError, TypeError, KeyError) as error:
        raise InputError(f"{where}: '{KEY}' is not what crowdbot writes: {error!r}") from None
    if version != _VERSION:
        raise InputError(f"{where}: '{KEY}' is of version {version}, not {_VERSION}")
    if action not in (("v", "w"), ("v", "w", "vy")):
        raise InputError(f"{where}: actions are v, w and perhaps vy, not {', '.join(action)}")
    return Conventions(
        observation=_spec(fields, where, registry), size=size, action=action, step=step
    )


def _spec(fields: dict[str, Any], where: str, registry: Registry) -> ObservationSpec:
    known = registry.components("observation")
    kind = str(fields.get("kind"))
    if kind not in known:
        near = did_you_mean(nearest(kind, known)) or f"; there are {', '.join(sorted(known))}"
        raise InputError(f"{where}: no observation '{kind}' is installed{near}")
    try:
        spec: ObservationSpec = known[kind].spec.model_validate(fields)
    except ValidationError as error:
        (first, *_) = error.errors(include_url=False)
        name = ".".join(map(str, first["loc"]))
        raise InputError(f"{where}: observation '{kind}': {name}: {first['msg']}") from None
    return spec

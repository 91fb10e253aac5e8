"""Responses by name: kinds of ``robot_response``, and crowds with the response they have."""

from __future__ import annotations

from collections.abc import Sequence

from crowdbot.core.crowd.response.from_spec import response_of
from crowdbot.core.realism.model import model_of
from crowdbot.core.realism.near_robots.replay import Response
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.named_crowds import open_crowd
from crowdbot.dsl.identity.crowd_likeness import fingerprint
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.robot_response import GivingWay, HumanResponse
from crowdbot.dsl.scenario.scenario import Scenario

#: The crowd whose people respond, where only a response is named.
USUAL_CROWD = "calibrated"
KINDS = tuple(str(spec.model_fields["kind"].default) for spec in (HumanResponse, GivingWay))


def response_of_crowd(crowd: Crowd, registry: Registry, rate: float = 16.0) -> Response:
    """Return the people of a scenario's crowd and their response; ``rate`` of decisions, Hz."""
    spec = crowd.robot_response
    return Response(
        crowd=model_of(crowd, registry, rate=rate),
        human=response_of(spec),
        ignoring=spec.ignoring,
        late=spec.late,
        margin=spec.margin,
        visible=spec.velocity == "visible",
    )


def open_responding(text: str, registry: Registry, overrides: Sequence[str] = ()) -> Crowd:
    """Return the crowd that a text names: a crowd, or a kind of response.

    Raises:
        UnknownNameError: neither exists.
        SpecError: an override is invalid.
    """
    if text in KINDS:
        kind = f"crowd.robot_response.kind={text}"
        return open_crowd(USUAL_CROWD, registry, [kind, *overrides])
    return open_crowd(text, registry, overrides)


def different_responses(scenarios: Sequence[Scenario]) -> dict[str, Crowd]:
    """Return the crowds that differ in people or response, by the id of their first scenario."""
    found: dict[tuple[str, str], tuple[str, Crowd]] = {}
    for scenario in scenarios:
        crowd = scenario.crowd
        if crowd is not None:
            key = fingerprint(crowd), crowd.robot_response.model_dump_json()
            found.setdefault(key, (scenario.id, crowd))
    return dict(found.values())

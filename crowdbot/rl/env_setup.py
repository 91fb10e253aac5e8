"""The arguments of environments, checked and resolved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from inspect import signature
from typing import Any, Literal

from pydantic import ValidationError

from crowdbot.api import registry as installed
from crowdbot.core.batch.blueprint import Blueprint, blueprint
from crowdbot.core.learning.build import sensors_of
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.library import open_spec, pick, select
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.component_specs import ObservationSpec, RewardSpec
from crowdbot.dsl.suite.settings import setting_texts
from crowdbot.errors import InputError, UnknownNameError
from crowdbot.rl.scatter import Spread, spread_of

#: A component: its kind, a map with ``kind`` and fields, or its spec.
Component = str | Mapping[str, Any]
#: End of an episode at a contact: never, or with a person.
ContactRule = Literal["go_on", "end"]


@dataclass(frozen=True, kw_only=True)
class EnvSetup:
    """Worlds, observation and reward of environments.

    Attributes:
        levels: scenarios of each level of the curriculum; an episode has one of its level.
        observation, reward: their specs.
        draws: number of different draws of people per scenario, which are reused; None: a new
            draw in every episode.
        edition: True to use the suite's own draw of people, as its scored runs do.
        spread: range of random starts and goals; None: those of the scenarios.
        ends_at_contact: True if a contact with a person ends the episode.
    """

    registry: Registry
    levels: tuple[tuple[Scenario, ...], ...]
    observation: ObservationSpec
    reward: RewardSpec
    draws: int | None
    edition: bool
    ends_at_contact: bool
    spread: Spread | None = None

    @cached_property
    def blueprints(self) -> dict[str, Blueprint]:
        """Return scenario id -> resolved scenario; their robots must be alike.

        Raises:
            InputError: the robots differ, or batches of worlds cannot simulate one.
        """
        needs = sensors_of([self.observation])
        found: dict[str, Blueprint] = {}
        for scenario in (s for level in self.levels for s in level):
            if scenario.id not in found:
                found[scenario.id] = blueprint(scenario, self.registry, needs)
        first = next(iter(found.values()))
        for other in found.values():
            _check_alike(first, other)
        return found


def resolve_named(arguments: Mapping[str, Any]) -> EnvSetup:
    """Check the keywords of an environment, then resolve them as `resolve` does.

    Raises:
        UnknownNameError: there is no such keyword, or as `resolve`.
        InputError: no suite is named, or as `resolve`.
    """
    known = signature(resolve).parameters
    for name in arguments:
        if name not in known:
            raise UnknownNameError("argument", name, known)
    if "suite" not in arguments:
        raise InputError("an environment needs a suite, such as suite='challenge-2020'")
    return resolve(**arguments)


def resolve(
    *,
    suite: str,
    scenario: str | Sequence[str] | None = None,
    levels: Sequence[str | Sequence[str]] | None = None,
    set: str | Sequence[str] | Mapping[str, Any] = (),
    observation: Component | ObservationSpec = "lidar_stack",
    reward: Component | RewardSpec = "progress",
    draws: int | None = None,
    edition: bool = False,
    contact: ContactRule = "go_on",
    start_spread: Mapping[str, float] | None = None,
    goal_spread: Mapping[str, float] | None = None,
) -> EnvSetup:
    """Check the arguments of an environment.

    Args:
        suite: a file, or the name of a packaged suite.
        scenario: id or pattern, or several; None: all of the suite.
        levels: for curricula: id or pattern, or several, for each level, the easiest first;
            ``options={"level": n}`` of a reset chooses one. In place of ``scenario``.
        set: changes to every scenario, as for `crowdbot.load`.
        observation, reward: kind, map with ``kind`` and fields, or spec.
        draws, edition: as in `EnvSetup`.
        contact: ``end`` ends an episode at the first contact with a person.
        start_spread: largest distances of an episode's start from the scenario's: ``x``, ``y``, m,
            and ``yaw``, rad; the start is clear of walls and people.
        goal_spread: likewise of the goal zone: ``x``, ``y``, m.

    Raises:
        SpecError: the document, or a change to it, is wrong.
        UnknownNameError: no such suite, scenario, observation or reward.
        InputError: another argument is wrong.
    """
    registry = installed()
    expansion = open_spec(str(suite), registry, setting_texts(set))
    if levels is not None and scenario is not None:
        raise InputError("give either scenario or levels")
    if draws is not None and draws < 1:
        raise InputError(f"draws must be at least 1, not {draws}")
    if draws is not None and edition:
        raise InputError("an edition has its own draws of people; leave draws out")
    if contact not in ("go_on", "end"):
        raise InputError(f"contact must be 'go_on' or 'end', not {contact!r}")
    patterns = [scenario] if levels is None else list(levels)
    if not patterns:
        raise InputError("levels must name at least one level")
    return EnvSetup(
        registry=registry,
        levels=tuple(_scenarios(expansion, level) for level in patterns),
        observation=spec_of(registry, "observation", observation),
        reward=spec_of(registry, "reward", reward),
        draws=draws,
        edition=edition,
        ends_at_contact=contact == "end",
        spread=spread_of(start_spread, goal_spread),
    )


def _scenarios(expansion: Any, patterns: str | Sequence[str] | None) -> tuple[Scenario, ...]:
    """Return the scenarios of ids or patterns, in the suite's order."""
    if patterns is None:
        return tuple(expansion.scenarios)
    names = [patterns] if isinstance(patterns, str) else list(patterns)
    found: dict[str, Scenario] = {}
    for name in names:
        fitting = select(expansion, name) or [pick(expansion, name)]  # raises with a suggestion
        found |= {s.id: s for s in fitting}
    return tuple(s for s in expansion.scenarios if s.id in found)


def spec_of(registry: Registry, category: str, given: Any) -> Any:
    """Return the spec of a component.

    Raises:
        UnknownNameError: there is no such kind.
        InputError: a field is wrong.
    """
    if isinstance(given, ObservationSpec | RewardSpec):
        return given
    fields = {"kind": given} if isinstance(given, str) else dict(given)
    kind = fields.get("kind")
    known = registry.components(category)
    if not isinstance(kind, str):
        raise InputError(f"{category}: 'kind' is missing; there are {', '.join(sorted(known))}")
    if kind not in known:
        raise UnknownNameError(category, kind, sorted(known), registry.why_absent(kind))
    try:
        return known[kind].spec.model_validate(fields)
    except ValidationError as error:
        lines = [
            f"{category} '{kind}': {'.'.join(map(str, item['loc']))}: {item['msg']}"
            for item in error.errors(include_url=False)
        ]
        raise InputError("\n".join(lines)) from None


def _check_alike(first: Blueprint, other: Blueprint) -> None:
    """Check that two scenarios agree in number of robots, limits, period and lidar shapes.

    Raises:
        InputError: they do not.
    """
    pair = f"{first.scenario.id} and {other.scenario.id}"
    if len(first.models) != len(other.models):
        raise InputError(f"{pair} differ in their number of robots; choose scenarios that agree")
    if [m.limits for m in first.models] != [m.limits for m in other.models]:
        raise InputError(f"{pair} have robots with different limits; choose scenarios that agree")
    if first.period != other.period:
        raise InputError(f"{pair} differ in rates.planner; choose scenarios that agree")
    shapes = [{(s.robot, s.name): s.info.shape for s in b.sensors} for b in (first, other)]
    if shapes[0] != shapes[1]:
        raise InputError(f"{pair} have lidars of different shapes; choose scenarios that agree")

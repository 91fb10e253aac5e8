"""Draws one stream of people: a row of the agents' table for each person."""

from __future__ import annotations

from typing import Any

from crowdbot.core.population.draws import Streams, draw_numbers, heading_to
from crowdbot.core.population.occupancy import Occupancy
from crowdbot.core.population.stream_draw import StreamDraw
from crowdbot.core.population.stream_starts import Start, starts
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.streams import StreamChoice


class StreamSampler:
    """Samples one stream; `rows` returns its part of the agents' table."""

    def __init__(
        self, name: str, stream: StreamChoice, scenario: Scenario, crowd: Crowd, streams: Streams
    ) -> None:
        self._stream, self._crowd = stream, crowd
        self._draw = StreamDraw(name, stream, scenario, crowd, streams)

    def rows(self, occupancy: Occupancy, next_group: int) -> list[dict[str, Any]]:
        """Return one row a person without ``id`` and ``goal_key``.

        Args:
            occupancy: the discs of those who are there already; people who start at once are added.
            next_group: number of the first group of several people; numbers of queues follow it.

        Raises:
            InputError: not all people fit at their start.
        """
        draw = self._draw
        begun: dict[int, Start] = dict(starts(self._stream, draw, occupancy))
        common, speeds, policies = self._common(), self._speeds(), self._policies()
        rows = []
        for unit, members in enumerate(draw.groups):
            alone = len(members) == 1
            for i in members:
                start = begun[i]
                rows.append(
                    common
                    | draw.bodies.row(i)
                    | {"x": start.at[0], "y": start.at[1], "start_time": start.time}
                    | {"heading": _heading(start), "speed": float(speeds[i])}
                    | {"attention": float(draw.rng("attention", i).random())}
                    | {"policy": policies[i], "group": -1 if alone else next_group + unit}
                    | start.route.columns()
                    | ({"queue": next_group} if start.queues else {})
                )
        return rows

    def _common(self) -> dict[str, Any]:
        own, body = self._stream.body, self._crowd.body
        return {
            "max_speed": own.max_speed or body.max_speed,
            "max_acceleration": own.max_acceleration or body.max_acceleration,
            "portals": ("", ""),
        }

    def _speeds(self) -> Array:
        speed = self._stream.speed or self._crowd.speed
        assert speed is not None  # checked on validation
        speeds = draw_numbers(self._draw.rng("speeds"), self._draw.people, speed)
        return self._draw.bodies.walk_at(speeds)

    def _policies(self) -> list[str]:
        names, people = self._stream.policy, self._draw.people
        if not names:
            return [""] * people
        return [names[i] for i in self._draw.rng("policy").integers(len(names), size=people)]


def _heading(start: Start) -> float:
    if start.heading is not None:
        return start.heading
    goals = [g for g in start.route.goals if g != start.at]
    return heading_to(*start.at, goals[0]) if goals else 0.0

"""The crowd engine: state, decisions and ticks of one crowd. Works without Drake."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.crowd.state as s
from crowdbot.core.crowd.agents import ONWARD, PORTAL, Agents
from crowdbot.core.crowd.contact.robot_contact import DISC, R_W, RVX, RVY
from crowdbot.core.crowd.contact.solid import LONGEST_STEP, MOST_OVERLAP, OUTSIDE
from crowdbot.core.crowd.decision_groups import groups_by_policy, who_plans
from crowdbot.core.crowd.desired_acceleration import desired_acceleration, relaxation_time_of
from crowdbot.core.crowd.groups import forces_of, groups_of, hold_together
from crowdbot.core.crowd.parameters import AgentParameters, Scratch, WorldParameters
from crowdbot.core.crowd.periodic_boundary import images
from crowdbot.core.crowd.policy import CONTACT_STIFFNESS, CrowdPolicy, CrowdView
from crowdbot.core.crowd.portals import draw_goal, enter
from crowdbot.core.crowd.response.evasion import evade_robots
from crowdbot.core.crowd.routes import head_for
from crowdbot.core.crowd.routing.router import Router
from crowdbot.core.crowd.routing.waypoints import squeeze
from crowdbot.core.crowd.steering.parts import parts_of
from crowdbot.core.crowd.step import tick, ticks_without_robots
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.support.immutable import immutable, immutable_fields
from crowdbot.core.support.records import numbers_of
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND, ticks
from crowdbot.core.types.arrays import Array, Indices

#: Builds the policy of a set of agents.
PolicyFactory = Callable[[Agents], CrowdPolicy]

NOBODY, DISCS = np.zeros((0, 8)), np.zeros((0, 0, 2))
NONE, NO_STIFFNESSES = np.zeros(0, np.int64), np.zeros(0)
_NOT_SHOWN = np.zeros((0, 5))
_SEEN = np.array([0, 1, 2, 3, 5])  # columns of a robot used by policies
#: Time of decisions in a situation of one's own, in ticks: late enough that people have reacted.
LATER = 60 * TICKS_PER_SECOND
_MOTION = np.isin(np.arange(8), [RVX, RVY, R_W])  # columns of its motion


class CrowdEngine:
    """Advances the flat state vector of a crowd in place; keeps no state of its own.

    Args:
        agents: all, present or to come.
        world: where they walk.
        policies: how they decide: a policy, a function that makes one for the agents, or a list
            of these to which `Agents.policy` refers.

    Attributes:
        policies: how they decide, as `Agents.policy` numbers them.
        goal_column: first column of the point that policies see as the goal: the goal, or a
            waypoint.
        groups: agents with the same policy and the same view, when there is a robot.
        ticks_per_decision: number of ticks between two decisions.
        parameters: arguments of `tick` for people, world and scratch, as numbers.
        heeds_robots, room, evades: arguments of `evade_robots`.

    Raises:
        ValueError: an agent refers to a policy or a portal that does not exist.
    """

    def __init__(
        self,
        agents: Agents,
        world: CrowdWorld,
        policies: CrowdPolicy | PolicyFactory | Sequence[CrowdPolicy | PolicyFactory],
    ) -> None:
        world.check(agents)
        self.agents, self.world = agents, world
        given = policies if isinstance(policies, Sequence) else [policies]
        made = [p(agents) if callable(p) else p for p in given]
        if len(agents) and not 0 <= agents.policy.min() <= agents.policy.max() < len(made):
            raise ValueError(f"agents follow policy {agents.policy.max()} of {len(made)}")
        self._kept: dict[str, Any] = {
            "agents": immutable_fields(agents),
            "walls": immutable(world.walls),
            "pillars": immutable(world.pillars),
        }
        self.policies: Sequence[CrowdPolicy] = tuple(made)
        self.groups = groups_by_policy(made, agents, who_plans(agents, world))
        self._groups_alone = groups_by_policy(made, agents, np.zeros(len(agents), np.bool_))
        strength = [getattr(p, "contact_stiffness", CONTACT_STIFFNESS) for p in made]
        self.ticks_per_decision = ticks(world.decision_rate)
        self._people = AgentParameters.of(
            agents, np.array(strength, np.float64)[agents.policy], _limits(made, agents, world)
        )
        largest = float(np.max(agents.radius, initial=0.0))
        touched = world.with_images(largest + LONGEST_STEP)
        self._pillars = touched.pillars
        self._place = WorldParameters.of(touched, largest)
        dt = self.ticks_per_decision * TICK
        self._steering = parts_of(world.steering)
        led = np.array([getattr(p, "commanded", False) for p in made], np.bool_)
        self._commanded = led[agents.policy] if len(agents) else np.zeros(0, np.bool_)
        self._led = bool(self._commanded.any())
        self.heeds_robots = ~agents.ignores_robot & ~self._commanded
        self.room = 2.0 * agents.attention - 1.0
        self.evades = world.response.by_decision(dt)
        self._router = (
            None
            if world.routing is None
            else Router(agents, world.walls, world.pillars, world.routing)
        )
        self.goal_column = s.GOAL_X if self._router is None else s.WAYPOINT_X
        self._members, self._ends = groups_of(agents)
        self._cohesion = None if world.cohesion is None else forces_of(world.cohesion)
        self.parameters = numbers_of(*self._people, *self._place, *Scratch.of(len(agents)))
        self._usual: dict[int, tuple[Indices, Array]] = {}

    def initial_state(self, robots: int = 1) -> Array:
        """Return the state at t = 0, with space for contacts with a number of robots.

        Agents that start at once walk to their first goal at preferred speed; others wait.
        """
        flat = s.blank(len(self.agents), robots)
        (_, rows), people = s.view(flat), s.people_in(flat)
        a = self.agents
        rows[:, s.X], rows[:, s.Y] = a.x, a.y
        for i in range(len(a)):
            if a.at_goal[i] == PORTAL:
                draw_goal(people, i, self._people, self._place, a.x[i], a.y[i])
            else:
                rows[i, s.ROUTE_POINT] = a.at_goal[i] == ONWARD
                head_for(people, i, self._people, self._place.goal_key)
        if self._router is not None:
            self._router.find(people, 0.0)
        for i in range(len(a)):
            if a.start_time[i] > 0.0:
                rows[i, s.WAITING] = s.NOT_YET
            else:
                enter(people, i, a.x[i], a.y[i], a.preferred_speed[i], 0.0)
        rows[:, s.ON_TRIP] = (a.at_goal == PORTAL) | (np.diff(a.first) > 0)
        to_goal = rows[:, self.goal_column : self.goal_column + 2] - rows[:, s.X : s.Y + 1]
        distance = np.hypot(to_goal[:, :1], to_goal[:, 1:])
        facing = np.divide(to_goal, distance, out=np.zeros_like(to_goal), where=distance > 0.0)
        arrived = distance[:, 0] == 0.0
        facing[arrived, 0], facing[arrived, 1] = (
            np.cos(a.heading)[arrived],
            np.sin(a.heading)[arrived],
        )
        rows[self._stays_first(rows), s.ON_TRIP] = 0.0
        rows[:, s.DIR_X : s.DIR_Y + 1] = facing
        rows[:, s.NOTICED] = s.UNAWARE
        return flat

    @property
    def decides_by_policies_alone(self) -> bool:
        """Return True if decisions depend on policies and evasion of robots only.

        False with routing around walls, steering parts, group forces, periodic boundaries, or
        people who follow a robot.
        """
        grouped = self._cohesion is not None and len(self._members) > 0
        border = self.world.periodic_boundary is not None
        others = self._steering is not None or grouped or border or self._led
        return not (self._router is not None or others)

    @property
    def steers(self) -> bool:
        """Return True if steering parts change what policies decide."""
        return self._steering is not None

    def _stays_first(self, rows: Array) -> NDArray[np.bool_]:
        """Return (N,) True for agents that begin with a stay at their first goal, a point."""
        a = self.agents
        found: NDArray[np.bool_] = self._people.traits["stays"] != 0.0
        stays = found.copy()
        begins = a.first[:-1][stays]
        away = np.hypot(
            rows[stays, s.X] - a.route[begins, 0],
            rows[stays, s.Y] - a.route[begins, 1],
        )
        found[stays] = (
            (away <= a.radius[stays])
            & (a.goal_area[begins, 0] == 0.0)
            & ((a.pause[begins] > 0.0) | (a.ahead[stays] >= 0))
        )
        return found

    def advance(
        self,
        flat: Array,
        robots: Array = NOBODY,
        outline: Array = DISC,
        dt: float = TICK,
        *,
        numbers: Indices | None = None,
        stiffnesses: Array | None = None,
    ) -> None:
        """Advance one tick of 1/128 s, in place; first decide if a decision is due.

        Args:
            flat: state vector, with room for as many robots.
            robots: (R, 8) x, y, vx, vy, physical and perceived radius, heading, yaw rate; the last
                two are optional.
            outline: (K, 2) of robots that are not discs, see `robot_contact`; or (R, K, 2) per
                robot, padded with NaN.
            dt: length of a tick, s. Other values are for studies of contacts: it is also the
                engine's clock, so decisions depend on ticks, not seconds.
            numbers: (R,) indices of the robots in the state; None: the first ones.
            stiffnesses: (R,) stiffness of contact with each, N/m; None: as in the world.

        Raises:
            ValueError: there are more robots than the state has room for.
        """
        if len(robots) > flat[s.ROBOTS]:
            raise ValueError(f"{len(robots)} robots in a state of {flat[s.ROBOTS]:g}")
        if robots.shape[1] < 8:
            robots = np.pad(robots, ((0, 0), (0, 8 - robots.shape[1])))
        outlines = outline if outline.ndim == 3 else _alike(outline, len(robots))
        if int(flat[s.TICK]) % self.ticks_per_decision == 0:
            self._decide(flat, robots, outlines)
        if numbers is None or stiffnesses is None:
            usual = self._usual_robots(len(robots))
            numbers = usual[0] if numbers is None else numbers
            stiffnesses = usual[1] if stiffnesses is None else stiffnesses
        tick(*self._given(flat, robots, outlines, dt, numbers, stiffnesses))

    def _usual_robots(self, count: int) -> tuple[Indices, Array]:
        """Return default indices and stiffnesses for `count` robots."""
        if count not in self._usual:
            self._usual[count] = np.arange(count), np.full(count, self.world.stiffness)
        return self._usual[count]

    def advance_alone(self, flat: Array, most: int) -> int:
        """Advance several ticks without robots, in place, with the same result as `advance`.

        Ends after a tick in which a trip ends, and before the next decision.

        Args:
            flat: state vector.
            most: largest number of ticks, at least 1.

        Returns:
            number of ticks advanced.
        """
        since = int(flat[s.TICK]) % self.ticks_per_decision
        if since == 0:
            self._decide(flat, NOBODY, DISCS)
        # Images across a border move with every tick.
        count = min(most, self.ticks_per_decision - since)
        count = count if self.world.periodic_boundary is None else 1
        return int(
            ticks_without_robots(
                count, *self._given(flat, NOBODY, DISCS, TICK, NONE, NO_STIFFNESSES)
            )
        )

    def _given(
        self,
        flat: Array,
        robots: Array,
        outlines: Array,
        dt: float,
        numbers: Indices,
        stiffnesses: Array,
    ) -> tuple[Any, ...]:
        """Return all arguments of `tick`."""
        return (
            flat, robots, outlines, numbers, stiffnesses, self._fixed(flat), dt, *self.parameters,
        )  # fmt: skip

    def run(self, duration: float, sample_rate: float = 16.0) -> tuple[Array, Array]:
        """Simulate from the start, without robots.

        Args:
            duration: s.
            sample_rate: Hz, a power of two up to 128.

        Returns:
            times (T,) in s and positions (T, N, 2) in m, NaN for agents outside the world.
        """
        flat, every = self.initial_state(), ticks(sample_rate)
        times, positions = [], []
        for now in range(round(duration * TICKS_PER_SECOND) + 1):
            if now:
                self.advance(flat)
            if now % every == 0:
                _, rows = s.view(flat)
                here = rows[:, s.WAITING] == s.PRESENT
                times.append(now * TICK)
                positions.append(np.where(here[:, None], rows[:, s.X : s.Y + 1], np.nan))
        return np.array(times), np.array(positions)

    def decide(
        self,
        position: Array,
        velocity: Array,
        goal: Array,
        present: NDArray[np.bool_],
        robots: Array = NOBODY,
    ) -> Array:
        """Return desired accelerations (N, 2) in a given situation, m/s^2.

        People face their walking direction, and have noticed all robots within sight.

        Args:
            position, velocity, goal: (N, 2), m and m/s.
            present: (N,) False for people to leave out; their acceleration is 0.
            robots: (R, 8) discs, as for `advance`.
        """
        flat = s.blank(len(self.agents), len(robots))
        header, rows = s.view(flat)
        header[s.TICK] = LATER
        rows[:, s.X : s.Y + 1], rows[:, s.VX : s.VY + 1] = position, velocity
        rows[:, s.GOAL_X : s.GOAL_Y + 1] = goal
        rows[:, self.goal_column : self.goal_column + 2] = goal
        rows[:, s.WAITING] = np.where(present, s.PRESENT, s.NOT_YET)
        away = goal - position
        distance = np.hypot(away[:, :1], away[:, 1:])
        rows[:, s.DIR_X : s.DIR_Y + 1] = away / np.maximum(distance, 1e-9)
        self._decide(flat, robots, _alike(DISC, len(robots)) if len(robots) else DISCS)
        return np.where(present[:, np.newaxis], rows[:, s.AX : s.AY + 1], 0.0)

    def _decide(self, flat: Array, robots: Array, outlines: Array) -> None:
        _, rows = s.view(flat)
        if not self.world.robot_visible:
            robots = np.where(_MOTION, 0.0, robots)
        if self._router is not None:
            number = int(flat[s.TICK]) // self.ticks_per_decision
            self._router.find(s.people_in(flat), self.ticks_per_decision * TICK, number)
        decisions: list[tuple[NDArray[np.bool_], Array]] = []
        for group in self.groups if len(robots) else self._groups_alone:
            shown = robots[:, _SEEN] if group.sees_robot and len(robots) else _NOT_SHOWN
            view = self._view(flat, rows, group.members, shown)
            decides: Any = view.decides
            if group.foreign:
                view = immutable_fields(replace(view, **self._kept))
            desired = desired_acceleration(group.policy, view)
            if self._led and np.any(group.members & self._commanded):
                decisions.append((decides, desired))
            if self._steering is not None:
                desired = self._steering.steer(view, relaxation_time_of(group.policy), desired)
            np.copyto(rows[:, s.AX : s.AY + 1], desired, where=decides[:, np.newaxis])
        if self._router is not None:
            squeeze(s.people_in(flat), self.agents.max_acceleration)
        if self._cohesion is not None and len(self._members):
            hold_together(
                s.people_in(flat), self._members, self._ends, self.agents.max_acceleration,
                self._place.boundary, self._cohesion,
            )  # fmt: skip
        self._evade(flat, robots, outlines)
        for decides, desired in decisions:  # nothing else changes what those want who are led
            np.copyto(rows[:, s.AX : s.AY + 1], desired, where=decides[:, np.newaxis])

    def _evade(self, flat: Array, robots: Array, outlines: Array) -> None:
        """Change desired accelerations of people who have noticed robots, under any policy."""
        if not len(robots):
            return
        now = float(flat[s.TICK]) * TICK
        evade_robots(
            s.people_in(flat), self.agents.radius, self.heeds_robots, self.agents.late, self.room,
            self.agents.preferred_speed, robots, outlines, self.evades, now,
        )  # fmt: skip

    def _view(
        self, flat: Array, rows: Array, members: NDArray[np.bool_], robots: Array
    ) -> CrowdView:
        present = rows[:, s.WAITING] == s.PRESENT
        return CrowdView(
            agents=self.agents,
            position=rows[:, s.X : s.Y + 1].copy(),
            velocity=rows[:, s.VX : s.VY + 1].copy(),
            goal=rows[:, self.goal_column : self.goal_column + 2].copy(),
            present=present,
            robot=robots,
            walls=self.world.walls,
            dt=self.ticks_per_decision * TICK,
            t=float(flat[s.TICK]) * TICK,
            decides=present & members,
            pillars=self.world.pillars,
            periodic_boundary=self.world.periodic_boundary,
            diagonal=not self.world.parity,
        )

    def _fixed(self, flat: Array) -> Array:
        """Return the discs (D, 3) that push: pillars, and images of people across the border."""
        if self.world.periodic_boundary is None:
            return self._pillars
        _, rows = s.view(flat)
        here, radius = rows[:, s.WAITING] == s.PRESENT, self.agents.radius
        people = np.column_stack([rows[:, [s.X, s.Y, s.VX, s.VY]], radius])[here]
        reach = 2.0 * float(np.max(radius, initial=0.0))
        seen = images(
            people, self.world.periodic_boundary, reach, diagonal=not self.world.parity
        )  # fmt: skip
        return np.concatenate([self._pillars, seen[:, [0, 1, 4]]])


def _alike(outline: Array, robots: int) -> Array:
    """Return one outline (K, 2) per robot."""
    return outline[np.newaxis] if robots == 1 else np.repeat(outline[np.newaxis], robots, axis=0)


def _limits(policies: Sequence[CrowdPolicy], agents: Agents, world: CrowdWorld) -> Array:
    """Return the smallest distance (N,) of each centre from walls and pillars, m; 0: no limit."""
    radius = agents.radius
    least = np.minimum(OUTSIDE, 0.5 * radius)
    limit = np.maximum(radius - MOST_OVERLAP, least) if world.firm else least
    walks_through = np.array([getattr(p, "walks_through_walls", False) for p in policies], np.bool_)
    return np.where(walks_through[agents.policy], 0.0, limit) if len(agents) else limit

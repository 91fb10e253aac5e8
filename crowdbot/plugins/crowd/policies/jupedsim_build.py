"""JuPedSim as a policy: each decision is a short simulation from the current state.

The library keeps its own state and accepts no corrections, while here contacts and robots also move
people. So nothing is kept: people are placed at their current positions, the library simulates one
decision, and their mean velocity is the result. Equal situations give equal results, in any order
of agents.
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import Any

import numpy as np

from crowdbot.plugin import Agents, Array, CrowdView, InputError, PluginError
from crowdbot.plugins.crowd.policies.jupedsim import JuPedSimSpec
from crowdbot.plugins.crowd.policies.jupedsim_area_build import SLIT, WalkableAreas

#: Smallest radius, m: the library refuses overlapping bodies, so overlapping ones are shrunk, but
#: not below this.
_SMALLEST = 0.01
#: Share of a gap between bodies that remains, so that rounding does not make them overlap.
_ROOM = 1.0 - 1e-6
#: The library needs targets on the floor; goals farther than this are replaced by nearer ones, m.
_FAR = 50.0
#: Seed of the library's own random numbers; each decision draws the same ones.
_SEED = 1


def library(name: str) -> Any:
    """Import a module of the optional extra.

    Raises:
        PluginError: it is not installed.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise PluginError(
            f"crowd policy 'jupedsim' needs the library {name}: "
            f"pip install 'crowdbot[jupedsim]' ({error})"
        ) from error


class JuPedSim:
    """One of the library's models for a set of agents."""

    def __init__(self, spec: JuPedSimSpec, jps: Any, areas: WalkableAreas) -> None:
        self._spec, self._jps, self._areas = spec, jps, areas
        self.contact_stiffness = spec.contact_stiffness

    def velocities(self, view: CrowdView, dt: float) -> Array:
        """Return mean velocities over the next ``dt``.

        Straight ahead for agents it cannot simulate.

        Raises:
            PluginError: the library refuses the situation.
        """
        preferred, goal = _preferred(view)
        others = view.others(self._spec.sight)
        people = np.flatnonzero(view.present)
        people = people[np.argsort(view.agents.id[people])]
        # Others keep their velocity: robots, pillars, people across the border.
        ahead = others[:, :2] + others[:, 2:4] * max(dt, 1.0)
        at = np.concatenate([view.position[people], others[:, :2]])
        aim = np.concatenate([goal[people], ahead])
        speed = np.hypot(*np.concatenate([preferred[people], others[:, 2:4]]).T)
        radius = np.concatenate([view.agents.avoided_radius[people], others[:, 4]])
        try:
            moved = self._walk(at, aim, speed, radius, view.walls, dt)[: len(people)]
        except RuntimeError as error:  # the library raises this for any invalid input
            raise PluginError(f"jupedsim at t = {view.t:g} s: {error}") from error
        answer = preferred.copy()
        done = np.isfinite(moved[:, 0])
        answer[people[done]] = moved[done] / dt
        return answer

    def _walk(
        self, at: Array, aim: Array, speed: Array, radius: Array, walls: Array, dt: float
    ) -> Array:
        """Return displacements (M, 2) within ``dt``, m.

        NaN for agents on a wall or on another agent.
        """
        moved = np.full(at.shape, np.nan)
        size = np.minimum(_shrunk(at, radius), _ROOM * (_to_walls(at, walls) - SLIT))
        steps = max(1, round(dt / self._spec.time_step))
        for area, inside in self._areas.of(at, walls):
            rows = np.flatnonzero(inside & (size >= _SMALLEST))
            simulation = self._jps.Simulation(
                model=self._model(), geometry=area.shape, dt=dt / steps
            )
            stage = simulation.add_direct_steering_stage()
            journey = simulation.add_journey(self._jps.JourneyDescription([stage]))
            numbers = []
            for row in rows:
                numbers.append(
                    simulation.add_agent(
                        self._agent(at[row], speed[row], size[row], journey, stage)
                    )
                )
                simulation.agent(numbers[-1]).target = area.nearest(aim[row])
            simulation.iterate(steps)
            for row, number in zip(rows, numbers, strict=True):
                moved[row] = np.array(simulation.agent(number).position) - at[row]
        return moved

    def _model(self) -> Any:
        if self._spec.model == "anticipation_velocity":
            return self._jps.AnticipationVelocityModel(rng_seed=_SEED)
        return self._jps.CollisionFreeSpeedModel()

    def _agent(self, at: Array, speed: float, radius: float, journey: int, stage: int) -> Any:
        kind = (
            self._jps.AnticipationVelocityModelAgentParameters
            if self._spec.model == "anticipation_velocity"
            else self._jps.CollisionFreeSpeedModelAgentParameters
        )
        return kind(
            position=(float(at[0]), float(at[1])),
            desired_speed=float(speed),
            radius=float(radius),
            time_gap=self._spec.time_gap,
            journey_id=journey,
            stage_id=stage,
        )


def _preferred(view: CrowdView) -> tuple[Array, Array]:
    """Return preferred velocities (N, 2), zero after arrival; and goals (N, 2) within reach."""
    offset = view.goal - view.position
    distance = np.hypot(offset[:, 0], offset[:, 1])
    on_the_way = distance > view.agents.radius
    pace = np.where(on_the_way, view.agents.preferred_speed, 0.0) / np.maximum(distance, 1e-9)
    nearer = np.minimum(1.0, _FAR / np.maximum(distance, _FAR))
    return offset * pace[:, np.newaxis], view.position + offset * nearer[:, np.newaxis]


def _shrunk(at: Array, radius: Array) -> Array:
    """Return radii (M,) without overlap: both of a pair shrink by the same factor."""
    factor = np.ones(len(at))
    for i in range(len(at) - 1):
        away = np.hypot(*(at[i + 1 :] - at[i]).T) / (radius[i + 1 :] + radius[i])
        factor[i] = min(factor[i], np.min(away))
        factor[i + 1 :] = np.minimum(factor[i + 1 :], away)
    return np.asarray(radius * factor * np.where(factor < 1.0, _ROOM, 1.0))


def _to_walls(at: Array, walls: Array) -> Array:
    """Return the distance (M,) of points to the nearest wall, m."""
    nearest = np.full(len(at), np.inf)
    for x0, y0, x1, y1 in walls:
        start, along = np.array([x0, y0]), np.array([x1 - x0, y1 - y0])
        length2 = max(float(along @ along), 1e-12)
        share = np.clip((at - start) @ along / length2, 0.0, 1.0)
        away = at - start - share[:, np.newaxis] * along
        nearest = np.minimum(nearest, np.hypot(away[:, 0], away[:, 1]))
    return nearest


def build(spec: JuPedSimSpec, costs: Sequence[object], agents: Agents) -> JuPedSim:
    """Build the policy for a set of agents.

    Raises:
        InputError: cost functions are given, which it does not support.
        PluginError: the library is not installed.
    """
    del agents
    if costs:
        raise InputError("crowd policy 'jupedsim' takes no cost functions")
    return JuPedSim(spec, library("jupedsim"), WalkableAreas(library("shapely")))

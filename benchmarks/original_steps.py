"""Whole steps of 0.1 s, as the original engine makes them: decide, push apart, move."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld, policy_of
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import DISC
from crowdbot.core.crowd.desired_acceleration import desired_acceleration
from crowdbot.core.crowd.engine import NO_STIFFNESSES, NONE
from crowdbot.core.crowd.parameters import AgentParameters, Scratch, WorldParameters
from crowdbot.core.crowd.policy import CONTACT_STIFFNESS, CrowdView
from crowdbot.core.crowd.step import tick
from crowdbot.core.support.records import numbers_of

Array = NDArray[np.float64]

DT = 0.1  # s
#: Policies, and with each what the original makes of them with 250 people on one thread (steps/s,
#: measured elsewhere) and how many times that is asked of us.
FIGURES: dict[str, tuple[dict[str, Any], dict[str, dict[str, Any]], float, float]] = {
    "challenge mix": (
        {"kind": "velocity_space"},
        {
            "mid_term": {
                "kind": "ttca_dca", "weight": 20.0, "range": 5.0, "sigma_ttca": 0.3,
                "sigma_dca": 0.3, "sigma_angle_goal": 3.0, "sigma_speed_goal": 0.01,
            },
            "reflex": {"kind": "rvo", "range": {"value": 0.3, "measure": "surface"}},
        },
        53.0, 25.0,
    ),
    "gradient ttca_dca": (
        {"kind": "velocity_space", "method": "gradient"},
        {"mid_term": {"kind": "ttca_dca"}},
        1020.0, 3.0,
    ),
    "rvo, 250 random": (
        {
            "kind": "velocity_space", "samples": "random", "random_samples": 250,
            "base": "current_velocity", "direction": "unit", "angle": "360 deg",
            "radius": "maximum_acceleration", "relaxation_time": 0.0,
        },
        {"reflex": {"kind": "rvo"}},
        43.0, 7.0,
    ),
}  # fmt: skip


def whole_step(
    policy: dict[str, Any], costs: dict[str, dict[str, Any]], agents: Agents, walls: Array,
    seen: list[CrowdView] | None = None,
) -> Callable[[], object]:  # fmt: skip
    """A function that advances a crowd by `DT`; each view of the policy is added to ``seen``."""
    chosen, world = policy_of(policy, costs)(agents), CrowdWorld(walls=walls)
    flat = CrowdEngine(agents, world, chosen).initial_state()
    _, rows = s.view(flat)
    n = len(agents)
    robots, everybody = np.zeros((0, 8)), np.ones(n, np.bool_)
    people = AgentParameters.of(agents, np.full(n, CONTACT_STIFFNESS))
    place = WorldParameters.of(world)
    scratch = Scratch.of(n)

    def step() -> None:
        view = CrowdView(
            agents=agents, position=np.ascontiguousarray(rows[:, s.X : s.Y + 1]),
            velocity=np.ascontiguousarray(rows[:, s.VX : s.VY + 1]),
            goal=np.ascontiguousarray(rows[:, s.GOAL_X : s.GOAL_Y + 1]),
            present=everybody, robot=robots[:, :5], walls=walls, dt=DT, decides=everybody,
        )  # fmt: skip
        if seen is not None:
            seen.append(view)
        rows[:, s.AX : s.AY + 1] = desired_acceleration(chosen, view)
        given: tuple[Any, ...] = (
            flat, robots, DISC[None], NONE, NO_STIFFNESSES, world.pillars, DT,
            *numbers_of(*people, *place, *scratch),
        )  # fmt: skip
        tick(*given)

    return step

"""People MPC: it does not drive people on before it."""

import math

import numpy as np
import pytest

from crowdbot.core.registry.build_reference import load_build
from crowdbot.plugins.planners.people_mpc.people_mpc import PEOPLE_MPC, PeopleMpcSpec
from crowdbot.plugins.planners.people_mpc.people_mpc_build import build
from tests.plugins.planners.world import CORRIDOR, PERSON, RADIUS, World

#: An alley that is too narrow to overtake in, behind somebody who walks at 0.2 m/s.
ALLEY = np.array([[-1.0, -0.7, 51.0, -0.7], [-1.0, 0.7, 51.0, 0.7], *CORRIDOR[2:]])
SLOW, WITHIN = 0.2, 12.0  # m/s, s
TOLD = PeopleMpcSpec(tracks="truth", localisation="truth")


def least_headway(spec: PeopleMpcSpec) -> float:
    """The shortest time, s, in which it would have reached the one ahead, had they stopped."""
    world = World([[5.0, 0.0, SLOW, 0.0]], walls=ALLEY, truth=True)
    out = world.run(build(spec), time_limit=WITHIN)
    assert not out.contacts
    times = np.linspace(0.0, out.t, len(out.path))
    x, y = np.array([[pose.x, pose.y] for pose in out.path]).T
    gap = np.hypot(5.0 + SLOW * times - x, y) - PERSON - RADIUS
    speed = np.gradient(x, times)
    return float((gap / np.maximum(speed, 0.05)).min())


def test_component() -> None:
    assert load_build(PEOPLE_MPC) is build


@pytest.mark.slow
def test_it_leaves_time_to_a_slow_one_ahead() -> None:
    watched = least_headway(TOLD)
    assert watched > least_headway(TOLD.model_copy(update={"hurry": 0.0}))
    assert watched > 0.4


@pytest.mark.slow
def test_it_arrives_all_the_same() -> None:
    out = World([[20.0, 0.1, -1.2, 0.0]], truth=True).run(build(TOLD), stop_at=20.0)
    assert out.arrived
    assert not out.contacts
    assert out.t < 1.3 * math.dist((2.5, 0.0), (20.0, 0.0)) / 0.65

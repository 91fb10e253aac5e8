"""The MPC in closed cases: straight, a wall, people who cross and come; and a solver that fails."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.plugin import RobotLimits
from crowdbot.plugins.planners.mpc.mpc import MpcSpec
from crowdbot.plugins.planners.mpc.mpc_build import Mpc, build
from crowdbot.plugins.planners.mpc.problem_build import Problem
from tests.plugins.planners.world import LIMITS, World

casadi = pytest.importorskip("casadi", reason="the extra mpc is not installed")
TOLD = {"tracks": "truth", "localisation": "truth"}
FREE = [0.0, 0.0, 0.0, 0.0, -1e3]


def _mpc(**parameters: Any) -> Mpc:
    return build(MpcSpec.model_validate({"kind": "mpc", **parameters}))


def _given(spec: MpcSpec, state: list[float], top: float) -> np.ndarray:
    rows = FREE * (spec.stages * (spec.neighbours + spec.planes))
    return np.array([*state, 9.0, 0.0, top, *rows])


@pytest.mark.parametrize("vy_max", [0.0, 0.5])
def test_the_free_plan_takes_up_speed_as_fast_as_it_may_and_keeps_it(vy_max: float) -> None:
    spec = MpcSpec()
    limits = RobotLimits(v_min=0.0, v_max=0.6, w_max=1.0, a_max=1.0, alpha_max=1.0, vy_max=vy_max)
    problem = Problem(casadi, spec, limits)
    solved = problem.solve(
        np.zeros((spec.stages, problem.axes)), _given(spec, [0.0] * 6, limits.v_max)
    )
    assert solved is not None
    plan, cost = solved
    assert plan[:4, 0] == pytest.approx([0.25, 0.5, 0.6, 0.6], abs=0.02)
    assert np.abs(plan[:, 1:]).max() < 1e-4
    assert cost < problem.cost(np.zeros_like(plan), _given(spec, [0.0] * 6, limits.v_max))


def test_a_robot_that_is_too_fast_slows_down_within_its_limits() -> None:
    spec = MpcSpec()
    solved = Problem(casadi, spec, LIMITS).solve(
        np.zeros((spec.stages, 2)), _given(spec, [0.0, 0.0, 0.0, 0.65, 0.0, 0.0], 0.1)
    )
    assert solved is not None
    assert solved[0][:3, 0] == pytest.approx([0.4, 0.15, 0.1], abs=1e-3)


def test_it_turns_round_on_the_spot_to_a_goal_behind_it() -> None:
    world = World(goal=(0.9, 0.0))
    out = world.run(_mpc(), time_limit=6.0, stop_at=99.0)
    assert abs(world.pose.yaw) > 2.5
    assert out.least_wall_gap > 0.0


@pytest.mark.parametrize("person", [[5.5, -3.6, 0.0, 0.8], [8.0, 0.05, -0.8, 0.0]])
def test_people_who_cross_and_who_come_are_let_past(person: list[float]) -> None:
    world = World([person], goal=(9.0, 0.0), truth=True)
    out = world.run(_mpc(**TOLD), time_limit=14.0, stop_at=8.0)
    assert out.arrived
    assert out.contacts == []
    assert out.logged["mpc/failed"][-1] == 0.0


def test_it_stops_before_a_wall() -> None:
    walls = np.array([[5.0, -5.0, 5.0, 5.0], [0.0, -5.0, 0.0, 5.0]])
    out = World(goal=(9.0, 0.0), walls=walls).run(_mpc(), time_limit=6.0, stop_at=8.0)
    assert out.least_wall_gap > 0.0


class _Broken:
    """A solver that fails in one of two ways."""

    def __init__(self, *, raises: bool) -> None:
        self.raises = raises

    def __call__(self, **given: Any) -> dict[str, Any]:
        if self.raises:
            raise RuntimeError("no solution")
        return {"x": np.full_like(given["x0"], np.nan), "f": 0.0}


@pytest.mark.parametrize("raises", [True, False])
def test_it_brakes_and_counts_when_the_solver_fails(
    monkeypatch: pytest.MonkeyPatch, *, raises: bool
) -> None:
    made = Problem.__init__

    def broken(self: Problem, *args: Any) -> None:
        made(self, *args)
        self._solver = _Broken(raises=raises)

    monkeypatch.setattr(Problem, "__init__", broken)
    world = World(goal=(9.0, 0.0))
    out = world.run(_mpc(), time_limit=0.3, stop_at=8.0)
    assert all(tuple(c) == (0.0, 0.0, 0.0) for c in out.commands)
    assert out.logged["mpc/failed"] == [1.0, 2.0, 3.0, 4.0, 5.0]

"""The metric on a signal whose score is known."""

from __future__ import annotations

import crowdbot
import pytest


def scores(signals: dict[str, list[list[float]]]) -> dict[str, crowdbot.Score]:
    run = crowdbot.Trajectories.from_arrays(
        t=[0.0, 4.0], robot_x=[0.0, 1.0], robot_y=[0.0, 0.0], robot_theta=[0.0, 0.0],
        robot_v=[1.0, 1.0], robot_w=[0.0, 0.0], robot_radius=0.2, robot_mass=15.0, signals=signals,
    )  # fmt: skip
    found = crowdbot.score(run, metrics="acme.hesitation")
    return {s.variant: s for s in found}


def test_time_above_the_threshold() -> None:
    brake = [[0.0, 0.4], [1.0, 0.5], [3.0, 0.9], [4.0, 1.0]]
    found = scores({"acme/brake": brake})
    assert found["corrected"].value == pytest.approx(3.0)
    assert found["share"].value == pytest.approx(0.75)


def test_a_planner_that_logs_nothing() -> None:
    found = scores({"other/signal": [[0.0, 1.0], [1.0, 1.0]]})
    assert {s.reason for s in found.values()} == {"no_signal"}

"""Who is touched on a step: by people between the samples, by walls, by the robot."""

from __future__ import annotations

import dataclasses

import numpy as np

from crowdbot.core.trajectories.touched import SLACK, touched
from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import AGENT_RADIUS, REACH, grid, line, scene

T = grid(1.0, 1 / 16)


def steps(run: Trajectories, person: int = 0) -> list[int]:
    """The steps on which somebody is touched."""
    assert run.agents is not None
    asked = np.ones((len(run.t) - 1, run.agents.x.shape[1]), dtype=bool)
    return list(np.flatnonzero(touched(run, asked, 10.0)[:, person]))


def test_nobody_touches_who_is_alone() -> None:
    assert steps(scene(T, line(T, (0, 5), (0, 0)), [line(T, (0, 0), (1, 0))])) == []


def test_people_who_pass_through_each_other_between_two_samples_touch() -> None:
    """At 30 m/s against each other they are apart at all samples."""
    t = grid(1.0, 1 / 4)
    each = [line(t, (-3.6, 0), (8.0, 0)), line(t, (3.6, 0), (-8.0, 0))]
    run = scene(t, line(t, (0, 50), (0, 0)), each)
    assert run.agents is not None
    apart = np.abs(run.agents.x[:, 0] - run.agents.x[:, 1])
    assert apart.min() > 2 * AGENT_RADIUS
    assert steps(run) == steps(run, 1) == [1]


def test_a_wall_and_the_robot_touch() -> None:
    run = scene(T, line(T, (REACH + 0.5, 0), (-1, 0)), [line(T, (0, 0), (0, 0))])
    assert steps(run)[0] == 7  # 0.5 m at 1 m/s
    wall = np.array([[AGENT_RADIUS + 0.01, -1.0, AGENT_RADIUS + 0.01, 1.0]])
    away = scene(T, line(T, (0, 9), (0, 0)), [line(T, (0, 0), (0, 0))])
    assert steps(dataclasses.replace(away, walls=wall)) == list(range(16))
    assert steps(dataclasses.replace(away, walls=wall + 0.1)) == []


def test_the_table_shows_what_samples_do_not() -> None:
    ones = np.ones(1)
    table = {
        "t0": [0.51], "t1": [0.53], "agent": np.array([0]), "bearing": [0.0],
        "impulse": ones, "peak_force": ones, "relative_speed": ones,
    }  # fmt: skip
    run = scene(T, line(T, (0, 5), (0, 0)), [line(T, (0, 0), (0, 0))], contacts=table)
    assert steps(run) == [8]


def test_only_what_is_asked_about() -> None:
    run = scene(T, line(T, (REACH, 0), (0, 0)), [line(T, (0, 0), (0, 0))])
    asked = np.zeros((16, 1), dtype=bool)
    asked[3] = True
    assert list(np.flatnonzero(touched(run, asked, 10.0)[:, 0])) == [3]


def test_a_crowd_is_compared_pair_by_pair() -> None:
    """People who rush about, stand still, vanish and come back."""
    random = np.random.default_rng(7)
    t = grid(2.0, 1 / 8)
    speeds = random.normal(0.0, 6.0, (12, 2)) * (np.arange(12) % 4 > 0)[:, None]
    starts = random.uniform(-2, 2, (12, 2))
    each = [line(t, (p[0], p[1]), (v[0], v[1])) for p, v in zip(starts, speeds, strict=True)]
    run = scene(t, line(t, (0, 90), (0, 0)), each)
    assert run.agents is not None
    x, y, r = run.agents.x.copy(), run.agents.y.copy(), run.agents.radius
    x[5:8, 3] = np.nan
    run = dataclasses.replace(run, agents=dataclasses.replace(run.agents, x=x))
    expected = np.zeros((len(t) - 1, 12), dtype=bool)
    for k, one, two in np.ndindex(len(t) - 1, 12, 12):
        px, py = x[k, two] - x[k, one], y[k, two] - y[k, one]
        dx, dy = x[k + 1, two] - x[k + 1, one] - px, y[k + 1, two] - y[k + 1, one] - py
        square = dx * dx + dy * dy
        u = np.clip(-(px * dx + py * dy) / square, 0.0, 1.0) if square > 0.0 else 0.0
        if one != two and np.hypot(px + u * dx, py + u * dy) - r[one] - r[two] < SLACK:
            expected[k, one] = True
    assert 0 < expected.sum() < expected.size / 2
    np.testing.assert_array_equal(touched(run, np.ones_like(expected), 50.0), expected)

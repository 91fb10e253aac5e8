"""Episodes as trajectories, scores and replay pages."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.errors import InputError
from tests.rl.test_env import FEW, SHORT

gym = pytest.importorskip("gymnasium", reason="the extra rl is not installed")
rl = pytest.importorskip("crowdbot.rl")


def drive(env: Any, steps: int, action: Any = (1.0, 0.0)) -> list[Any]:
    return [env.step(np.array(action, np.float32)) for _ in range(steps)]


def test_an_episode_is_scored_like_a_run() -> None:
    env = rl.EpisodeRecorder(gym.make(rl.NAV, **FEW))
    env.reset(seed=3)
    drive(env, 32)
    run, rollout = env.trajectories, env.unwrapped.rollout
    assert run.t == pytest.approx(np.arange(33) / 16.0)
    assert (run.robot.x[-1], run.robot.y[-1]) == tuple(rollout.rows[0, 0, :2])
    people = rollout.people()[0]
    assert np.array_equal(run.agents.x[-1], people[:, 0], equal_nan=True)
    (left,) = env.scores("final_distance_to_goal")
    away = np.hypot(*(np.array(rollout.world(0).tasks[0].goal) - rollout.rows[0, 0, :2]))
    assert away - 5.0 < left.value < away  # to the zone, not to its centre
    assert {score.metric for score in env.scores()} >= {"safe_efficiency", "push_work"}


def test_contacts_of_an_episode_are_recorded() -> None:
    crowded = {**FEW, "set": ["crowd.flow.density=0.5"]}
    env = rl.EpisodeRecorder(gym.make(rl.NAV, **crowded))
    env.reset(seed=1)
    touched = any(info["touched"] for *_, info in drive(env, 120))
    assert touched
    contacts = env.trajectories.contacts
    assert len(contacts.t0) > 0
    assert (contacts.t1 >= contacts.t0).all()
    assert (contacts.peak_force > 0.0).all()
    assert set(contacts.agent) <= set(env.trajectories.agents.id)


def test_each_episode_that_ends_gets_a_page(tmp_path: Path) -> None:
    env = rl.EpisodeRecorder(gym.make(rl.NAV, **SHORT), folder=tmp_path / "episodes", every=2)
    for episode in range(3):
        env.reset(seed=episode)
        drive(env, 8)
    pages = sorted(path.name for path in (tmp_path / "episodes").iterdir())
    assert pages == ["episode-00000.html", "episode-00002.html"]
    again = rl.EpisodeRecorder(gym.make(rl.NAV, **SHORT), folder=tmp_path / "episodes")
    again.reset(seed=9)
    before = (tmp_path / "episodes" / pages[1]).read_bytes()
    drive(again, 8)
    assert (tmp_path / "episodes" / "episode-00003.html").is_file()  # nothing is overwritten
    assert (tmp_path / "episodes" / pages[1]).read_bytes() == before
    assert "timeout" in (tmp_path / "episodes" / pages[0]).read_text("utf-8")


def test_what_cannot_be_recorded_is_refused() -> None:
    with pytest.raises(InputError, match="every is 0"):
        rl.EpisodeRecorder(gym.make(rl.NAV, **FEW), every=0)
    with pytest.raises(InputError, match="one world of one robot"):
        rl.EpisodeRecorder(gym.make("CartPole-v1"))
    with pytest.raises(InputError, match=r"call reset\(\) first"):
        _ = rl.EpisodeRecorder(gym.make(rl.NAV, **FEW)).trajectories

"""The Gymnasium environments: spaces, seeds, episodes, and both conventions of the next one."""

from __future__ import annotations

import pickle
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.errors import CrowdbotError, InputError, UnknownNameError
from tests.paths import ROOT

gym = pytest.importorskip("gymnasium", reason="the extra rl is not installed")
rl = pytest.importorskip("crowdbot.rl")
CHECKER = pytest.importorskip("gymnasium.utils.env_checker")

FEW: dict[str, Any] = {
    "suite": "challenge-2020",
    "scenario": "counter-d0500-dispersed-c20-r05",
    "set": ["crowd.flow.density=0.02"],
}
#: Over after 0.5 s.
SHORT = {**FEW, "set": [*FEW["set"], "robots.robot.task.time_limit=0.5"]}


def vector(count: int, **arguments: Any) -> Any:
    return gym.make_vec(rl.NAV, num_envs=count, **{**FEW, **arguments})


def actions(count: int, steps: int) -> Any:
    return np.random.default_rng(1).uniform(-1.0, 1.0, (steps, count, 2)).astype(np.float32)


def test_it_passes_gymnasiums_own_checks() -> None:
    env = gym.make(rl.NAV, draws=2, **FEW)
    CHECKER.check_env(env.unwrapped, skip_render_check=True)
    assert np.isfinite(env.observation_space.low).all()
    assert np.isfinite(env.observation_space.high).all()
    assert (env.action_space.low, env.action_space.high) == (pytest.approx(-1), pytest.approx(1))


def test_it_draws_from_above() -> None:
    env = gym.make(rl.NAV, render_mode="rgb_array", **FEW)
    env.reset(seed=1)
    image = env.render()
    assert image.dtype == np.uint8
    assert image.shape == (480, 640, 3)
    assert len(np.unique(image.reshape(-1, 3), axis=0)) > 4


def test_a_window_shows_each_step(monkeypatch: pytest.MonkeyPatch) -> None:
    pygame = pytest.importorskip("pygame", reason="pygame is not installed")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = gym.make(rl.NAV, render_mode="human", **FEW)
    env.reset(seed=1)
    shown = pygame.surfarray.array3d(pygame.display.get_surface()).swapaxes(0, 1)
    own = gym.make(rl.NAV, render_mode="rgb_array", **FEW)
    own.reset(seed=1)
    assert np.array_equal(shown, own.render())
    assert env.render() is None
    env.close()
    assert not pygame.display.get_init()
    with pytest.raises(InputError, match="'rgb_array' or 'human' or None, not 'ansi'"):
        rl.NavEnv(render_mode="ansi", **FEW)


def rollout(env: Any, given: Any) -> list[Any]:
    return [env.step(action) for action in given]


@pytest.mark.parametrize("threads", [1, 2])
def test_a_world_is_the_same_in_any_batch(threads: int) -> None:
    given = actions(3, 12)
    many = vector(3, threads=threads)
    first, _ = many.reset(seed=[7, 3, 5])
    found = rollout(many, given)
    for w, seed in enumerate([7, 3, 5]):
        one = gym.make(rl.NAV, **FEW)
        alone, _ = one.reset(seed=seed)
        assert np.array_equal(alone, first[w])
        for (obs, reward, *_), (own, mine, *_) in zip(
            found, rollout(one, given[:, w]), strict=True
        ):
            assert np.array_equal(obs[w], own)
            assert reward[w] == mine
    assert not np.array_equal(first[0], first[1])
    many.close()


def test_each_episode_has_new_people_unless_they_are_asked_for() -> None:
    def starts(**arguments: Any) -> list[Any]:
        env = gym.make(rl.NAV, observation="truth", **{**FEW, **arguments})
        return [env.reset(seed=4)[0], env.reset()[0], env.reset()[0]]

    new = starts()
    assert not np.array_equal(new[0], new[1])
    assert not np.array_equal(new[1], new[2])
    again = starts(draws=1)
    assert np.array_equal(again[0], again[1])
    suite = starts(edition=True, set=())
    assert np.array_equal(suite[0], suite[2])
    world = gym.make(rl.NAV, edition=True, **{**FEW, "set": ()}).unwrapped.rollout.world(0)
    whole = crowdbot.load(FEW["suite"], FEW["scenario"])
    from crowdbot.api import registry
    from crowdbot.core.scenarios.lock import population

    assert np.array_equal(world.engine.agents.x, population(whole, registry()).agents.x)


def ends(mode: str) -> list[Any]:
    """Steps of two worlds of half a second, of which one is begun again in between."""
    env = gym.make_vec(rl.NAV, num_envs=2, autoreset_mode=mode, draws=3, **SHORT)
    env.reset(seed=2)
    return rollout(env, actions(2, 18))


def test_the_next_step_begins_the_next_episode() -> None:
    steps = ends("NextStep")
    late = [u.tolist() for _, _, _, u, _ in steps]
    assert late[7] == [True, True]
    assert [n for n, ended in enumerate(late) if any(ended)] == [7, 16]
    assert steps[8][1].tolist() == [0.0, 0.0]
    assert steps[8][4]["t"].tolist() == [0.0, 0.0]
    assert steps[9][4]["t"].tolist() == [0.0625, 0.0625]


def test_the_same_step_begins_the_next_episode_and_keeps_the_last_observation() -> None:
    steps = ends("SameStep")
    assert [n for n, step in enumerate(steps) if step[3].any()] == [7, 15]
    obs, _, _, _, infos = steps[7]
    assert infos["_final_obs"].tolist() == [True, True]
    assert infos["final_info"]["t"].tolist() == [0.5, 0.5]
    assert infos["t"].tolist() == [0.0, 0.0]
    last = ends("NextStep")[7][0]
    assert np.array_equal(np.stack(infos["final_obs"]), last)
    assert not np.array_equal(obs, last)
    assert np.array_equal(obs, ends("NextStep")[8][0])


def test_some_worlds_are_reset_by_a_mask() -> None:
    env = vector(3, autoreset_mode="Disabled", draws=4)
    first, _ = env.reset(seed=1)
    rollout(env, actions(3, 4))
    mask = np.array([False, True, False])
    obs, infos = env.reset(seed=1, options={"reset_mask": mask})
    assert infos["t"].tolist() == [0.25, 0.0, 0.25]
    assert np.array_equal(obs[1], first[1])
    assert not np.array_equal(obs[0], first[0])
    with pytest.raises(InputError, match="reset_mask must be a bool array"):
        env.reset(options={"reset_mask": [True]})


def test_an_episode_that_has_ended_is_not_stepped_on() -> None:
    env = gym.make_vec(rl.NAV, num_envs=1, autoreset_mode="Disabled", **SHORT)
    env.reset(seed=2)
    rollout(env, actions(1, 8))
    with pytest.raises(InputError, match="episodes have ended"):
        env.step(actions(1, 1)[0])


def test_arriving_is_a_success_and_people_may_end_an_episode() -> None:
    near = ["crowd=null", "robots.robot.task.start=[44.5 m, 0 m, 0 deg]"]
    env = gym.make(rl.NAV, suite=FEW["suite"], scenario=FEW["scenario"], set=near)
    env.reset(seed=0)
    done, info, steps, total = False, {}, 0, 0.0
    while not done and steps < 200:
        _, reward, done, late, info = env.step(np.array([1.0, 0.0], np.float32))
        steps, total = steps + 1, total + reward
        assert not late
    assert done
    assert info["is_success"]
    assert total > 5.0


def test_levels_choose_scenarios() -> None:
    levels = ["in-d0125-slow-c20-r10", ["counter-d0500-dispersed-c20-r10"]]
    env = gym.make(rl.NAV, suite="challenge-2020", levels=levels)
    assert env.reset(seed=1)[1]["scenario"] == levels[0]
    assert env.reset(options={"level": 1})[1]["scenario"] == levels[1][0]
    assert env.reset()[1]["scenario"] == levels[1][0]
    with pytest.raises(InputError, match="level 2 of 2"):
        env.reset(options={"level": 2})


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"observation": "lidarstack"}, "unknown observation 'lidarstack'; did you mean"),
        ({"reward": {"kind": "progress", "tme": 1}}, "reward 'progress': tme"),
        ({"observation": {"kind": "occupancy", "sensor": "us0"}}, "a lidar is wanted"),
        ({"observation": {"kind": "lidar_stack", "sensor": "imu"}}, "kind 'imu'.*of distances"),
        ({"draws": 0}, "at least 1"),
        ({"contact": "stop"}, "'go_on' or 'end'"),
        ({"scenario": "nowhere"}, "nowhere"),
        ({"scenarios": "x"}, "unknown argument 'scenarios'; did you mean 'scenario'"),
    ],
)
def test_wrong_arguments_are_named(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(CrowdbotError, match=message) as caught:
        gym.make(rl.NAV, **{**FEW, **wrong})
    assert isinstance(caught.value, InputError | UnknownNameError)


def test_a_missing_suite_is_named() -> None:
    with pytest.raises(InputError, match="an environment needs a suite"):
        gym.make(rl.NAV)


def test_wrong_actions_are_named() -> None:
    env = vector(2, draws=1)
    with pytest.raises(InputError, match="reset"):
        env.step(np.zeros((2, 2)))
    env.reset(seed=0)
    with pytest.raises(InputError, match=r"shape \(2, 2\), not \(3, 2\)"):
        env.step(np.zeros((3, 2)))
    with pytest.raises(InputError, match="not a number"):
        env.step(np.full((2, 2), np.nan))


@pytest.mark.parametrize("made", [lambda: rl.NavEnv(**FEW), lambda: rl.NavVectorEnv(2, **FEW)])
def test_a_pickled_environment_begins_anew_with_the_same_arguments(made: Any) -> None:
    env = made()
    again = pickle.loads(pickle.dumps(env))  # noqa: S301 - our own
    for one in (env, again):
        one.reset(seed=3)
    action = np.full(env.action_space.shape, 0.3)
    assert np.array_equal(env.step(action)[0], again.step(action)[0])


def test_crowdbot_does_not_import_gymnasium() -> None:
    code = "import sys, crowdbot, crowdbot.api; print('gymnasium' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          cwd=ROOT)  # fmt: skip
    assert done.stdout.strip() == "False"


@pytest.mark.parametrize("observation", ["lidar_stack", "tracks"])
def test_worlds_that_end_at_other_times_do_not_disturb_each_other(observation: str) -> None:
    """Both conventions show the same episodes; what one world remembers is its own."""
    limits = {"counter-d0500-dispersed-c20-r05": 0.5, "counter-d0500-dispersed-c20-r10": 0.75}
    several = {**SHORT, "scenario": list(limits), "observation": observation, "draws": 2}
    several["set"] = [*FEW["set"], "robots.robot.task.time_limit=0.5"]
    next_step = gym.make_vec(rl.NAV, num_envs=2, **several)
    same_step = gym.make_vec(rl.NAV, num_envs=2, autoreset_mode="SameStep", **several)
    next_step.reset(seed=9)
    same_step.reset(seed=9)
    # Put the second world of both a few steps behind.
    mask = np.array([False, True])
    given = actions(2, 30)
    for action in given[:3]:
        next_step.step(action)
        same_step.step(action)
    one, _ = next_step.reset(options={"reset_mask": mask})
    other, _ = same_step.reset(options={"reset_mask": mask})
    assert np.array_equal(one, other)
    alone = gym.make_vec(rl.NAV, num_envs=1, **several)
    alone.reset(seed=9)
    for action in given[:4]:
        found, *_ = alone.step(action[:1])
    shown, *_ = same_step.step(given[3])
    assert np.array_equal(shown[0], found[0])
    own, *_ = next_step.step(given[3])
    assert np.array_equal(own, shown)


def test_without_gymnasium_environments_say_what_is_missing() -> None:
    code = (
        "import sys; sys.modules['gymnasium'] = None\n"
        "import crowdbot.rl\n"
        "try:\n    crowdbot.rl.NavVectorEnv(2, suite='challenge-2020')\n"
        "except Exception as error:\n    print(type(error).__name__, error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          cwd=ROOT)  # fmt: skip
    assert done.stdout.startswith("MissingLibraryError Gymnasium is not installed; install it with")

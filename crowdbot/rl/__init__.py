"""Gymnasium environments for training policies, which the full simulation judges afterwards.

``import crowdbot.rl`` registers ``crowdbot/Nav-v0``; Gymnasium comes with the extra ``rl``::

    import gymnasium as gym
    import crowdbot.rl

    env = gym.make("crowdbot/Nav-v0", suite="challenge-2020", scenario="in-d0250-*")
    envs = gym.make_vec("crowdbot/Nav-v0", num_envs=64, suite="challenge-2020")
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from crowdbot.lazy import lazy_names
from crowdbot.rl.libraries import gym

if TYPE_CHECKING:
    from crowdbot.rl.env import NavEnv
    from crowdbot.rl.parallel_env import ParallelNavEnv
    from crowdbot.rl.policy_export import conventions, save_layers, save_onnx
    from crowdbot.rl.recorder import EpisodeRecorder
    from crowdbot.rl.sb3 import StableVecEnv
    from crowdbot.rl.vector_env import NavVectorEnv

#: Name of the environment in Gymnasium.
NAV = "crowdbot/Nav-v0"

if gym is not None and NAV not in gym.registry:
    gym.register(
        NAV,
        entry_point="crowdbot.rl.env:NavEnv",
        vector_entry_point="crowdbot.rl.vector_env:NavVectorEnv",
        order_enforce=True,
    )

__all__ = [
    "NAV",
    "EpisodeRecorder",
    "NavEnv",
    "NavVectorEnv",
    "ParallelNavEnv",
    "StableVecEnv",
    "conventions",
    "save_layers",
    "save_onnx",
]

__getattr__ = lazy_names(
    __name__,
    {
        "crowdbot.rl.env": "NavEnv",
        "crowdbot.rl.vector_env": "NavVectorEnv",
        "crowdbot.rl.parallel_env": "ParallelNavEnv",
        "crowdbot.rl.recorder": "EpisodeRecorder",
        "crowdbot.rl.sb3": "StableVecEnv",
        "crowdbot.rl.policy_export": "conventions save_layers save_onnx",
    },
)

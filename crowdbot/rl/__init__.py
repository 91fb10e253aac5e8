"""Gymnasium environments for training policies, which the full simulation judges afterwards.

``import crowdbot.rl`` registers ``crowdbot/Nav-v0``; Gymnasium comes with the extra ``rl``::

    import gymnasium as gym
    import crowdbot.rl

    env = gym.make("crowdbot/Nav-v0", suite="challenge-2020", scenario="in-d0250-*")
    envs = gym.make_vec("crowdbot/Nav-v0", num_envs=64, suite="challenge-2020")
"""

from __future__ import annotations

from crowdbot.lazy import lazy_face
from crowdbot.rl.libraries import gym

#: Name of the environment in Gymnasium.
NAV = "crowdbot/Nav-v0"

if gym is not None and NAV not in gym.registry:
    gym.register(
        NAV,
        entry_point="crowdbot.rl.env:NavEnv",
        vector_entry_point="crowdbot.rl.vector_env:NavVectorEnv",
        order_enforce=True,
    )

__all__, __getattr__, __dir__ = lazy_face(__name__, __file__, "NAV")

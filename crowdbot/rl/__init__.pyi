"""Names of this package, and where they come from: for type checkers, and to import them."""

__all__: list[str]

from crowdbot.rl.env import NavEnv as NavEnv
from crowdbot.rl.parallel_env import ParallelNavEnv as ParallelNavEnv
from crowdbot.rl.policy_export import conventions as conventions
from crowdbot.rl.policy_export import save_layers as save_layers
from crowdbot.rl.policy_export import save_onnx as save_onnx
from crowdbot.rl.recorder import EpisodeRecorder as EpisodeRecorder
from crowdbot.rl.sb3 import StableVecEnv as StableVecEnv
from crowdbot.rl.vector_env import NavVectorEnv as NavVectorEnv

NAV: str

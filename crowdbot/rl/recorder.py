"""EpisodeRecorder: the episodes of an environment as trajectories, scores and replay pages."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from crowdbot.api import score
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score
from crowdbot.errors import InputError
from crowdbot.rl.env import NavEnv
from crowdbot.rl.episode_log import EpisodeLog
from crowdbot.rl.episode_page import episode_page
from crowdbot.rl.libraries import Wrapper


class EpisodeRecorder(Wrapper):
    """An environment that keeps each episode: its trajectories, its scores, its replay page.

    ::

        env = crowdbot.rl.EpisodeRecorder(gym.make("crowdbot/Nav-v0", ...), folder="episodes")

    Args:
        env: `NavEnv`, wrapped or not.
        folder: where replay pages ``episode-00000.html`` of finished episodes are written; numbers
            continue after those of existing pages; None: no pages.
        every: write a page for every n-th episode only.

    Raises:
        InputError: it is another environment, or ``every`` is not positive.
    """

    def __init__(self, env: Any, folder: str | Path | None = None, *, every: int = 1) -> None:
        super().__init__(env)
        if not isinstance(env.unwrapped, NavEnv):
            raise InputError("EpisodeRecorder records crowdbot.rl.NavEnv, one world of one robot")
        if every < 1:
            raise InputError(f"every is {every}; it must be at least 1")
        self._rollout, self._every = env.unwrapped.rollout, every
        self._folder = None if folder is None else Path(folder)
        self._log: EpisodeLog | None = None
        self._episodes, self._first = 0, _next_number(self._folder)

    def reset(self, **arguments: Any) -> Any:
        """Begin an episode; see `NavEnv.reset`."""
        found = super().reset(**arguments)
        self._log = EpisodeLog(self._rollout)
        return found

    def step(self, action: Any) -> Any:
        """Advance by one period of the planner; write the page of an episode that ends."""
        found = super().step(action)
        self._begun().add(self._rollout)
        if found[2] or found[3]:
            self._end()
        return found

    @property
    def trajectories(self) -> Trajectories:
        """Return the trajectories of the episode so far, in the form that metrics read."""
        return self._begun().trajectories()

    def scores(self, metrics: str = "*") -> list[Score]:
        """Return the scores of the episode so far, by the metrics that score runs.

        Raises:
            UnknownNameError: no metric has such a name.
        """
        return list(score(self.trajectories, metrics=metrics))

    def write_replay(self, path: str | Path) -> None:
        """Write the replay page of the episode so far: one HTML file that needs no network.

        Raises:
            InputError: the path cannot be written.
        """
        log = self._begun()
        episode_page(Path(path), self._rollout.world(0), log, self.scores())

    def _end(self) -> None:
        if self._folder is not None and self._episodes % self._every == 0:
            self._folder.mkdir(parents=True, exist_ok=True)
            self.write_replay(self._folder / f"episode-{self._first + self._episodes:05}.html")
        self._episodes += 1

    def _begun(self) -> EpisodeLog:
        if self._log is None:
            raise InputError("call reset() first: it begins an episode")
        return self._log


def _next_number(folder: Path | None) -> int:
    """Return one more than the highest number of the replay pages in a folder."""
    pages = [] if folder is None else folder.glob("episode-*.html")
    numbers = (page.stem.removeprefix("episode-") for page in pages)
    return max((int(n) + 1 for n in numbers if n.isdecimal()), default=0)

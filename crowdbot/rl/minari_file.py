"""Write runs as a Minari data set."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from crowdbot.core.registry.registry import Registry
from crowdbot.errors import InputError, MissingLibraryError
from crowdbot.rl.libraries import found, gym
from crowdbot.rl.offline import RunEpisode, run_episode

#: Names of data sets; the variable that names the folder of Minari's data sets.
_NAME, _ROOT = re.compile(r"[-_\w]+-v\d+"), "MINARI_DATASETS_PATH"


def write_minari(runs: Sequence[Path], out: Path, registry: Registry) -> None:
    """Write run directories as a data set, an episode each, in their order.

    Args:
        out: a folder that does not exist; ``minari.load_dataset`` finds its name in the folder
            above, which ``MINARI_DATASETS_PATH`` names.

    Raises:
        MissingLibraryError: Minari or one of its libraries is not installed.
        InputError: a run cannot be an episode, or episodes observe differently.
    """
    minari = found("minari")
    if minari is None or gym is None or found("pyarrow") is None:
        raise MissingLibraryError("Minari is not installed; install it with: "
                                  "pip install minari gymnasium pyarrow")  # fmt: skip
    if not _NAME.fullmatch(out.name):
        raise InputError(f"{out.name}: the name of a data set is like 'runs-v0', with a version")
    episodes = [run_episode(run, registry) for run in runs]
    first = episodes[0]
    for run, episode in zip(runs, episodes, strict=True):
        if episode.low.shape != first.low.shape:
            raise InputError(f"{run}: observes {len(episode.low)} numbers, not {len(first.low)}")
    with _root(out.parent), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it asks for authors and links, which runs do not have
        minari.create_dataset_from_buffers(
            dataset_id=out.name,
            buffer=[_buffer(n, episode) for n, episode in enumerate(episodes)],
            observation_space=gym.spaces.Box(first.low, first.high),
            action_space=gym.spaces.Box(-1.0, 1.0, (2,)),
            algorithm_name="planners of crowdbot",
            description="Runs of crowdbot: tracks of people, commands, reward 'progress'.",
            data_format="arrow",
        )


def _buffer(number: int, episode: RunEpisode) -> Any:
    """Return an episode as an `EpisodeBuffer` of Minari."""
    last = len(episode.rewards) - 1
    return found("minari.data_collector").EpisodeBuffer(
        id=number,
        observations=list(episode.observations),
        actions=list(episode.actions),
        rewards=episode.rewards.tolist(),
        terminations=[n == last and episode.arrived for n in range(last + 1)],
        truncations=[n == last and not episode.arrived for n in range(last + 1)],
        options={"scenario": episode.scenario},
    )


@contextmanager
def _root(folder: Path) -> Iterator[None]:
    """Set the root folder of Minari's data sets while the context is open."""
    before = os.environ.get(_ROOT)
    os.environ[_ROOT] = str(folder.resolve())
    try:
        yield
    finally:
        if before is None:
            del os.environ[_ROOT]
        else:
            os.environ[_ROOT] = before

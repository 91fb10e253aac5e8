"""Libraries of the extra ``rl``; without them, creating an environment fails with a message."""

from __future__ import annotations

import importlib
from typing import Any

from crowdbot.errors import MissingLibraryError


def found(name: str) -> Any:
    """Return a module; None if it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


def missing(library: str, how: str) -> Any:
    """Return a base class whose objects cannot be created, since a library is missing."""

    class Missing:
        def __new__(cls, *args: object, **kwargs: object) -> Missing:
            del args, kwargs
            raise MissingLibraryError(f"{library} is not installed; {how}")

        def __class_getitem__(cls, item: object) -> Any:
            return cls

    return Missing


_EXTRA = "install it with: pip install 'crowdbot[rl]'"

gym = found("gymnasium")
pettingzoo = found("pettingzoo")


Env: Any = gym.Env if gym else missing("Gymnasium", _EXTRA)
VectorEnv: Any = gym.vector.VectorEnv if gym else missing("Gymnasium", _EXTRA)
Wrapper: Any = gym.Wrapper if gym else missing("Gymnasium", _EXTRA)
ParallelEnv: Any = pettingzoo.ParallelEnv if pettingzoo else missing("PettingZoo", _EXTRA)

#: Names of `gymnasium.vector.AutoresetMode`.
NEXT_STEP, SAME_STEP, DISABLED = "NextStep", "SameStep", "Disabled"

"""Deprecated hooks, one for each category, in place of ``crowdbot_components``; kept until 1.0."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from crowdbot.hookspecs import hookspec
from crowdbot.old_names import OldNameWarning

#: Old hook -> category of what it returns.
OLD_HOOKS = {
    "crowdbot_environments": "environment",
    "crowdbot_robots": "robot",
    "crowdbot_sensors": "sensor",
    "crowdbot_noise_generators": "noise",
    "crowdbot_planners": "planner",
    "crowdbot_crowd_policies": "crowd policy",
    "crowdbot_cost_functions": "cost function",
    "crowdbot_metrics": "metric",
}


def old_hookspecs() -> ModuleType:
    """Return pluggy's specs of the deprecated hooks; implementing one gives a warning."""
    module = ModuleType("old_hooks")
    for name, category in OLD_HOOKS.items():
        setattr(module, name, _spec(name, category))
    return module


def _spec(name: str, category: str) -> Any:
    def spec() -> None: ...

    text = (
        f"{name} is an old hook that ends with crowdbot 1.0: "
        f"let crowdbot_components return {{'{category}': [...]}}"
    )
    return hookspec(spec, warn_on_impl=OldNameWarning(text))

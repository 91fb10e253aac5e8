"""crowdbot's own components, registered through the entry point ``builtin``.

They have the same rights as those of any plugin.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from crowdbot.plugin import Component, hookimpl

CROWDBOT_API = 1


@hookimpl
def crowdbot_components() -> Mapping[str, Sequence[Component[Any] | str]]:
    """Return the components in the modules of the folders of this package."""
    return {
        "environment": ["crowdbot.plugins.environments.*"],
        "robot": ["crowdbot.plugins.robots.*"],
        "sensor": ["crowdbot.plugins.sensors.*"],
        "noise": ["crowdbot.plugins.noise.*"],
        "planner": ["crowdbot.plugins.planners.*"],
        "crowd policy": ["crowdbot.plugins.crowd.policies.*"],
        "cost function": ["crowdbot.plugins.crowd.cost_functions.*"],
        "metric": ["crowdbot.plugins.metrics.*"],
        "observation": ["crowdbot.plugins.observations.*"],
        "reward": ["crowdbot.plugins.rewards.*"],
    }


@hookimpl
def crowdbot_scenario_dirs() -> Sequence[Traversable]:
    """Return the suites: beside the package in a checkout, inside it in a wheel."""
    package = Path(__file__).parent.parent
    installed = package / "scenario_specs"
    return [installed if installed.is_dir() else package.parent / "scenario_specs"]

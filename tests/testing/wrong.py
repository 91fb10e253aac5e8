"""Components that are wrong on purpose, and what a check says about them."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable
from types import ModuleType
from typing import Any, ClassVar, Literal

import pytest

from crowdbot.core.registry.registry import Registry, discover
from crowdbot.plugin import (
    Component,
    CostFunctionSpec,
    CrowdPolicySpec,
    EnvironmentSpec,
    NoiseSpec,
    PlannerSpec,
    RobotSpec,
    SensorSpec,
)

BUILT_IN: Registry = discover(allow=(), entry_points=False)
_NUMBERS = itertools.count()


class WrongEnvironment(EnvironmentSpec):
    """A place."""

    kind: Literal["acme.x"] = "acme.x"


class WrongRobot(RobotSpec):
    """A robot."""

    kind: Literal["acme.x"] = "acme.x"


class WrongSensor(SensorSpec):
    """A sensor."""

    kind: Literal["acme.x"] = "acme.x"


class WrongNoise(NoiseSpec):
    """A noise generator."""

    kind: Literal["acme.x"] = "acme.x"


class WrongPlanner(PlannerSpec):
    """A planner."""

    kind: Literal["acme.x"] = "acme.x"
    needs: ClassVar[tuple[str, ...]] = ()


class WrongPolicy(CrowdPolicySpec):
    """A crowd policy."""

    kind: Literal["acme.x"] = "acme.x"


class WrongCost(CostFunctionSpec):
    """A cost function."""

    kind: Literal["acme.x"] = "acme.x"


def made(spec: type[Any], build: Callable[..., Any], **words: Any) -> Component[Any]:
    """A component whose build function is this one."""
    module: Any = ModuleType(f"acme_wrong_{next(_NUMBERS)}")
    module.build = build
    sys.modules[module.__name__] = module
    return Component(spec=spec, build=f"{module.__name__}:build", summary="wrong", **words)


def assert_fails(check: Callable[..., None], component: Component[Any], because: str) -> None:
    """The check fails, and says why."""
    with pytest.raises(AssertionError, match=because):
        check(component, BUILT_IN)

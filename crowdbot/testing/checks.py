"""The list of checks per component. Needs neither pytest nor hypothesis."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import ModuleType
from typing import Any
from unittest import SkipTest

import crowdbot.testing.all_kinds as all_kinds
import crowdbot.testing.card as card
import crowdbot.testing.commanded_motion as commanded_motion
import crowdbot.testing.cost_function as cost_function
import crowdbot.testing.crowd_policy as crowd_policy
import crowdbot.testing.environment as environment
import crowdbot.testing.learning as learning
import crowdbot.testing.metric as metric
import crowdbot.testing.noise as noise
import crowdbot.testing.planner as planner
import crowdbot.testing.robot as robot
import crowdbot.testing.sensor as sensor
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.spec.component import Component

Check = Callable[..., None]


def checks_in(module: ModuleType) -> tuple[Check, ...]:
    """Return the checks of a module, in its order: its functions whose names begin so."""
    found = vars(module).items()
    return tuple(
        f for name, f in found if name.startswith("check_") and f.__module__ == module.__name__
    )


#: Checks of every component.
OF_ALL_KINDS = checks_in(all_kinds)
#: Category -> its own checks.
BY_CATEGORY: Mapping[str, tuple[Check, ...]] = {
    "cost function": checks_in(cost_function),
    "crowd policy": checks_in(crowd_policy),
    "environment": checks_in(environment),
    "metric": (*checks_in(metric), *checks_in(card)),
    "noise": checks_in(noise),
    "observation": learning.OBSERVATION_CHECKS,
    "planner": checks_in(planner),
    "reward": learning.REWARD_CHECKS,
    "robot": (*checks_in(robot), *checks_in(commanded_motion)),
    "sensor": checks_in(sensor),
}

#: Category -> check of the built object, which must pass before the others.
_FIRST: Mapping[str, Check] = {
    "cost function": cost_function.check_signatures,
    "environment": environment.check_parts,
    "robot": robot.check_model,
    "sensor": sensor.check_info,
}
_BY_ITSELF = (robot.check_mass_agrees,)


def checks_of(component: Component[Any]) -> tuple[Check, ...]:
    """Return all checks for a component, as functions of the component."""
    return (*OF_ALL_KINDS, *BY_CATEGORY.get(component.category, ()))


def checks_for(
    component: Component[Any], registry: Registry | None = None
) -> list[tuple[str, Callable[[], None]]]:
    """Return names and checks of a component, ready to be called.

    A check returns, or raises `AssertionError` with the reason, `unittest.SkipTest` if an optional
    library is missing, or the component's own error. A check that the component declares as an
    exception passes if it fails.

    Args:
        registry: the other components; default: the installed ones.
    """
    checks = []
    for check in checks_of(component):
        bound = bind(check, component, registry)
        reason = component.exceptions.get(check.__name__)
        checks.append((check.__name__, bound if reason is None else partial(_fails, bound, reason)))
    return checks


def bind(check: Check, component: Component[Any], registry: Registry | None) -> Callable[[], None]:
    """Return a check bound to one component, and to the registry if the check needs it.

    Checks of computations are skipped while the spec or the build reference is wrong: they would
    all fail for that reason, with misleading advice.
    """
    given = (component, registry) if _wants_registry(check) else (component,)
    bound = partial(check, *given)
    before = _before(check, component.category)
    return partial(_after, [bind(b, component, registry) for b in before], before, bound)


def _wants_registry(check: Check) -> bool:
    return "registry" in inspect.signature(check).parameters


def _before(check: Check, category: str) -> list[Check]:
    """Return the checks that must pass before this one makes sense."""
    if check in OF_ALL_KINDS:
        return []
    found = [all_kinds.check_examples_validate, all_kinds.check_build_resolves]
    first = _FIRST.get(category)
    if first is not None and check is not first and check not in _BY_ITSELF:
        found.append(first)
    return found


def _after(
    before: Sequence[Callable[[], None]], names: Sequence[Check], check: Callable[[], None]
) -> None:
    for first, name in zip(before, names, strict=True):
        try:
            first()
        except SkipTest:
            raise
        except Exception as error:
            raise SkipTest(f"{name.__name__} comes first") from error
    check()


def _fails(check: Callable[[], None], reason: str) -> None:
    """Pass if the check fails, as the component declares."""
    try:
        check()
    except SkipTest:
        raise
    except Exception:
        return
    raise AssertionError(f"passes, but Component(exceptions=...) says that it fails: {reason}")

"""Chooses the checks of a component by its category, and makes tests of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

import pytest

from crowdbot.core.component import Component
from crowdbot.testing import all_kinds, metric

Check = Callable[[Component[Any]], None]

#: Category -> its own checks. Those of `all_kinds` hold for every category.
BY_CATEGORY: Mapping[str, tuple[Check, ...]] = {"metric": metric.CHECKS}


def checks_of(component: Component[Any]) -> tuple[Check, ...]:
    """All checks that a component has to pass."""
    return (*all_kinds.CHECKS, *BY_CATEGORY.get(component.category, ()))


def parametrize_with_checks(
    components: Iterable[Component[Any]],
    *,
    expected_failures: Mapping[str, str] | None = None,
) -> pytest.MarkDecorator:
    """Decorator of a test with one argument ``check``: one test a component and check.

    Args:
        components: what to check; test ids are ``kind-check_name``.
        expected_failures: check name, or whole test id -> reason. Such a test must fail.

    Raises:
        ValueError: an expected failure names no test, or no component was given.
    """
    reasons, used = dict(expected_failures or {}), set()
    params = []
    for component in components:
        for check in checks_of(component):
            name = check.__name__
            test_id = f"{component.kind}-{name}"
            known = [key for key in (test_id, name) if key in reasons]
            used.update(known)
            marks = [pytest.mark.xfail(reason=reasons[k], strict=True) for k in known[:1]]
            params.append(pytest.param(partial(check, component), id=test_id, marks=marks))
    if not params:
        raise ValueError("parametrize_with_checks: no component was given")
    if unknown := sorted(set(reasons) - used):
        raise ValueError(f"expected_failures: no such check: {', '.join(unknown)}")
    return pytest.mark.parametrize("check", params)

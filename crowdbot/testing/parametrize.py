"""Create pytest tests from the checks of components."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from crowdbot.dsl.spec.component import Component
from crowdbot.testing.checks import bind, checks_of

if TYPE_CHECKING:
    import pytest


def parametrize_with_checks(
    components: Iterable[Component[Any]],
    *,
    expected_failures: Mapping[str, str] | None = None,
) -> pytest.MarkDecorator:
    """Parametrise a test with one argument ``check``: one test per component and check.

    Args:
        components: the components to check; test ids are ``kind-check_name``.
        expected_failures: check name, or whole test id -> reason. Such a test must fail. Exceptions
            declared by a component (``Component(exceptions=...)``) are added.

    Raises:
        ValueError: an expected failure names no test, or no component was given.
    """
    import pytest

    reasons, used = dict(expected_failures or {}), set()
    params = []
    for component in components:
        _assert_known(component)
        for check in checks_of(component):
            name = check.__name__
            test_id = f"{component.kind}-{name}"
            known = [key for key in (test_id, name) if key in reasons]
            used.update(known)
            why = [reasons[k] for k in known] + [
                r for n, r in component.exceptions.items() if n == name
            ]
            marks = [pytest.mark.xfail(reason=reason, strict=True) for reason in why[:1]]
            params.append(pytest.param(bind(check, component, None), id=test_id, marks=marks))
    if not params:
        raise ValueError("parametrize_with_checks: no component was given")
    if unknown := sorted(set(reasons) - used):
        raise ValueError(f"expected_failures: no such check: {', '.join(unknown)}")
    return pytest.mark.parametrize("check", params)


def _assert_known(component: Component[Any]) -> None:
    names = {check.__name__ for check in checks_of(component)}
    if unknown := sorted(set(component.exceptions) - names):
        raise ValueError(f"{component.kind}: exceptions: no such check: {', '.join(unknown)}")

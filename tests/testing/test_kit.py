"""The kit itself: every check fails for a component that breaks what it checks."""
# ruff: noqa: ARG001, ARG005 - the signature of a metric is fixed

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Sequence
from types import ModuleType
from typing import Any, Literal
from unittest import SkipTest

import numpy as np
import pytest
from pydantic import ConfigDict, Field

from crowdbot.dsl.spec.component_specs import CATEGORIES
from crowdbot.errors import PluginError
from crowdbot.plugin import (
    Component,
    MetricComponent,
    MetricSpec,
    References,
    Score,
    ScoreFactory,
    SensorSpec,
    Trajectories,
    declare_metric,
)
from crowdbot.testing import all_kinds, card, checks_of, metric, parametrize_with_checks
from crowdbot.testing.checks import BY_CATEGORY, OF_ALL_KINDS, checks_for, checks_in
from tests.paths import ROOT
from tests.testing.wrong import BUILT_IN

DOCS = ROOT / "docs/reference"


class GoodSpec(MetricSpec):
    """Length of the record."""

    kind: Literal["acme.x"] = "acme.x"


class BareSpec(MetricSpec):
    """Fields without words."""

    kind: Literal["acme.x"] = "acme.x"
    gap: float = Field(default=1.0, description="Some gap.")


class LooseSpec(MetricSpec):
    """Takes anything."""

    model_config = ConfigDict(extra="ignore")
    kind: Literal["acme.x"] = "acme.x"


class NamelessSpec(MetricSpec):
    """No name of a plugin."""

    kind: Literal["X"] = "X"


class ListeningSpec(SensorSpec):
    """Of a sensor."""

    kind: Literal["acme.x"] = "acme.x"


def component(**changes: Any) -> MetricComponent[Any]:
    usual = {"build": "acme_x:build", "card": "# acme.x\n", "symbol": "x", "category": "c"}
    usual |= {"unit": "m", "better": "none"}
    return declare_metric(**{"spec": GoodSpec, **usual, **changes})


@pytest.fixture
def build(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Sets what the metric computes: a function of run and references."""
    module: Any = ModuleType("acme_x")
    monkeypatch.setitem(sys.modules, "acme_x", module)

    def use(value: Any) -> None:
        class Metric:
            def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
                found = value(run, refs)
                factory = ScoreFactory(component())
                return [found] if isinstance(found, Score) else [factory.ok("corrected", found)]

        module.build = lambda spec: Metric()

    return use


@pytest.mark.slow
@pytest.mark.parametrize(
    ("check", "changes"),
    [
        (all_kinds.check_kind_is_a_name, {"spec": NamelessSpec}),
        (all_kinds.check_summary_is_a_line, {"summary": "two\nlines"}),
        (all_kinds.check_examples_validate, {"examples": ()}),
        (all_kinds.check_fields_are_described, {"spec": BareSpec}),
        (all_kinds.check_unknown_field_is_refused, {"spec": LooseSpec}),
        (all_kinds.check_spec_is_light, {}),  # this very module imports numpy
        (all_kinds.check_entry_point_yields_it, {}),
        (metric.check_declaration, {"card": "acme_x:cards/x.md"}),
        (metric.check_declaration, {"spec": ListeningSpec}),
        (card.check_card_says_what_the_scores_say, {"card": "# acme.y\n\nNothing."}),
        (card.check_card_examples_run, {"card": "# acme.x\n\n## Worked example\n\nNone.\n"}),
    ],
)
def test_words_that_break_a_check(check: Any, changes: dict[str, Any]) -> None:
    with pytest.raises(AssertionError):
        check(component(**changes))


def _grows(run: Trajectories, refs: References) -> float:
    _grows.calls += 1  # type: ignore[attr-defined]
    return float(_grows.calls)  # type: ignore[attr-defined]


_grows.calls = 0  # type: ignore[attr-defined]


def _x(run: Trajectories) -> float:
    return 0.0 if run.robot is None else float(np.nan_to_num(run.robot.x).max())


def _people(run: Trajectories) -> int:
    return 0 if run.agents is None else len(run.agents.id)


def _mutates(run: Trajectories, refs: References) -> float:
    run.t[0] -= 1.0
    return 0.0


@pytest.mark.parametrize(
    ("check", "value", "declared"),
    [
        (metric.check_pure, _grows, {}),
        (metric.check_symmetries, lambda run, refs: _x(run), {}),
        (metric.check_symmetries, lambda run, refs: float(run.t[0]), {}),
        (metric.check_self_value, lambda run, refs: 2.0, {"self_value": 1.0}),
        (metric.check_refinement, lambda run, refs: len(run.t), {}),
        (metric.check_refinement, lambda run, refs: 1.0, {"refinement": "double"}),
        (metric.check_more_people, lambda run, refs: -_people(run), {"more_people": "up"}),
        (metric.check_more_people, lambda run, refs: _people(run), {"more_people": "down"}),
        (metric.check_masses, lambda run, refs: run.robot.mass if run.robot else 0.0, {}),
        (
            metric.check_teleports_add_nothing,
            lambda run, refs: np.nansum(np.abs(np.diff(run.agents.x, axis=0))),
            {},
        ),
        (metric.check_velocities_left_out, lambda run, refs: len(np.unique(run.robot.v)), {}),
        (metric.check_rounding, lambda run, refs: float(_x(run) > 6.25), {"integer": True}),
        (metric.check_scores_are_well_formed, lambda run, refs: -1.0, {"minimum": 0.0}),
        (metric.check_scores_are_well_formed, lambda run, refs: 0.5, {"integer": True}),
        (
            metric.check_scores_are_well_formed,
            lambda run, refs: ScoreFactory(component(unit="s")).ok("corrected", 1.0),
            {},
        ),
        (metric.check_degenerate_runs, lambda run, refs: float(run.robot.mass), {}),
    ],
)
def test_deeds_that_break_a_check(
    check: Any, value: Any, declared: dict[str, Any], build: Any
) -> None:
    build(value)
    with pytest.raises(AssertionError):
        check(component(**declared))


def test_a_metric_cannot_change_what_it_gets(build: Any) -> None:
    build(_mutates)
    with pytest.raises(PluginError, match="read-only"):
        metric.check_pure(component())


def test_a_metric_that_is_declared_as_any_component() -> None:
    plain = Component(spec=GoodSpec, build="acme_x:build", summary="x", card="# acme.x\n")
    with pytest.raises(AssertionError, match=r"'acme\.x' is not a MetricComponent"):
        metric.check_declaration(plain)


def test_variants_that_were_not_declared(build: Any) -> None:
    build(lambda run, refs: 1.0)
    with pytest.raises(
        PluginError, match=r"'acme.x' \(checked\): returned the variants corrected; declared are a"
    ):
        metric.check_scores_are_well_formed(component(variants=["a"]))


def test_a_sound_metric_passes(build: Any) -> None:
    build(lambda run, refs: float(run.t[-1] - run.t[0]))
    for check in checks_in(metric):
        if "card" not in check.__name__:
            check(component())


def test_a_build_that_is_not_there() -> None:
    with pytest.raises(Exception, match="not found"):
        all_kinds.check_build_resolves(component(build="acme_x_nowhere:build"))


def test_expected_failures() -> None:
    mark = parametrize_with_checks(
        [component()],
        expected_failures={"check_pure": "why", "acme.x-check_declaration": "because"},
    )
    tests = {str(p.id): p for p in mark.args[1]}
    assert set(tests) == {f"acme.x-{c.__name__}" for c in checks_of(component())}
    assert [m.kwargs["reason"] for m in tests["acme.x-check_pure"].marks] == ["why"]
    assert [m.kwargs["reason"] for m in tests["acme.x-check_declaration"].marks] == ["because"]
    with pytest.raises(ValueError, match="check_nothing"):
        parametrize_with_checks([component()], expected_failures={"check_nothing": ""})
    with pytest.raises(ValueError, match="no component"):
        parametrize_with_checks([])


def test_checks_say_what_to_do_and_the_page_lists_them() -> None:
    page = (DOCS / "conformance.md").read_text(encoding="utf-8")
    groups = [OF_ALL_KINDS, *BY_CATEGORY.values()]
    for check in (c for group in groups for c in group):
        text = inspect.getdoc(check)
        assert text is not None
        what, _, then = text.partition("If this fails, ")
        assert then.strip().endswith("."), check.__name__
        assert f"| `{check.__name__}` | {' '.join(what.split())} |" in page
    rows = re.findall(r"^\| `(check_\w+)` \|", page, re.MULTILINE)
    assert rows == [c.__name__ for group in _as_listed() for c in group]


def _as_listed() -> list[tuple[Any, ...]]:
    """The groups of checks in the order of the page."""
    order = ("environment", "robot", "sensor", "noise", "planner", "crowd policy", "cost function",
             "metric", "observation", "reward")  # fmt: skip
    assert set(order) == set(BY_CATEGORY) == {c.category for c in CATEGORIES}
    return [OF_ALL_KINDS, *(BY_CATEGORY[c] for c in order)]


@pytest.mark.slow
def test_what_cannot_be_built_fails_once() -> None:
    """The other checks would fail for its reason, with advice that does not help."""
    broken = component(build="acme_x_nowhere:build")
    found: dict[str, str] = {}
    for name, check in checks_for(broken, BUILT_IN):
        try:
            check()
        except SkipTest as error:
            found[name] = str(error)
        except Exception as error:
            found[name] = f"failed: {error}"
    assert "not found" in found.pop("check_build_resolves")
    for name in ("check_entry_point_yields_it", "check_spec_is_light"):
        found.pop(name)  # this file is not a plugin
    assert len(found) >= 10
    assert set(found.values()) == {"check_build_resolves comes first"}


@pytest.mark.parametrize("given", ["", "spec, costs", "*, spec"])
def test_a_build_function_that_takes_something_else(
    given: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    module = ModuleType("acme_x_signature")
    exec(f"def build({given}): pass", vars(module))
    monkeypatch.setitem(sys.modules, "acme_x_signature", module)
    with pytest.raises(AssertionError, match=r"cannot be called as build\(spec\)"):
        all_kinds.check_build_resolves(component(build="acme_x_signature:build"))

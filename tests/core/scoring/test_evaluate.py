"""score(): which metrics are asked, with which parameters, and what happens when one fails."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import FrozenInstanceError
from types import ModuleType
from typing import Any, Literal

import numpy as np
import pytest
from pydantic import Field

from crowdbot.core.registry.registry import Plugin, Registry, assemble
from crowdbot.core.scoring.evaluate import Scores, score
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score
from crowdbot.errors import InputError, PluginError, UnknownNameError
from crowdbot.plugin import Component, MetricSpec, PositiveLength, References


class HeightSpec(MetricSpec):
    """A third party's metric."""

    kind: Literal["acme.height"] = "acme.height"
    scale: PositiveLength = Field(default=1.0)


class WidthSpec(MetricSpec):
    """Another one."""

    kind: Literal["acme.width"] = "acme.width"


def result(metric: str, variant: str, value: float) -> Score:
    return Score(
        metric=metric,
        symbol="h",
        category="shape",
        variant=variant,
        unit="m",
        better="none",
        value=value,
    )


class Measured:
    """Height of the path; knows what it was given."""

    seen: References | None = None

    def __init__(self, spec: MetricSpec, scale: float = 1.0) -> None:
        self.kind, self.scale = spec.kind, scale

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        Measured.seen = refs
        assert run.robot is not None
        height = float(np.ptp(run.robot.y)) * self.scale
        return [result(self.kind, "literal", height), result(self.kind, "corrected", 2 * height)]


@pytest.fixture
def build(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """The module that the components name; a test may replace its functions."""
    module: Any = ModuleType("acme_build")
    module.height = lambda spec: Measured(spec, spec.scale)
    module.width = Measured
    monkeypatch.setitem(sys.modules, "acme_build", module)
    yield module
    Measured.seen = None


@pytest.fixture
def registry(build: ModuleType) -> Registry:
    del build
    components = tuple(
        Component(spec=spec, build=f"acme_build:{name}", summary=name)
        for name, spec in (("width", WidthSpec), ("height", HeightSpec))
    )
    return assemble([Plugin(name="acme", distribution="acme 2.1", components=components)])


def run_of(height: float = 3.0, goal_time: float | None = None) -> Trajectories:
    t = np.linspace(0, 1, 5)
    still: dict[str, Any] = {f"robot_{n}": 0 * t for n in ("x", "theta", "v", "w")}
    return Trajectories.from_arrays(
        t=t,
        **still,
        robot_y=t * height,
        robot_radius=0.2,
        robot_mass=6.0,
        robot_goal_time=goal_time,
    )


def names(scores: Scores) -> list[tuple[str, str]]:
    return [(s.metric, s.variant) for s in scores]


def test_everything_by_name(registry: Registry) -> None:
    found = score(registry, run_of())
    both = ("literal", "corrected")
    assert names(found) == [(m, v) for m in ("acme.height", "acme.width") for v in both]
    assert [s.value for s in found] == [3, 6, 3, 6]


def test_references_reach_the_metric(registry: Registry) -> None:
    alone, crowd = run_of(1.0), run_of(2.0)
    score(registry, run_of(), alone, crowd)
    assert Measured.seen == References(robot_alone=alone, crowd_alone=crowd)


@pytest.mark.parametrize(
    ("metrics", "kinds"),
    [
        ("*", {"acme.height", "acme.width"}),
        ("acme.h*", {"acme.height"}),
        (["*width", "acme.height"], {"acme.height", "acme.width"}),
        (["acme.width", "*width"], {"acme.width"}),
    ],
)
def test_globs(registry: Registry, metrics: Any, kinds: set[str]) -> None:
    found = score(registry, run_of(), metrics=metrics)
    assert {s.metric for s in found} == kinds
    assert len(found) == 2 * len(kinds)


@pytest.mark.parametrize("metrics", ["acme.heigt", ["acme.width", "acme.heigt"]])
def test_a_glob_without_match(registry: Registry, metrics: Any) -> None:
    with pytest.raises(UnknownNameError, match=r"'acme\.heigt'; did you mean 'acme\.height'"):
        score(registry, run_of(), metrics=metrics)


def test_variants(registry: Registry) -> None:
    assert {s.variant for s in score(registry, run_of(), variants="literal")} == {"literal"}
    assert len(score(registry, run_of(), variants=["literal", "corrected"])) == 4
    with pytest.raises(UnknownNameError, match="variant 'correct'; did you mean 'corrected'"):
        score(registry, run_of(), variants="correct")


def test_parameters(registry: Registry) -> None:
    found = score(registry, run_of(), parameters={"acme.height": {"scale": "50 cm"}})
    assert found.find("acme.height", "literal").value == 1.5
    assert found.find("acme.width", "literal").value == 3


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"acme.height": {"scale": -1.0}}, r"'acme\.height', parameter 'scale': .*greater than 0"),
        ({"acme.height": {"scale": "1 s"}}, "not a quantity of length"),
        ({"acme.height": {"scael": 1.0}}, "'scael': unknown; did you mean 'scale'"),
        ({"acme.height": {"scale": float("nan")}}, "'scale'"),
        ({"acme.hight": {"scale": 1.0}}, "unknown metric 'acme.hight'; did you mean"),
    ],
)
def test_wrong_parameters(registry: Registry, parameters: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        score(registry, run_of(), metrics="acme.width", parameters=parameters)


def _raises(spec: MetricSpec) -> Any:
    raise ZeroDivisionError(f"oh {spec.kind}")


class _Returning:
    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def score(self, run: Trajectories, refs: References) -> Any:
        del run, refs
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


@pytest.mark.parametrize(
    ("broken", "message"),
    [
        (_raises, "ZeroDivisionError: oh acme"),
        (lambda _: _Returning(ValueError("bad")), "ValueError: bad"),
        (lambda _: _Returning(InputError("odd")), "InputError: odd"),
        (lambda _: _Returning(None), "returned None; a list of scores"),
        (lambda _: _Returning([1.0]), r"returned 1\.0 instead"),
        (lambda _: _Returning([result("risk", "literal", 1.0)]), "instead of its own"),
        (lambda _: _Returning([result("acme.width", "a", 1.0)] * 2), "a variant twice: a, a"),
        (lambda _: [result("acme.width", "a", float("nan"))], "nan must not escape"),
    ],
)
def test_a_metric_that_fails_is_named(
    registry: Registry, build: ModuleType, broken: Callable[[MetricSpec], Any], message: str
) -> None:
    build.width = broken  # type: ignore[attr-defined]
    with pytest.raises(PluginError, match=rf"'acme\.width' \(acme 2\.1\): .*{message}"):
        score(registry, run_of())
    assert len(score(registry, run_of(), metrics="acme.height")) == 2


def test_a_build_function_that_is_missing(registry: Registry, build: ModuleType) -> None:
    del build.width
    with pytest.raises(PluginError, match="acme_build:width' not found"):
        score(registry, run_of())


def test_an_impossible_arrival_is_nobodys_failure_but_the_inputs(registry: Registry) -> None:
    bad = run_of(goal_time=-1.0)
    for runs in ((bad, None), (run_of(), bad)):
        with pytest.raises(InputError, match="goal_time"):
            score(registry, *runs)


def test_metrics_cannot_change_the_run(registry: Registry, build: ModuleType) -> None:
    class Vandal(Measured):
        def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
            assert run.robot is not None
            run.robot.y[0] = 9.0
            return super().score(run, refs)

    build.width = Vandal  # type: ignore[attr-defined]
    with pytest.raises(PluginError, match="read-only"):
        score(registry, run_of())


def test_scores_are_an_unchangeable_sequence(registry: Registry) -> None:
    found = score(registry, run_of())
    assert found[0] is found.find("acme.height", "literal")
    assert found.find("acme.height") is found[1]
    assert isinstance(found[1:3], Scores)
    assert list(found[1:3]) == [found[1], found[2]]
    assert (len(found), found[-1] in found) == (4, True)
    with pytest.raises(FrozenInstanceError):
        found.items = ()  # type: ignore[misc]
    assert found == score(registry, run_of())


def test_find_what_is_not_there(registry: Registry) -> None:
    found = score(registry, run_of())
    with pytest.raises(UnknownNameError, match=r"unknown metric 'acme\.widht'; did you mean"):
        found.find("acme.widht")
    with pytest.raises(UnknownNameError, match=r"variant of acme\.width 'literally'; did you mean"):
        found.find("acme.width", "literally")

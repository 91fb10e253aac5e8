"""Scores of one run: select metrics from a registry, build them, and run each."""

from __future__ import annotations

import fnmatch
import html
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING, Any, cast, overload

import numpy as np
from pydantic import ValidationError

from crowdbot.core.registry.registry import Registry
from crowdbot.core.scoring.metric import Metric, References
from crowdbot.core.scoring.scores_csv import COLUMNS
from crowdbot.core.support.arguments import expect, mapping_of, texts_of
from crowdbot.core.support.data_frame import to_arrow, to_pandas
from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.preprocess import truncate_at_arrival, with_velocities
from crowdbot.core.trajectories.questionnaires import Questionnaires
from crowdbot.core.trajectories.sizes import check_sizes
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import MetricSpec
from crowdbot.dsl.spec.metric_component import MetricComponent
from crowdbot.errors import (
    InputError,
    PluginError,
    UnknownNameError,
    did_you_mean,
    hidden_character,
    nearest,
)

if TYPE_CHECKING:
    import pandas as pd  # type: ignore[import-untyped]
    import pyarrow as pa  # type: ignore[import-untyped]

#: Metric -> field -> value.
MetricParameters = Mapping[str, Mapping[str, object]]


@dataclass(frozen=True, slots=True)
class Scores(Sequence[Score]):
    """The scores of one run, ordered by metric; read-only.

    Attributes:
        items: the scores.
        scenario, planner, seed: of the run, if known.
    """

    items: tuple[Score, ...] = ()
    scenario: str = ""
    planner: str = ""
    seed: int | None = None

    @overload
    def __getitem__(self, index: int) -> Score: ...
    @overload
    def __getitem__(self, index: slice) -> Scores: ...
    def __getitem__(self, index: int | slice) -> Score | Scores:
        """Return one score or a slice."""
        found = self.items[index]
        return replace(self, items=found) if isinstance(found, tuple) else found

    def __len__(self) -> int:
        """Return the number of scores."""
        return len(self.items)

    def __iter__(self) -> Iterator[Score]:
        """Iterate in order."""
        return iter(self.items)

    def find(self, metric: str, variant: str = "corrected") -> Score:
        """Return the score of one metric and variant.

        Raises:
            UnknownNameError: there is none.
            InputError: a name is not a string.
        """
        expect("metric", metric, str)
        expect("variant", variant, str)
        of_metric = {s.variant: s for s in self.items if s.metric == metric}
        if not of_metric:
            raise UnknownNameError("metric", metric, {s.metric for s in self.items})
        if variant not in of_metric:
            raise UnknownNameError(f"variant of {metric}", variant, of_metric)
        return of_metric[variant]

    def to_pandas(self) -> pd.DataFrame:
        """Return one row per score: scenario, planner, seed, metric, variant, value, and so on.

        Missing values are NaN; ``status`` and ``reason`` say why.

        Raises:
            InputError: pandas is not installed.
        """
        return to_pandas(self._rows(), COLUMNS)

    def to_arrow(self) -> pa.Table:
        """Return the scores as an Arrow table; missing values are null.

        Raises:
            InputError: pyarrow is not installed.
        """
        return to_arrow(self._rows(), COLUMNS)

    def _rows(self) -> list[dict[str, object]]:
        run = {"scenario": self.scenario, "planner": self.planner, "seed": self.seed}
        return [{**run, **{n: getattr(s, n) for n in COLUMNS[3:]}} for s in self.items]

    def _repr_html_(self) -> str:
        """Return an HTML table for notebooks."""
        heads = ("metric", "variant", "value", "unit", "better", "status")
        head = "".join(f"<th>{n}</th>" for n in heads)
        rows = "".join(f"<tr>{_cells(s)}</tr>" for s in self.items)
        return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def _cells(score: Score) -> str:
    value = "" if score.value is None else f"{score.value:.5g}"
    status = f"{score.status}: {score.reason}" if score.reason else score.status
    texts = (score.metric, score.variant, value, score.unit, score.better, status)
    return "".join(f"<td>{html.escape(text)}</td>" for text in texts)


def score(
    registry: Registry,
    crowded: Trajectories | None,
    robot_alone: Trajectories | None = None,
    crowd_alone: Trajectories | None = None,
    commands: Commands | None = None,
    commands_baseline: Commands | None = None,
    questionnaires: Questionnaires | Mapping[str, object] | None = None,
    metrics: str | Sequence[str] = "*",
    variants: str | Sequence[str] = "all",
    parameters: MetricParameters | None = None,
) -> Scores:
    """Score a run.

    Args:
        registry: registry with the metrics.
        crowded: the run; None if only commands or answers are known, then metrics that need a run
            are undefined. Velocities that were not recorded are derived, here and in the
            references.
        robot_alone: the same robot without people, if known.
        crowd_alone: the same people without robot, if known.
        commands: the user's and the final commands; default: those of the run's recording.
        commands_baseline: commands of a drive of the same user without shared control.
        questionnaires: answers; see `Questionnaires.from_mapping`.
        metrics: one or several globs over metric names; each must match. Experimental metrics are
            scored only if a glob matches no stable one, as their own names do. Metrics about the
            person of a task are scored only if the run has one, or if they are named.
        variants: ``all``, or the names of the variants to keep.
        parameters: metric -> field -> value; others keep their defaults.

    Raises:
        UnknownNameError: no metric or variant has a given name.
        InputError: there is nothing to score, a metric is retired, a parameter does not fit, an
            arrival time lies outside its run, or a number is too large.
        PluginError: a metric failed.
    """
    if crowded is None and commands is None and questionnaires is None:
        raise InputError("nothing to score: no run, no commands, no questionnaires")
    if questionnaires is not None and not isinstance(questionnaires, Questionnaires):
        questionnaires = Questionnaires.from_mapping(questionnaires)
    refs = References(
        robot_alone=None if robot_alone is None else with_velocities(robot_alone),
        crowd_alone=None if crowd_alone is None else with_velocities(crowd_alone),
        commands=commands,
        commands_baseline=commands_baseline,
        questionnaires=questionnaires,
    )
    if refs.commands is None and crowded is not None:
        refs = replace(refs, commands=crowded.commands)
    run = Trajectories(t=np.zeros(1)) if crowded is None else with_velocities(crowded)
    for trajectories in (run, robot_alone, crowd_alone):
        if trajectories is not None:
            truncate_at_arrival(trajectories)  # not the metric's fault
            check_sizes(trajectories)
    specs = _of_task(registry, metric_specs(registry, metrics, parameters or {}), run, metrics)
    scores = [s for spec in specs for s in _scores_of(registry, spec, run, refs)]
    return Scores(tuple(_of_variants(scores, variants)))


def metric_specs(
    registry: Registry, metrics: str | Sequence[str], parameters: MetricParameters
) -> list[MetricSpec]:
    """Return the specs of matching metrics, by name; all parameters are checked.

    Raises:
        UnknownNameError: a glob, or a metric with parameters, matches nothing installed.
        InputError: a parameter does not fit, or a metric that is named is retired.
    """
    known = registry.components("metric")
    for kind, fields in mapping_of("parameters", parameters, "metrics to fields").items():
        registry.find("metric", str(kind))
        mapping_of(f"parameters of {kind}", fields, "fields to values")
    chosen: set[str] = set()
    for glob in texts_of("metrics", metrics):
        chosen.update(_matching(known, glob, registry.why_absent(glob)))
    requested = chosen.union(parameters)
    specs = {
        kind: _spec(known[kind], parameters.get(kind, {})) for kind in known if kind in requested
    }
    return [specs[kind] for kind in known if kind in chosen]


def _of_task(
    registry: Registry, specs: Sequence[MetricSpec], run: Trajectories, metrics: str | Sequence[str]
) -> list[MetricSpec]:
    """Leave out metrics about a task's person that are not named, if the run has no person."""
    if run.person is not None:
        return list(specs)
    known = registry.components("metric")
    about = {name for name, metric in known.items() if getattr(metric, "about_person", False)}
    left_out = about.difference(texts_of("metrics", metrics))
    return [spec for spec in specs if spec.kind not in left_out]


def _matching(known: Mapping[str, Component[MetricSpec]], glob: str, absent: str) -> list[str]:
    """Return the stable metrics that match; if there are none, experimental ones."""
    if glob in known and known[glob].successor:
        raise InputError(f"metric '{glob}' is retired; use '{known[glob].successor}'")
    matching = [kind for kind in fnmatch.filter(known, glob) if not known[kind].successor]
    stable = [kind for kind in matching if not known[kind].experimental]
    if not matching:
        raise UnknownNameError("metric", glob, known, absent)
    return stable or matching


def _spec(component: Component[MetricSpec], fields: Mapping[str, Any]) -> MetricSpec:
    try:
        return component.spec.model_validate({"kind": component.kind, **fields})
    except ValidationError as error:
        lines = [_complaint(component, e["loc"], e["msg"]) for e in error.errors()]
        raise InputError("\n".join(lines)) from error


def _complaint(component: Component[MetricSpec], where: Sequence[int | str], problem: str) -> str:
    field, known = str(where[0]) if where else "", component.spec.model_fields
    if where and field not in known:
        problem = f"unknown{did_you_mean(nearest(field, known))}"
    return f"metric '{component.kind}', parameter '{'.'.join(map(str, where))}': {problem}"


def _checked_metric(metric: object) -> Metric:
    if not callable(getattr(metric, "score", None)):
        raise PluginError(f"build returned a {type(metric).__name__}, which has no score")
    return cast(Metric, metric)


#: Largest number of scores of one metric; a plugin may return an endless iterator.
_MOST_SCORES = 1000


def _scores_of(
    registry: Registry, spec: MetricSpec, run: Trajectories, refs: References
) -> list[Score]:
    """Run one metric; any error in it is its plugin's failure."""
    call = registry.plugin_call(spec, passes=PluginError)
    metric = registry.build(spec, _checked_metric, call=call)
    with call("score"):
        answer: object = metric.score(run, refs)
        if not isinstance(answer, Iterable):
            call.fail(f"score returned {answer!r}; a list of scores is wanted")
        scores = list(islice(answer, _MOST_SCORES))  # with more, the variants are wrong anyway
    with call("what it returned"):
        wrong = _what_is_wrong(scores, registry.find("metric", spec.kind))
    if wrong:
        call.fail(wrong)
    parameters = spec.model_dump(exclude={"kind"})
    return [replace(s, parameters=parameters) for s in scores]


def _what_is_wrong(scores: Sequence[object], component: Component[MetricSpec]) -> str:
    """Describe what is wrong with a metric's result; empty if nothing is."""
    for item in scores:
        if not isinstance(item, Score) or item.metric != component.kind:
            return f"returned {item!r} instead of its own scores"
        if hidden := hidden_character(str(item.reason), allowed=""):
            return f"returned a reason with the character {hidden}"
    names = [s.variant for s in scores if isinstance(s, Score)]
    if len(set(names)) != len(names):
        return f"returned a variant twice: {', '.join(names)}"
    if isinstance(component, MetricComponent) and set(names) != set(component.variants):
        declared = ", ".join(component.variants)
        return f"returned the variants {', '.join(names) or 'none'}; declared are {declared}"
    return ""


def _of_variants(scores: Sequence[Score], variants: str | Sequence[str]) -> list[Score]:
    if variants == "all":
        return list(scores)
    chosen = set(texts_of("variants", variants))
    known = {s.variant for s in scores}
    for name in sorted(chosen - known):
        raise UnknownNameError("variant", name, known)
    return [s for s in scores if s.variant in chosen]

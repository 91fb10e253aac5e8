"""Scores of one metric in a world, and its declared invariants."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from crowdbot.core.registry.registry import Plugin, assemble
from crowdbot.core.scoring.evaluate import score
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.person_task import PersonTask, TaskPerson
from crowdbot.core.types.score import Score
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.metric_component import MetricComponent
from crowdbot.dsl.spec.metric_invariants import MetricInvariants
from crowdbot.testing.worlds import World

Scored = Mapping[str, Score]


def with_signals(component: Component[Any], world: World) -> World:
    """Return a world whose run has the signals that a metric declares to read.

    They are smooth in time, the same at every sampling rate, and between 0 and 1. For a
    metric about the person of a task, the run gets the task to follow its first person.
    """
    if getattr(component, "about_person", False):
        world = replace(world, run=_with_person_task(world.run))
    names = getattr(component, "signals", ())
    if not names or not len(world.run.t):
        return world
    t = world.run.t
    signals = {
        name: np.column_stack([t, 0.5 + 0.5 * np.sin((k + 1.0) * (t - t[0]))])
        for k, name in enumerate(names)
    }
    return replace(world, run=replace(world.run, signals={**world.run.signals, **signals}))


def _with_person_task(run: Trajectories) -> Trajectories:
    """Return a run whose task is to follow one of its people; without people the same run."""
    if run.agents is None or not len(run.agents.id):
        return run
    task = PersonTask(kind="follow", distance=1.2, tolerance=1.0, angle=1.5, hold=20.0)
    one = run.agents.id[:1]
    return replace(run, person=TaskPerson(task=task, id=one, facing=np.zeros(1)))


def scores_of(component: Component[Any], world: World) -> dict[str, Score]:
    """Return variant -> score in a world."""
    plugin = Plugin(name="checked", distribution="checked", components=(component,))
    found = score(assemble([plugin]), **world.score_arguments(), metrics=component.kind)
    return {s.variant: s for s in found}


def metric_of(component: Component[Any]) -> MetricComponent[Any]:
    """Return the component; raise AssertionError if it is not a metric."""
    assert isinstance(component, MetricComponent), (
        f"'{component.kind}' is not a MetricComponent; use declare_metric"
    )
    return component


def invariants_of(component: Component[Any], variant: str) -> MetricInvariants:
    """Return the invariants of a variant's values."""
    return metric_of(component).variants[variant].invariants

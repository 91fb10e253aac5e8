"""Scores of one metric in a world, and what its words promise about them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from crowdbot.core.component import Component
from crowdbot.core.evaluate import score
from crowdbot.core.laws import Laws
from crowdbot.core.registry import Plugin, assemble
from crowdbot.core.score import Score
from crowdbot.core.score_label import MetricComponent
from crowdbot.testing.worlds import World

Scored = Mapping[str, Score]


def signalled(component: Component[Any], world: World) -> World:
    """A world in which the run has the signals that a metric says it reads.

    They are smooth in time, the same at every sampling rate, and between 0 and 1.
    """
    names = getattr(component, "signals", ())
    if not names or not len(world.run.t):
        return world
    t = world.run.t
    signals = {
        name: np.column_stack([t, 0.5 + 0.5 * np.sin((k + 1.0) * (t - t[0]))])
        for k, name in enumerate(names)
    }
    return replace(world, run=replace(world.run, signals={**world.run.signals, **signals}))


def scores_of(component: Component[Any], world: World) -> dict[str, Score]:
    """Variant -> score of a world."""
    plugin = Plugin(name="checked", distribution="checked", components=(component,))
    found = score(assemble([plugin]), **world.given(), metrics=component.kind)
    return {s.variant: s for s in found}


def laws_of(component: Component[Any], variant: str) -> Laws:
    """What a variant promises."""
    laws: Mapping[str, Laws] = getattr(component, "laws", {})
    return laws.get(variant, Laws())


def variants_of(component: Component[Any]) -> tuple[str, ...]:
    """Names of the variants, in order."""
    assert isinstance(component, MetricComponent), "no MetricComponent"
    return component.label.variants

"""The choice of a planner that calls another planner."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from crowdbot.core.planning.choice import PlannerChoice, label_of
from crowdbot.core.planning.description import described, sensors_of
from crowdbot.core.planning.half import HalfPlanner, PlannerWithHalf
from crowdbot.core.planning.registered import build_of_kind, is_privileged
from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import PlannerSpec


@dataclass(frozen=True, slots=True)
class BuildWithHalf:
    """Builds a planner in the simulator's process, and the called one in a separate process."""

    spec: PlannerSpec
    registry: Registry
    half: PlannerChoice

    def __call__(self) -> PlannerWithHalf:
        """Return a new planner.

        Raises:
            PlannerError: one of both cannot be made.
        """
        chosen = self.half
        half = HalfPlanner(
            chosen.build(),
            chosen.name,
            chosen.needs,
            origin=chosen.origin,
            privileged=chosen.privileged,
        )
        try:
            return PlannerWithHalf(build_of_kind(self.spec, self.registry, half), half)
        except BaseException:
            half.close()
            raise

    @property
    def died(self) -> str:
        """Return how the process of this half ended while it loaded; empty if it still runs."""
        return self.half.died


def choice_with_half(
    spec: PlannerSpec,
    component: Component[Any],
    registry: Registry,
    half: PlannerChoice,
    is_default: Callable[[Component[Any], PlannerSpec], bool],
) -> PlannerChoice:
    """Return the choice of a built-in planner that calls another one.

    Records name the process of the called planner: that one may be untrusted and contained, while
    the calling planner is trusted and runs in the simulator's process.

    Args:
        half: the planner that it uses.
        is_default: returns True if a spec has the defaults of its component only.
    """
    load_build(component, registry.plugin_call(spec))
    description = described(component.spec, registry.plugin_call(spec))
    own = sensors_of(description.needs, spec)
    both = None if own is None or half.needs is None else (*own, *half.needs)
    privileged = is_privileged(spec) or half.privileged
    as_given = is_default(component, spec)
    dump = {**spec.model_dump(mode="json"), spec.half: half.spec_dump}
    owner = registry.owner(component)
    return PlannerChoice(
        name=spec.kind,
        spec_dump=dump,
        build=BuildWithHalf(spec, registry, half),
        pinned=owner.pinned and half.pinned,
        origin=owner.distribution,
        needs=both,
        label=label_of(spec.kind, {} if as_given else dump, privileged),
        privileged=privileged,
        role=description.role if as_given else "candidate",
        in_process=half.in_process,
        memory=half.memory,
        repeatable=half.repeatable,
        patience=half.patience,
        files=half.all_files,
    )

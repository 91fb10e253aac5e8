"""The people that robots' tasks are about, in the blocks of a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from crowdbot.core.assistance.guide import PersonGuide, check_sees, task_with_person
from crowdbot.core.assistance.led import LedPeople
from crowdbot.core.assistance.target import Target, find_targets, led_people, lidars_of
from crowdbot.core.assistance.watch import PersonWatch, rows_in, seen_from
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotState
from crowdbot.dsl.scenario.seeds import stream_seed


def with_targets(builts: Mapping[str, BuiltRun], people: Realisation) -> dict[str, BuiltRun]:
    """Return runs whose tasks have the data of their persons; other runs are unchanged.

    Args:
        builts: from `build_runs`, of all robots of a scenario.
        people: of that scenario.

    Raises:
        InputError: a person is not there, or a robot cannot see its person.
    """
    first = next(iter(builts.values()))
    targets = find_targets(first.scenario, first.parts, people)
    for name, target in targets.items():
        check_sees(first.scenario.id, name, target, builts[name].infos)
    return {
        name: built
        if name not in targets
        else replace(built, target=targets[name], task=task_with_person(built.task, targets[name]))
        for name, built in builts.items()
    }


def guide_of(built: BuiltRun, seed: int) -> PersonGuide | None:
    """Return the guide that estimates a person's position for the planner; None without a person.

    Args:
        seed: of the run.
    """
    if built.target is None:
        return None
    own = stream_seed(seed, built.name, "task.person")
    return PersonGuide(built.task, built.target, lidars_of(built.infos), own)


def watch_of(built: BuiltRun) -> PersonWatch | None:
    """Return the watch that ends a task about a person; None for other tasks."""
    if built.target is None:
        return None
    return PersonWatch(built.task, built.target, footprint_of_model(built.model))


def led_in(builts: Sequence[BuiltRun]) -> tuple[LedPeople, ...]:
    """Return the people who follow robots."""
    targets = {b.name: b.target for b in builts if b.target is not None}
    led = led_people(targets)
    return tuple(
        LedPeople(robot=k, target=led[b.name], reach=footprint_of_model(b.model).reach)
        for k, b in enumerate(builts)
        if b.name in led
    )


def relative_people(target: Target) -> Callable[[Array, Array], Array]:
    """Return a function from robot and crowd state to a target's people, as for `PersonSight`."""

    def seen(robot: Array, crowd: Array) -> Array:
        state = RobotState(*robot.tolist())
        return seen_from(Pose(state.x, state.y, state.yaw), rows_in(crowd, target))

    return seen

"""Worlds with a change to every run, which a metric should not notice or in a known way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import crowdbot.testing.degenerate as degenerate
from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.testing.symmetries import COMMAND_SYMMETRIES, RUN_SYMMETRIES, perturb
from crowdbot.testing.worlds import World, random_world


def symmetric(world: World, name: str) -> World:
    """Return a world after one of `RUN_SYMMETRIES`."""
    changed = each_run(world, RUN_SYMMETRIES[name])
    return each_command(changed, COMMAND_SYMMETRIES.get(name))


@lru_cache(maxsize=256)
def symmetric_world(seed: int, name: str) -> World:
    """Return a random world after a symmetry, made once: almost all metrics use it."""
    return symmetric(random_world(seed), name)


def each_run(world: World, change: Callable[[Trajectories], Trajectories]) -> World:
    """Return a world with a change to its run and its references."""

    def changed(run: Trajectories | None) -> Trajectories | None:
        return None if run is None else change(run)

    return replace(
        world,
        run=change(world.run),
        robot_alone=changed(world.robot_alone),
        crowd_alone=changed(world.crowd_alone),
    )


def each_command(world: World, change: Callable[[Commands], Commands] | None) -> World:
    """Return a world with a change, if there is one, to its commands."""

    def changed(commands: Commands | None) -> Commands | None:
        return None if commands is None or change is None else change(commands)

    if change is None:
        return world
    return replace(
        world,
        commands=changed(world.commands),
        commands_baseline=changed(world.commands_baseline),
    )


def perturbed(world: World, seed: int) -> World:
    """Return a world with rounding errors in all its runs."""
    return each_run(world, lambda run: perturb(run, 1e-12, seed))


@lru_cache(maxsize=64)
def perturbed_world(seed: int) -> World:
    """Return a random world with rounding errors, made once."""
    return perturbed(random_world(seed), seed)


@lru_cache(maxsize=64)
def perturbed_threshold(name: str, seed: int) -> World:
    """Return a world on a threshold with rounding errors, made once."""
    return perturbed(degenerate.on_thresholds()[name], seed)

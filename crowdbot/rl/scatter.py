"""Random starts and goals around those of the scenario, drawn for each episode."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from crowdbot.core.batch.world import BatchWorld
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.task import Task
from crowdbot.errors import InputError

#: Places tried before a scenario is refused.
_TRIES = 200


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """Largest distances of start and goal from those of the scenario; all are equally likely.

    Attributes:
        start: of x, y and yaw, m and rad.
        goal: of x and y, m; the whole goal zone moves.
    """

    start: tuple[float, float, float] = (0.0, 0.0, 0.0)
    goal: tuple[float, float] = (0.0, 0.0)

    def draw(self, task: Task, rng: np.random.Generator) -> Task:
        """Return a task with another start and goal."""
        (x, y, yaw), (a, b) = task.start, task.goal
        dx, dy, turn = rng.uniform(-1.0, 1.0, 3) * self.start
        da, db = rng.uniform(-1.0, 1.0, 2) * self.goal
        return replace(
            task,
            start=Pose(x + dx, y + dy, yaw + turn),
            goal=(a + da, b + db),
            goal_zone=np.asarray(task.goal_zone) + np.array([da, db]),
        )


def _check_reach(world: BatchWorld, tasks: Sequence[Task]) -> None:
    """Check that no wall separates a start or goal from that of the scenario.

    Raises:
        InputError: a wall does.
    """
    walls = world.blueprint.parts.walls
    for before, task in zip(world.blueprint.tasks, tasks, strict=True):
        for name, a, b in (
            ("start", before.start[:2], task.start[:2]),
            ("goal", before.goal, task.goal),
        ):
            if _crosses(np.array(a), np.array(b), walls):
                raise InputError(f"the {name} would lie behind a wall")


def _crosses(a: Array, b: Array, walls: Array) -> bool:
    """Return True if the segment from a to b meets one of the walls (S, 4)."""
    p, q = walls[:, :2], walls[:, 2:]
    of_walls = _side(a, b, p) * _side(a, b, q) <= 0.0
    of_ends = _side(p, q, a) * _side(p, q, b) <= 0.0
    return bool(np.any(of_walls & of_ends & (np.hypot(*(b - a)) > 0.0)))


def _side(a: Array, b: Array, point: Array) -> Array:
    """Return a number that is positive to the left of the line from a to b."""
    along, to = b - a, point - a
    return np.asarray(along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0])


def spread_of(start: Mapping[str, float] | None, goal: Mapping[str, float] | None) -> Spread | None:
    """Return the spread of starts and goals from arguments; None for those of the scenario.

    Raises:
        InputError: a name or a number is wrong.
    """
    if not start and not goal:
        return None
    x, y, yaw = _numbers("start_spread", start or {}, ("x", "y", "yaw"))
    a, b = _numbers("goal_spread", goal or {}, ("x", "y"))
    return Spread(start=(x, y, yaw), goal=(a, b))


def _numbers(name: str, given: Mapping[str, float], known: tuple[str, ...]) -> list[float]:
    for key, value in given.items():
        if key not in known:
            raise InputError(f"{name} has no '{key}'; it has {', '.join(known)}")
        if not (isinstance(value, int | float) and 0.0 <= value < math.inf):
            raise InputError(f"{name}: {key} is a distance of at least 0, not {value!r}")
    return [float(given.get(key, 0.0)) for key in known]


def scatter(world: BatchWorld, spread: Spread, seed: int) -> None:
    """Give the robots of a world random starts and goals, clear of walls, people and each other.

    Raises:
        InputError: no such place was found.
    """
    rng, problem = np.random.default_rng(seed), ""
    for _ in range(_TRIES):
        tasks = [spread.draw(task, rng) for task in world.blueprint.tasks]
        try:
            _check_reach(world, tasks)
            world.place(tasks)
        except InputError as error:
            problem = str(error)
        else:
            return
    raise InputError(f"{world.blueprint.scenario.id}: no free start in {_TRIES} tries: {problem}")

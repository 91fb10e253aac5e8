"""One draw of a scenario's people, ready to be stepped in a batch."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.core.batch.array_tables import ArrayTable, ScratchPool
from crowdbot.core.batch.blueprint import Blueprint
from crowdbot.core.batch.crowd_tables import (
    CROWD_FIELDS,
    crowd_table,
    group_tables,
    is_compiled,
    random_states,
)
from crowdbot.core.batch.robot_tables import robot_table
from crowdbot.core.batch.scanner_tables import others_of, scanner_table
from crowdbot.core.batch.sensor_reader import SensorReader
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact.robot_contact import R_YAW
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim.build_crowd import in_series
from crowdbot.core.sim.contacts.bodies import outlines_of, rows_of
from crowdbot.core.sim.contacts.start_pose_check import check_apart, check_start
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.task import Task

_NOBODY = np.zeros((0, s.AGENT_COLUMNS))


class BatchWorld:
    """People, robots and scanners of one world; begins at its initial state.

    Attributes:
        blueprint: its scenario.
        engine: its people; None without any.
        robots: (R, 8) states of the robots, see `RobotRecord`.
        compiled: True if people decide in compiled code alone.
        steady: True if no sensor outside of compiled code is due within a step.
        crowd, groups, scanners: arrays for compiled code.
        root: root of the draw; None: the people of the scenario.
        tasks, tables: of its robots, in order; those of the blueprint until `place`.

    Args:
        pool: scratch that worlds of one thread share.
    """

    def __init__(
        self, blueprint: Blueprint, root: int | None, pool: ScratchPool | None = None
    ) -> None:
        pool = pool or ScratchPool()
        self.blueprint, self.root = blueprint, root
        self.engine = blueprint.crowd(root)
        spec, models = blueprint.scenario.crowd, blueprint.models
        self._start = rows_of(models, spec.robot_response.margin if spec else 0.0)
        self.tasks, self.tables = blueprint.tasks, blueprint.tables
        self._check(self.tasks)
        self._put_starts()
        self.robots = self._start.copy()
        self._initial = s.blank(0, len(models))
        if self.engine is not None:
            self._initial = self.engine.initial_state(len(models))
        self.flat = self._initial.copy()
        self.outlines = outlines_of(models)
        self.compiled = self.engine is None or is_compiled(self.engine)
        self._drawn = [] if self.engine is None else random_states(self.engine)
        self._drawn_first = [drawn.copy() for drawn in self._drawn]
        self.stiffnesses = self._stiffnesses()
        self.crowd = self._crowd(pool)
        grouped = self.engine is not None and self.compiled
        self.groups = (
            group_tables(self.engine, self.robots, pool) if grouped and self.engine else []
        )
        self._readers = {
            k: SensorReader(seen, blueprint.names, models, self._scene(seen.robot))
            for k, seen in enumerate(blueprint.sensors)
            if not seen.compiled
        }
        self.steady = all(r.is_steady(blueprint.period) for r in self._readers.values())
        self.scanners = [
            self._readers[k].table if k in self._readers
            else scanner_table(seen, models, self._scene(seen.robot), pool)
            for k, seen in enumerate(blueprint.sensors)
        ]  # fmt: skip

    @property
    def people(self) -> int:
        """Return the number of people, present or to come."""
        return 0 if self.engine is None else len(self.engine.agents)

    def place(self, tasks: Sequence[Task]) -> None:
        """Set other starts and goals of the robots, used from the next `reset` on.

        Raises:
            InputError: a robot would start in a wall, a person or another robot, or end in a wall.
        """
        self._check(tasks)
        plan = self.blueprint
        for model, task, name in zip(plan.models, tasks, plan.names, strict=True):
            check_start(plan.parts, model, Pose(*task.goal, 0.0), None, name)
        self.tasks = tuple(tasks)
        self.tables = tuple(
            robot_table(model, plan.parts, np.asarray(task.goal_zone))
            for model, task in zip(plan.models, tasks, strict=True)
        )
        self._put_starts()

    @property
    def reads(self) -> bool:
        """Return True if some sensors are read outside compiled code."""
        return bool(self._readers)

    def reset(self) -> None:
        """Return to the initial state."""
        self.flat[:] = self._initial
        self.robots[:] = self._start
        if self.engine is not None:
            self.crowd.arrays["pressed"][:] = 0.0
        for drawn, first in zip(self._drawn, self._drawn_first, strict=True):
            drawn[:] = first
        for scanner in self.scanners:
            scanner.arrays["ranges"][:] = np.inf

    def begin_noise(self, key: int) -> None:
        """Set the key of the random numbers of sensors outside of compiled code."""
        for reader in self._readers.values():
            reader.begin(key)

    def read(self, tick: int) -> None:
        """Read the sensors outside of compiled code that are due at a tick."""
        if self._readers:
            rows = self.rows() if self.engine is not None else _NOBODY
            for reader in self._readers.values():
                reader.read(rows, self.robots, tick)

    def rows(self) -> Array:
        """Return the state of all people (N, C), see `PersonRecord`; shared memory."""
        return s.view(self.flat)[1]

    def advance_people(self) -> None:
        """Advance people by a tick with `CrowdEngine`, if compiled code alone cannot."""
        if self.engine is not None:
            self.engine.advance(
                self.flat, self.robots, self.outlines, numbers=np.arange(len(self.robots)),
                stiffnesses=self.stiffnesses,
            )  # fmt: skip

    def _check(self, tasks: Sequence[Task]) -> None:
        """Check that robots start clear of walls and people, and of each other."""
        plan = self.blueprint
        for model, task, name in zip(plan.models, tasks, plan.names, strict=True):
            check_start(plan.parts, model, task.start, self.engine, name)
        check_apart(plan.names, plan.models, [task.start for task in tasks])

    def _put_starts(self) -> None:
        for row, task in zip(self._start, self.tasks, strict=True):
            row[[0, 1, R_YAW]] = task.start

    def _stiffnesses(self) -> Array:
        body = self.blueprint.scenario.contact.stiffness
        return np.array([in_series(body, m.skin_stiffness) for m in self.blueprint.models])

    def _crowd(self, pool: ScratchPool) -> ArrayTable:
        if self.engine is None:
            own = ArrayTable(CROWD_FIELDS)
            own.put(flat=self.flat, robots=self.robots, outlines=self.outlines)
            return own
        return crowd_table(
            self.engine, self.flat, self.robots, self.outlines, self.stiffnesses, pool
        )

    def _scene(self, robot: int) -> Scene:
        """Return the scene of a robot's lidars: walls, pillars, people and other robots."""
        b = self.blueprint
        spec, parts = b.scenario.crowd, b.parts
        agents = None if self.engine is None else self.engine.agents
        radius = np.zeros(0) if agents is None else agents.radius
        height = np.full(len(radius), spec.body.height if spec else 0.0)
        return Scene(
            parts.walls, parts.wall_heights, radius, height, parts.pillars, parts.pillar_heights,
            None if agents is None else agents.looks, others_of(b.models, robot),
        )  # fmt: skip

"""Logs of one run, which write into one recording."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.recording.header import RecordingHeader, RobotHeader
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.robots.urdf_export import to_urdf
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.loggers.watched_run import WatchedRun
from crowdbot.core.sim.robot_ending import RobotEnding
from crowdbot.core.sim.run_outcome import last_arrival, status_of
from crowdbot.core.sim.run_setup import RunSetup, agents, choosers, goal_column_of, ids
from crowdbot.core.types.ending import of_several
from crowdbot.core.types.person_task import TaskPerson
from crowdbot.core.types.robot import DifferentialDrive, HolonomicDrive


@dataclass(frozen=True, slots=True, kw_only=True)
class RunLogs:
    """The logs of people and of each robot in one run.

    Attributes:
        people: records people; of a run with one robot, that robot's log.
        robots: of each robot, by name.
    """

    people: RunLog
    robots: Mapping[str, RunLog]


@contextmanager
def run_logs(
    setup: RunSetup,
    builts: Mapping[str, BuiltRun],
    engine: CrowdEngine | None,
    endings: Mapping[str, RobotEnding],
) -> Iterator[RunLogs]:
    """Yield the logs of a run; their recording is always closed.

    A run with one robot has a single log, with the people. Several robots each write to a namespace
    of their own beside the shared data.
    """
    headers = {name: header_of(setup, built) for name, built in builts.items()}
    if len(builts) == 1:
        (name,) = builts
        shared = headers[name] = replace(headers[name], agents=agents(engine))
    else:
        walls = next(iter(builts.values())).parts.walls
        shared = RecordingHeader(
            scenario=setup.scenario.id, hashes=setup.hashes, agents=agents(engine), walls=walls
        )
    watched = WatchedRun(setup.watchers, shared, headers, endings)
    with ExitStack() as stack:
        if len(builts) == 1:
            yield _one_log(setup, builts[name], engine, shared, endings[name], watched, stack)
        else:
            yield _several_logs(setup, builts, engine, shared, headers, endings, watched, stack)


def _one_log(
    setup: RunSetup,
    built: BuiltRun,
    engine: CrowdEngine | None,
    header: RecordingHeader,
    ending: RobotEnding,
    watched: WatchedRun,
    stack: ExitStack,
) -> RunLogs:
    writer = RecordingWriter(
        setup.recording, header, record=setup.options.record, choosers=choosers(engine),
        description=description_of(setup, built), wheels=_wheels(built),
    )  # fmt: skip
    stack.callback(lambda: writer.close(ending.goal_time, ending.ended, status_of(ending)))
    log = RunLog(
        writer, ids(engine), sideways=_sideways(built), goal_column=goal_column_of(engine),
        on_sample=watched.watch(built.name, people=True),
        on_drawing=watched.drawings_of(built.name),
    )  # fmt: skip
    return RunLogs(people=log, robots={built.name: log})


def _several_logs(
    setup: RunSetup,
    builts: Mapping[str, BuiltRun],
    engine: CrowdEngine | None,
    shared: RecordingHeader,
    headers: Mapping[str, RecordingHeader],
    endings: Mapping[str, RobotEnding],
    watched: WatchedRun,
    stack: ExitStack,
) -> RunLogs:
    root = RecordingWriter(
        setup.recording, shared, record=setup.options.record, choosers=choosers(engine)
    )
    stack.callback(_close_shared, root, endings)
    robots = {}
    for k, (name, built) in enumerate(builts.items()):
        writer = RecordingWriter(
            setup.recording, replace(headers[name], namespace=name), record=setup.options.record,
            beside=root, description=description_of(setup, built), wheels=_wheels(built),
        )  # fmt: skip
        stack.callback(_close_robot, writer, endings[name])  # before the root is closed
        robots[name] = RunLog(
            writer, ids(engine), sideways=_sideways(built), people=False, robot=k,
            on_sample=watched.watch(name, people=False), on_drawing=watched.drawings_of(name),
        )  # fmt: skip
    people = RunLog(
        root,
        ids(engine),
        robot=None,
        goal_column=goal_column_of(engine),
        on_sample=watched.watch("", people=True),
    )
    return RunLogs(people=people, robots=robots)


def _close_robot(writer: RecordingWriter, ending: RobotEnding) -> None:
    until = ending.until if ending.ended else None
    writer.close(ending.goal_time, ending.ended, status_of(ending), until)


def _close_shared(writer: RecordingWriter, endings: Mapping[str, RobotEnding]) -> None:
    found = list(endings.values())
    complete = all(ending.ended for ending in found)
    writer.close(last_arrival(found), complete, of_several(map(status_of, found)))


def header_of(setup: RunSetup, built: BuiltRun) -> RecordingHeader:
    """Return the constants of a robot's run, without people."""
    model, task, target = built.model, built.task, built.target
    return RecordingHeader(
        scenario=built.scenario.id,
        hashes=setup.hashes,
        robot=RobotHeader.of(model, task.goal if target is None else None),
        sensors=built.infos,
        walls=built.parts.walls[built.parts.wall_heights[:, 0] < model.height],
        goal_zone=task.goal_zone if built.robot.task.zone is not None else None,
        person=None
        if target is None
        else TaskPerson(task=target.task(), id=target.id, facing=target.heading),
    )


def description_of(setup: RunSetup, built: BuiltRun) -> str:
    """Return the robot's URDF, where it is recorded."""
    return to_urdf(built.model, built.infos, built.name) if setup.options.record != "none" else ""


def _wheels(built: BuiltRun) -> tuple[str, ...]:
    """Return the joints of the driven wheels, left and right; none of a holonomic robot."""
    drive = built.model.drive
    if not isinstance(drive, DifferentialDrive):
        return ()
    return drive.left_joint, drive.right_joint


def _sideways(built: BuiltRun) -> bool:
    return isinstance(built.model.drive, HolonomicDrive)

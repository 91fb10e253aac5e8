"""Constructors of trajectories from external data: tables, frames, bags, data sets.

They derive missing data and warn of implausible data, such as positions in millimetres.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar, Self, TypeVar, Unpack, cast

from numpy.typing import ArrayLike

import crowdbot.core.trajectories.own_recordings as own
import crowdbot.core.trajectories.plausibility.times as times
from crowdbot.core.support.arguments import mapping_of, number_of, path_of, point_of
from crowdbot.core.trajectories.bag.tables import bag_tables
from crowdbot.core.trajectories.data_sets.homography import Homography, in_metres
from crowdbot.core.trajectories.data_sets.readers import eth_ucy_table, split_robot, trajnet_table
from crowdbot.core.trajectories.message_columns import QUATERNION
from crowdbot.core.trajectories.plausibility.findings import implausible
from crowdbot.core.trajectories.raw_table import ColumnNames, RawTable
from crowdbot.core.trajectories.recording_options import (
    DEFAULTS,
    DataSetOptions,
    TableOptions,
    TopicOptions,
    takes,
)
from crowdbot.core.trajectories.table_columns.completed import sentences
from crowdbot.core.trajectories.table_columns.frame_table import frame_table
from crowdbot.core.trajectories.table_columns.frames import in_seconds
from crowdbot.core.trajectories.table_columns.robots import without_robots
from crowdbot.core.trajectories.text_table import read_table
from crowdbot.errors import InputError, RecordingWarning

#: Table -> our name of a column -> the name that it has there.
TableColumns = Mapping[str, ColumnNames]
_COLUMNS = {
    "robot": (*own.ROBOT, *QUATERNION),
    "agents": own.AGENT,
    "trips": own.TRIP,
    "contacts": own.CONTACT,
}
_Run = TypeVar("_Run", bound="FromRecordings")


class FromRecordings:
    """Constructors of `Trajectories` besides arrays."""

    __slots__ = ()
    _read_recording: ClassVar[Callable[[Path | str, str | None], FromRecordings] | None] = None

    @classmethod
    @takes(TableOptions)
    def from_csv(
        cls,
        robot: Path | str | None = None,
        agents: Path | str | None = None,
        trips: Path | str | None = None,
        *,
        frame_rate: float | None = None,
        homography: Homography | None = None,
        columns: TableColumns | None = None,
        contacts: Path | str | Mapping[str, ArrayLike] | None = None,
        **options: Unpack[TableOptions],
    ) -> Self:
        """Read tables with a header row; SI units, radians, an empty cell is unknown.

        Cells are separated by commas, semicolons, tabs or blanks; comments begin with ``#``. Times
        are seconds, or stamps (ISO 8601, without a zone UTC; ms, us or ns since 1970), which are
        counted from the robot's first. A comment may name the columns, as in files of PeTrack and
        JuPedSim: ``# framerate: 25``, ``# id frame x/cm y/cm z/cm``.

        Args:
            robot: t, x, y, optionally theta, v, w, vx, vy: one row a sample. It sets the samples.
                Without ``theta`` the robot looks where it moves, velocities are derived.
            agents: t, id, x, y, optionally vx, vy, radius, mass, jump: one row for each person
                and sample; or t, x1, y1, x2, y2, ...: one row for each sample. No place, no
                person. ``jump`` is 1 where the person was teleported since the sample before. Ids
                may be names: people are numbered as they appear.
            trips: agent, t0, t1, reached (0 or 1): one row a trip.
            frame_rate: frames per second, where times are numbers of frames; None: they are not, or
                a comment states it.
            homography: where positions are pixels: the matrix (3, 3) to metres, its file, or
                metres per pixel; velocities and headings in the tables are then left out.
            columns: names of columns where they differ:
                ``{"robot": {"x": "pos_x"}, "agents": {"id": "track"}}``.
            contacts: t0, t1, agent (-1: a wall), impulse, peak_force, relative_speed, optionally
                bearing: one row a contact of the robot; or such columns.
            agent_radius, agent_mass: m, kg, where the table does not say them.
            resample: None: rows of people lie on the robot's; ``"robot"``: people are interpolated
                at the robot's times; a number: everything is, at this rate in Hz.
            clock_offset: s, added to the times of people, whose clock differs by it.
            max_gap: s; across a longer time without a row a person is absent, not interpolated.
            robot_radius, robot_mass: m, kg; needed with a robot.
            robot_goal_time: when it arrived, s. Left out, it is derived: the first time that its
                centre is within ``robot_goal_radius`` (0: its own radius) of ``robot_goal``, or in
                ``goal_zone``. None: it did not arrive. Without a goal, metrics of the task are
                undefined.
            robot_goal, robot_goal_radius: middle and radius of the goal, m.
            robot_speed_limit: the fastest that the robot can go, m/s.
            goal_zone, walls, planner_step_time, robot_footprint, signals: as in `Trajectories`.

        Raises:
            InputError: a file cannot be read, does not fit the others, or there is no table.

        Warns:
            RecordingWarning: units or frames cannot be what they should be.
        """
        names = _names_of(columns)
        files: dict[str, Path | str | None] = {"robot": robot, "agents": agents, "trips": trips}
        as_columns = None
        if contacts is None or isinstance(contacts, Path | str):
            files["contacts"] = contacts
        else:
            as_columns = contacts
        tables = {
            n: read_table(path_of(n, p), names.get(n, {}), _COLUMNS[n])
            for n, p in files.items()
            if p is not None
        }
        if "agents" in tables:
            tables["agents"] = without_robots(tables["agents"])
        placed = {name: in_metres(table, homography) for name, table in tables.items()}
        return _made(cls, in_seconds(placed, frame_rate), options, contacts=as_columns)

    @classmethod
    @takes(TableOptions)
    def from_pandas(
        cls,
        robot: object | None = None,
        agents: object | None = None,
        trips: object | None = None,
        *,
        frame_rate: float | None = None,
        columns: TableColumns | None = None,
        contacts: object | None = None,
        **options: Unpack[TableOptions],
    ) -> Self:
        """Take data frames, or mappings of columns, that are as the tables of `from_csv`.

        Args:
            robot: t, x, y, optionally theta, v, w, vx, vy.
            agents: t, id, x, y, optionally vx, vy, radius, mass, jump.
            trips: agent, t0, t1, reached.
            frame_rate: frames per second, where times are numbers of frames; None: they are not.
            columns: names of columns where they differ, as for `from_csv`.
            contacts: a frame as the table of `from_csv`.
            options: all further keywords are those of `from_csv`.

        Raises:
            InputError: a frame is something else, does not fit the others, or there is none.

        Warns:
            RecordingWarning: units or frames cannot be what they should be.
        """
        names = _names_of(columns)
        frames = {"robot": robot, "agents": agents, "trips": trips, "contacts": contacts}
        tables = {
            n: frame_table(f"frame '{n}'", f, names.get(n, {}), _COLUMNS[n])
            for n, f in frames.items()
            if f is not None
        }
        if "agents" in tables:
            tables["agents"] = without_robots(tables["agents"])
        return _made(cls, in_seconds(tables, frame_rate), options)

    @classmethod
    @takes(TopicOptions, resample="robot")
    def from_rosbag(
        cls,
        path: Path | str,
        *,
        robot: str | None = None,
        people: str | None = None,
        same_frame: bool = False,
        **options: Unpack[TopicOptions],
    ) -> Self:
        """Read topics of a bag of ROS 1 or ROS 2; times are counted from the robot's first.

        Args:
            path: a ``.bag``, a folder of rosbag2, or its ``.mcap`` or ``.db3`` file.
            robot: topic of the robot's pose: ``Odometry``, ``PoseStamped``,
                ``PoseWithCovarianceStamped``, turtlesim's ``Pose`` and their like; or ``/tf``,
                ``/tf:FRAME``, for poses that are only there.
            people: topic with a list of people with positions: ``People``, ``TrackedPersons``,
                ``AgentStates``, ``Agents``, ``ObjectArray``, ``MarkerArray``, ``PoseArray``. Where
                nothing names a person, nearness does.
            same_frame: True to take frames with different names for one, where the bag has no
                transform between them.
            options: all further keywords are those of `from_csv`. With ``resample=None`` the
                topics must have the same times.

        Raises:
            InputError: it cannot be read, messages have no pose or no list of people, or frames
                differ without a transform.
            UnknownNameError: there is no such topic.

        Warns:
            RecordingWarning: rows are left out or changed, such as a robot among the people; units
                or frames cannot be what they should be.
        """
        read = bag_tables(path_of("path", path), robot, people, same_frame=same_frame)
        for note in read.notes:
            warnings.warn(f"{path}: {note}", RecordingWarning, stacklevel=3)
        if read.robot is None and options.get("resample") == "robot":
            options["resample"] = None
        return _made(cls, {"robot": read.robot, "agents": read.people}, options)

    @classmethod
    @takes(DataSetOptions, robot_radius=0.25, robot_mass=70.0)
    def from_trajnet(
        cls,
        path: Path | str,
        *,
        scene: int | None = None,
        robot: int | None = None,
        frame_rate: float | None = None,
        homography: Homography | None = None,
        **options: Unpack[DataSetOptions],
    ) -> Self:
        """Read people of TrajNet++ (``.ndjson``).

        Args:
            path: the file.
            scene: number of one scene; None takes all tracks.
            robot: number of a person who is taken for the robot; the run is as long as that
                person is there. None: people alone.
            frame_rate: frames per second; None: as the data set has it (2.5 annotations a second).
            homography: where positions are pixels, as for `from_csv`.
            options: all further keywords are those of `from_csv`.

        Raises:
            InputError: it cannot be read, or is of another format.
            UnknownNameError: there is no such scene or person.

        Warns:
            RecordingWarning: units or frames cannot be what they should be.
        """
        table = in_metres(trajnet_table(path_of("path", path), scene, frame_rate), homography)
        return _made(cls, _people_and_robot(table, robot), options)

    @classmethod
    @takes(DataSetOptions, robot_radius=0.25, robot_mass=70.0)
    def from_eth_ucy(
        cls,
        path: Path | str,
        *,
        robot: int | None = None,
        frame_rate: float | None = None,
        homography: Homography | None = None,
        **options: Unpack[DataSetOptions],
    ) -> Self:
        """Read people of ETH or UCY: ``obsmat.txt``, ``.vsp``, or rows of frame, id, x, y.

        A comment above the rows may name other columns, as in files of PeTrack and JuPedSim.

        Args:
            path: the file.
            robot: number of a person who is taken for the robot, as for `from_trajnet`.
            frame_rate: frames per second; None: a comment states it, or 2.5 annotations a second;
                for splines 25.
            homography: where positions are pixels: the matrix (3, 3) to metres, its file, or
                metres per pixel. None: they are metres; of splines, ``H.txt`` beside them.
            options: all further keywords are those of `from_csv`.

        Raises:
            InputError: it cannot be read, or is of another format.
            UnknownNameError: there is no such person.

        Warns:
            RecordingWarning: units or frames cannot be what they should be.
        """
        table, notes = eth_ucy_table(path_of("path", path), frame_rate, homography)
        for note in notes:
            warnings.warn(f"{path}: {note}", RecordingWarning, stacklevel=3)
        return _made(cls, _people_and_robot(table, robot), options)

    @classmethod
    def from_mcap(cls, path: Path | str, *, robot: str | None = None) -> Self:
        """Read a recording; `crowdbot.Recording` also has its header, scans and robots.

        Args:
            path: ``run.mcap`` of a run.
            robot: which, of several.

        Raises:
            InputError: it cannot be read, crowdbot did not write it, or there are several robots
                and none is named.
            UnknownNameError: there is no such robot.
        """
        read = cls._read_recording
        if read is None:
            raise InputError("this Trajectories reads no recordings; crowdbot.Trajectories does")
        return cast(Self, read(path_of("path", path), robot))

    def implausible(self) -> list[str]:
        """Return sentences on implausible values, such as positions in millimetres."""
        return implausible(cast(Any, self))


def register_reader(read: Callable[[Path | str, str | None], FromRecordings]) -> None:
    """Register the reader of `from_mcap`, which belongs to a package that imports this one."""
    FromRecordings._read_recording = read


#: Numbers among the options and their units; and those that None leaves unknown.
_NUMBERS = {
    "agent_radius": "m", "agent_mass": "kg", "clock_offset": "s", "max_gap": "s",
    "robot_goal_radius": "m", "robot_radius": "m", "robot_mass": "kg", "robot_speed_limit": "m/s",
}  # fmt: skip
_OPTIONAL = ("robot_radius", "robot_mass", "robot_speed_limit")
_FOR_COLUMNS = ("agent_radius", "agent_mass", "resample", "clock_offset", "max_gap")


def _checked(name: str, value: Any) -> Any:
    """Return the value of an option.

    Raises:
        InputError: it should be a number or a point, and is something else.
    """
    if name in _NUMBERS and not (value is None and name in _OPTIONAL):
        return number_of(name, value, _NUMBERS[name])
    return point_of(name, value) if name == "robot_goal" and value is not None else value


def _names_of(columns: TableColumns | None) -> TableColumns:
    """Return names of columns by table.

    Raises:
        InputError: there is no such table.
    """
    columns = mapping_of("columns", columns or {}, "tables to names of columns")
    for table, names in columns.items():
        if table not in _COLUMNS or not isinstance(names, Mapping):
            raise InputError(
                "columns: write {'robot': {'x': 'NAME THERE'}}, with the tables "
                f"{', '.join(_COLUMNS)}; not {table!r}: {names!r}"
            )
    return columns


def _people_and_robot(table: RawTable, robot: int | None) -> dict[str, RawTable | None]:
    """Return the tables of a data set, of which one person may be taken for the robot."""
    own_robot, others = split_robot(table, robot)
    return {"robot": own_robot, "agents": others if len(others) else None}


def _made(
    cls: type[_Run],
    tables: Mapping[str, RawTable | None],
    options: Mapping[str, Any],
    contacts: Mapping[str, ArrayLike] | None = None,
) -> _Run:
    """Build a run from tables and further options; warn of implausible data."""
    given = {name: _checked(name, value) for name, value in {**DEFAULTS, **options}.items()}
    how = {name: given.pop(name) for name in _FOR_COLUMNS}
    columns = own.columns_of(*(tables.get(name) for name in _COLUMNS), **how)
    arrived = given.pop("robot_goal_time")
    if arrived == "derived":
        radius = given["robot_goal_radius"] or given["robot_radius"] or 0.0
        arrived = own.arrival(columns, given["robot_goal"], radius, given["goal_zone"])
    elif isinstance(arrived, str):
        raise InputError(f"robot_goal_time is a time in s, None or 'derived', not {arrived!r}")
    if "robot_x" in columns and None in (given["robot_radius"], given["robot_mass"]):
        raise InputError("a robot needs robot_radius (m) and robot_mass (kg), which tables lack")
    arrays = {"contacts": contacts, **given, **columns, "robot_goal_time": arrived}
    run: Any = cast(Any, cls).from_arrays(**arrays)
    notes = (note for table in tables.values() if table is not None for note in sentences(table))
    apart = run.agents is not None and tables.get("robot") is None and times.apart(run.agents.x)
    for text in (*notes, *([apart] if apart else []), *run.implausible()):
        warnings.warn(text, RecordingWarning, stacklevel=4)
    return cast(_Run, run)

"""Clips from files: crowdbot's recordings, tables with a robot, and archives of clips."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.realism.near_robots.clip import RATE, Clip, clip_from_arrays, clip_of
from crowdbot.core.realism.near_robots.encounters import BODY
from crowdbot.core.realism.tracks import of_files
from crowdbot.core.recording.recording import Recording
from crowdbot.core.trajectories.own_recordings import columns_of
from crowdbot.core.trajectories.raw_table import RawTable
from crowdbot.core.trajectories.table_columns.frames import in_seconds
from crowdbot.core.trajectories.text_table import read_table
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError

_COLUMNS = ("t", "id", "x", "y", "theta", "radius")
#: Longest gap between rows of a person that is interpolated, s.
_GAP = 0.6
#: Value of ``id`` in a table that marks the rows of the robot.
ROBOT_ID = "robot"
_FORMATS = (
    "a recording (.mcap), a table t,id,x,y with rows of id 'robot' (.csv, .tsv), an archive of "
    "clips (.npz), or a folder of these"
)
_READABLE = (".mcap", ".csv", ".tsv", ".npz")


def read_clips(path: Path) -> list[Clip]:
    """Read the clips of a file or folder.

    Raises:
        InputError: it cannot be read, is of another format, or holds no robot among people.
    """
    if not path.exists():
        raise InputError(f"{path}: no such file")
    if path.is_dir():
        files = sorted(f for f in path.rglob("*") if f.suffix.lower() in _READABLE)
        if not files:
            raise InputError(f"{path}: there is no recording in it: {_FORMATS}")
        return [clip for file in files for clip in read_clips(file)]
    suffix = path.suffix.lower()
    if suffix == ".mcap":
        return clips_of_run(path)
    if suffix in (".csv", ".tsv"):
        return [_table(path)]
    if suffix == ".npz":
        return _archive(path)
    raise InputError(f"{path}: not {_FORMATS}")


def clips_of_run(path: Path) -> list[Clip]:
    """Read a recording of crowdbot: a clip per robot."""
    with Recording(path) as recording:
        runs = [recording.trajectories(name) for name in recording.robots or (None,)]
    return [clip_of(run, str(path)) for run in runs]


def clips_of_runs(files: Sequence[Path]) -> tuple[list[Clip], list[str]]:
    """Return the clips of finished runs, and why others are left out.

    Raises:
        InputError: a recording cannot be read, or all are left out.
    """
    return of_files(files, clips_of_run)


def _table(path: Path) -> Clip:
    """Read a table whose rows with the id ``robot`` are the robot's.

    The robot's rows have ``radius`` (m) and may have ``theta`` (rad).
    """
    table = read_table(path, {}, _COLUMNS)
    table.require("", "t", "id", "x", "y")
    table = in_seconds({"agents": table}, None)["agents"]
    mine = np.array([str(cell).strip() == ROBOT_ID for cell in table.columns["id"]], np.bool_)
    if not mine.any() or mine.all():
        missing = f"row of id '{ROBOT_ID}'" if not mine.any() else "row of a person"
        raise InputError(f"{path}: there is no {missing}")
    robot, people = _rows(table, mine, "theta", "radius"), _rows(table, ~mine, "id")
    radii = robot.numbers("radius") if "radius" in robot else np.array([np.nan])
    radius = float(radii[0])
    if not (np.isfinite(radius) and radius > 0.0):
        raise InputError(f"{robot.where(0)}: the robot's first row needs its radius, m, above 0")
    if "theta" in robot and not np.isfinite(robot.numbers("theta")).all():
        robot = _rows(robot, np.ones(len(robot), np.bool_))
    columns = columns_of(
        robot, people, None, None, agent_radius=BODY, agent_mass=75.0, resample=RATE,
        clock_offset=0.0, max_gap=_GAP,
    )  # fmt: skip
    columns.pop("robot_radius", None)
    run = Trajectories.from_arrays(**columns, robot_radius=radius, robot_mass=1.0)
    return clip_of(run, str(path))


def _rows(table: RawTable, chosen: NDArray[np.bool_], *more: str) -> RawTable:
    """Return the chosen rows of a table, sorted by time."""
    rows = np.flatnonzero(chosen)
    rows = rows[np.argsort(table.numbers("t")[rows], kind="stable")]
    names = [n for n in ("t", "x", "y", *more) if n in table]
    columns = {n: [table.columns[n][int(k)] for k in rows] for n in names}
    lines = [table.lines[int(k)] for k in rows] if len(table.lines) else []
    return RawTable(table.name, columns, lines, table.header)


def _archive(path: Path) -> list[Clip]:
    """Read an archive of numpy: ``index``, and arrays for each key of it."""
    try:
        with np.load(path, allow_pickle=False) as data:
            index = json.loads(str(data["index"]))
            return [_clip(path, data, entry) for entry in index]
    except (OSError, ValueError, KeyError, TypeError) as error:
        reason = f"it has no {error}" if isinstance(error, KeyError) else str(error)
        raise InputError(f"{path}: not an archive of clips: {reason}") from error


def _clip(path: Path, data: Mapping[str, Any], entry: Mapping[str, Any]) -> Clip:
    key = entry["key"]
    t, vehicle, people = (data[f"{key}_{n}"] for n in ("t", "vehicle", "people"))
    outline = np.asarray(data[f"{key}_outline"], np.float64).reshape(-1, 2)
    shapes = len(t) > 3 and vehicle.shape == (len(t), 6) and people.shape[::2] == (len(t), 2)
    if not shapes:
        raise ValueError(f"clip {key}: t, vehicle (T, 6) and people (T, N, 2) do not fit")
    return clip_from_arrays(
        str(entry.get("name", key)), str(entry.get("group", path)), t,
        vehicle[:, :3].astype(np.float64), people.astype(np.float64),
        Footprint(outline, float(entry.get("radius", 0.0))),
    )  # fmt: skip

"""Export recordings as tables for general tools: CSV, Parquet, GeoJSON, TrajNet++.

`Trajectories.from_csv` can read the CSV tables.
"""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.trajectories.tracks import AgentTracks
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

Table = dict[str, Any]
_ROBOT = ("x", "y", "theta", "v", "w")
_TRIP = ("agent", "t0", "t1", "reached")
_CONTACT = ("t0", "t1", "agent", "impulse", "peak_force", "relative_speed", "bearing")
#: Frames per second of TrajNet++, and the robot's number there.
TRAJNET_RATE, ROBOT_ID = 2.5, 0


def tables(run: Trajectories) -> dict[str, Table]:
    """Return the tables of a run by name; each is column -> values of equal number."""
    found: dict[str, Table] = {}
    robot, people = run.robot, run.agents
    if robot is not None:
        aside = {n: getattr(robot, n) for n in ("vx", "vy")}
        found["robot"] = {
            "t": run.t,
            **{n: getattr(robot, n) for n in _ROBOT},
            **{n: column for n, column in aside.items() if column is not None},
        }
    if people is not None:
        found["people"] = _people(run.t, people)
    if run.trips is not None:
        found["trips"] = {n: getattr(run.trips, n) for n in _TRIP}
    if run.contacts is not None:
        found["contacts"] = {n: getattr(run.contacts, n) for n in _CONTACT}
    return found


def _people(t: Array, people: AgentTracks) -> Table:
    """Return a row per person and sample in which the person is present."""
    k, i = np.nonzero(np.isfinite(people.x))
    jump = np.zeros(people.x.shape, np.bool_)
    if people.jump is not None:
        jump[1:] = people.jump
    return {
        "t": t[k],
        "id": people.id[i],
        **{n: getattr(people, n)[k, i] for n in ("x", "y", "vx", "vy")},
        "radius": people.radius[i],
        "mass": people.mass[i],
        "jump": jump[k, i].astype(np.int64),
    }


def write_csv(run: Trajectories, out: Path) -> list[str]:
    """Write the existing ones of ``robot.csv``, ``people.csv``, ``trips.csv``, ``contacts.csv``.

    Numbers are written exactly.
    """
    written = []
    for name, table in tables(run).items():
        file = out / f"{name}.csv"
        with file.open("w", encoding="utf-8", newline="") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow(table)
            writer.writerows(zip(*(_cells(column) for column in table.values()), strict=True))
        written.append(file.name)
    return written


def _cells(column: Any) -> list[Any]:
    values = np.asarray(column)
    if values.dtype == np.bool_:
        values = values.astype(np.int64)
    plain: list[Any] = values.tolist()
    return ["" if isinstance(x, float) and math.isnan(x) else x for x in plain]


def write_parquet(run: Trajectories, out: Path) -> list[str]:
    """Write the tables of robot, people, trips and contacts as Parquet, compressed with zstd."""
    import pyarrow as pa  # type: ignore[import-untyped]
    import pyarrow.parquet as pq  # type: ignore[import-untyped]

    written = []
    for name, table in tables(run).items():
        file = out / f"{name}.parquet"
        columns = {n: pa.array(np.asarray(values)) for n, values in table.items()}
        pq.write_table(pa.table(columns), file, compression="zstd")
        written.append(file.name)
    return written


def geojson(run: Trajectories) -> str:
    """Return walls, goal zone, and paths of robot and people as GeoJSON; metres, not degrees."""
    features = [*_scenery(run), *_ways(run)]
    document = {
        "type": "FeatureCollection",
        "coordinate_unit": "m",
        "frame": "map",
        "features": features,
    }
    return json.dumps(document, allow_nan=False) + "\n"


def _feature(kind: str, coordinates: Any, **properties: Any) -> dict[str, Any]:
    geometry = {"type": kind, "coordinates": coordinates}
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def _scenery(run: Trajectories) -> Iterator[dict[str, Any]]:
    if run.walls is not None:
        for x0, y0, x1, y1 in np.asarray(run.walls).tolist():
            yield _feature("LineString", [[x0, y0], [x1, y1]], what="wall")
    if run.goal_zone is not None and len(run.goal_zone):
        ring = np.asarray(run.goal_zone).tolist()
        yield _feature("Polygon", [[*ring, ring[0]]], what="goal")


def _ways(run: Trajectories) -> Iterator[dict[str, Any]]:
    if run.robot is not None and len(run.t) > 1:
        path = np.column_stack((run.robot.x, run.robot.y)).tolist()
        yield _feature("LineString", path, what="robot", t=run.t.tolist())
    people = run.agents
    for i in range(0 if people is None else len(people.id)):
        assert people is not None
        jumps = None if people.jump is None else people.jump[:, i]
        for rows in _pieces(people.x[:, i], jumps):
            path = np.column_stack((people.x[rows, i], people.y[rows, i])).tolist()
            fields = {"what": "person", "id": int(people.id[i]), "radius": float(people.radius[i])}
            yield _feature("LineString", path, **fields, t=run.t[rows].tolist())


def _pieces(x: Array, jumps: Any) -> list[Any]:
    """Return stretches of at least two samples of a present person, cut at teleports."""
    there = np.isfinite(x)
    cut = np.flatnonzero(~(there[1:] & there[:-1]) | (False if jumps is None else jumps)) + 1
    return [p for p in np.split(np.arange(len(x)), cut) if len(p) > 1 and there[p].all()]


def trajnet(runs: Iterable[tuple[Trajectories, str]]) -> str:
    """Return runs and their names as TrajNet++ scenes, ndjson: 2.5 frames per second.

    In the first scene the robot is person 0 and the first frame is 0; people and frames of a later
    scene have the numbers after those of the scene before, so that none are in two scenes.

    Raises:
        InputError: a recording has no second sample at that rate.
    """
    scenes, tracks, frame, first = [], [], 0, ROBOT_ID
    for number, (run, name) in enumerate(runs):
        rows = [_row(frame + f, first + p, x, y) for f, p, x, y in _trajnet_rows(run)]
        if not rows:
            raise InputError(
                f"{name}: is too short for trajnet, which needs two frames 0.4 s apart"
            )
        last = max(row["track"]["f"] for row in rows)
        scene = {"id": number, "p": first, "s": frame, "e": last, "fps": TRAJNET_RATE, "tag": name}
        scenes.append({"scene": scene})
        tracks += rows
        frame, first = last + 1, max(row["track"]["p"] for row in rows) + 1
    return "".join(json.dumps(line) + "\n" for line in (*scenes, *tracks))


def _trajnet_rows(run: Trajectories) -> Iterator[tuple[int, int, float, float]]:
    """Yield frame, person, x and y; the robot is person 0, a person has its id + 1."""
    step = 1.0 / TRAJNET_RATE
    frames = math.floor(float(run.t[-1]) / step + 1e-9) + 1 if len(run.t) else 0
    nearest = np.abs(run.t[np.newaxis] - step * np.arange(frames)[:, np.newaxis]).argmin(axis=1)
    for frame, k in enumerate(nearest.tolist()):
        if run.robot is not None:
            yield frame, ROBOT_ID, run.robot.x[k], run.robot.y[k]
        if run.agents is not None:
            for i in np.flatnonzero(np.isfinite(run.agents.x[k])).tolist():
                number = int(run.agents.id[i]) + 1
                yield frame, number, run.agents.x[k, i], run.agents.y[k, i]


def _row(frame: int, person: int, x: float, y: float) -> dict[str, Any]:
    return {"track": {"f": frame, "p": person, "x": round(float(x), 4), "y": round(float(y), 4)}}

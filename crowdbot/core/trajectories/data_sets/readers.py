"""Tracks of people in data set formats: TrajNet++, and ETH and UCY."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import crowdbot.core.trajectories.plausibility.exchanged as exchanged
from crowdbot.core.support.text_files import LARGEST_TABLE, input_text
from crowdbot.core.trajectories.data_sets.homography import (
    Homography,
    in_metres,
    matrix_of,
    projected,
)
from crowdbot.core.trajectories.data_sets.jupedsim_output import is_database, jupedsim_table
from crowdbot.core.trajectories.data_sets.splines import is_spline_file, spline_table
from crowdbot.core.trajectories.plausibility.times import CREEPING
from crowdbot.core.trajectories.raw_table import RawTable
from crowdbot.core.trajectories.table_columns.frames import refuse_exchanged, whole_numbers
from crowdbot.core.trajectories.table_columns.names import FRAMES
from crowdbot.core.trajectories.table_columns.units import unit_in, without_unit
from crowdbot.core.trajectories.text_table import split
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError, UnknownNameError

#: Columns of ETH's ``obsmat.txt``: y is the height, and the third column is y in the plane.
_OBSMAT = ("frame", "id", "x", "z", "y", "vx", "vz", "vy")
#: Median of what people move by in a second from which positions are hardly metres.
_PIXELS = 10.0
_PLAIN = ("frame", "id", "x", "y")
#: Numbers of columns of tables whose columns nothing names.
WIDTHS = (len(_PLAIN), len(_OBSMAT))
#: Columns of data sets that hold boxes, and where a person stands in one seen from aside.
_SDD = "id, xmin, ymin, xmax, ymax, frame, lost, occluded, generated, label"
_MOT = "frame, id, left, top, width, height, confidence, and three more"
_FEET = "left + width/2, top + height"
#: Names of columns in comments, in lower case -> ours.
_OURS = {**dict.fromkeys(FRAMES, "frame"), **{n: n for n in ("id", "x", "y", "vx", "vy")},
         **dict.fromkeys(("persid", "personid", "ped_id"), "id")}  # fmt: skip


def trajnet_table(path: Path, scene: int | None, frame_rate: float | None) -> RawTable:
    """Read people from a TrajNet++ file (``.ndjson``: lines of ``scene`` and ``track``).

    Args:
        path: the file.
        scene: number of one scene: frames and people of its time; None takes all tracks.
        frame_rate: frames per second; None: from the scenes (``fps``, of their steps).

    Raises:
        InputError: it cannot be read, or a line is invalid.
        UnknownNameError: there is no such scene.
    """
    scenes: dict[int, dict[str, Any]] = {}
    rows: list[tuple[int, dict[str, Any]]] = []
    for number, line in enumerate(input_text(path, LARGEST_TABLE).splitlines(), 1):
        if not line.strip():
            continue
        try:
            item = json.loads(line)
            if "scene" in item:
                scenes[int(item["scene"]["id"])] = item["scene"]
            elif "prediction_number" not in item["track"]:
                rows.append((number, {k: float(item["track"][k]) for k in "fpxy"}))
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise InputError(f"{path}:{number}: not a scene or track of TrajNet++") from error
    if scene is not None:
        if scene not in scenes:
            raise UnknownNameError("scene", str(scene), map(str, scenes))
        first, last = int(scenes[scene]["s"]), int(scenes[scene]["e"])
        rows = [(n, r) for n, r in rows if first <= r["f"] <= last]
    if not rows:
        raise InputError(f"{path}: there are no tracks")
    frames = np.array([r["f"] for _, r in rows])
    fps = next((float(s["fps"]) for s in scenes.values() if s.get("fps")), 2.5)
    t = _seconds(frames, 1.0 / fps) if frame_rate is None else (frames - frames.min()) / frame_rate
    columns = {"t": t, "id": np.array([int(r["p"]) for _, r in rows])}
    columns |= {n: np.array([r[n] for _, r in rows]) for n in "xy"}
    return _once(RawTable(str(path), columns, [n for n, _ in rows]))


def eth_ucy_table(
    path: Path, frame_rate: float | None, homography: Homography | None = None
) -> tuple[RawTable, list[str]]:
    """Read people from ETH or UCY: splines, ``obsmat.txt`` (8 columns), or 4: frame, id, x, y.

    A comment such as ``# id frame x/m y/m z/m``, as in files of PeTrack and JuPedSim, names the
    columns otherwise. A database of JuPedSim is read, too.

    Args:
        path: the file; blanks, tabs or commas between the columns, no header.
        frame_rate: frames per second; None: as a comment states, else one annotation per 0.4 s, as
            in both data sets.
        homography: from positions in the file to metres, see `spline_table`; velocities in the
            file are then left out.

    Returns:
        The table, and sentences on what is not as the format has it.

    Raises:
        InputError: it cannot be read, or a row is invalid.
    """
    if is_database(path):
        return in_metres(jupedsim_table(path, frame_rate), homography), []
    text = input_text(path, LARGEST_TABLE)
    if is_spline_file(path, text):
        return spline_table(path, homography, frame_rate)
    found = split(path, text)
    if not found.rows:
        raise InputError(f"{path}: the table has no rows")
    width = len(found.rows[0])
    names = [_OURS.get(without_unit(name).lower(), "") for name in found.header]
    assumed = found.assumed
    if not {"frame", "id", "x", "y"} <= set(names):
        assumed = True
        if found.header or width not in WIDTHS:
            seen = f"columns {', '.join(found.header)}" if found.header else f"{width} columns"
            if not found.header and width == 10:
                raise InputError(f"{path}:{found.lines[0]}: {_boxes(found.rows[0][-1])}")
            raise InputError(
                f"{path}:{found.lines[0]}: {seen}; 4 (frame, id, x, y) or 8 (obsmat.txt) are "
                "wanted, or a comment that names others, such as '# id frame x/m y/m z/m'; tables "
                "with times are read by from_csv, and by commands as .csv"
            )
        names = list(_PLAIN if width == 4 else _OBSMAT)
    cells = {n: [row[names.index(n)] for row in found.rows] for n in dict.fromkeys(names) if n}
    raw = RawTable(str(path), cells, found.lines)
    columns: dict[str, Any] = {
        n: raw.numbers(n) for n in ("frame", "id", "x", "y", "vx", "vy") if n in cells
    }
    for name in ("x", "y"):
        header = found.header[names.index(name)] if found.header else ""
        columns[name] = columns[name] * (unit_in(header) or found.unit)
    if homography is not None:
        places = np.column_stack([columns["x"], columns["y"]])
        columns["x"], columns["y"] = projected(path, matrix_of(homography), places).T
        columns = {n: c for n, c in columns.items() if n not in ("vx", "vy")}
    if assumed:
        whole_numbers(raw, "frame", "id")
    notes = _exchanged(columns, names) if assumed else []
    unused = [c for c, ours in zip(found.header, names, strict=False) if not ours]
    rate = found.frame_rate if frame_rate is None else frame_rate
    frames = columns.pop("frame")
    t = _seconds(frames, 0.4) if rate is None else (frames - frames.min()) / rate
    table = RawTable(
        str(path), {"t": t, **columns}, found.lines, header=found.header, unused=unused
    )
    notes += _odd_speeds(columns, frames, t, rate)
    if not assumed:
        refuse_exchanged(table, frames)
    return table, notes


def _boxes(last: str) -> str:
    """Describe rows of ten columns (bounding boxes), and how to convert them, for an error."""
    of_sdd = last.strip("\"'").isalpha()
    names, middle = (_SDD, "(xmin + xmax)/2, (ymin + ymax)/2") if of_sdd else (_MOT, _FEET)
    return (
        f"10 columns, as in the {'Stanford Drone Dataset' if of_sdd else 'MOTChallenge'}: "
        f"{names}. These are boxes in pixels: write rows of frame, id, {middle}; "
        "from_eth_ucy(path, frame_rate=30, homography=...) takes metres per pixel, or a matrix"
    )


def _odd_speeds(
    columns: Mapping[str, Array], frames: Array, t: Array, rate: float | None
) -> list[str]:
    """Return a sentence if positions seem pixels, or frames of a video annotations."""
    moved = exchanged.median_step(columns["id"], frames, columns["x"], columns["y"])
    times, steps = np.diff(np.unique(t)), np.diff(np.unique(frames))
    if moved is None or not len(times):
        return []
    speed = moved / float(np.median(times))
    if speed > _PIXELS:
        return [
            f"people move by {speed:.3g} a second (median): pixels? homography=... takes the "
            "matrix (3, 3) to metres, its file, or metres per pixel"
        ]
    if rate is not None or np.min(steps) != 1.0 or speed >= CREEPING:
        return []
    return [
        f"people walk at {speed:.2g} m/s (median) if a step of frame numbers takes 0.4 s: "
        "frames of a video? frame_rate=25 says how many there are in a second"
    ]


def _exchanged(columns: dict[str, Array], names: Sequence[str]) -> list[str]:
    """Exchange frames and ids if people then move less from row to row; return what was found.

    Files of PeTrack have the columns of ETH and UCY in another order: id, frame, x, y.
    """
    found = exchanged.steps(columns)
    if found is None:
        return []
    read, other = found
    columns["id"], columns["frame"] = columns["frame"], columns["id"]
    seen = "no one is there twice" if read is None else f"steps of {read:.3g} m (median)"
    return [
        f"the first column is read as the {names[1]}, the second as the {names[0]}: the other way "
        f"round there are {seen}, instead of {other:.3g} m"
    ]


def split_robot(table: RawTable, robot: int | str | None) -> tuple[RawTable | None, RawTable]:
    """Return one person of a table as the robot, and the others.

    Raises:
        UnknownNameError: there is no such person.
    """
    if robot is None:
        return None, table
    ids = np.array([str(int(i)) for i in table.columns["id"]])
    mine = ids == str(robot)
    if not mine.any():
        raise UnknownNameError("person", str(robot), sorted(set(ids), key=int))
    order = np.flatnonzero(mine)[np.argsort(np.asarray(table.columns["t"])[mine])]
    own = {n: np.asarray(c)[order] for n, c in table.columns.items() if n != "id"}
    begin, end = own["t"][0], own["t"][-1]
    t = np.asarray(table.columns["t"])
    there = np.flatnonzero(~mine & (t >= begin) & (t <= end))
    others = {n: np.asarray(c)[there] for n, c in table.columns.items()}
    return RawTable(f"{table.name}, person {robot}", own), RawTable(table.name, others)


def _seconds(frames: Any, step: float) -> Any:
    """Return times of frames; the most frequent frame step equals ``step`` seconds."""
    between = np.diff(np.unique(frames))
    if not len(between):
        return np.zeros(len(frames))
    values, counts = np.unique(between, return_counts=True)
    return (frames - frames.min()) / values[np.argmax(counts)] * step


def _once(table: RawTable) -> RawTable:
    """Return the table without duplicates: overlapping scenes list a track twice."""
    keys = list(zip(table.columns["id"], table.columns["t"], strict=True))
    first = sorted({k: i for i, k in reversed(list(enumerate(keys)))}.values())
    columns = {n: np.asarray(c)[first] for n, c in table.columns.items()}
    return RawTable(table.name, columns, [table.lines[i] for i in first])

"""Files that hold people alone, tables and data sets: one reader for all commands."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

from crowdbot.core.support.text_files import LARGEST_TABLE, input_text
from crowdbot.core.trajectories.data_sets.homography import AS_STATED, VideoScale, in_metres
from crowdbot.core.trajectories.data_sets.jupedsim_output import ENDINGS as DATABASES
from crowdbot.core.trajectories.data_sets.readers import WIDTHS, eth_ucy_table, trajnet_table
from crowdbot.core.trajectories.data_sets.splines import is_spline_file
from crowdbot.core.trajectories.own_recordings import AGENT, columns_of
from crowdbot.core.trajectories.raw_table import RawTable
from crowdbot.core.trajectories.recording_options import DEFAULTS
from crowdbot.core.trajectories.table_columns.frames import in_seconds
from crowdbot.core.trajectories.table_columns.names import FRAMES, chosen
from crowdbot.core.trajectories.table_columns.robots import without_robots
from crowdbot.core.trajectories.table_columns.units import without_units
from crowdbot.core.trajectories.table_columns.wide import columns_of_people
from crowdbot.core.trajectories.text_table import COMMENTS, TextTable, read_table, split
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError, RecordingWarning

#: Endings of such files.
ENDINGS = (".csv", ".tsv", ".ndjson", ".txt", ".vsp", *DATABASES)
_FOR_COLUMNS = ("agent_radius", "agent_mass", "resample", "clock_offset", "max_gap")


def people_table(path: Path, scale: VideoScale = AS_STATED) -> RawTable:
    """Read the people of a file.

    Args:
        path: a table t,id,x,y with a header (or a comment) that names its columns; TrajNet++
            (``.ndjson``); ETH, UCY, PeTrack or JuPedSim (``.txt``, ``.vsp``, ``.sqlite``).
        scale: of positions and numbers of frames; what the file states holds otherwise.

    Returns:
        t (s, or stamps), id, x, y (m), a row for each person and sample.

    Raises:
        InputError: it cannot be read, or is of another format.
    """
    form = _form(path)
    if form == "trajnet":
        return in_metres(trajnet_table(path, None, scale.frame_rate), scale.homography)
    if form == "data set":
        table, notes = eth_ucy_table(path, scale.frame_rate, scale.homography)
        return replace(table, notes=[*table.notes, *(f"{path}: {note}" for note in notes)])
    table = without_robots(read_table(path, {}, AGENT))
    table.require("", *AGENT[:4])
    placed = in_metres(table, scale.homography)
    return in_seconds({"agents": placed}, scale.frame_rate)["agents"]


def people_run(table: RawTable, notes: Sequence[str]) -> Trajectories:
    """Return people as trajectories; warn with notes and of implausible numbers.

    Raises:
        InputError: a cell is not a number, or a person is in two places at a time.
    """
    how = {name: DEFAULTS[name] for name in _FOR_COLUMNS}
    run = Trajectories.from_arrays(**columns_of(None, table, None, None, **how))
    for text in (*notes, *run.implausible()):
        warnings.warn(text, RecordingWarning, stacklevel=3)
    return run


def holds_people(path: Path, text: str) -> bool:
    """Return True for the text of such a file: its columns are named, or it is a data set's."""
    if path.suffix.lower() in (".ndjson", ".vsp", *DATABASES):
        return True
    try:
        table = split(path, _head(text))
        named = _named(path, table)
    except InputError:
        return False
    plain = path.suffix.lower() == ".txt" and not table.header and len(table.rows[0]) in WIDTHS
    wide = columns_of_people(RawTable(str(path), dict.fromkeys(named, ())), table.header)
    return plain or bool(wide) or {"t", "id", "x", "y"} <= set(named)


def _head(text: str) -> str:
    """Return the lines up to the second row: those that say what a table is."""
    head: list[str] = []
    rows = 0
    for line in text.splitlines():
        head.append(line)
        rows += bool(line.strip()) and not line.lstrip().startswith(COMMENTS)
        if rows == 2:
            break
    return "\n".join(head)


def _form(path: Path) -> Literal["table", "data set", "trajnet"]:
    """Return which reader a file is for; a text whose columns have times is a table."""
    ending = path.suffix.lower()
    if ending == ".txt":
        text = input_text(path, LARGEST_TABLE)
        if is_spline_file(path, text):
            return "data set"
        named = _named(path, split(path, _head(text)))
        timed = named.get("t", FRAMES[0]) not in FRAMES
        return "table" if timed and {"id", "x", "y"} <= set(named) else "data set"
    if ending == ".ndjson":
        return "trajnet"
    return "data set" if ending in (".vsp", *DATABASES) else "table"


def _named(path: Path, table: TextTable) -> dict[str, str]:
    """Return our names of columns and what the file calls them, in lower case."""
    header = without_units(table.header)
    found = chosen(str(path), header, {}, AGENT, spelled=table.header)
    return {ours: header[at].lower() for ours, at in found.items()}

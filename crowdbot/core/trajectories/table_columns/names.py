"""Find our columns in a table by their names."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from crowdbot.core.support.arguments import expect
from crowdbot.core.trajectories.raw_table import ColumnNames
from crowdbot.errors import InputError, did_you_mean, nearest

#: Names of a column with numbers of frames, in lower case.
FRAMES = ("frame", "fr", "frames", "frame_id", "frameid", "frame_number")
#: Our name -> other names that are usual, in lower case; taken if ours is not there.
USUAL_NAMES: Mapping[str, Sequence[str]] = {
    "t": (
        "time", "timestamp", "time_stamp", "stamp", "simsec", "simtime", "sim_time", "elapsed",
        "elapsed_time", *FRAMES,
    ),
    **{
        axis: (
            f"coordcent{axis}", f"start{axis}", f"pos_{axis}", f"position_{axis}", f"p{axis}",
            f"t{axis}", f"{axis}center", f"{axis}_center", f"center_{axis}", f"c{axis}",
            f"{axis}_pos", f"{axis}pos", f"pos{axis}", f"{axis}_position", f"position{axis}",
            f"{axis}_coord", f"coord_{axis}", f"loc_{axis}", f"{axis}_world", f"world_{axis}",
        )
        for axis in "xy"
    },
    "vx": ("vel_x", "velocity_x", "v_x"),
    "vy": ("vel_y", "velocity_y", "v_y"),
    "theta": ("yaw", "heading"),
    "w": ("omega", "yaw_rate"),
    "id": (
        "persid", "personid", "person_id", "ped_id", "pedestrian_id", "agent_id", "track_id",
        "pers", "person", "pedestrian", "pedestrianid", "agent", "agentid", "trackid", "human_id",
        "pedid", "ped", "p_id", "human", "actor_id", "actor", "object_id", "obj_id",
    ),
}  # fmt: skip
#: Our name -> how fields of ROS messages end that mean the same.
_FIELDS = {
    "t": re.compile(r"^(?:%|__)time$"),
    **{axis: re.compile(rf"(?:^|[./_])position[./_]{axis}$|^p_\w+_{axis}$") for axis in "xy"},
}


def chosen(
    name: str,
    header: Sequence[str],
    names: ColumnNames,
    known: Iterable[str],
    spelled: Sequence[str] = (),
) -> dict[str, int]:
    """Return our column names -> their index: the given name, ours, ours in capitals, a usual one.

    Args:
        name: of the table, for messages.
        header: names of the columns there, without units.
        names: our name -> the name there, if the user gave one.
        known: our names.
        spelled: names there, with units.

    Raises:
        InputError: a given name is not one of ours, or not there; or two columns have one name.
    """
    known = list(known)
    for ours, theirs in names.items():
        expect("a column's name", theirs, str)
        if ours not in known:
            raise InputError(
                f"columns: '{ours}' is not a column of ours{did_you_mean(nearest(ours, known))}; "
                f"there are {', '.join(known)}"
            )
        if theirs not in header and theirs not in spelled:
            near = did_you_mean(nearest(theirs, header))
            raise InputError(f"{name}:1: there is no column '{theirs}'{near}")
    lower = [column.lower() for column in header]
    found: dict[str, int] = {}
    for ours in known:
        given = names.get(ours)
        if given is not None:
            found[ours] = header.index(given) if given in header else spelled.index(given)
            continue
        taken = [names.get(other) for other in known]
        for theirs in (ours, *USUAL_NAMES.get(ours, ())):
            where = header if theirs in header else lower
            if theirs in where and header[where.index(theirs)] not in taken:
                found[ours] = where.index(theirs)
                break
        else:
            found |= _in_messages(ours, lower)
    refuse_twins(name, header, found.values())
    return found


def _in_messages(ours: str, header: Sequence[str]) -> dict[str, int]:
    """Return the one column that is a field of a message of ROS: ``/odom/pose/pose/position/x``.

    ``rostopic echo -p`` writes ``%time`` and dots, PlotJuggler ``__time`` and slashes.
    """
    end = _FIELDS.get(ours)
    found = [] if end is None else [i for i, name in enumerate(header) if end.search(name)]
    return {ours: found[0]} if len(found) == 1 else {}


def refuse_twins(name: str, header: Sequence[str], used: Iterable[int]) -> None:
    """Refuse a table in which a column that is used shares its name with another one.

    Raises:
        InputError: that is so.
    """
    for i in used:
        if list(header).count(header[i]) > 1:
            raise InputError(f"{name}:1: two columns are called '{header[i]}'; rename one")

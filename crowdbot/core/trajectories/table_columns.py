"""Match the columns of a table with ours: names, units, frames, wide tables."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import crowdbot.core.trajectories.plausibility.exchanged as exchanged
from crowdbot.core.support.arguments import expect, number_of
from crowdbot.core.trajectories.message_columns import joined, nanosecond_halves
from crowdbot.core.trajectories.plausibility.times import PERSON_SPEED
from crowdbot.core.trajectories.raw_table import Cells, ColumnNames, Ids, RawTable, as_number
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError, did_you_mean, kind_of, nearest

#: Names of a column with numbers of frames, in lower case.
FRAMES = ("frame", "fr", "frames", "frame_id", "frameid", "frame_number")
#: Our name -> other names that are usual, in lower case; taken if ours is not there.
USUAL_NAMES: Mapping[str, Sequence[str]] = {
    "t": ("time", "timestamp", "time_stamp", "stamp", "simsec", "simtime", *FRAMES),
    "x": ("coordcentx", "startx", "pos_x", "position_x", "px", "tx", "xcenter"),
    "y": ("coordcenty", "starty", "pos_y", "position_y", "py", "ty", "ycenter"),
    "vx": ("vel_x", "velocity_x", "v_x"),
    "vy": ("vel_y", "velocity_y", "v_y"),
    "theta": ("yaw", "heading"),
    "w": ("omega", "yaw_rate"),
    "id": (
        "persid", "personid", "person_id", "ped_id", "pedestrian_id", "agent_id", "track_id",
        "pers", "person", "pedestrian", "pedestrianid", "agent", "agentid", "trackid", "human_id",
    ),
}  # fmt: skip
#: Our name -> how fields of ROS messages end that mean the same.
_FIELDS = {
    "t": re.compile(r"^(?:%|__)time$"),
    **{axis: re.compile(rf"(?:^|[./_])position[./_]{axis}$|^p_\w+_{axis}$") for axis in "xy"},
}
#: Vadere's columns end in the number of what wrote them: ``startX-PID1``.
_PROCESSOR = re.compile(r"-PID\d+$")
_LENGTHS = ("x", "y", "vx", "vy", "radius")
#: Columns that may be in another unit than ours, by themselves.
_OTHERS = ("t", "theta", "w")
#: Unit of lengths -> metres.
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001}
#: Unit of times and angles -> seconds, rad.
_SCALES = {
    "s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9,
    "rad": 1.0, "deg": math.pi / 180.0, "°": math.pi / 180.0, "degrees": math.pi / 180.0,
}  # fmt: skip
_UNIT = re.compile(
    rf"^(.*?)\s*(?:/|\[|\(|_in_)\s*({'|'.join([*_METRES, *_SCALES])})(?:/s)?\s*[\])]?$",
    re.IGNORECASE,
)
_UNIT_IN_TEXT = re.compile(
    r"\b(?:in|units?|lengths?|positions?)\s*(?:is|are|in|[:=])*\s*\(?"
    r"(mm|cm|m|millimet(?:er|re)s?|centimet(?:er|re)s?|met(?:er|re)s?)\b", re.IGNORECASE
)  # fmt: skip
#: Columns of a wide table: x1, x_1, x[1], 1_x, ped1_x, 1.x.
_WIDE = (
    re.compile(r"^(?P<axis>[xy])[_\[( ]?(?P<who>\d+)[\])]?$", re.IGNORECASE),
    re.compile(r"^(?P<axis>[xy])_(?P<who>\w+)$", re.IGNORECASE),
    re.compile(r"^(?P<who>\w+)[_. ](?P<axis>[xy])$", re.IGNORECASE),
)
#: What has x and y, and is not a person of a wide table.
_NO_PERSON = re.compile(
    r"^(?:pos(?:ition)?|loc(?:ation)?|(?:v|vel(?:ocity)?|speed|acc(?:el(?:eration)?)?|force)"
    r"|goal|target|orientation|q|quat(?:ernion)?|dir(?:ection)?|size|offset|gaze|head)s?\d*$",
    re.IGNORECASE,
)
#: A unit at the end of a name: ``t_ms``, ``yaw_deg``, ``pos_x_mm``, ``radius_cm``.
_ENDING = re.compile(
    r"^((?:t|time|timestamp|time_stamp|stamp|theta|yaw|heading|w|omega|yaw_rate)"
    r"(?=_(?:s|sec|ms|us|ns|rad|deg)$)"
    r"|(?:(?:pos_|position_|t)?[xy]|v[xy]|vel_[xy]|radius)(?=_(?:mm|cm|m)$))"
    r"_(s|sec|ms|us|ns|rad|deg|mm|cm|m)$",
    re.IGNORECASE,
)
#: Columns that say nothing about the plane, or number the rows.
_NEEDLESS = ("z", "tz", "pos_z", "pz", "point", "geometry", "", "index", "unnamed: 0")
_HEIGHT = re.compile(r"(?:^|[./_])position[./_]z$|^p_\w+_z$")
#: Columns that say what moves, and what they say of people, in lower case.
_KINDS = ("type", "object_type", "agent_type", "class", "label", "category", "classification")
_PEOPLE = {
    "ped",
    "peds",
    "pedestrian",
    "pedestrians",
    "person",
    "people",
    "human",
    "adult",
    "child",
}
#: Most columns that are told by name.
_MOST_NAMED = 12
#: Least extent of x and z, m, if y seems to be the height.
_FLAT = 0.5
#: Prefixes of numbers of people.
_PERSON = re.compile(r"^(?:p|ped|pedestrian|person|agent|id|human)_?(\d+)$", re.IGNORECASE)


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
    _refuse_twins(name, header, found.values())
    return found


def _in_messages(ours: str, header: Sequence[str]) -> dict[str, int]:
    """Return the one column that is a field of a message of ROS: ``/odom/pose/pose/position/x``.

    ``rostopic echo -p`` writes ``%time`` and dots, PlotJuggler ``__time`` and slashes.
    """
    end = _FIELDS.get(ours)
    found = [] if end is None else [i for i, name in enumerate(header) if end.search(name)]
    return {ours: found[0]} if len(found) == 1 else {}


def _refuse_twins(name: str, header: Sequence[str], used: Iterable[int]) -> None:
    for i in used:
        if list(header).count(header[i]) > 1:
            raise InputError(f"{name}:1: two columns are called '{header[i]}'; rename one")


def without_unit(column: str) -> str:
    """Return the name of a column without its unit: ``x/cm``, ``x [cm]``, ``x(cm)``."""
    column = _PROCESSOR.sub("", column)
    match = _UNIT.match(column) or _ENDING.match(column)
    return match[1] if match is not None and match[1] else column


def without_units(header: Sequence[str]) -> list[str]:
    """Return names of columns without units, but for nanoseconds that belong to seconds."""
    halves = nanosecond_halves(header)
    return [name if i in halves else without_unit(name) for i, name in enumerate(header)]


def unit_in(column: str) -> float | None:
    """Return the unit that a column's name states, in m, s or rad; None if it states none."""
    match = _UNIT.match(column) or _ENDING.match(column)
    if match is None:
        return length_unit(column)
    word = match[2].lower()
    return _METRES[word] if word in _METRES else _SCALES[word]


def length_unit(text: str) -> float | None:
    """Return metres in the unit that a comment states; None if it states none."""
    match = _UNIT_IN_TEXT.search(text)
    if match is None:
        match = _UNIT.match(text)
        return None if match is None else _METRES.get(match[2].lower())
    word = match[1].lower()
    return _METRES[word if word in _METRES else {"mi": "mm", "ce": "cm", "me": "m"}[word[:2]]]


def unit_of(ours: str, column: str, of_lengths: float) -> float:
    """Return the unit of a column in ours: its own, or that of all lengths of the table."""
    own = unit_in(column)
    return own if own is not None else of_lengths if ours in _LENGTHS else 1.0


def scaled(name: str, ours: str, cells: Cells, unit: float, lines: Sequence[int]) -> Cells:
    """Return a column in metres, seconds or rad, if it is in another unit."""
    if unit == 1.0 or ours not in (*_LENGTHS, *_OTHERS):
        return cells
    table = RawTable(name, {ours: cells}, lines)
    return table.numbers(ours) * unit


def frame_table(name: str, frame: Any, names: ColumnNames, known: Iterable[str]) -> RawTable:
    """Read a pandas data frame, any mapping of columns, or trajectories of PedPy.

    Args:
        name: name for messages.
        frame: object with columns by name; or with such ``data`` and a ``frame_rate``.
        names: our name -> the frame's name, if different.
        known: our names; other columns are named in the table's notes.

    Raises:
        InputError: it is not a frame, or lacks a named column.
    """
    rate = getattr(frame, "frame_rate", None) if hasattr(frame, "data") else None
    frame = frame.data if rate is not None else frame
    try:
        spelled = [str(c) for c in frame]
        header = without_units(spelled)
        made = chosen(name, header, names, known, spelled)
        keys = dict(zip(header, frame, strict=True))

        def cells(column: str) -> Cells:
            return np.asarray(_plain(frame[keys[column]]))

        columns = {
            ours: scaled(name, ours, cells(header[i]), unit_of(ours, spelled[i], 1.0), ())
            for ours, i in made.items()
        }
    except (TypeError, KeyError) as error:
        raise InputError(f"{name}: a data frame is wanted, not {kind_of(frame)}") from error
    if len({len(c) for c in columns.values()}) > 1:
        raise InputError(f"{name}: its columns differ in length")
    counts = "t" in made and header[made["t"]].lower() in FRAMES
    raw = RawTable(name, columns, header=spelled, frame_rate=rate, counts_frames=counts)
    raw, more = joined(raw, made, lambda place: cells(header[place]), known)
    return completed(raw, header, cells, 1.0, {*made.values(), *more}, wide="id" in known)


def _plain(series: Any) -> Any:
    """Convert stamps with a zone to UTC."""
    if getattr(getattr(series, "dtype", None), "tz", None) is not None:
        return series.dt.tz_convert("UTC").dt.tz_localize(None).to_numpy()
    return series


def not_used(columns: Iterable[str]) -> list[str]:
    """Return a sentence that names columns which are not read, if they could matter."""
    names = ((column, without_unit(column).lower()) for column in columns)
    left = [column for column, name in names if name not in _NEEDLESS and not _HEIGHT.search(name)]
    if not left:
        return []
    more = f" and {len(left) - _MOST_NAMED} more" if len(left) > _MOST_NAMED else ""
    return [
        f"the column{'s' if len(left) > 1 else ''} {', '.join(left[:_MOST_NAMED])}{more} "
        f"{'are' if len(left) > 1 else 'is'} not used"
    ]


def completed(
    table: RawTable,
    header: Sequence[str],
    cells: Callable[[str], Cells],
    unit: float,
    used: Iterable[int],
    *,
    wide: bool,
) -> RawTable:
    """Return a table in rows, whose notes name the columns that are not used.

    Args:
        table: what was found under our names.
        header: names of its columns, without units.
        cells: returns a column by name.
        unit: metres in the unit of lengths.
        used: places of the columns that were found.
        wide: True if it may have two columns for each person.

    Raises:
        InputError: a person has two columns of one name, or a number has x without y.
    """
    people = _columns_of_people(table, header) if wide else {}
    kinds, others = _not_people(header, cells) if wide else (set(), [])
    read = {*used, *kinds, *(header.index(c) for axes in people.values() for c in axes.values())}
    notes = not_used(table.header[i] for i in range(len(header)) if i not in read)
    notes += others + _height_is_y(table, header, cells)
    table = replace(table, notes=[*table.notes, *(f"{table.name}: {note}" for note in notes)])
    return _in_rows(table, people, cells, unit) if people else table


def _not_people(header: Sequence[str], cells: Callable[[str], Cells]) -> tuple[set[int], list[str]]:
    """Return the places of columns of kinds, and a sentence if they hold others than people."""
    places = {i for i, column in enumerate(header) if column.lower() in _KINDS}
    found = {i: sorted({str(cell).strip() for cell in cells(header[i])}) for i in places}
    notes = [
        f"the column {header[i]} says {', '.join(kinds[:6])}: all rows are read as people; leave "
        "out those that are not"
        for i, kinds in found.items()
        if not {kind.lower() for kind in kinds} <= _PEOPLE
    ]
    return places, notes


def _height_is_y(
    table: RawTable, header: Sequence[str], cells: Callable[[str], Cells]
) -> list[str]:
    """Return a sentence if y never changes and z does: motion capture and Unity have y upwards."""
    z = next((column for column in header if column.lower() in ("z", "tz")), None)
    if z is None or not {"x", "y"} <= set(table.columns):
        return []
    try:
        x, y = table.numbers("x"), table.numbers("y")
        depth = RawTable(table.name, {"z": cells(z)}, table.lines).numbers("z")
    except InputError:
        return []  # told where the column is read; nothing reads z
    spans = [float(np.nanmax(v) - np.nanmin(v)) if np.isfinite(v).any() else 0.0
             for v in (x, y, depth)]  # fmt: skip
    if spans[1] > 0.0 or min(spans[0], spans[2]) < _FLAT:
        return []
    return [f"y is {y[0]:g} m in all rows, and z is not: is y upwards? Exchange their names"]


def _columns_of_people(table: RawTable, header: Sequence[str]) -> dict[str, dict[str, str]]:
    """Return x and y of each person, if the table of people has two columns for each."""
    if any(name in table for name in ("id", "x", "y")) or "t" not in table:
        return {}
    people: dict[str, dict[str, str]] = {}
    for column in header:
        match = next((m for pattern in _WIDE if (m := pattern.match(column))), None)
        if match is not None and not _NO_PERSON.match(match["who"]):
            people.setdefault(match["who"], {})[match["axis"].lower()] = column
    _refuse_halves(table.name, header, people)
    return {person: axes for person, axes in people.items() if len(axes) == 2}


def _in_rows(
    table: RawTable,
    people: Mapping[str, Mapping[str, str]],
    cells: Callable[[str], Cells],
    unit: float,
) -> RawTable:
    """Return one row for each person and time."""
    tracks = [
        (_number(person), cells(axes["x"]), cells(axes["y"])) for person, axes in people.items()
    ]
    rows = [
        (k, person, x[k], y[k])
        for k in range(len(table))
        for person, x, y in tracks
        if _is_there(x[k]) and _is_there(y[k])
    ]
    times = table.columns["t"]
    places = {"x": [row[2] for row in rows], "y": [row[3] for row in rows]}
    lines = [table.lines[row[0]] for row in rows] if len(table.lines) else []
    long = RawTable(table.name, {
        "t": times[[row[0] for row in rows]] if isinstance(times, np.ndarray)
        else [times[row[0]] for row in rows],
        "id": [row[1] for row in rows], **places,
    }, lines)  # fmt: skip
    if unit != 1.0:
        long = replace(long, columns={**long.columns, **{n: long.numbers(n) * unit for n in "xy"}})
    return replace(table, columns=long.columns, lines=lines)


def _refuse_halves(
    name: str, header: Sequence[str], people: Mapping[str, Mapping[str, str]]
) -> None:
    columns = [(person, axes, axis) for person, axes in people.items() for axis in axes]
    _refuse_twins(name, header, [header.index(axes[axis]) for _, axes, axis in columns])
    if not any(len(axes) == 2 for axes in people.values()):
        return
    for person, axes, axis in columns:
        if len(axes) == 1 and _number(person).isdigit():
            other = "y" if axis == "x" else "x"
            raise InputError(f"{name}:1: column '{axes[axis]}' has none for {other} beside it")


def _number(person: str) -> str:
    match = _PERSON.match(person)
    return match[1] if match is not None else person


def _is_there(cell: Any) -> bool:
    try:
        return not math.isnan(as_number(cell))
    except (TypeError, ValueError):
        return True  # its line is named when it is read


def whole_numbers(table: RawTable, *columns: str) -> None:
    """Require columns of whole numbers, where the order of columns is assumed.

    Raises:
        InputError: a frame or an id is not a whole number, so the columns have another order.
    """
    for name in columns:
        numbers = table.numbers(name)
        odd = np.flatnonzero(numbers != np.round(numbers))
        if len(odd):
            raise InputError(
                f"{table.where(int(odd[0]))}: nothing names the columns, and {numbers[odd[0]]:g} "
                f"cannot be {'an id' if name == 'id' else 'the number of a frame'}: write their "
                "names above them, such as '# id frame x/m y/m z/m'"
            )


def refuse_exchanged(table: RawTable, frames: Array) -> None:
    """Raise an error if ids and frames seem exchanged: people would move far less if they were.

    Args:
        table: t in s, id, x, y.
        frames: (K,).

    Raises:
        InputError: that is so, and they move faster than anyone.
    """
    columns = {name: table.numbers(name) for name in ("id", "x", "y")}
    found = exchanged.steps({**columns, "frame": frames})
    times = np.unique(table.numbers("t"))
    if found is None or found[0] is None or len(times) < 2:
        return
    speeds = [step / float(np.median(np.diff(times))) for step in found if step is not None]
    if speeds[0] > PERSON_SPEED:
        raise InputError(
            f"{table.name}: people move at {speeds[0]:.3g} m/s (median), and by {found[1]:.2g} m "
            f"from row to row instead of {found[0]:.2g} if columns of ids and frames are "
            "exchanged: exchange their names"
        )


def in_seconds(tables: Mapping[str, RawTable], frame_rate: float | None) -> Mapping[str, RawTable]:
    """Convert times in tables from frame numbers to s.

    Args:
        tables: tables by kind.
        frame_rate: frames per second; None: as the table states, else times are in seconds, or
            stamps.

    Raises:
        InputError: the rate is not positive or not known, or there are stamps.
    """
    if frame_rate is not None and number_of("frame_rate", frame_rate, "1/s") <= 0.0:
        raise InputError(f"frame_rate is a number of frames per second, not {frame_rate!r}")
    made = {}
    for name, table in tables.items():
        rate = frame_rate
        if rate is None and table.counts_frames:
            rate = table.frame_rate
            if rate is None:
                raise InputError(
                    f"{table.name}: times are numbers of frames; a comment above the header, "
                    "'# framerate: 25', or frame_rate=25 (--frame-rate 25) says how many there "
                    "are in a second"
                )
        made[name] = table if rate is None else _without_frames(table, rate)
        if table.counts_frames and name == "agents" and {"id", "x", "y"} <= set(table.columns):
            ids = Ids(table).rows.astype(float)
            seconds = replace(made[name], columns={**made[name].columns, "id": ids})
            refuse_exchanged(seconds, table.times()[0])
    return made


def _without_frames(table: RawTable, frame_rate: float) -> RawTable:
    seconds = {}
    for name in {"t", "t0", "t1"} & set(table.columns):
        frames, stamped = table.times(name)
        if stamped:
            raise InputError(f"{table.where(0)}: {name} holds stamps; frame_rate is for frames")
        seconds[name] = frames / frame_rate
    return replace(table, columns={**table.columns, **seconds})

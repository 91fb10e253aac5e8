"""Tables in rows: what they hold besides our columns, and sentences on it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np

from crowdbot.core.trajectories.raw_table import Cells, RawTable
from crowdbot.core.trajectories.table_columns.robots import is_robot
from crowdbot.core.trajectories.table_columns.units import without_unit
from crowdbot.core.trajectories.table_columns.wide import columns_of_people, in_rows
from crowdbot.errors import InputError

#: Columns that say nothing about the plane, or number the rows.
_NEEDLESS = ("z", "tz", "pos_z", "pz", "point", "geometry", "", "index", "unnamed: 0")
_HEIGHT = re.compile(r"(?:^|[./_])position[./_]z$|^p_\w+_z$")
#: Columns that say what moves, and what they say of people, in lower case.
_KINDS = (
    "type", "object_type", "agent_type", "entity", "kind", "class", "label", "category",
    "classification",
)  # fmt: skip
_PEOPLE = {
    "ped",
    "peds",
    "pedestrian",
    "pedestrians",
    "person",
    "people",
    "human",
    "agent",
    "adult",
    "child",
}
#: Most columns that are told by name.
_MOST_NAMED = 12
#: Names of the sides of boxes.
_SIDES = (("w", "h"), ("width", "height"), ("bb_width", "bb_height"))
#: Least extent of x and z, m, if y seems to be the height.
_FLAT = 0.5
#: Least extent of z, m, if a camera seems to look along it.
_AHEAD = 0.3


def sentences(table: RawTable) -> list[str]:
    """Return the notes of a table, and a sentence on columns that are not used and could matter."""
    names = ((column, without_unit(column).lower()) for column in table.unused)
    left = [column for column, name in names if name not in _NEEDLESS and not _HEIGHT.search(name)]
    if not left:
        return [*table.notes]
    more = f" and {len(left) - _MOST_NAMED} more" if len(left) > _MOST_NAMED else ""
    message = (
        f"the column{'s' if len(left) > 1 else ''} {', '.join(left[:_MOST_NAMED])}{more} "
        f"{'are' if len(left) > 1 else 'is'} not used"
    )
    return [f"{table.name}: {message}", *table.notes]


def completed(
    table: RawTable,
    header: Sequence[str],
    cells: Callable[[str], Cells],
    unit: float,
    used: Iterable[int],
    *,
    wide: bool,
) -> RawTable:
    """Return a table in rows, with the columns that are not used and notes on odd ones.

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
    people = columns_of_people(table, header) if wide else {}
    kinds, others = _not_people(header, cells) if wide else ([], [])
    read = {*used, *kinds, *(header.index(c) for axes in people.values() for c in axes.values())}
    unused = [table.header[i] for i in range(len(header)) if i not in read]
    notes = others + _height_is_y(table, header, cells) + (_boxes(table, header) if wide else [])
    table = replace(
        table,
        notes=[*table.notes, *(f"{table.name}: {note}" for note in notes)],
        unused=unused,
        kinds=() if people or not kinds else cells(header[kinds[0]]),
    )
    return in_rows(table, people, cells, unit) if people else table


def _not_people(
    header: Sequence[str], cells: Callable[[str], Cells]
) -> tuple[list[int], list[str]]:
    """Return indices of columns with object types, and notes on types other than people."""
    places = [i for i, column in enumerate(header) if column.lower() in _KINDS]
    found = {i: sorted({str(cell).strip() for cell in cells(header[i])}) for i in places}
    notes = []
    for i, kinds in found.items():
        of_people = [kind for kind in kinds if not is_robot(kind)]
        if not {kind.lower() for kind in of_people} <= _PEOPLE:
            notes.append(
                f"the column {header[i]} says {', '.join(of_people[:6])}: all rows are read as "
                "people; leave out those that are not"
            )
    return places, notes


def _boxes(table: RawTable, header: Sequence[str]) -> list[str]:
    """Return a sentence if x and y seem to be corners of boxes, such as those of detections."""
    lower = {column.lower() for column in header}
    if not {"x", "y"} <= lower & set(table.columns):
        return []
    sides = next((names for names in _SIDES if set(names) <= lower), None)
    if sides is None:
        return []
    return [
        f"x and y beside {' and '.join(sides)}: corners of boxes? People stand at "
        f"x + {sides[0]}/2, y + {sides[1]}"
    ]


def _height_is_y(
    table: RawTable, header: Sequence[str], cells: Callable[[str], Cells]
) -> list[str]:
    """Return a sentence if x and y do not seem to span the floor.

    Motion capture and Unity have y upwards, cameras look along z.
    """
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
    if spans[2] > max(_AHEAD, 2.0 * max(spans[:2])):
        return [
            f"z changes by {spans[2]:.2g} m, more than x and y ({spans[0]:.2g} and {spans[1]:.2g} "
            "m): the frame of a camera, which looks along z? Give it as x, and minus x as y"
        ]
    if spans[1] > 0.0 or min(spans[0], spans[2]) < _FLAT:
        return []
    return [f"y is {y[0]:g} m in all rows, and z is not: is y upwards? Exchange their names"]

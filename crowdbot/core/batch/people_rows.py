"""People of one world as rows of numbers, compiled."""

from __future__ import annotations

import math

from crowdbot.core.batch import crowd_tables as c
from crowdbot.core.batch.array_tables import floats1
from crowdbot.core.crowd.state import AGENT_COLUMNS, HEADER_SIZE, PERSON, PRESENT
from crowdbot.core.crowd.traits import TRAITS
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import as_rows
from crowdbot.core.types.arrays import Array, Indices


@kernel
def write_people(crowd: Indices, count: int, out: Array) -> None:
    """Write x, y, vx, vy and radius (M, 5) of all people; NaN for those who are absent.

    Args:
        crowd: (F, 4) entries of a `crowd_table`, of which nothing is read without people.
        count: number of people.
    """
    for i in range(count, out.shape[0]):
        out[i] = math.nan
    if count == 0:
        return
    people = as_rows(
        floats1(crowd, c.FLAT)[HEADER_SIZE : HEADER_SIZE + count * AGENT_COLUMNS], PERSON
    )
    traits = as_rows(floats1(crowd, c.TRAITS), TRAITS)
    for i in range(min(count, out.shape[0])):
        if people[i].waiting != PRESENT:
            out[i] = math.nan
            continue
        out[i, 0], out[i, 1] = people[i].x, people[i].y
        out[i, 2], out[i, 3] = people[i].vx, people[i].vy
        out[i, 4] = traits[i].radius

"""Copies from many worlds into arrays, compiled."""

from __future__ import annotations

import math

from crowdbot.core.batch import crowd_tables as c
from crowdbot.core.batch.array_tables import floats1, floats2
from crowdbot.core.batch.scanner_tables import RANGES
from crowdbot.core.batch.step import FIRST_SCANNER, PEOPLE
from crowdbot.core.crowd.state import AGENT_COLUMNS, HEADER_SIZE, PERSON, PRESENT
from crowdbot.core.crowd.traits import TRAITS
from crowdbot.core.support.compiling.compile import free_kernel
from crowdbot.core.support.records import as_rows
from crowdbot.core.types.arrays import Array, Indices


@free_kernel
def gather_robots(crowds: Indices, out: Array) -> None:
    """Write the rows (W, R, 8) of all robots; see `crowdbot.core.crowd.contact.robot_contact`."""
    for w in range(out.shape[0]):
        rows = floats2(crowds[w], c.ROBOTS)
        for r in range(rows.shape[0]):
            for k in range(rows.shape[1]):
                out[w, r, k] = rows[r, k]


@free_kernel
def gather_people(worlds: Indices, crowds: Indices, out: Array) -> None:
    """Write x, y, vx, vy and radius (W, M, 5) of all people; NaN for those who are absent."""
    for w in range(out.shape[0]):
        crowd, count = crowds[w], worlds[w, PEOPLE]
        people = as_rows(
            floats1(crowd, c.FLAT)[HEADER_SIZE : HEADER_SIZE + count * AGENT_COLUMNS], PERSON
        )
        traits = as_rows(floats1(crowd, c.TRAITS), TRAITS)
        for i in range(out.shape[1]):
            if i >= count or people[i].waiting != PRESENT:
                for k in range(5):
                    out[w, i, k] = math.nan
                continue
            out[w, i, 0], out[w, i, 1] = people[i].x, people[i].y
            out[w, i, 2], out[w, i, 3] = people[i].vx, people[i].vy
            out[w, i, 4] = traits[i].radius


@free_kernel
def gather_ranges(worlds: Indices, scanners: Indices, sensor: int, out: Array) -> None:
    """Write the latest ranges (W, L, B) of one sensor of each world, m."""
    for w in range(out.shape[0]):
        ranges = floats2(scanners[worlds[w, FIRST_SCANNER] + sensor], RANGES)
        for r in range(out.shape[1]):
            for k in range(out.shape[2]):
                out[w, r, k] = ranges[r, k]

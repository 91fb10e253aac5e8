"""Copies from many worlds into arrays, compiled."""

from __future__ import annotations

from crowdbot.core.batch import crowd_tables as c
from crowdbot.core.batch.array_tables import floats2
from crowdbot.core.batch.people_rows import write_people
from crowdbot.core.batch.scanner_tables import RANGES
from crowdbot.core.batch.step import FIRST_SCANNER, PEOPLE
from crowdbot.core.support.compiling.compile import free_kernel
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
def gather_people(which: Indices, worlds: Indices, crowds: Indices, out: Array) -> None:
    """Write the people (W, M, 5) of some worlds, see `write_people`."""
    for k in range(which.shape[0]):
        w = which[k]
        write_people(crowds[w], worlds[w, PEOPLE], out[w])


@free_kernel
def gather_ranges(worlds: Indices, scanners: Indices, sensor: int, out: Array) -> None:
    """Write the latest ranges (W, L, B) of one sensor of each world, m."""
    for w in range(out.shape[0]):
        ranges = floats2(scanners[worlds[w, FIRST_SCANNER] + sensor], RANGES)
        for r in range(out.shape[1]):
            for k in range(out.shape[2]):
                out[w, r, k] = ranges[r, k]

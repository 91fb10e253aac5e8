"""One step of many worlds, compiled: decisions, contacts, motion, robots, readings."""

from __future__ import annotations

import numpy as np

from crowdbot.core.batch import crowd_tables as c
from crowdbot.core.batch.array_tables import floats1, floats2, floats3, ints1
from crowdbot.core.batch.decide import decide
from crowdbot.core.batch.drive import move, watch_goal
from crowdbot.core.batch.encounters import meet, press
from crowdbot.core.batch.people_rows import write_people
from crowdbot.core.batch.robot_tables import DRIVE_STATE
from crowdbot.core.batch.scan import is_due, scan
from crowdbot.core.batch.scanner_tables import OWN, SCANNER
from crowdbot.core.crowd.contact.robot_contact import ROBOT
from crowdbot.core.crowd.state import (
    AGENT_COLUMNS,
    FELT,
    FELT_SIZE,
    HEADER_SIZE,
    PERSON,
    TOUCH_COLUMNS,
)
from crowdbot.core.crowd.step import tick
from crowdbot.core.crowd.traits import TRAITS
from crowdbot.core.support.compiling.compile import free_kernel, kernel
from crowdbot.core.support.records import as_record, as_rows
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Columns of the table of worlds: its first group and their number; likewise of robots and
#: scanners; people; key of noise; ticks of a step; ticks since the
#: start.
FIRST_GROUP, GROUPS, FIRST_SCANNER, SCANNERS, PEOPLE, NOISE_KEY, PERIOD, NOW = range(8)
WORLD_COLUMNS = 8


@free_kernel
def step_worlds(
    commands: Array, least: Array, most: Array, which: Indices, worlds: Indices, crowds: Indices,
    groups: Indices, robots: Indices,
    scanners: Indices, drives: Array, sound: Mask, seen: Array,
) -> None:  # fmt: skip
    """Advance some worlds by a step each, and read the scanners that are due.

    Args:
        commands, least, most: (W, R, 3) v, w, vy of each robot, and its limits, m/s and rad/s.
        which: (K,) rows of worlds.
        worlds: (W, `WORLD_COLUMNS`), changed.
        crowds: (W, F, 4) entries of `crowd_table`.
        groups: (G, F, 4) entries of `group_tables`.
        robots: (W, R, F, 4) entries of `robot_table`.
        scanners: (S, F, 4) entries of `scanner_table`.
        drives: (W, R, D) `DriveStateRecord`, changed.
        sound: (W,) set to False where a cost function returned NaN.
        seen: (W, M, 5) output: people, see `write_people`, while the processor's cache has them;
            nothing with M = 0.
    """
    _command(commands, least, most, drives)
    for k in range(which.shape[0]):
        w = which[k]
        for _ in range(worlds[w, PERIOD]):
            if worlds[w, PEOPLE] > 0:
                own = groups[worlds[w, FIRST_GROUP] : worlds[w, FIRST_GROUP] + worlds[w, GROUPS]]
                if not _advance_people(worlds[w], crowds[w], own):
                    sound[w] = False
            _advance_robots(worlds[w], crowds[w], robots[w], drives[w])
            worlds[w, NOW] += 1
            _read(worlds[w], crowds[w], scanners)
        meet_people(w, worlds, crowds, drives)
        if seen.shape[1] > 0:
            write_people(crowds[w], worlds[w, PEOPLE], seen[w])


@kernel
def _command(commands: Array, least: Array, most: Array, drives: Array) -> None:
    """Set the commands of all robots within their limits, and reset the counters of the step."""
    for w in range(drives.shape[0]):
        for r in range(drives.shape[1]):
            drive, low, high = as_record(drives[w, r], DRIVE_STATE), least[w, r], most[w, r]
            drive.wanted_v = _within(commands[w, r, 0], low[0], high[0])
            drive.wanted_w = _within(commands[w, r, 1], low[1], high[1])
            drive.wanted_vy = _within(commands[w, r, 2], low[2], high[2])
            drive.blocked = drive.touched = drive.since = drive.forced = drive.aside = 0.0


@kernel
def _within(value: float, low: float, high: float) -> float:
    """Return a value within limits; NaN stays NaN."""
    return low if value < low else high if value > high else value


@free_kernel
def step_robots(
    w: int, worlds: Indices, crowds: Indices, robots: Indices, scanners: Indices, drives: Array
) -> None:
    """Advance the robots of one world by a tick, after its people have been advanced."""
    _advance_robots(worlds[w], crowds[w], robots[w], drives[w])
    worlds[w, NOW] += 1
    _read(worlds[w], crowds[w], scanners)


@free_kernel
def read_scanners(which: Indices, worlds: Indices, crowds: Indices, scanners: Indices) -> None:
    """Read the lidars of some worlds that are due at the present tick."""
    for k in range(which.shape[0]):
        _read(worlds[which[k]], crowds[which[k]], scanners)


@free_kernel
def meet_people(w: int, worlds: Indices, crowds: Indices, drives: Array) -> None:
    """Store how much space people have around a world's robots, at the end of a step."""
    crowd, count = crowds[w], worlds[w, PEOPLE]
    rows, outlines = as_rows(floats2(crowd, c.ROBOTS), ROBOT), floats3(crowd, c.OUTLINES)
    people = as_rows(
        floats1(crowd, c.FLAT)[HEADER_SIZE : HEADER_SIZE + count * AGENT_COLUMNS], PERSON
    )
    traits = as_rows(floats1(crowd, c.TRAITS), TRAITS)
    for r in range(rows.shape[0]):
        drive = as_record(drives[w, r], DRIVE_STATE)
        meet(drive, rows[r], outlines, r, people, traits, worlds[w, PERIOD] * TICK)


@kernel
def _advance_people(world: Indices, crowd: Indices, groups: Indices) -> bool:
    """Let people decide if a decision is due, then advance people and contacts by a tick."""
    counts, now, sound = ints1(crowd, c.COUNTS), world[NOW], True
    if now % counts[c.EVERY] == 0:
        sound = decide(crowd, groups, now * TICK)
    tick(
        floats1(crowd, c.FLAT), floats2(crowd, c.ROBOTS), floats3(crowd, c.OUTLINES),
        ints1(crowd, c.NUMBERS), floats1(crowd, c.STIFFNESSES), floats2(crowd, c.DISCS), TICK,
        floats1(crowd, c.TRAITS), floats1(crowd, c.ROUTE), floats1(crowd, c.ORIGIN),
        ints1(crowd, c.ENTRY_ORDER), floats2(crowd, c.WALLS), floats2(crowd, c.ENTRANCE),
        floats2(crowd, c.OUT), floats1(crowd, c.BOUNDARY), floats1(crowd, c.RULES),
        floats1(crowd, c.RESPONSE), np.uint64(counts[c.GOAL_KEY]), floats2(crowd, c.SOLIDS),
        floats1(crowd, c.GRID_FRAME), ints1(crowd, c.GRID_FIRST), ints1(crowd, c.GRID_NEAR),
        floats2(crowd, c.REACTION), floats1(crowd, c.PLACED), ints1(crowd, c.ORDER),
        floats1(crowd, c.ROOM),
    )  # fmt: skip
    return sound


@kernel
def _advance_robots(world: Indices, crowd: Indices, robots: Indices, drives: Array) -> None:
    """Move all robots by a tick; record contacts, pushes, stops at walls and arrivals."""
    flat, people = floats1(crowd, c.FLAT), world[PEOPLE]
    rows = as_rows(floats2(crowd, c.ROBOTS), ROBOT)
    felt_first = HEADER_SIZE + people * AGENT_COLUMNS
    walkers = as_rows(flat[HEADER_SIZE:felt_first], PERSON)
    outlines, traits = floats3(crowd, c.OUTLINES), as_rows(floats1(crowd, c.TRAITS), TRAITS)
    for r in range(rows.shape[0]):
        drive = as_record(drives[r], DRIVE_STATE)
        if people > 0:
            first = felt_first + r * (FELT_SIZE + people * TOUCH_COLUMNS)
            felt = as_record(flat[first:], FELT)
            if felt.robot_fx != 0.0 or felt.robot_fy != 0.0:
                drive.touched += 1.0
            press(drive, rows[r], outlines, r, walkers, traits, floats2(crowd, c.PRESSED)[r], TICK)
        x, y = rows[r].x, rows[r].y
        move(rows[r], drive, robots[r])
        drive.since += TICK
        watch_goal(rows[r], drive, robots[r], x, y)


@kernel
def _read(world: Indices, crowd: Indices, scanners: Indices) -> None:
    """Read a world's scanners that are due."""
    people = as_rows(
        floats1(crowd, c.FLAT)[HEADER_SIZE : HEADER_SIZE + world[PEOPLE] * AGENT_COLUMNS], PERSON
    )
    rows = as_rows(floats2(crowd, c.ROBOTS), ROBOT)
    for k in range(world[SCANNERS]):
        own = scanners[world[FIRST_SCANNER] + k]
        rate = as_record(floats1(own, OWN), SCANNER).rate
        if rate > 0.0 and is_due(world[NOW], rate):
            scan(own, people, rows, world[NOW], np.uint64(world[NOISE_KEY] + k))

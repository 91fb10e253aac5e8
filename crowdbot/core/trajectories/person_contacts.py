"""Contacts of the robot with people: from the recorded table, else from the samples.

The table contains every contact that the simulator or the robot's skin detected. Samples miss short
contacts: a bounce of 30 ms fits between samples 62.5 ms apart.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.trajectories.encounters import (
    Contacts,
    encounter,
    onsets,
    people,
    relative_velocity,
    robot_of,
    robot_velocities,
)
from crowdbot.core.trajectories.fault.touch_point import touch_point
from crowdbot.core.trajectories.preprocess import TIME_TOLERANCE, inf_to_nan
from crowdbot.core.trajectories.tracks import ContactEvents
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class PersonContacts:
    """Contacts with people, by time; each (K,).

    Attributes:
        time: onset, s.
        end: when it ends, s.
        agent: column of the person; -1: not in the table of people.
        sample: last sample before or at the onset.
        speed: relative speed before, m/s; NaN: unknown.
        closing: speed of the robot's touching point towards the person before, m/s; NaN: unknown.
        recorded: True if they are from the table.
    """

    time: Array
    end: Array
    agent: NDArray[np.int64]
    sample: NDArray[np.int64]
    speed: Array
    closing: Array
    recorded: bool

    def __len__(self) -> int:
        """Return the number of contacts."""
        return len(self.time)


def person_contacts(
    run: Trajectories, jump_speed: float, contact_tol: float, release_gap: float
) -> PersonContacts:
    """Return contacts of a run that has a robot and ends at its arrival.

    Args:
        jump_speed: speed that detects teleports if none were recorded, m/s.
        contact_tol, release_gap: for contacts from samples, m; see `encounters.contact_onsets`. A
            table has its own rule for the end of a contact.
    """
    key = "person_contacts", jump_speed, contact_tol, release_gap
    return run.cached(key, lambda: _contacts(run, jump_speed, contact_tol, release_gap))


def _contacts(
    run: Trajectories, jump_speed: float, contact_tol: float, release_gap: float
) -> PersonContacts:
    if run.contacts is not None:
        return _recorded(run, run.contacts, jump_speed)
    found = onsets(run, jump_speed, contact_tol, release_gap)
    vx, vy = (v[found.sample, found.agent] for v in relative_velocity(run, jump_speed))
    unknown = np.full(len(found.time), np.nan)
    return PersonContacts(
        time=found.time,
        end=_ends(run, found, jump_speed, release_gap),
        agent=found.agent,
        sample=found.sample,
        speed=np.hypot(vx, vy),
        closing=_closing(run, found.time, found.agent, found.sample, unknown, jump_speed),
        recorded=False,
    )


def _ends(run: Trajectories, contacts: Contacts, jump_speed: float, release_gap: float) -> Array:
    """Return the last sample times (K,) at which the surfaces are not yet apart, s."""
    pair = encounter(run, jump_speed)
    ends = contacts.time.copy()
    for k, (sample, agent) in enumerate(zip(contacts.sample, contacts.agent, strict=True)):
        near = pair.gap[sample + 1 :, agent] <= release_gap
        near[1:] &= pair.valid[sample + 1 :, agent]
        lasts = len(near) if near.all() else int(near.argmin())
        ends[k] = max(ends[k], run.t[sample + lasts])
    return ends


def _recorded(run: Trajectories, table: ContactEvents, jump_speed: float) -> PersonContacts:
    rows = np.flatnonzero(table.agent >= 0)
    rows = rows[np.lexsort((table.agent[rows], table.t0[rows]))]
    time, agent, ids = table.t0[rows], table.agent[rows], people(run).id
    order = np.argsort(ids)
    slot = np.minimum(np.searchsorted(ids[order], agent), max(len(ids) - 1, 0))
    column = (
        np.where(ids[order][slot] == agent, order[slot], -1)
        if len(ids)
        else np.full(len(agent), -1)
    )
    before = np.searchsorted(run.t, time + TIME_TOLERANCE, side="right") - 1
    sample = np.clip(before, 0, len(run.t) - 1)
    return PersonContacts(
        time=time,
        end=table.t1[rows],
        agent=column,
        sample=sample,
        speed=table.relative_speed[rows],
        closing=_closing(run, time, column, sample, table.bearing[rows], jump_speed),
        recorded=True,
    )


def _closing(
    run: Trajectories,
    time: Array,
    agent: NDArray[np.int64],
    sample: NDArray[np.int64],
    bearing: Array,
    jump_speed: float,
) -> Array:
    """Return the robot's speed towards the point of contact (K,), m/s; NaN if unknown.

    Uses the table's bearing if there is one, else the person's centre at the onset.
    """
    if not len(time):
        return np.empty(0)
    if encounter(run, jump_speed).footprint is not None:
        return _closing_of_outline(run, agent, sample, bearing, jump_speed)
    vx, vy = (v[sample] for v in robot_velocities(run, jump_speed))
    recorded = inf_to_nan(robot_of(run).theta)[sample] + bearing
    towards = _direction_of(run, time, agent, sample, jump_speed)
    angle = np.where(np.isfinite(recorded), recorded, towards)
    stands = np.hypot(vx, vy) == 0.0
    return np.where(stands, 0.0, vx * np.cos(angle) + vy * np.sin(angle))


def _closing_of_outline(
    run: Trajectories,
    agent: NDArray[np.int64],
    sample: NDArray[np.int64],
    bearing: Array,
    jump_speed: float,
) -> Array:
    """Like `_closing`, of a robot with a footprint: by the point nearest to the person.

    The bearing counts only if the person is not in the table of people.
    """
    known = agent >= 0
    found = np.full(len(sample), np.nan)
    found[known] = touch_point(run, sample[known], agent[known], jump_speed).closing
    vx, vy = (v[sample] for v in robot_velocities(run, jump_speed))
    angle = inf_to_nan(robot_of(run).theta)[sample] + bearing
    velocity = np.where(np.hypot(vx, vy) == 0.0, 0.0, vx * np.cos(angle) + vy * np.sin(angle))
    return np.where(known & np.isfinite(found), found, velocity)


def _direction_of(
    run: Trajectories,
    time: Array,
    agent: NDArray[np.int64],
    sample: NDArray[np.int64],
    jump_speed: float,
) -> Array:
    """Return the world direction from the robot to a person between two samples (K,), rad."""
    pair = encounter(run, jump_speed)
    if not pair.px.shape[1]:
        return np.full(len(time), np.nan)
    after = np.minimum(sample + 1, len(run.t) - 1)
    span = run.t[after] - run.t[sample]
    part = np.divide(time - run.t[sample], span, out=np.zeros(len(time)), where=span > 0)
    px, py = (
        p[sample, agent] + part * (p[after, agent] - p[sample, agent]) for p in (pair.px, pair.py)
    )
    first = pair.px[sample, agent], pair.py[sample, agent]
    px, py = (np.where(np.isfinite(p), p, q) for p, q in zip((px, py), first, strict=True))
    return np.where(agent >= 0, np.arctan2(py, px), np.nan)

"""Recordings of several robots: one run of each, with the people that all of them met."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from crowdbot.core.recording.container.records import Record, Records, decode
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.reading.assemble import Collected
from crowdbot.core.recording.reading.scan_collector import ScanCollector, cones, lidars
from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.recording.topics import Topic
from crowdbot.core.support.immutable import immutable
from crowdbot.core.trajectories.trajectories import AgentTracks, Trajectories, Trips
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetMember:
    """One robot of a fleet.

    Attributes:
        run: as if it had been alone with the people: until it ended.
        scans: what its sensors of distances saw.
        until: when it ended, s.
    """

    header: RecordingHeader
    run: Trajectories
    scans: list[ReplayScan]
    complete: bool
    until: float


def read_fleet(
    path: Path, max_rate: float | None = None, also: Callable[[Record], None] | None = None
) -> Mapping[str, FleetMember]:
    """The robots of a recording of several, by name.

    Args:
        path: a recording.
        max_rate: leave out scans so that at most this many per second remain, Hz.
        also: is given each record.

    Raises:
        InputError: no recording of several robots, or damaged.
    """
    records = Records(path)
    topics: dict[str, tuple[str, str]] = {}
    by_name: dict[str, list[Record]] = {}
    for record in records:
        if also is not None:
            also(record)
        if record.topic not in topics:
            topics[record.topic] = _split(record.topic)
        name, topic = topics[record.topic]
        by_name.setdefault(name, []).append(record._replace(topic=topic))
    named = {n: rows for n, rows in by_name.items() if any(r.topic == Topic.HEADER for r in rows)}
    people = named.pop("", [])
    if not named:
        raise InputError(f"{path}: no recording of several robots")
    shared = _collected(path, people).people(path)
    return {
        name: _member(path, rows, shared, max_rate, finished=records.finished)
        for name, rows in named.items()
    }


def fleet_names(path: Path) -> tuple[str, ...]:
    """Names of the robots of a recording of several; empty of any other.

    Raises:
        InputError: not an MCAP file, or damaged.
    """
    names: list[str] = []
    for record in Records(path):
        if record.topic.endswith(Topic.STATE):
            break  # all headers come before
        name, topic = _split(record.topic)
        if name and topic == Topic.HEADER:
            names.append(name)
    return tuple(names) if len(names) > 1 else ()


def _split(topic: str) -> tuple[str, str]:
    """Robot and the rest of a topic; what is on the first level belongs to all."""
    for known in Collected.TOPICS:
        if topic == known:
            return "", topic
    name, slash, rest = topic.removeprefix("/").partition("/")
    return (name, f"/{rest}") if slash else ("", topic)


def _collected(path: Path, records: list[Record]) -> Collected:
    collected = Collected()
    for record in records:
        if record.topic in Collected.TOPICS:
            collected.add_record(path, record)
    return collected


def _member(
    path: Path,
    records: list[Record],
    people: Trajectories | None,
    max_rate: float | None,
    *,
    finished: bool,
) -> FleetMember:
    collected = _collected(path, records)
    header, own = collected.header(path), collected.trajectories(path)
    scans = ScanCollector(path, lambda header: {**lidars(header), **cones(header)}, max_rate)
    scans.open(header)
    for record in records:
        scans.add(record)
    end = next((r for r in records if r.topic == Topic.END), None)
    until = float(own.t[-1]) if end is None else end.ns / 1e9
    complete = finished and end is not None and bool(decode(path, end).complete)
    run = own if people is None else among(own, people, until)
    return FleetMember(header=header, run=run, scans=scans.scans(), complete=complete, until=until)


def among(own: Trajectories, people: Trajectories, until: float) -> Trajectories:
    """One robot's run, with the people whom all robots met, until it ended.

    Args:
        own: of the robot alone.
        people: of the people alone, sampled at the same times, perhaps for longer.
        until: when the robot ended, s.

    Raises:
        InputError: the samples are not at the same times.
    """
    count, agents, trips = len(own.t), people.agents, people.trips
    if len(people.t) < count or not np.array_equal(own.t, people.t[:count]):
        raise InputError("robots and people are not sampled at the same times")
    if agents is None or trips is None:
        return own
    cut = trips.t1 > until
    row = np.argsort(np.argsort(agents.id))[np.searchsorted(np.sort(agents.id), trips.agent)]
    going_on = np.flatnonzero(cut & (trips.t0 <= until))
    begun = np.concatenate([np.flatnonzero(~cut), going_on[np.argsort(row[going_on])]])
    return replace(
        own,
        agents=AgentTracks(
            id=agents.id, radius=agents.radius, mass=agents.mass,
            x=immutable(agents.x[:count]), y=immutable(agents.y[:count]),
            vx=immutable(agents.vx[:count]), vy=immutable(agents.vy[:count]),
            jump=None if agents.jump is None else immutable(agents.jump[: count - 1]),
        ),
        trips=Trips(
            agent=immutable(trips.agent[begun]),
            t0=immutable(trips.t0[begun]),
            t1=immutable(np.minimum(trips.t1, until)[begun]),
            reached=immutable((trips.reached & ~cut)[begun]),
        ),
    )  # fmt: skip

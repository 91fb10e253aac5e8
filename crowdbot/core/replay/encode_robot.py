"""Pack the robots of a run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from crowdbot.core.replay.encode_contacts import contacts_of
from crowdbot.core.replay.other_track import OtherTrack, Seen, motion_of, motion_until
from crowdbot.core.replay.pack import pack_words
from crowdbot.core.replay.shown_run import ShownRun
from crowdbot.core.trajectories.person_track import members_of
from crowdbot.core.trajectories.tracks import AgentTracks
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array


def encode_robots(shown: ShownRun) -> tuple[dict[str, Any], dict[str, str]]:
    """Return robots with all contacts, and their x, y, theta, v, w (5, N), float32."""
    run = shown.run
    contacts = contacts_of(run)
    about, motions = [], []
    if run.robot is not None:
        about.append(_about(run, shown.robot, shown.look, run.agents))
        motions.append(motion_of(run.robot))
    for other in shown.others:
        contacts += [{**contact, "robot": len(about)} for contact in contacts_of(other.run)]
        about.append(_about(other.run, other.name, other.look, run.agents))
        motions.append(_motion(other, len(run.t)))
    blobs = {f"robot{i}": pack_words(rows.astype("<f4")) for i, rows in enumerate(motions)}
    contacts.sort(key=lambda contact: contact["t0"])
    return {"robots": about, "contacts": contacts}, blobs


def _motion(other: OtherTrack, samples: int) -> Array:
    assert other.run.robot is not None  # runs of robots
    return motion_until(other.run.robot, samples, leaves=other.leaves)


def _about(
    run: Trajectories, name: str, look: Sequence[Seen], people: AgentTracks | None
) -> dict[str, Any]:
    robot = run.robot
    assert robot is not None
    task_people = None if people is None or run.person is None else members_of(people, run.person)
    return {
        **robot_numbers(name, robot.radius, run.robot_footprint, run.goal_zone, look),
        "wanted": [] if task_people is None else task_people.tolist(),
        "goal": robot.goal,
        "goalRadius": robot.goal_radius,
        "goalTime": robot.goal_time,
    }


def robot_numbers(
    name: str, radius: float, outline: Array | None, zone: Array | None, look: Sequence[Seen]
) -> dict[str, Any]:
    """Return the numbers to draw a robot: its outline, its parts from above, its goal zone."""
    return {
        "name": name,
        "radius": radius,
        "outline": [] if outline is None else np.round(outline, 4).tolist(),
        "zone": [] if zone is None else np.round(zone, 4).tolist(),
        "look": [[colour, np.round(part, 3).tolist()] for part, colour in look],
    }

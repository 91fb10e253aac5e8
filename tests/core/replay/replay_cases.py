"""Runs made by hand for the replay page: a robot passes by two people and touches one."""

from __future__ import annotations

from typing import Any

import numpy as np

from crowdbot.core.recording.reading.images import ReplayImages
from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.replay.shown_run import Scenery, ShownRun
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score

DURATION, RATE = 10.0, 16
NEAR_AT, CONTACT_AT, ARRIVED_AT = 4.0, 6.5, 9.5  # s


def score(metric: str, value: float | None, status: str = "ok", **more: Any) -> Score:
    """One of a category."""
    return Score(
        **{
            "metric": metric, "symbol": "X", "category": "path_efficiency", "variant": "corrected",
            "unit": "m", "better": "lower", "status": status, "value": value, **more,
        }
    )  # fmt: skip


def passing(label: str = "dwa", speed: float = 0.5, aside: float = 0.55) -> ShownRun:
    """At 4 s it is 5 cm from person 7, at 6.5 s it touches person 9, at 9.5 s it arrives.

    Args:
        label: of the run.
        speed: of the robot, m/s; another one changes the times.
        aside: where person 7 stands, m.
    """
    t = np.arange(int(DURATION * RATE) + 1) / RATE
    still = np.ones_like(t)
    names = ("t0", "t1", "agent", "impulse", "peak_force", "relative_speed", "bearing")
    contact = (CONTACT_AT, CONTACT_AT + 0.25, 9, 2.5, 40.0, 0.5, 0.3)
    run = Trajectories.from_arrays(
        t=t, robot_x=speed * t, robot_y=0 * t, robot_theta=0 * t, robot_v=speed * still,
        robot_w=0 * t, robot_radius=0.2, robot_mass=6.0, robot_goal=(4.75, 0.0),
        robot_goal_radius=0.3, robot_goal_time=ARRIVED_AT,
        agent_id=[7, 9], agent_radius=0.3, agent_mass=70.0,
        agent_x=np.column_stack((2.0 * still, 3.5 - 0.01 * t)),
        agent_y=np.column_stack((aside * still, -0.45 * still)),
        contacts={name: [value] for name, value in zip(names, contact, strict=True)},
        walls=[[-1, -2, 6, -2], [-1, 2, 6, 2]], planner_step_time=0.001 * still,
        signals={"my/signal": np.column_stack((t, np.sin(t)))},
    )  # fmt: skip
    return ShownRun(
        run=run,
        title=f"passing · {label}",
        label=label,
        facts={"Planner": label, "Status": "arrived"},
        scans=_scans(),
        images=_images(),
        scores=[score("path_length", 4.0 * speed), score("delay", None, "undefined")],
        scenery=Scenery(
            walls=np.array([[-1, -2, 6, -2], [-1, 2, 6, 2], [6, -2, 6, 2.0]]),
            stops_robot=np.array([True, True, True]),
            stops_crowd=np.array([True, True, False]),
            pillars=np.array([[0.0, 1.2, 0.2]]),
            blocks=(np.array([[5.0, -1.8], [5.8, -1.8], [5.8, -1.2], [5.0, -1.2]]),),
            steps=(np.array([[0.0, -1.9], [1.0, -1.9], [1.0, -1.7], [0.0, -1.7]]),),
        ),
    )


def _scans() -> list[ReplayScan]:
    t = np.arange(80) / 8.0
    beams, edges = np.linspace(-2.0, 2.0, 90), np.array([-0.2, 0.2])
    return [
        ReplayScan(
            sensor=name, mount=(0.1, 0.0, 0.2, 0.0), angles=angles, range_max=5.0, t=t,
            ranges=np.full((80, 1 if name == "sonar" else 90), 1.5), cone=name == "sonar",
        )
        for name, angles in (("front", beams), ("sonar", edges))
    ]  # fmt: skip


def _images() -> list[ReplayImages]:
    """Two colour images, red then green; one of depth with a hole."""
    red, green = (200, 0, 0), (0, 200, 0)
    colour = np.array([[[red] * 8] * 6, [[green] * 8] * 6], np.uint8)
    depth = np.full((1, 6, 8), 4000, np.uint16)
    depth[0, 0, 0] = 0
    return [
        ReplayImages(sensor="eye", kind="colour", t=np.array([0.5, 5.0]), pixels=colour),
        ReplayImages(sensor="eye", kind="depth", t=np.array([0.5]), pixels=depth),
    ]

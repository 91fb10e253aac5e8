"""Pictures of metrics: one for each, small, on its page and in the gallery, and drawn truly."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.core.trajectories.preprocess import time_weights, truncate_at_arrival
from scripts import make_metric_pictures as pictures
from scripts.metric_pictures.figure import Array
from scripts.metric_pictures.near import wall_gap
from scripts.metric_pictures.registry import DRAWINGS
from scripts.metric_pictures.world import ANSWERS, World, all_metrics, made_up_commands
from tests.docs.doc_pages import read
from tests.paths import ROOT

#: A picture is smaller than this.
SMALL = 40_000


def test_every_metric_is_drawn_and_no_other() -> None:
    missing, extra = set(all_metrics()) - set(DRAWINGS), set(DRAWINGS) - set(all_metrics())
    assert not missing, f"draw {missing}: a function with @draws in scripts/metric_pictures/"
    assert not extra, f"scripts/metric_pictures/ draws {extra}, which no metric is named"
    assert {p.stem for p in pictures.IMAGES.glob("*.svg")} == set(DRAWINGS)
    assert all(p.stat().st_size < SMALL for p in pictures.IMAGES.glob("*.svg"))


def test_the_readme_says_how_many_there_are() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"[{len(all_metrics())} metrics]" in readme, "count them again in README.md"


@pytest.mark.parametrize("metric", DRAWINGS)
def test_every_page_shows_its_picture(metric: str) -> None:
    page = read(f"reference/metrics/{metric}.md")
    assert f"](../../images/metrics/{metric}.svg)" in page


def _track(t: Array, way: float) -> dict[str, Any]:
    """A robot that goes aside once by ``way`` (m) and reaches its goal."""
    y = way * np.sin(np.pi * t / t[-1]) ** 2
    vx, vy = np.full(len(t), 0.5), np.gradient(y, t)
    return {
        "robot_x": 0.5 * t, "robot_y": y, "robot_theta": np.arctan2(vy, vx),
        "robot_v": np.hypot(vx, vy), "robot_w": np.gradient(np.arctan2(vy, vx), t),
        "robot_radius": 0.18, "robot_mass": 6.3, "robot_goal_time": float(t[-1]),
        "robot_goal": (0.5 * float(t[-1]) + 0.4, 0.0), "robot_speed_limit": 0.65,
        "goal_zone": [[0.5 * t[-1] + x, y] for x, y in ((0, -1), (1, -1), (1, 1), (0, 1))],
        "walls": [[-1, -2, 14, -2], [-1, 2, 14, 2]],
    }  # fmt: skip


def _crowd(t: Array, aside: float) -> dict[str, Any]:
    """Two who come towards the robot, one of whom goes aside by ``aside`` (m), and one behind."""
    x = np.stack([8 - t, 9 - 0.8 * t, -0.5 + 0.6 * t], axis=1)
    y = np.stack([0.1 + aside * np.exp(-((t - 5.0) ** 2)), 0.9 + 0 * t, -0.9 + 0 * t], axis=1)
    ends = [float(t[-1])] * 3
    return {
        "agent_x": x, "agent_y": y, "agent_vx": np.gradient(x, t, axis=0),
        "agent_vy": np.gradient(y, t, axis=0), "agent_radius": 0.25, "agent_mass": 70.0,
        "trip_agent": [0, 1, 2], "trip_t0": [0.0] * 3, "trip_t1": ends,
        "trip_reached": [True] * 3,
    }  # fmt: skip


@pytest.fixture(scope="module")
def world() -> World:
    t = np.linspace(0.0, 10.0, 161)
    touched: dict[str, Any] = {
        "t0": [5.0], "t1": [5.2], "agent": [0], "impulse": [3.0], "peak_force": [40.0],
        "relative_speed": [1.2], "bearing": [0.0],
    }  # fmt: skip
    whole = crowdbot.Trajectories.from_arrays(
        t=t, **_track(t, 0.6), **_crowd(t, 0.5), contacts=touched, planner_step_time=[0.01, 0.02]
    )  # fmt: skip
    alone = crowdbot.Trajectories.from_arrays(t=t, **_track(t, 0.2))
    crowd = crowdbot.Trajectories.from_arrays(t=t, **_crowd(t, 0.0))
    commands = made_up_commands(whole)
    scores = crowdbot.score(
        whole, alone, crowd, commands=commands, questionnaires=ANSWERS, metrics=all_metrics()
    )
    return World(whole, truncate_at_arrival(whole), alone, crowd, commands, scores)


@pytest.mark.parametrize("metric", DRAWINGS)
def test_whatever_runs_are_like_all_is_drawn(metric: str, world: World) -> None:
    drawn = DRAWINGS[metric].draw(world, metric).svg()
    assert world.title(metric).replace("<", "&lt;") in drawn
    assert len(drawn) < SMALL
    assert re.search(r"<(path d=\"M|rect x=|circle|polygon)", drawn.partition("</text>")[2])
    assert not re.search(r"nan|inf\b", re.sub(r"<t[^>]*>[^<]*</t", "", drawn))


def test_what_is_drawn_gives_the_score(world: World) -> None:
    """Lines of pictures are those whose mean, least or area the metric tells."""
    weights = time_weights(world.t)
    span = float(world.t[-1])
    drawn = {
        "min_clearance": world.gap.min(),
        "avg_clearance": weights @ world.gap / span,
        "proximity": weights @ (1.0 / np.maximum(world.distance, 0.1)) / span,
        "intimate_time_fraction": weights @ (world.gap < 0.45) / span,
        "personal_time_fraction": weights @ ((world.gap >= 0.45) & (world.gap < 1.2)) / span,
        "social_time_fraction": weights @ ((world.gap >= 1.2) & (world.gap < 3.6)) / span,
        "space_compliance": weights @ (world.gap > 0.5) / span,
        "neighbour_count": weights @ world.near.sum(axis=1) / span,
        "time_exposed": weights @ (world.time_to_collision < 5.0),
        "min_time_to_collision": world.time_to_collision.min(),
        "min_wall_clearance": wall_gap(world).min(),
        "final_distance_to_goal": world.to_zone(world.run)[-1],
        "contact_impulse": 3.0,
        "max_planner_time": 0.02,
    }
    for metric, value in drawn.items():
        assert world.scores.find(metric).value == pytest.approx(float(value), rel=1e-9), metric


def test_a_picture_takes_its_place_once() -> None:
    page = "# x\n\nText.\n\n## Formula\n\n    x\n"
    once = pictures.with_picture(page, "speed")
    assert once.count("images/metrics/speed.svg") == 1
    assert once.index("![") < once.index("## Formula")
    assert pictures.with_picture(once, "speed") == once

"""The push of people who are forced aside, as rewards get it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.batch.encounters import press
from crowdbot.core.batch.robot_tables import DRIVE_STATE
from crowdbot.core.crowd.contact.robot_contact import ROBOT
from crowdbot.core.crowd.state import PERSON, PRESENT
from crowdbot.core.crowd.traits import TRAITS
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import as_record, as_rows
from crowdbot.core.trajectories.evasion import evasion, own_legs
from crowdbot.core.trajectories.headway import share_below
from crowdbot.core.types.arrays import Array

DISC, LONG = np.full((1, 2, 2), np.nan), np.array([[[-0.6, 0.0], [0.6, 0.0]]])


@kernel
def call(
    drive: Array, robot: Array, outlines: Array, people: Array, traits: Array, pressed: Array
) -> None:
    """Call with rows of numbers."""
    press(
        as_record(drive, DRIVE_STATE), as_record(robot, ROBOT), outlines, 0,
        as_rows(people, PERSON), as_rows(traits, TRAITS), pressed, 0.1,
    )  # fmt: skip


def row(record: Any, **values: float) -> Array:
    found = np.zeros(len(record.names))
    for name, value in values.items():
        found[record.names.index(name)] = value
    return found


def forced(outlines: Array = DISC, /, **person: float) -> float:
    drive, robot = row(DRIVE_STATE), row(ROBOT, vx=0.8, body=0.2)
    here = {"x": 0.8, "ax": 1.5, "waiting": PRESENT, **person}
    call(drive, robot, outlines, row(PERSON, **here), row(TRAITS, radius=0.3), np.zeros(1))
    return float(drive[DRIVE_STATE.names.index("forced")])


def test_it_is_push_times_approach() -> None:
    assert forced() == pytest.approx(0.1 * 1.5 * 0.8)
    # Both as far as they point from one to the other.
    cos = 0.8 / np.hypot(0.8, 0.1)
    assert forced(y=0.1) == pytest.approx(0.1 * 1.5 * 0.8 * cos**2)


@pytest.mark.parametrize(
    "person",
    [
        {"x": 0.95},  # is reached after more than half a second
        {"x": 0.45},  # is touched
        {"y": 0.7},  # would be passed
        {"x": -0.8, "ax": -1.5},  # is left behind
        {"ax": -1.5},  # comes nearer
        {"push_y": 0.1},  # is pushed by others
        {"waiting": PRESENT + 1},  # is not there
    ],
    ids=str,
)
def test_no_one_else_is_forced_aside(person: dict[str, float]) -> None:
    assert forced(**person) == 0.0


def test_the_outline_counts() -> None:
    assert forced(LONG, x=1.4) > 0.0
    assert forced(LONG, x=1.6) == 0.0


def test_each_person_is_driven_aside_once() -> None:
    drive, robot = row(DRIVE_STATE), row(ROBOT, vx=0.8, body=0.2)
    people = np.concatenate([row(PERSON, x=0.8, ax=a, waiting=PRESENT) for a in (1.0, 0.5)])
    traits, pressed, counted = np.tile(row(TRAITS, radius=0.3), 2), np.zeros(2), []
    for _ in range(8):
        call(drive, robot, DISC, people, traits, pressed)
        counted.append(float(drive[DRIVE_STATE.names.index("aside")]))
    # 0.08 and 0.04 J/kg in each call, of 0.25 J/kg.
    assert counted[0] == pytest.approx((0.08**2 + 0.04**2) / 0.25**2)
    assert counted[3] == pytest.approx(1.0 + (0.16 / 0.25) ** 2)
    assert counted[-1] == pytest.approx(2.0)


@pytest.mark.slow
def test_it_is_about_that_of_the_score() -> None:
    gym = pytest.importorskip("gymnasium", reason="the extra rl is not installed")
    rl = pytest.importorskip("crowdbot.rl")
    nothing = dict.fromkeys(("progress", "arrival", "time", "contact", "wall", "change"), 0.0)
    env = rl.EpisodeRecorder(gym.make(
        rl.NAV, suite="challenge-2020", scenario="counter-d0250-fast-c20-r05",
        reward={"kind": "progress", "forced": 1.0, **nothing},
    ))  # fmt: skip
    ours = scores = 0.0
    aside = [0, 0]
    for seed in (2, 3):
        env.reset(seed=seed)
        ours -= sum(env.step(np.array([1.0, 0.0], np.float32))[1] for _ in range(16 * 40))
        run, pressed = env.trajectories, env.unwrapped.rollout.world(0).crowd.arrays["pressed"]
        share = share_below(run, 0.5, 8.0) * own_legs(run, 2.0, 8.0)
        pushes = evasion(run, 2.0, 8.0).push(share)
        scores += float(pushes.sum())
        aside = [aside[0] + int((pressed > 0.25).sum()), aside[1] + int((pushes > 0.25).sum())]
    assert scores > 1.0
    assert 0.7 < ours / scores < 1.5
    assert aside[1] > 3
    assert 0.6 < aside[0] / aside[1] < 1.6

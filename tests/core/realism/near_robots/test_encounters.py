"""Encounters and their numbers, on clips with known answers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from crowdbot.core.realism.near_robots.encounters import BODY, encounters_of
from crowdbot.core.realism.near_robots.features import FEATURES, features_of
from tests.core.realism.near_robots.walks import clip


def _features(*args: float, **given: float) -> dict[str, float]:
    (found,) = encounters_of([clip(*args, **given)])
    return dict(zip(FEATURES, features_of([found], [found.person])[0].tolist(), strict=True))


@pytest.mark.parametrize(
    ("angle", "kind"),
    [(math.pi, "front"), (2.5, "front"), (1.57, "cross"), (-2.0, "cross"), (0.3, "behind")],
)
def test_the_kind_is_the_angle_between_the_ways(angle: float, kind: str) -> None:
    (found,) = encounters_of([clip(angle, own=0.9 if kind == "behind" else 1.2)])
    assert found.kind == kind
    assert found.robot_speed == pytest.approx(1.0, abs=0.01)


def test_a_person_who_would_pass_far_away_or_stands_meets_nobody() -> None:
    assert encounters_of([clip(offset=1.2)]) == []
    assert encounters_of([clip(own=0.1)]) == []
    assert encounters_of([clip(speed=0.05)]) == []


def test_straight_on_is_a_touch_without_evasion() -> None:
    found = _features()
    assert found["gap"] == pytest.approx(-0.25 - BODY, abs=0.03)
    assert found["evades"] == 0.0
    assert math.isnan(found["onset_ttc"])
    assert math.isnan(found["passes_first"])
    assert found["deviation"] == pytest.approx(0.0, abs=0.01)
    assert found["slowest"] == pytest.approx(1.0, abs=0.01)


def test_a_step_aside_has_its_onset_when_it_begins() -> None:
    found = _features(aside=0.8)
    assert found["gap"] == pytest.approx(0.8 - 0.25 - BODY, abs=0.03)
    assert found["deviation"] == pytest.approx(0.8, abs=0.03)
    assert found["evades"] == 1.0
    assert 2.2 < found["onset_ttc"] + (0.25 + BODY) / 2.2 < 3.2
    assert 0.4 < found["lateral_acceleration"] < 1.4


def test_slowing_down_lets_the_robot_pass_first() -> None:
    found = _features(angle=1.57, slow=0.4)
    assert found["passes_first"] == 0.0
    assert found["slowest"] == pytest.approx(0.4, abs=0.05)
    assert found["braking"] > 0.3
    assert _features(angle=1.57, slow=1.25)["passes_first"] == 1.0


def test_moved_and_turned_recordings_give_the_same_numbers() -> None:
    one = clip(1.2, aside=0.5)
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c, s], [-s, c]])
    pose = np.column_stack([one.pose[:, :2] @ turn + 3.0, one.pose[:, 2] + 0.7])
    other = replace(one, pose=pose, people=one.people @ turn + 3.0)
    (a,), (b,) = encounters_of([one]), encounters_of([other])
    assert features_of([a], [a.person]) == pytest.approx(
        features_of([b], [b.person]), abs=1e-9, nan_ok=True
    )

"""Groups hold together: gaze, cohesion, repulsion, whatever the policy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.groups import forces_of, groups_of, hold_together
from crowdbot.core.crowd.periodic_boundary import ENDLESS
from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.support.records import rows_in
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.group_forces import GroupForces

FORCES = GroupForces(limit=100.0)


def rows_at(places: list[tuple[float, float]], velocity: tuple[float, float] = (1.0, 0.0)) -> Array:
    rows = np.zeros((len(places), s.AGENT_COLUMNS))
    rows[:, s.X : s.Y + 1] = places
    rows[:, s.VX : s.VY + 1] = velocity
    rows[:, s.DIR_X : s.DIR_Y + 1] = np.array(velocity) / math.hypot(*velocity)
    rows[:, s.ON_TRIP] = 1.0
    return rows


def pulled(rows: Array, forces: GroupForces = FORCES, boundary: Array = ENDLESS) -> Array:
    count = len(rows)
    everybody = np.arange(count), np.array([0, count])
    hold_together(
        rows_in(rows, s.PERSON), *everybody, np.full(count, 100.0), boundary, forces_of(forces)
    )
    return rows[:, s.AX : s.AY + 1]


def by_hand(places: list[tuple[float, float]], i: int, v: tuple[float, float]) -> Array:
    """The three forces as the paper has them."""
    p, others = np.array(places[i]), np.array([q for j, q in enumerate(places) if j != i])
    to = (others - p).sum(axis=0) / len(places)
    away = float(np.hypot(*to))
    force = np.zeros(2)
    for q in others:
        d = q - p
        if 0.0 < np.hypot(*d) < 0.8:
            force -= d / np.hypot(*d)
    if away == 0.0:
        return force
    if away > (len(places) - 1) / 2.0:
        force += 3.0 * to / away
    cosine = np.clip(np.dot(to / away, v) / math.hypot(*v), -1.0, 1.0)
    return np.asarray(force - 4.0 * max(0.0, math.acos(cosine) - math.pi / 2.0) * np.array(v))


@given(
    st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=2, max_size=5, unique=True),
    st.tuples(st.floats(0.1, 2), st.floats(-2, 2)),
)
@settings(max_examples=80)
def test_forces_are_those_of_the_paper(
    places: list[tuple[float, float]], velocity: tuple[float, float]
) -> None:
    found = pulled(rows_at(places, velocity))
    for i in range(len(places)):
        assert found[i] == pytest.approx(by_hand(places, i, velocity), abs=1e-6)


def test_who_is_ahead_slows_down() -> None:
    ahead, behind = pulled(rows_at([(1.0, 0.0), (0.0, 0.0)]))
    assert ahead[0] < 0.0
    assert behind[0] == 0.0


def test_the_sum_keeps_to_the_limits() -> None:
    rows = rows_at([(0.0, 0.0), (7.0, 0.0)])
    rows[:, s.AX] = 5.0
    hold_together(
        rows_in(rows, s.PERSON), np.array([0, 1]), np.array([0, 2]), np.array([5.0, 5.0]), ENDLESS,
        forces_of(GroupForces()),
    )  # fmt: skip
    assert np.hypot(rows[:, s.AX], rows[:, s.AY]).max() <= 5.0 + 1e-9


def test_the_absent_the_far_and_the_resting_do_not_count() -> None:
    rows = rows_at([(0.0, 0.0), (2.0, 0.0), (20.0, 0.0)])
    rows[1, s.WAITING] = s.GONE
    assert pulled(rows).tolist() == [[0.0, 0.0]] * 3
    rows = rows_at([(0.0, 0.0), (3.0, 0.0)])
    rows[0, s.ON_TRIP] = 0.0
    assert pulled(rows)[0].tolist() == [0.0, 0.0]


def test_the_nearest_way_leads_across_the_border_of_a_torus() -> None:
    rows = rows_at([(0.5, 5.0), (9.0, 5.0)], velocity=(0.0, 1.0))
    found = pulled(rows, boundary=np.array([0.0, 10.0, 0.0, 10.0]))
    assert found[0][0] < 0.0 < found[1][0]


def test_rows_of_groups() -> None:
    agents = Agents.of(
        x=[0.0, 1.0, 2.0, 3.0, 4.0], y=[0.0] * 5, id=[9, 3, 7, 1, 2], group=[4, -1, 2, 4, 5]
    )
    members, ends = groups_of(agents)
    assert members.tolist() == [3, 0]
    assert ends.tolist() == [0, 2]


class Straight:
    contact_stiffness = 0.0

    def velocities(self, view: CrowdView, dt: float) -> Array:  # noqa: ARG002 - the contract
        to = view.goal - view.position
        pace = view.agents.preferred_speed[:, np.newaxis]
        return np.asarray(pace * to / np.hypot(to[:, :1], to[:, 1:]))


@pytest.mark.parametrize(("cohesion", "together"), [(GroupForces(), True), (None, False)])
def test_a_slow_member_is_waited_for(cohesion: GroupForces | None, *, together: bool) -> None:
    given: dict[str, Any] = {"routes": [[(99.0, 0.0)], [(99.0, 0.7)]], "group": [1, 1]}
    agents = Agents.of(x=[0.0, 0.0], y=[0.0, 0.7], preferred_speed=[1.4, 0.9], **given)
    crowd = CrowdEngine(agents, CrowdWorld(cohesion=cohesion), Straight())
    _, position = crowd.run(15.0)
    apart = math.dist(position[-1, 0], position[-1, 1])
    assert (apart < 2.5) == together
    assert position[-1, :, 0].min() > 10.0

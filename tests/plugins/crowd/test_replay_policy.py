"""Recorded people: reading, resampling, following, with and without avoidance."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.recorded import read_record
from crowdbot.dsl.spec.assets import Asset
from crowdbot.errors import InputError
from crowdbot.plugin import Range
from crowdbot.plugins.crowd.cost_functions.ttca_dca.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.policies.replay import ReplaySpec
from crowdbot.plugins.crowd.policies.replay_build import build
from tests.core.crowd.crowd_reference import Array
from tests.core.crowd.crowd_worlds import TICKS, rows
from tests.core.crowd.oracle_cases import compiled


def _curve(t: Array, who: int) -> Array:
    """A wavy walk at 1 m/s or so."""
    return np.column_stack([2.0 * who + t, 0.5 * np.sin(t + who)])


@pytest.fixture
def table(tmp_path: Path) -> Path:
    """Three people, ids 3, 5, 9, sampled at 10 Hz; the last one comes late, rows shuffled."""
    lines = []
    for who, start in ((3, 0.0), (5, 0.0), (9, 2.05)):
        t = start + np.arange(0.0, 6.0, 0.1)
        lines += [
            f"{a!r},{who},{x!r},{y!r}"
            for a, (x, y) in zip(t.tolist(), _curve(t, who).tolist(), strict=True)
        ]
    np.random.default_rng(0).shuffle(lines)
    path = tmp_path / "people.csv"
    path.write_text("t,id,x,y\n" + "\n".join(lines) + "\n")
    return path


def words(table: Path) -> ReplaySpec:
    return ReplaySpec(file=Asset(path=str(table)))


def test_a_record_is_resampled_on_the_line_between_samples(table: Path) -> None:
    record = read_record(table)
    assert sorted(record.time) == [3, 5, 9]
    halfway = 0.5 * (_curve(np.array([1.0]), 5) + _curve(np.array([1.1]), 5))[0]
    assert record.at(5, 1.05) == pytest.approx(halfway)
    assert record.at(9, 0.0) == pytest.approx(_curve(np.array([2.05]), 9)[0])
    assert record.at(3, 99.0) == pytest.approx(_curve(np.array([5.9]), 3)[0])


def test_the_agents_of_a_record(table: Path) -> None:
    agents = read_record(table).agents(radius=0.2)
    assert agents.id.tolist() == [3, 5, 9]
    assert agents.start_time.tolist() == [0.0, 0.0, 2.05]
    assert agents.radius.tolist() == [0.2] * 3
    assert agents.preferred_speed == pytest.approx([1.06] * 3, abs=0.05)
    assert agents.x == pytest.approx([6.0, 10.0, 20.05])


def test_people_walk_as_recorded(table: Path) -> None:
    record = read_record(table)
    engine = CrowdEngine(record.agents(), CrowdWorld(), lambda a: build(words(table), [], a))
    t, place = engine.run(9.0)
    for column, who in enumerate((3, 5, 9)):
        seen = np.isfinite(place[:, column, 0])
        first = record.time[who][0]
        assert t[seen][0] == pytest.approx(first, abs=1.0 / 16.0)
        assert t[seen][-1] == pytest.approx(first + 5.9, abs=0.5)  # gone a radius before the end
        error = [np.hypot(*(place[k, column] - record.at(who, t[k]))) for k in np.flatnonzero(seen)]
        assert np.max(error) < 0.05  # the first step is towards the end of the record
        assert np.max(error[8:]) < 0.01


def test_pushed_people_find_back_to_the_record(table: Path) -> None:
    record = read_record(table)
    engine = CrowdEngine(record.agents(), CrowdWorld(), lambda a: build(words(table), [], a))
    flat = engine.initial_state()
    for tick in range(4 * TICKS):
        if tick == TICKS:
            rows(flat)[0, s.Y] += 0.8
        engine.advance(flat)
    assert np.hypot(*(rows(flat)[0, : s.Y + 1] - record.at(3, 4.0))) < 0.05


def test_reactive_people_follow_the_record_and_avoid_what_is_in_the_way(table: Path) -> None:
    """A pillar on the recorded line of 3: walked through exactly, walked around reactively."""
    record = read_record(table)
    pillar = np.array([[*record.at(3, 3.0), 0.4]])
    cost = compiled(TtcaDcaSpec(weight=20.0, range=Range(value=5.0)))
    least, ends = {}, {}
    for name, costs in (("exact", []), ("reactive", [cost])):
        engine = CrowdEngine(
            record.agents(), CrowdWorld(pillars=pillar),
            lambda a, c=costs: build(words(table), c, a),  # type: ignore[misc]
        )  # fmt: skip
        _, place = engine.run(5.0)
        least[name] = float(np.min(np.hypot(*(place[:, 0] - pillar[0, :2]).T)))
        ends[name] = float(np.hypot(*(place[-1, 1] - record.at(5, 5.0))))
    assert least["exact"] < 0.1
    assert least["reactive"] > 0.4
    assert ends["exact"] < 0.02
    assert ends["reactive"] < 1.2


def test_an_agent_that_is_not_recorded_is_refused(table: Path) -> None:
    with pytest.raises(InputError, match="no person with id 4"):
        build(words(table), [], Agents.of(id=[3, 4], x=[0, 1], y=0.0))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", ":1: a record has the columns t,id,x,y"),
        ("time,id,x,y\n0,1,2,3\n", ":1: a record has the columns"),
        ("t,id,x,y\n", "is empty"),
        ("t,id,x,y\n0,1,2,3\n0.1,1,2\n", ":3: '0.1,1,2' is not t,id,x,y"),
        ("t,id,x,y\n0,1,nan,3\n", ":2: "),
        ("t,id,x,y\n0,1.5,2,3\n", ":2: "),
        ("t,id,x,y\n0,1,2,3\n\n0,1,4,3\n", ":4: id 1 is in two places at t = 0"),
        ("t,id,x,y\n0,1,a,3\n", ":2: "),
    ],
)
def test_what_is_no_record_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "r.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message.replace("(", r"\(")):
        read_record(path)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"no_such\.csv: cannot be read"):
        read_record(tmp_path / "no_such.csv")


def test_one_sample_is_a_person_who_stands(tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.write_text("t,id,x,y\n1.0,7,2.0,3.0\n")
    agents = read_record(path).agents()
    assert agents.preferred_speed.tolist() == [0.0]

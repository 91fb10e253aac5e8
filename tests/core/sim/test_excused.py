"""A run whose draw is excused is made again with the next one, which the record tells."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import crowdbot
from crowdbot.core.registry.registry import discover
from crowdbot.core.results.confounds import check_comparable, confounds
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from crowdbot.core.runs.excused import with_draw
from crowdbot.core.runs.record_parts import ExcusedPart
from crowdbot.core.runs.run import Run
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.sim import simulate as simulating
from crowdbot.core.sim.simulate import simulate
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError

SUITE = """
crowdbot: 1
suite: {id: few-people, title: A few people, seed: 3}
base:
  extends: ["builtin:parts/corridor_50x10.yaml", "builtin:parts/turtlebot2.yaml"]
  robots.robot.task: {start: [2.5 m, 0 m, 0 deg], goal: {zone: robot_goal}, time_limit: 1 s}
  crowd:
    speed: {mean: 1.2 m/s, std: 0.1 m/s}
    policy: {kind: velocity_space}
    costs: {reflex: {kind: rvo}}
    flow: {direction: counter, portals: [a, b], density: 0.03 1/m^2, area: crowd}
"""


@pytest.fixture
def scenario(tmp_path: Path) -> Scenario:
    suite = tmp_path / "few-people.yaml"
    suite.write_text(SUITE)
    return crowdbot.expand(suite)[0]


def excused_until(monkeypatch: pytest.MonkeyPatch, draws: int) -> None:
    """As if the robot was struck and toppled in the first draws."""

    def excuse(_: object, __: object, realisation: str, draw: int) -> ExcusedPart | None:
        part = ExcusedPart(draw=draw, person=3, struck_time=0.5, toppled_time=0.75,
                           realisation=realisation, trajectory=f"cb1-sha256:{draw}")  # fmt: skip
        return part if draw < draws else None

    monkeypatch.setattr(simulating, "excuse_of", excuse)


def made(scenario: Scenario, out: Path, most: int) -> Run:
    options = RunOptions(record="none", replay=False, replace_draws=most, force=True)
    return simulate(scenario, discover(), planner="goal_seek", out=out, options=options)


def test_the_next_draw_counts(
    scenario: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = made(scenario, tmp_path / "own", 0)
    assert own.record.excused == []
    assert "excused" not in own.record.document()
    excused_until(monkeypatch, 1)
    run, again = (made(scenario, tmp_path / name, 2) for name in ("a", "b"))
    (part,) = run.record.excused
    assert (part.draw, part.realisation) == (0, own.record.hashes.realisation)
    assert run.record.replace_draws == 2
    # The people are others; the scenario that counts, and its place, are the same.
    starts = [r.trajectories.agents.x[0] for r in (own, run) if r.trajectories.agents]
    assert not np.array_equal(starts[0], starts[1])
    assert run.record.hashes.trajectory == again.record.hashes.trajectory
    assert run.record.hashes.spec == own.record.hashes.spec
    assert run.record.run_id != own.record.run_id
    alone = run.references.crowd_alone
    assert alone is not None
    assert alone.agents is not None
    assert np.array_equal(alone.agents.x[0], starts[1])
    # A second excuse of the same kind is not granted beyond the limit.
    excused_until(monkeypatch, 9)
    assert [e.draw for e in made(scenario, tmp_path / "c", 1).record.excused] == [0]
    one = RunRow(record=run.record, directory="run")
    found = confounds(Results(runs=(one,), scores=()))
    assert [f.kind for f in found if f.kind.startswith("excused")] == ["excused"]


def test_more_than_a_tenth_forbids_a_comparison(scenario: Scenario, tmp_path: Path) -> None:
    own = made(scenario, tmp_path / "own", 0).record
    part = ExcusedPart(draw=0, person=3, struck_time=0.5, toppled_time=0.75,
                       realisation="cb1-sha256:0", trajectory="cb1-sha256:1")  # fmt: skip
    rows = [
        RunRow(
            record=own.model_copy(
                update={"run_id": f"{k}", "seed": k, "excused": [part] * (k < replaced)}
            ),
            directory=f"seed-{k}",
        )
        for replaced in (2,)
        for k in range(20)
    ]
    check_comparable(confounds(Results(runs=tuple(rows), scores=())))
    rows[2] = RunRow(record=rows[2].record.model_copy(update={"excused": [part]}), directory="2")
    with pytest.raises(InputError, match="excused_often"):
        check_comparable(confounds(Results(runs=tuple(rows), scores=())))


def test_draws_are_numbered(scenario: Scenario) -> None:
    keys = [with_draw(scenario, k).crowd for k in range(3)]
    assert len({crowd.seed.key for crowd in keys if crowd is not None}) == 3
    assert with_draw(scenario, 0) is scenario


@pytest.mark.parametrize(("wrong", "why"), [(-1, "at least 0"), (4, "at most 3 draws")])
def test_a_limit(wrong: int, why: str) -> None:
    with pytest.raises(InputError, match=why):
        RunOptions(replace_draws=wrong)

"""What score() makes of its arguments: nothing, commands alone, experimental metrics, tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest

import crowdbot
from crowdbot.core.registry.registry import Plugin, assemble
from crowdbot.core.scoring.evaluate import score
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError, UnknownNameError
from crowdbot.plugin import Component, MetricComponent, MetricSpec
from tests.built_in import built_in
from tests.plugins.metrics.scenes import REGISTRY, grid, line, random_scene, scene

T = grid(2)
STABLE = {
    c.kind for c in built_in("metric") if not (c.experimental or getattr(c, "about_person", False))
}
RUN = scene(T, line(T, (0, 0), (1, 0)), [line(T, (5, 0), (-1, 0))], goal_time=2.0)
COMMANDS = crowdbot.Commands.from_arrays(
    t=T, v_user=T, w_user=T, v_sc=T, w_sc=T, v_max=1.0, w_max=1.0
)


@pytest.mark.parametrize("component", built_in("metric"), ids=lambda c: c.kind)
def test_every_score_says_what_its_metric_declares(component: MetricComponent[Any]) -> None:
    runs: list[tuple[Any, Any, Any]] = [
        (RUN, RUN, RUN),
        (random_scene(3), None, None),
        (None, None, None),
    ]
    for given in runs:
        found = score(REGISTRY, *given[:3], commands=COMMANDS, metrics=component.kind)
        assert [s.variant for s in found] == list(component.variants)
        for s in found:
            variant = component.variants[s.variant]
            assert (s.symbol, s.category) == (component.symbol, component.score_category)
            assert (s.unit, s.better) == (variant.unit, variant.better)
            fields = component.spec.model_validate({"kind": component.kind})
            assert s.parameters == fields.model_dump(exclude={"kind"})


def test_parameters_are_recorded() -> None:
    found = score(REGISTRY, RUN, metrics="risk", parameters={"risk": {"risk_horizon": "3 s"}})
    assert {s.parameters["risk_horizon"] for s in found} == {3.0}


def test_commands_alone() -> None:
    found = crowdbot.score(None, commands=COMMANDS)
    assert {s.metric for s in found} == STABLE
    assert found.find("agreement").value == 1
    assert found.find("risk").reason == "invalid_no_robot"
    assert {s.status for s in found} == {"ok", "undefined"}
    known = {s.metric for s in found if s.status == "ok"}
    assert known == {"agreement", "fluency"}
    beside = crowdbot.score(None, commands=COMMANDS, commands_baseline=COMMANDS)
    assert {s.metric for s in beside if s.status == "ok"} == known | {"user_input_entropy"}


def test_answers_alone() -> None:
    found = crowdbot.score(questionnaires={"use": {"satisfaction": [4] * 7}}, metrics="use")
    assert found.find("use", "satisfaction").value == 4


def test_nothing_to_score() -> None:
    with pytest.raises(InputError, match="nothing to score"):
        crowdbot.score(None)


def test_experimental_metrics_are_scored_on_request() -> None:
    assert {s.metric for s in score(REGISTRY, RUN)} == STABLE
    assert "avg_clearance" not in STABLE
    assert [s.metric for s in score(REGISTRY, RUN, metrics="avg_clearance")] == ["avg_clearance"]
    assert {s.metric for s in score(REGISTRY, RUN, metrics="stl")} == {"stl"}
    assert {s.metric for s in score(REGISTRY, RUN, metrics="*clearance")} == {
        "min_clearance",
        "min_wall_clearance",
        "avg_wall_clearance",
    }
    both = score(REGISTRY, RUN, metrics=["min_clearance", "stalled*"])
    assert {s.metric for s in both} == {"min_clearance", "stalled_time"}


class OldSpec(MetricSpec):
    """Retired."""

    kind: Literal["acme.old"] = "acme.old"


def test_retired_metrics_name_their_successor() -> None:
    old = Component(spec=OldSpec, build="x:y", summary="old", successor="risk", card="# old\n")
    plugins = [Plugin(name="builtin", distribution="crowdbot", components=built_in("metric"))]
    plugins += [Plugin(name="acme", distribution="acme 1", components=(old,))]
    registry = assemble(plugins)
    with pytest.raises(InputError, match=r"'acme.old' is retired; use 'risk'"):
        score(registry, RUN, metrics="acme.old")
    assert "acme.old" not in {s.metric for s in score(registry, RUN)}
    with pytest.raises(UnknownNameError):
        score(registry, RUN, metrics="acme.o*")


def test_scores_do_not_depend_on_what_was_scored_before() -> None:
    """What metrics share of a run changes nothing."""
    run, alone = random_scene(11), random_scene(12)
    together = score(REGISTRY, run, alone, alone)
    for kind in sorted(STABLE):
        fresh, other = random_scene(11), random_scene(12)
        assert list(score(REGISTRY, fresh, other, other, metrics=kind)) == [
            s for s in together if s.metric == kind
        ]


# ------------------------------------------------------------------------- tables
def tables(folder: Path) -> tuple[Path, Path, Path]:
    robot, agents, trips = (folder / f"{n}.csv" for n in ("robot", "agents", "trips"))
    robot.write_text("t,x,y,theta,v,w\n" + "".join(f"{t},{t},0,0,1,0\n" for t in range(4)))
    rows = ["t,id,x,y,jump", "0,7,0,1,", "1,7,1,1,0", "2,7,0,1,1", "0,3,5,5,", "3,3,5,6,0"]
    agents.write_text("\n".join(rows) + "\n")
    trips.write_text("agent,t0,t1,reached\n7,0,1.5,1\n7,1.5,2,0\n")
    return robot, agents, trips


def test_trajectories_from_tables(tmp_path: Path) -> None:
    run = crowdbot.Trajectories.from_csv(
        *tables(tmp_path), robot_radius=0.2, robot_mass=5.0, robot_goal_time=3.0
    )
    assert run.t.tolist() == [0, 1, 2, 3]
    assert run.robot is not None
    assert run.robot.goal_time == 3.0
    assert run.agents is not None
    assert run.agents.id.tolist() == [3, 7]
    assert np.isnan(run.agents.x[:, 1]).tolist() == [False, False, False, True]
    assert run.agents.x[0].tolist() == [5, 0]
    assert run.agents.jump is not None
    assert run.agents.jump.tolist() == [[False, False], [False, True], [False, False]]
    assert run.trips is not None
    assert run.trips.reached.tolist() == [True, False]
    lone = crowdbot.Trajectories.from_csv(agents=tables(tmp_path)[1], agent_radius=0.3)
    assert lone.robot is None
    assert lone.t.tolist() == [0, 1, 2, 3]
    assert lone.agents is not None
    assert lone.agents.radius.tolist() == [0.3, 0.3]


@pytest.mark.parametrize(
    ("table", "text", "message"),
    [
        ("robot", "t,x,theta,v\n0,0,0,0\n", "column y is missing"),
        ("robot", "t,x,y,theta,v,w\n0,0,0,0,0,zero\n", ":2: w"),
        ("agents", "t,id,x,y\n0.5,1,0,0\n", "not a sample of the robot"),
        ("agents", "t,id,x,y\n0,1,0,0\n0,1,0,0\n", "two rows of id 1"),
        ("agents", "t,id,x,y\n0,,0,0\n", "no id"),
        ("trips", "agent,t0\n1,0\n", "columns? t1, reached|column t1, reached is missing"),
    ],
)
def test_tables_that_do_not_fit(tmp_path: Path, table: str, text: str, message: str) -> None:
    files = tables(tmp_path)
    (tmp_path / f"{table}.csv").write_text(text)
    with pytest.raises(InputError, match=message):
        Trajectories.from_csv(*files, robot_radius=0.2, robot_mass=5.0)


def test_tables_and_arguments() -> None:
    with pytest.raises(InputError, match="neither"):
        Trajectories.from_csv()

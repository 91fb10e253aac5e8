"""The suite is valid, and both planners get somewhere in it."""

from __future__ import annotations

from pathlib import Path

import crowdbot
import pytest
from crowdbot.testing import installed

SUITE = "acme:office"


def short(cell: str) -> crowdbot.Scenario:
    """A cell of the suite that ends after 3 s."""
    scenario = crowdbot.load(SUITE, cell)
    assert isinstance(scenario, crowdbot.Scenario)
    robot = scenario.robots["robot"]
    task = robot.task.model_copy(update={"time_limit": 3.0})
    return scenario.model_copy(
        update={"robots": {"robot": robot.model_copy(update={"task": task})}}
    )


def test_every_cell_is_valid() -> None:
    suite = crowdbot.load(SUITE)
    assert isinstance(suite, crowdbot.Suite)
    names = {s.id for s in suite.scenarios}
    assert names == {"cart-drift", "cart-costs", "glider-drift", "glider-costs"}


@pytest.mark.parametrize(
    ("cell", "planner"), [("cart-drift", "acme.swerve"), ("glider-drift", "acme.outside")]
)
def test_a_short_run(cell: str, planner: str, tmp_path: Path) -> None:
    run = crowdbot.simulate(
        short(cell),
        planner=planner,
        out=tmp_path,
        references=False,
        record="used",
        metrics=["acme.hesitation"],
    )
    assert run.status == "timeout"
    robot = run.trajectories.robot
    assert robot is not None
    assert robot.x[-1] - robot.x[0] > 0.5
    (share,) = (s for s in crowdbot.evaluate(run, "acme.hesitation") if s.variant == "share")
    assert (share.status == "ok") == (planner == "acme.swerve"), "only one of them logs the brake"


def test_the_plugin_is_healthy() -> None:
    (acme,) = (p for p in installed().plugins if p.name == "acme")
    assert acme.error == ""

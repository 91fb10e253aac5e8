"""Conditions of Drake that fail give an error and do not end the process."""

from __future__ import annotations

import pytest
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from crowdbot.core.sim.drake_failures import drake_failures

TURNED_ROUND = """<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit effort="1" velocity="-1"/></joint></robot>"""


def test_a_failed_condition_is_an_error() -> None:
    plant = MultibodyPlant(0.0)
    parser = Parser(plant)
    wanted = r"a condition of Drake failed: set_velocity_limits\(\): condition .* failed"
    with pytest.raises(RuntimeError, match=wanted), drake_failures():
        parser.AddModelsFromString(TURNED_ROUND, "urdf")


def test_other_exits_pass() -> None:
    with pytest.raises(SystemExit, match="done"), drake_failures():
        raise SystemExit("done")
